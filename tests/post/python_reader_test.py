"""suffuse.py against suffuse-post, and against what is known of a small run.

    python_reader_test.py FOLDER_OF_PROGRAMS SOURCE
"""

import csv
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

try:
    import numpy as np
    import h5py  # noqa: F401
except ImportError as error:
    print(f"skipped: {error}; apt-get install python3-numpy python3-h5py")
    sys.exit(77)

PROGRAMS, SOURCE = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
TABLES = SOURCE / "solver/files/tables.hpp"
sys.dont_write_bytecode = True
sys.path.insert(0, str(SOURCE / "post/python"))
import suffuse  # noqa: E402

SCENE = """
name        = "reader"
formulation = "double-point"
[geometry]
shape  = "column"
width  = 0.5
height = 1.0
[mesh]
size = 0.25
[points]
liquid_per_element = 3
[liquid]
density      = 1000.0
bulk_modulus = 2.0e9
viscosity    = 1.0e-3
[soil.specimen]
porosity          = 0.3
skeleton_fraction = 0.6
grain_density     = 2700.0
conductivity      = 2.0e-2
[soil.specimen.erosion]
law   = "first-order"
rate  = 1.0e-2
[[boundary]]
on            = "top"
pressure      = 6.0e3
concentration = 0.0
[[boundary]]
on       = "bottom"
pressure = 0.0
[time]
end = 6.0
[output]
every = 2.0
[[output.probe]]
at = [0.25, 0.5]
[[output.probe]]
at = [0.3, 0.2]
[[output.section]]
from = [0.0, 0.5]
to   = [0.5, 0.5]
"""


def run_program(name, *arguments):
    subprocess.run([PROGRAMS / name, *map(str, arguments)], check=True, stdout=subprocess.DEVNULL)


def rows_of(path):
    """The columns of a table of suffuse-post, as texts, and their units where the header has them: "t [s]"."""
    with open(path, newline="", encoding="utf-8") as file:
        header, *rows = csv.reader(file)
    names = [re.sub(r" \[.*\]$", "", name) for name in header]
    units = {name: head[len(name) + 2:-1] for name, head in zip(names, header) if head != name}
    return {name: [row[i] for row in rows] for i, name in enumerate(names)}, units


class Reader(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.scratch.name)
        (cls.folder / "reader.toml").write_text(SCENE)
        run_program("suffuse-mesher", cls.folder / "reader.toml", "-o", cls.folder / "reader.case.h5")
        cls.results = cls.folder / "reader.results"
        run_program("suffuse-solver", cls.folder / "reader.case.h5", "-o", cls.results, "--quiet")
        cls.run_ = suffuse.open(cls.results)

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def post(self, *arguments):
        table = self.folder / "table.csv"
        run_program("suffuse-post", arguments[0], self.results, *arguments[1:], "--csv", table)
        return rows_of(table)

    def expect_columns(self, table, wanted, units):
        for name, values in wanted.items():
            np.testing.assert_array_equal(table[name], np.array(values, dtype=float), err_msg=name)
        for name, unit in units.items():
            self.assertEqual(table.units[name], unit, name)

    def test_tables_are_those_of_suffuse_post(self):
        self.expect_columns(self.run_.history, *self.post("history"))
        self.expect_columns(self.run_.ledger, *self.post("ledger"))
        columns, units = self.post("boundaries")
        self.assertEqual(list(self.run_.boundaries), ["top", "bottom"])
        for name, table in self.run_.boundaries.items():
            mine = [i for i, boundary in enumerate(columns["boundary"]) if boundary == name]
            wanted = {c: [v[i] for i in mine] for c, v in columns.items() if c != "boundary"}
            self.expect_columns(table, wanted, {c: unit for c, unit in units.items() if c != "boundary"})

    def test_units_are_those_of_the_solver(self):
        """Every column has a unit; another test compares these with suffuse-post's headers."""
        declared = re.findall(r'\{"(\w+)", &(\w+)::\w+, "(.+)"\}', TABLES.read_text())
        self.assertGreater(len(declared), 60)
        for column, _, unit in declared:
            if column not in ("probe", "section"):  # keys of suffuse.py, not columns
                self.assertEqual(suffuse.UNIT_OF_COLUMN.get(column), unit.replace("1", "-"), f"UNITS: {column}")

    def test_parts_of_tables(self):
        run = self.run_
        self.assertEqual(list(run.probes), [0, 1])
        self.assertEqual((run.probes[1]["x"][0], run.probes[1]["y"][0]), (0.3, 0.2))
        np.testing.assert_array_equal(run.history["t"], [0, 2, 4, 6])
        np.testing.assert_array_equal(run.sections[0]["t"], run.history["t"])
        # The flow is steady and downwards: the discharge of the section leaves below.
        self.assertAlmostEqual(abs(run.sections[0]["discharge"][-1]), run.boundaries["bottom"]["discharge"][-1], delta=1e-9)
        np.testing.assert_allclose(sum(t["solid"] for t in run.regions.values()), run.ledger["solid"], rtol=1e-14)

    def test_mesh(self):
        mesh = self.run_.mesh
        a, b, c = (mesh.nodes[mesh.elements[:, i]] for i in range(3))
        areas = ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2
        self.assertGreater(areas.min(), 0)
        self.assertAlmostEqual(areas.sum(), 0.5)
        self.assertEqual(mesh.region_names, ["specimen"])
        self.assertEqual(set(mesh.element_region), {0})
        np.testing.assert_array_equal(mesh.nodes[mesh.boundaries["top"]][:, :, 1], 1.0)

    def test_fields(self):
        run = self.run_
        np.testing.assert_array_equal(run.times, [0, 2, 4, 6])
        # Uniform and exact: n = 0.3 + n_e (1 - exp(-rate t)), n_e = 1 - 0.3 - 0.6.
        for time in run.times:
            wanted = 0.3 + 0.1 * (1 - np.exp(-1e-2 * time))
            np.testing.assert_allclose(run.field("porosity", time=time, on="cell"), wanted, rtol=1e-12)
        count = len(run.mesh.elements)
        self.assertEqual(run.field("porosity", on="element_vertex").shape, (count, 3))
        self.assertEqual(run.field("darcy_flux").shape, (count, 2))
        np.testing.assert_allclose(run.field("darcy_flux")[:, 0], 0, atol=1e-8)
        self.assertEqual(run.field("liquid_velocity", on="node").shape, (len(run.mesh.nodes), 2))
        self.assertEqual((run.unit("darcy_flux"), run.unit("pressure", on="node")), ("m/s", "Pa"))
        for place, names in run.fields().items():
            for name in names:
                self.assertTrue(np.isfinite(run.field(name, on=place)).all(), (place, name))

    def test_a_field_is_that_of_suffuse_post(self):
        mesh, time = self.run_.mesh, 4.0
        element = 3
        corners = mesh.nodes[mesh.elements[element]]
        (x, y), (u, v) = corners.mean(axis=0), 0.6 * corners[0] + 0.2 * corners[1] + 0.2 * corners[2]
        columns, _ = self.post("sample", "--time", time, "--line", f"{x:.17g},{y:.17g}:{u:.17g},{v:.17g}", "--count", 2,
                               "--fields", "concentration")
        at_vertices = self.run_.field("concentration", time=time, on="element_vertex")[element]
        wanted = [at_vertices.mean(), at_vertices @ [0.6, 0.2, 0.2]]
        self.assertGreater(abs(wanted[0]), 0)
        np.testing.assert_allclose(np.array(columns["concentration"], dtype=float), wanted, rtol=1e-12)

    def test_points(self):
        run = self.run_
        count = len(run.mesh.elements)
        for kind in ("solid", "liquid"):
            points = run.points(kind, time=0.0)
            self.assertEqual(len(points), len(run.field("concentration", time=0.0, on=kind)))
            self.assertTrue(((points >= 0) & (points <= [0.5, 1.0])).all())
        self.assertEqual(len(run.points("liquid", time=0.0)), 3 * count)
        self.assertAlmostEqual(run.field("water_mass", on="liquid").sum(), run.ledger["water"][-1], delta=1e-9)

    def expect_error(self, action, *parts):
        with self.assertRaises(suffuse.Error) as caught:
            action()
        for part in parts:
            self.assertIn(part, str(caught.exception))

    def test_errors_say_what_there_is(self):
        run = self.run_
        self.expect_error(lambda: run.history["flux_ot"], "got 'flux_ot'", "t, dt,", "did you mean flux_out?")
        self.expect_error(lambda: run.history["fines_left"], "got 'fines_left'", "did you mean fines_out?")
        self.expect_error(lambda: run.boundaries["tpo"], "expected one of: top, bottom; did you mean top?")
        self.expect_error(lambda: run.field("porsity"), "did you mean porosity?")
        self.expect_error(lambda: run.field("porosity"), "expected on= one of: cell, element_vertex, solid")
        self.expect_error(lambda: run.field("porosity", on="node"), "expected one of: cell,")
        self.expect_error(lambda: run.field("darcy_flux", time=3.0), "got 3 s", "from 0 to 6 s", "the nearest is")
        self.expect_error(lambda: run.points("mesh"), "expected one of: solid, liquid")
        self.expect_error(lambda: suffuse.open(self.folder), "expected a results folder of suffuse-solver")
        self.assertIsNone(run.history.get("flux_ot"))
        self.assertNotIn("flux_ot", run.history)


unittest.main(argv=sys.argv[:1])
