#!/usr/bin/env python3
"""What must hold of the sources (docs/develop/architecture.md). check_sources.py [ROOT] [--list]

A room is a folder. Includes between rooms go down only, and there may not be too many rooms of the solver, or arrows (pairs of rooms,
one of which includes the other). A source file has at most 500 lines and is in a room. A room of the solver has at most 2500 lines, laws in
folders of physics/ included; a class, which is its definition and the bodies of its member functions in all files, at most 600. Those
listed below are larger; they may only become smaller, and their numbers with them: by more than a tenth they may not differ.

Two source files of a program may not have functions of one name in their unnamed namespaces: several files are compiled as one, two such
functions become overloads, and a call may silently use the other one. Laws (solver/physics) are compiled file by file.

Prints a line for each problem; exit code 1 if there is any. --list prints the sizes of rooms and classes.
"""

import collections
import pathlib
import re
import sys

# A room may include itself and the rooms before it.
ROOMS = [f"{program}/{part}" for program, parts in (
    ("solver", "physics"), ("mesher", "common mesh scene case"),
    ("solver", "files results ranks grid linear solid equilibrium boundary motion mixed bounds flow coupling field points explicit "
               "formulation driver tools main.cpp"),
    ("post", "drawing values tables checks figures report commands")) for part in parts.split()]
# The other programs, and all that they may include.
BELOW_MESHER = {"solver/physics", "mesher/common", "mesher/mesh", "mesher/scene", "mesher/case"}
BELOW = {"mesher": BELOW_MESHER, "post": BELOW_MESHER | {"solver/files", "solver/results"}}
MAX_ROOMS, MAX_ARROWS, MAX_LINES = 20, 98, 500
# The schema is one list that is read from top to bottom. The other file is still to be divided.
LONG_FILES = {"mesher/scene/scene_keys.cpp", "mesher/common/hdf5_io.cpp"}
MAX_ROOM, MAX_CLASS = 2500, 600
LARGER = {"flow/": 2550, "physics/": 2742}  # physics/: a file for each law

INCLUDE = re.compile(r'[ \t]*#[ \t]*include[ \t]*"([^"]*)"')
COMMENT_OR_TEXT = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'', re.S)
CLASS = re.compile(r"^(?:class|struct) (\w+)[^;{}()]*\{", re.M)
# Definitions of members start at the left margin, and so do those of classes.
MEMBER = re.compile(r"^(?:template <[^\n]*>\n)?(?:[\w:&*<>,~\[\] ]+[ &*])?(\w+)(?:<\w+>)?::~?\w+\([^;{}]*?\)[^;{}]*\{", re.M)
UNNAMED = re.compile(r"^namespace \{\n(.*?)^\}  // namespace$", re.S | re.M)
FUNCTION = re.compile(r"^(?![/\s#])[\w:<>,\s*&\[\]]+?[\s*&](\w+)\([^{};]*\)[^;{}]*\{", re.M)


class Sources:
    """What was found in the source files so far."""

    def __init__(self):
        self.problems, self.rooms, self.arrows = [], set(), set()
        self.room_lines, self.class_lines = collections.Counter(), collections.Counter()
        self.functions = collections.defaultdict(set)

    def add(self, file, text):
        program, *folders, name = file.split("/")
        room = f"{program}/{folders[0] if folders else name}"
        if room not in ROOMS and program not in BELOW:
            self.problems.append(f"{file}: is in a folder without a place in the order of check_sources.py" if folders else
                                 f"{file}: is a loose file; expected it in a folder of solver/")
        else:
            self.check_includes(file, text, program, room if room in ROOMS else program)
        if program == "solver" and folders:
            self.rooms.add(room)
            self.room_lines[f"{folders[0]}/"] += text.count("\n")
            self.class_lines.update(class_lines(text))
        if text.count("\n") > MAX_LINES and file not in LONG_FILES:
            self.problems.append(f"{file}: has {text.count(chr(10))} lines; expected at most {MAX_LINES}")
        if name.endswith(".cpp") and "physics" not in folders:
            for function in FUNCTION.findall("\n".join(UNNAMED.findall(text))):
                self.functions[program, function].add(file)

    def check_includes(self, file, text, program, room):
        for number, line in enumerate(text.splitlines(), 1):
            found = INCLUDE.match(line)
            if not found:
                continue
            target = next((known for known in ROOMS if known.partition("/")[2] == found[1].partition("/")[0]), None)
            place = f'{file}:{number}: includes "{found[1]}"'
            if target is None and room in ROOMS:
                self.problems.append(f"{place}; expected ROOM/FILE with a known room")
            if target in (None, room):
                continue
            if room in ROOMS and ROOMS.index(target) > ROOMS.index(room):
                self.problems.append(f"{place}; {room} stands below {target}")
            if program in BELOW and not target.startswith(f"{program}/") and target not in BELOW[program]:
                self.problems.append(f"{place}; {program} must not include {target}")
            if file.count("/") > 1 and program == "solver" and target.startswith("solver/"):
                self.arrows.add((room, target))

    def check_sums(self):
        for what, found, most in (("rooms", self.rooms, MAX_ROOMS), ("arrows between rooms", self.arrows, MAX_ARROWS)):
            if len(found) > most:
                self.problems.append(f"solver/: has {len(found)} {what}; expected at most {most}")
        for sizes, most in ((self.room_lines, MAX_ROOM), (self.class_lines, MAX_CLASS)):
            for name, lines in sizes.items():
                allowed = LARGER.get(name, most)
                if lines > allowed:
                    self.problems.append(f"solver: {name} has {lines} lines; expected at most {allowed}")
                elif name in LARGER and lines < 0.9 * allowed:
                    self.problems.append(f"solver: {name} has {lines} lines, well below the {allowed} of check_sources.py: lower that")
        for (_, name), files in sorted(self.functions.items(), key=lambda found: found[0][1]):
            if len(files) > 1:
                self.problems.append(f"{name}: is a function in the unnamed namespaces of {' and '.join(sorted(files))}; expected two names")


def end_of_block(text, start):
    """Position after the brace that closes the one at `start`."""
    depth = 0
    for match in re.compile(r"[{}]").finditer(text, start):
        depth += 1 if match.group() == "{" else -1
        if depth == 0:
            return match.end()
    return len(text)


def class_lines(source):
    """Lines of each class in one file. Comments and texts are blank: braces in them do not count, lines do."""
    text = COMMENT_OR_TEXT.sub(lambda match: re.sub(r"[^\n]", " ", match.group()), source)
    sizes = collections.Counter()
    for match in [*CLASS.finditer(text), *MEMBER.finditer(text)]:
        sizes[match[1]] += text.count("\n", match.start(), end_of_block(text, match.end() - 1)) + 1
    return sizes


def main():
    roots = [argument for argument in sys.argv[1:] if argument != "--list"]
    root = pathlib.Path(roots[0]) if roots else pathlib.Path(__file__).parent.parent
    sources = Sources()
    for path in sorted(path for program in ("solver", "mesher", "post") for path in (root / program).rglob("*.[ch]pp")):
        sources.add(str(path.relative_to(root)), path.read_text(encoding="utf-8"))
    sources.check_sums()
    print("\n".join([*sources.problems, f"check_sources: {len(sources.rooms)} rooms, {len(sources.arrows)} arrows, "
                     f"{len(sources.class_lines)} classes, {len(sources.problems)} problems"]))
    if "--list" in sys.argv:
        print(sources.room_lines.most_common(), sources.class_lines.most_common(15))
    return 1 if sources.problems else 0


if __name__ == "__main__":
    sys.exit(main())
