#!/usr/bin/env python3
"""Functions of one name in the unnamed namespaces of two source files of a program.

Several files are compiled as one: two such functions become overloads, and a call may silently
use the other one.
check_names.py [ROOT] prints each and ends with exit code 1 if there is any. Laws (solver/physics) are compiled file by file.
"""

import collections
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent.parent)
unnamed = re.compile(r"^namespace \{\n(.*?)^\}  // namespace$", re.S | re.M)
function = re.compile(r"^(?![/\s#])[\w:<>,\s*&\[\]]+?[\s*&](\w+)\([^{};]*\)[^;{}]*\{", re.M)

places = collections.defaultdict(set)
for program in ("mesher", "solver", "post"):
    for path in sorted((root / program).rglob("*.cpp")):
        if "physics" in path.parts:
            continue
        for body in unnamed.findall(path.read_text()):
            for name in function.findall(body):
                places[program, name].add(str(path.relative_to(root)))

twice = {name: files for (_, name), files in places.items() if len(files) > 1}
for name, files in sorted(twice.items()):
    print(f"{name}: is a function in the unnamed namespaces of {' and '.join(sorted(files))}; expected two names")
sys.exit(1 if twice else 0)
