#!/usr/bin/python3
"""What a run is made of, in a file STEM.inputs: run.py makes the run again when this changes.

    scene /path/weir.toml                     the scene
    set soil.foundation.porosity=0.3          a change of it, as for the mesher's --set
    sha256 0123... /path/weir.geo             the content of every file that has a part in it
    adapt                                     the scene is meshed again until mesh.error is met
    adapt by default                          likewise, with 0.01 for mesh.error, if the mesher chooses mesh.size

    inputs.py SCENE PROGRAMS STEM [KEY=VALUE...]     writes STEM.inputs, if its text changes
"""

import functools
import hashlib
import pathlib
import re
import sys
import tomllib

sys.path.insert(1, str(pathlib.Path(__file__).resolve().parent.parent))
from common import InputError, read, write_changed

PROGRAMS = ["suffuse-mesher", "suffuse-solver"]
QUOTED = re.compile(r'"([^"\n]+)"|\'([^\'\n]+)\'')


@functools.lru_cache(maxsize=None)
def content(path):
    """The line of a file, or for the results folder of an earlier run that of its run.json."""
    file = path / "run.json" if path.is_dir() else path
    return f"sha256 {hashlib.sha256(file.read_bytes()).hexdigest()} {file}"


def named_files(text, folder):
    """Files and results folders that quoted texts name, from `folder`. A chance hit is harmless."""
    for groups in QUOTED.findall(text):
        path = folder / (groups[0] or groups[1])
        try:
            if path.is_file() or (path / "run.json").is_file():
                yield path
        except OSError:  # too long for a name
            pass


@functools.lru_cache(maxsize=None)
def common_lines(scene, programs):
    text = read(scene)
    files = [scene, *named_files(text, scene.parent), *(programs / name for name in PROGRAMS)]
    return [content(file) for file in files]


def mesh_keys(text):
    """The keys of [mesh] in a text. What is no TOML the mesher refuses."""
    try:
        return set(tomllib.loads(text).get("mesh", {}))
    except (ValueError, AttributeError, TypeError):
        return set()


def adaptation(scene, changes):
    """The line that says whether the scene, with its changes, is meshed again: one or none."""
    given = mesh_keys(read(scene)).union(*map(mesh_keys, changes))
    if "error" in given:
        return ["adapt"]
    return [] if "size" in given else ["adapt by default"]


def inputs_of(scene, programs, changes):
    """The text of the file. `changes`: KEY=VALUE. Throws InputError where scene or programs cannot be read."""
    try:
        lines = [f"scene {scene}", *(f"set {change}" for change in changes), *common_lines(scene, programs)]
        lines += adaptation(scene, changes)
        for change in changes:
            value = change.split("=", 1)[1]
            lines += [content(file) for file in named_files(f'{value}\n"{value}"', scene.parent)]
    except OSError as error:
        raise InputError([f"{error.filename}: {error.strerror}"]) from None
    return "\n".join(lines) + "\n"


def write_inputs(scene, programs, stem, changes=()):
    text = inputs_of(scene, programs, changes)
    stem.parent.mkdir(parents=True, exist_ok=True)
    write_changed(stem.with_name(stem.name + ".inputs"), text)


def main():
    scene, programs, stem = (pathlib.Path(argument).absolute() for argument in sys.argv[1:4])
    try:
        write_inputs(scene, programs, stem, sys.argv[4:])
    except InputError as error:
        sys.exit(f"inputs.py: {error}")


if __name__ == "__main__":
    main()
