"""Reads results folders of suffuse-solver into numpy arrays. Needs numpy and h5py, nothing else.

    import suffuse
    run = suffuse.open("weir.results")
    run.history["t"], run.history["flux_out"]        # columns of history.csv, over time
    run.boundaries["upstream"]["discharge"]          # one boundary; likewise run.regions["foundation"], run.probes[0]
    run.history.units["flux_out"]                    # "m3/s/m"
    run.times                                        # times of the snapshots, s
    run.mesh.nodes, run.mesh.elements                # places, m, and node numbers of triangles, from 0
    run.field("porosity", time=100.0, on="cell")     # a field of a snapshot; without a time of the last one
    run.points("solid")                              # places of material points, m
    run.fields()                                     # names of all fields, by where they are

All values are in SI units; in two dimensions volumes and masses are per metre of thickness. The columns and fields are
described in docs/reference/file-formats.md. A run can be read while it goes on: `open` it again for what is new. Every mistake is a
`suffuse.Error`, which says what there is.
"""

import collections.abc
import csv
import difflib
import json
import pathlib

import h5py
import numpy as np

__all__ = ["Error", "Mesh", "Run", "Table", "UnknownName", "open"]

FORMAT = "suffuse-results"
# Where fields can be: the kind of snapshot file and the group in it.
PLACES = {
    "cell": ("mesh", "VTKHDF/CellData"),
    "node": ("mesh", "VTKHDF/PointData"),
    "element_vertex": ("mesh", "Suffuse/element_vertex"),
    "solid": ("solid", "VTKHDF/PointData"),
    "liquid": ("liquid", "VTKHDF/PointData"),
}
# Units of the columns of the tables; "-" where there is none. A column that is not listed has the unit "".
UNITS = {
    "s": "t dt failure_time", "m": "x y z head level disc head_mean head_mean_estimate head_mean_time_estimate head_mean_transport_estimate settlement_max displacement_max", "Pa": "pressure pressure_min pressure_max pressure_scatter",
    "m/s": "speed_max flux_x flux_y flux_z", "m3/s": "flux_in flux_out flux_out_low flux_out_high flux_out_estimate flux_out_time_estimate "
            "flux_out_transport_estimate discharge discharge_low discharge_high "
            "discharge_estimate discharge_time_estimate discharge_transport_estimate", "m3": "liquid_in liquid_out volume",
    "g/l": "turbidity_out", "W": "power", "J": "energy", "%": "fines_out_percent solid_out_percent",
    "kg": "solid erodible water fines pending eroded deposited carried water_in water_out fines_in fines_out",
    "-": "porosity porosity_mean concentration concentration_out concentration_min concentration_max saturation "
         "volume_defect eos_error pressure_overshoot residual_water residual_grains conductivity_ratio "
         "liquid_points empty_elements empty_elements_total points points_in points_out "
         "solid_correction newton_iterations inertia "
         "gradient gradient_estimate gradient_time_estimate gradient_transport_estimate",
}
UNIT_OF_COLUMN = {column: unit for unit, columns in UNITS.items() for column in columns.split()}
# Columns of history.csv of earlier versions, by their names of today.
RENAMED = {"fines_left": "fines_out", "fines_left_percent": "fines_out_percent", "solid_left_percent": "solid_out_percent"}
PER_THICKNESS = ("kg", "m3", "m3/s", "W", "J")  # units that are per metre of thickness in two dimensions


class Error(Exception):
    """A folder, name or time that does not fit; the message says what does."""


class UnknownName(Error, KeyError):
    """A name that a run does not have."""

    __str__ = Exception.__str__  # a KeyError would quote the sentence


def _unknown(what, got, known):
    known = list(known)
    names = ", ".join(str(name) for name in known) or "none"
    closest = difflib.get_close_matches(str(got), [str(name) for name in known], n=1)
    if RENAMED.get(got) in known:
        closest = [RENAMED[got]]
    hint = f"; did you mean {closest[0]}?" if closest else ""
    return UnknownName(f"{what}: got {got!r}; expected one of: {names}{hint}")


class _Named(collections.abc.Mapping):
    """A mapping whose error for a missing name lists the names that it has."""

    def __init__(self, what, content):
        self._what, self._content = what, content

    def __getitem__(self, name):
        if name not in self._content:
            raise _unknown(self._what, name, self._content)
        return self._content[name]

    def __contains__(self, name):
        return name in self._content

    def __iter__(self):
        return iter(self._content)

    def __len__(self):
        return len(self._content)

    def __repr__(self):
        return f"<{self._what}: {', '.join(map(str, self))}>"


class Table(_Named):
    """Columns by name, arrays of one length. `units` has the unit of each, "-" for a number without one."""

    def __init__(self, what, columns, dimension):
        super().__init__(what, columns)
        self.units = {name: UNIT_OF_COLUMN.get(name, "") for name in columns}
        if dimension == 2:
            self.units.update({name: unit + "/m" for name, unit in self.units.items() if unit in PER_THICKNESS})


class Mesh:
    """Triangles with regions and boundaries. Numbers of nodes and elements count from 0."""

    def __init__(self, file):
        self.nodes = file["mesh/nodes"][:]  # m, a row per node
        self.elements = file["mesh/elements"][:]  # the nodes of each, counter-clockwise
        self.element_region = file["mesh/element_region"][:]  # index into region_names
        self.region_names = [_text(name) for name in np.atleast_1d(file["mesh/region_names"][()])]
        groups = file["boundaries"].values() if "boundaries" in file else []
        self.boundaries = {_text(group["name"][()]): group["faces"][:] for group in groups}  # the nodes of each face


class Run:
    """A results folder. Tables and fields are read when they are asked for."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        try:
            self.info = json.loads((self.folder / "run.json").read_text(encoding="utf-8"))  # all of run.json
        except FileNotFoundError:
            raise Error(f"{folder}: got no run.json; expected a results folder of suffuse-solver") from None
        except ValueError as error:
            raise Error(f"{self.folder / 'run.json'}: {error}") from None
        if not isinstance(self.info, dict) or self.info.get("format") != FORMAT:
            raise Error(f"{self.folder / 'run.json'}: expected \"format\": \"{FORMAT}\"")
        self._files = {kind: self._series(kind) for kind in ("mesh", "solid", "liquid")}
        self.times = np.array([time for time, _ in self._files["mesh"]])  # of the snapshots, s

    def __repr__(self):
        return f"<suffuse run {self.folder}, {self.info['status']}, {len(self.times)} snapshots>"

    # --- Tables ---

    @property
    def history(self):
        """history.csv: the flow against time."""
        return self._table("history")

    @property
    def ledger(self):
        """ledger.csv: masses of the model against time."""
        return self._table("ledger")

    @property
    def regions(self):
        """regions.csv: a table for each region, by its name."""
        names = self.info["regions"]
        return self._tables("regions", "region", lambda index: names[int(index)])

    @property
    def boundaries(self):
        """boundaries.csv: a table for each boundary that has a condition, by its name."""
        return self._tables("boundaries", "boundary", str)

    @property
    def probes(self):
        """probes.csv: a table for each probe, by its number in the scene, from 0."""
        return self._tables("probes", "probe", int)

    @property
    def sections(self):
        """sections.csv: a table for each section, by its number in the scene, from 0."""
        return self._tables("sections", "section", int)

    def _rows(self, name):
        path = self.folder / f"{name}.csv"
        if not path.is_file():
            raise Error(f"{path}: there is no such table in this run")
        with path.open(newline="", encoding="utf-8") as file:
            names, *rows = list(csv.reader(file)) or [[]]
        if not names:
            raise Error(f"{path}: it is empty; the run has no rows yet")
        for line, row in enumerate(rows, start=2):
            if len(row) != len(names):
                raise Error(f"{path}:{line}: got {len(row)} values; expected {len(names)}")
        return path, names, rows

    def _table(self, name):
        path, names, rows = self._rows(name)
        if name == "history":
            names = [RENAMED.get(column, column) for column in names]
        return self._columns(path, names, rows)

    def _tables(self, name, by, key):
        path, names, rows = self._rows(name)
        place = names.index(by)
        parts = {}
        for row in rows:
            parts.setdefault(key(row[place]), []).append(row[:place] + row[place + 1:])
        names = names[:place] + names[place + 1:]
        return _Named(path, {part: self._columns(f"{path}, {by} {part}", names, rows) for part, rows in parts.items()})

    def _columns(self, what, names, rows):
        try:
            values = np.array(rows, dtype=float).reshape(len(rows), len(names))
        except ValueError as error:
            raise Error(f"{what}: {error}") from None
        return Table(what, dict(zip(names, values.T)), self.info["dimension"])

    # --- Mesh, points and fields ---

    @property
    def mesh(self):
        """The mesh of the run."""
        with self._open("case.h5") as file:
            return Mesh(file)

    def fields(self):
        """Names of the fields of the last snapshot, by where they are: "cell", "node", "solid" and so on."""
        found = {}
        for place, (kind, group) in PLACES.items():
            if self._files[kind]:
                with self._snapshot(kind, None) as file:
                    found[place] = sorted(file[group]) if group in file else []
        return {place: names for place, names in found.items() if names}

    def field(self, name, time=None, on=None):
        """Values of a field: one per element ("cell"), node or point, for a vector a row of x and y
        each; on "element_vertex" a row per element with the values of its own linear field at its
        three nodes.

        `time` is that of a snapshot, s; without it the last. `on` is needed where a field is in several places.
        """
        on = self._place_of(name, on)
        kind, group = PLACES[on]
        with self._snapshot(kind, time) as file:
            if name not in file[group]:
                raise _unknown(f"{self.folder}, fields on {on}", name, file[group])
            values = file[group][name]
            components = int(np.ravel(values.attrs["components"])[0])
            # Vectors of the plane are stored with a third component of zero for VTK.
            return values[:, :components] if components > 1 and values.ndim == 2 else values[:]

    def unit(self, name, on=None):
        """The unit of a field."""
        kind, group = PLACES[self._place_of(name, on)]
        with self._snapshot(kind, None) as file:
            return _text(np.ravel(file[group][name].attrs["unit"])[0])

    def points(self, kind, time=None):
        """Places of the "solid" or "liquid" points of a snapshot, m, a row each, in the order of their fields."""
        kinds = [k for k in ("solid", "liquid") if self._files[k]]
        if kind not in kinds:
            raise _unknown(f"{self.folder}, points", kind, kinds)
        with self._snapshot(kind, time) as file:
            return file["VTKHDF/Points"][:, :int(self.info["dimension"])]

    def _place_of(self, name, on):
        fields = self.fields()
        places = [place for place, names in fields.items() if name in names]
        if not places:
            known = sorted({field for names in fields.values() for field in names})
            raise _unknown(f"{self.folder}, fields", name, known)
        if on is None and len(places) > 1:
            raise Error(f"{self.folder}: {name!r} is in several places; expected on= one of: {', '.join(places)}")
        if on is not None and on not in places:
            raise _unknown(f"{self.folder}, places of {name!r}", on, places)
        return on or places[0]

    def _series(self, kind):
        path = self.folder / f"{kind}.hdf.series"
        if not path.is_file():
            return []
        try:
            return [(entry["time"], entry["name"]) for entry in json.loads(path.read_text(encoding="utf-8"))["files"]]
        except (ValueError, KeyError, TypeError) as error:
            raise Error(f"{path}: it is damaged: {error!r}") from None

    def _snapshot(self, kind, time):
        series = self._files[kind]
        if not series:
            raise Error(f"{self.folder}: there is no snapshot of {kind} yet")
        if time is None:
            return self._open(series[-1][1])
        closest = min(series, key=lambda entry: abs(entry[0] - time))
        if abs(closest[0] - time) > 1e-9 * max(abs(time), abs(closest[0])):
            raise Error(f"{self.folder}: time: got {time:g} s; expected a time of a snapshot, from {series[0][0]:g} to "
                        f"{series[-1][0]:g} s; the nearest is {closest[0]:g} s (see run.times)")
        return self._open(closest[1])

    def _open(self, name):
        try:
            return h5py.File(self.folder / name, "r")
        except OSError as error:
            raise Error(f"{self.folder / name}: {error}") from None


def _text(value):
    return value.decode("utf-8").rstrip("\0") if isinstance(value, bytes) else str(value)


def open(folder):  # noqa: A001, as in gzip.open
    """A results folder as a Run. Raises Error where `folder` is none."""
    return Run(folder)
