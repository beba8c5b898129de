"""Shows a results folder in ParaView 5.11 or newer: fields beside one another, each with its colour bar, over all times.

    SUFFUSE_RESULTS=NAME.results paraview --script=show_results.py
    pvpython show_results.py NAME.results [--fields porosity,concentration] [--time T] [--save PICTURE.png]
    pvpython show_results.py NAME.results --list

Without --save, pvpython opens a window to turn and zoom. --time takes the snapshot nearest to T; the last one is
shown without it. --list prints the times and the fields, and draws nothing.
"""

import argparse
import os
import sys

import paraview
from paraview import simple as pv

UNITS = {"pressure": "Pa", "liquid_velocity": "m/s", "darcy_flux": "m/s"}
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
    """The snapshots of one kind ("mesh" or "solid") as one source that knows its times."""
    path = os.path.join(folder, kind + ".hdf.series")
    if not os.path.isfile(path):
        sys.exit(f"show_results.py: {path}: no such file; expected the results folder of a run")
    source = pv.OpenDataFile(path)
    if source is None:
        sys.exit(f"show_results.py: {path}: ParaView cannot read it; version 5.11 or newer is needed")
    pv.RenameSource(kind, source)
    source.UpdatePipeline()
    return source


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


def show_field(source, field, view):
    """One field with a colour bar whose range covers all times."""
    association = association_of(source, field)
    if association is None:
        names = sorted(set(source.CellData.keys()) | set(source.PointData.keys()))
        sys.exit(f"show_results.py: there is no field '{field}'; expected one of {', '.join(names)}")
    display = pv.Show(source, view)
    display.Representation = "Surface With Edges"
    display.EdgeColor = [0.35, 0.35, 0.35]
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


def lay_out(source, fields):
    """One view per field: side by side, or one above the other where the model is wide."""
    bounds = source.GetDataInformation().GetBounds()
    wide = bounds[1] - bounds[0] > 1.5 * (bounds[3] - bounds[2])
    size = (1000, 480) if wide else (600, 680)
    layout = pv.CreateLayout("Suffuse")
    split = layout.SplitVertical if wide else layout.SplitHorizontal
    views = []
    cell = 0
    for number, field in enumerate(fields):
        # Splitting cell i puts what was in it into 2 i + 1 and opens 2 i + 2.
        views.append(new_view(layout, cell))
        show_field(source, field, views[-1])
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
    source = open_series(given.results, "mesh")
    times = times_of(source)
    if given.list:
        print("times:", " ".join(f"{t:g}" for t in times))
        print("cells:", " ".join(sorted(source.CellData.keys())))
        print("nodes:", " ".join(sorted(source.PointData.keys())))
        return
    layout = lay_out(source, given.fields.split(","))
    go_to(times, given.time)
    pv.RenderAllViews()
    if given.save:
        pv.SaveScreenshot(given.save, layout)
    elif not paraview.fromGUI:
        pv.Interact()


main()
