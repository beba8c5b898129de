"""Shows results in ParaView 5.11 or newer: fields side by side, with colour bars, over all times.

    SUFFUSE_RESULTS=NAME.results paraview --script=show_results.py
    pvpython show_results.py NAME.results [--fields porosity,concentration] [--time T] [--save PICTURE.png]
    pvpython show_results.py NAME.results --list

A field is looked for on the mesh, then at the solid points, then at the liquid points; "liquid:NAME" and "solid:NAME"
say which. Points are drawn over the edges of the mesh.

Without --save, pvpython opens a window to turn and zoom. --time takes the snapshot nearest to T; the last one is
shown without it. --list prints the times and the fields, and draws nothing.
"""

import argparse
import os
import sys

import paraview
from paraview import simple as pv

UNITS = {
    "pressure": "Pa", "liquid_velocity": "m/s", "darcy_flux": "m/s", "erosion_rate": "1/s",
    "volume": "m3/m", "water_mass": "kg/m", "fines_mass": "kg/m",
}
POINT_SIZE = 3  # pixels
BAR_ROOM = 1.35  # how much taller a view is than the model, for the colour bar below and the time above


def arguments():
    """The command line; the ParaView program itself passes none, so the folder may come from the environment."""
    parser = argparse.ArgumentParser(prog="show_results.py", description="Shows a results folder in ParaView.")
    parser.add_argument("results", nargs="?", default=os.environ.get("SUFFUSE_RESULTS"))
    parser.add_argument("--fields", default="porosity,concentration")
    parser.add_argument("--time", type=float)
    parser.add_argument("--save", metavar="PICTURE.png")
    parser.add_argument("--list", action="store_true")
    given = parser.parse_args()
    if not given.results:
        parser.error("name the results folder, or set SUFFUSE_RESULTS")
    return given


def open_series(folder, kind):
    """The snapshots of one kind ("mesh", "solid" or "liquid") as one source that knows its times."""
    path = os.path.join(folder, kind + ".hdf.series")
    if not os.path.isfile(path):
        sys.exit(f"show_results.py: {path}: no such file; expected the results folder of a run")
    source = pv.OpenDataFile(path)
    if source is None:
        sys.exit(f"show_results.py: {path}: ParaView cannot read it; version 5.11 or newer is needed")
    pv.RenameSource(kind, source)
    source.UpdatePipeline()
    return source


def open_all(folder):
    """Mesh, solid points and, of a double-point run, liquid points, by kind."""
    kinds = ["mesh", "solid"]
    if os.path.isfile(os.path.join(folder, "liquid.hdf.series")):
        kinds.append("liquid")
    return {kind: open_series(folder, kind) for kind in kinds}


def times_of(source):
    values = source.TimestepValues
    return list(values) if hasattr(values, "__len__") else [values]


def association_of(source, field):
    """Where ParaView finds a field: "CELLS", "POINTS", or None."""
    if field in source.CellData.keys():
        return "CELLS"
    if field in source.PointData.keys():
        return "POINTS"
    return None


def find_field(sources, wanted):
    """Kind of source, name of the field and its association, of "NAME" or "KIND:NAME"."""
    kind, _, field = wanted.rpartition(":")
    for name, source in sources.items():
        if kind in ("", name) and association_of(source, field):
            return name, field, association_of(source, field)
    names = [f"{name}:{field}" for name, source in sources.items()
             for field in sorted(set(source.CellData.keys()) | set(source.PointData.keys()))]
    sys.exit(f"show_results.py: there is no field '{wanted}'; expected one of {', '.join(names)}")


def show_field(sources, wanted, view):
    """One field with a colour bar whose range covers all times."""
    kind, field, association = find_field(sources, wanted)
    display = pv.Show(sources[kind], view)
    if kind == "mesh":
        display.Representation = "Surface With Edges"
        display.EdgeColor = [0.35, 0.35, 0.35]
    else:
        edges = pv.Show(sources["mesh"], view)
        edges.Representation = "Wireframe"
        edges.AmbientColor = edges.DiffuseColor = [0.7, 0.7, 0.7]
        edges.ColorArrayName = [None, ""]
        display.Representation = "Points"
        display.PointSize = POINT_SIZE
    pv.ColorBy(display, (association, field))
    display.RescaleTransferFunctionToDataRangeOverTime()
    display.SetScalarBarVisibility(view, True)
    bar = pv.GetScalarBar(pv.GetColorTransferFunction(field), view)
    unit = UNITS.get(field)
    bar.Title = field.replace("_", " ") + (f" ({unit})" if unit else "")
    bar.ComponentTitle = ""
    bar.TitleColor = bar.LabelColor = [0.0, 0.0, 0.0]
    bar.Orientation = "Horizontal"
    bar.WindowLocation = "Lower Center"
    bar.ScalarBarLength = 0.6
    bar.AutomaticLabelFormat = 0
    bar.LabelFormat = bar.RangeLabelFormat = "%.3g"


def add_time(source, view):
    stamp = pv.AnnotateTimeFilter(Input=source)
    stamp.Format = "t = {time:g} s"
    text = pv.Show(stamp, view)
    text.Color = [0.0, 0.0, 0.0]
    text.WindowLocation = "Upper Center"


def new_view(layout, cell):
    view = pv.CreateView("RenderView")
    view.InteractionMode = "2D"
    view.OrientationAxesVisibility = 0
    view.UseColorPaletteForBackground = 0
    view.Background = [1.0, 1.0, 1.0]
    pv.AssignViewToLayout(view=view, layout=layout, hint=cell)
    return view


def fit(view, bounds, size):
    """The whole model, with room for the colour bar and the time."""
    width, height = bounds[1] - bounds[0], bounds[3] - bounds[2]
    centre = [(bounds[0] + bounds[1]) / 2, (bounds[2] + bounds[3]) / 2, (bounds[4] + bounds[5]) / 2]
    view.CameraFocalPoint = centre
    view.CameraPosition = [centre[0], centre[1], centre[2] + 10 * (width + height)]
    view.CameraParallelProjection = 1
    view.CameraParallelScale = max(BAR_ROOM * height, 1.1 * width * size[1] / size[0]) / 2


def lay_out(sources, fields):
    """One view per field: side by side, or one above the other where the model is wide."""
    source = sources["mesh"]
    bounds = source.GetDataInformation().GetBounds()
    wide = bounds[1] - bounds[0] > 1.5 * (bounds[3] - bounds[2])
    size = (1000, 480) if wide else (600, 680)
    layout = pv.CreateLayout("Suffuse")
    split = layout.SplitVertical if wide else layout.SplitHorizontal
    views = []
    cell = 0
    for number, field in enumerate(fields):
        # Splitting cell i moves its content to cell 2 i + 1 and opens cell 2 i + 2.
        views.append(new_view(layout, cell))
        show_field(sources, field, views[-1])
        add_time(source, views[-1])
        if number + 1 < len(fields):
            cell = split(cell, 1.0 / (len(fields) - number)) + 1
    layout.SetSize(*((size[0], size[1] * len(fields)) if wide else (size[0] * len(fields), size[1])))
    pv.RenderAllViews()  # the first rendering moves the camera
    for view in views:
        fit(view, bounds, size)
    for number, view in enumerate(views[1:]):
        pv.AddCameraLink(views[0], view, f"camera {number + 1}")
    return layout


def go_to(times, wanted):
    """Sets the time of all views to the snapshot nearest to `wanted`, or to the last."""
    scene = pv.GetAnimationScene()
    scene.UpdateAnimationUsingDataTimeSteps()
    scene.AnimationTime = times[-1] if wanted is None else min(times, key=lambda t: abs(t - wanted))


def main():
    given = arguments()
    sources = open_all(given.results)
    source = sources["mesh"]
    times = times_of(source)
    if given.list:
        print("times:", " ".join(f"{t:g}" for t in times))
        print("cells:", " ".join(sorted(source.CellData.keys())))
        print("nodes:", " ".join(sorted(source.PointData.keys())))
        for kind in list(sources)[1:]:
            print(f"{kind} points:", " ".join(sorted(sources[kind].PointData.keys())))
        return
    layout = lay_out(sources, given.fields.split(","))
    go_to(times, given.time)
    pv.RenderAllViews()
    if given.save:
        pv.SaveScreenshot(given.save, layout)
    elif not paraview.fromGUI:
        pv.Interact()


main()
