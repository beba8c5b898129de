"""Shows a results folder in ParaView 5.11 or newer: fields side by side, each with its colour bar, over all times.

    SUFFUSE_RESULTS=NAME.results paraview --script=show_results.py
    pvpython show_results.py NAME.results [--fields porosity,concentration] [--time T] [--save PICTURE.png]
    pvpython show_results.py NAME.results --list

Without --save, pvpython opens a window to turn and zoom. --time takes the snapshot nearest to T; the last one is
shown without it. --list prints the times and the fields, and draws nothing.
"""

import argparse
import os
import sys

from paraview import simple as pv

UNITS = {"pressure": "Pa", "erosion_rate": "1/s", "liquid_velocity": "m/s", "velocity": "m/s", "darcy_flux": "m/s"}
VIEW_SIZE = (620, 640)


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
    bar.ComponentTitle = "magnitude" if field in ("liquid_velocity", "velocity", "darcy_flux") else ""
    for part in (bar, view):
        if part is bar:
            bar.TitleColor = bar.LabelColor = [0.0, 0.0, 0.0]
    return display


def lay_out(source, fields):
    """One view per field, side by side, with a common camera and the time in each."""
    views = []
    layout = pv.CreateLayout("Suffuse")
    cell = 0
    for number, field in enumerate(fields):
        if number:
            cell = layout.SplitHorizontal(cell, 1.0 / (len(fields) - number + 1)) + 1
        view = pv.CreateView("RenderView")
        view.ViewSize = VIEW_SIZE
        view.InteractionMode = "2D"
        view.OrientationAxesVisibility = 0
        view.UseColorPaletteForBackground = 0
        view.Background = [1.0, 1.0, 1.0]
        pv.AssignViewToLayout(view=view, layout=layout, hint=cell)
        show_field(source, field, view)
        stamp = pv.AnnotateTimeFilter(Input=source)
        stamp.Format = "t = {time:g} s"
        text = pv.Show(stamp, view)
        text.Color = [0.0, 0.0, 0.0]
        text.WindowLocation = "Upper Center"
        pv.ResetCamera(view)
        views.append(view)
    for view in views[1:]:
        pv.AddCameraLink(views[0], view, f"camera{id(view)}")
    layout.SetSize(VIEW_SIZE[0] * len(fields), VIEW_SIZE[1])
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
    elif "pvpython" in os.path.basename(sys.executable or "") or "pvbatch" in sys.argv[0]:
        pv.Interact()


main()
