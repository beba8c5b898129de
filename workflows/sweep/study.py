#!/usr/bin/python3
"""A scene of one's own. make calls it, with its variables in the environment.

    study.py           from its mesh to its figures and a report, in OUT/study/: a second call makes only what is missing or out
                       of date
    study.py adapt     meshes it again until its discharge is known to mesh.error, in OUT/adapt/
"""

import os
import pathlib
import subprocess
import sys

here = pathlib.Path(__file__).resolve().parent
sys.path.insert(1, str(here.parent))
from common import call, end_with, find_file, programs_of, wrong
from inputs import write_inputs


def stem_of(target, scene):
    stem = pathlib.Path(os.environ["OUT_FOLDER"]).resolve() / target / scene.stem
    stem.parent.mkdir(parents=True, exist_ok=True)
    return stem


def study():
    scene, programs = find_file("SCENE"), programs_of()
    stem = stem_of("study", scene)
    write_inputs(scene, programs, stem)
    ended = subprocess.run([here / "run.py", programs, stem, os.environ["TOLERANCE"]], env=os.environ | {"PROGRESS": "1"})
    if ended.returncode:
        return ended.returncode
    post = programs / "suffuse-post"
    made = max(os.stat(path).st_mtime_ns for path in (f"{stem}.status", post))
    files = {"history.csv": ["history", "RESULTS", "--csv"], "html": ["report", "RESULTS", "-o"]}
    files |= {f"{figure}.{suffix}": ["figure", figure, "RESULTS", "-o"] for figure in ("porosity", "masses") for suffix in ("png", "svg")}
    for suffix, command in files.items():
        file = pathlib.Path(f"{stem}.{suffix}")
        if not file.is_file() or file.stat().st_mtime_ns <= made:
            command = [f"{stem}.results" if word == "RESULTS" else word for word in command]
            print("suffuse-post", *command, file, flush=True)
            call(post, *command, file)
    print(f"The report is {stem}.html; the study's figures, tables and results are {stem}.*")


def adapt():
    over = os.environ.get("OVER", "")
    if over not in ("", "run"):
        raise wrong("OVER", "", f"'{over}'", "run")
    scene = find_file("SCENE")
    stem = stem_of("adapt", scene)
    ended = subprocess.run([here.parent / "adapt.py", *["--over-run"] * bool(over), programs_of(), scene, stem])
    if ended.returncode == 0:
        print(f"The case is {stem}.case.h5")
    return ended.returncode


if __name__ == "__main__":
    end_with("", adapt if sys.argv[1:] == ["adapt"] else study)
