#!/usr/bin/env python3
"""The batches of source files that clang-tidy is to look at: tidy_batches.py BUILD [COMMIT]

BUILD has compile_commands.json; ninja knows what each batch includes. Without COMMIT all batches of
mesher/, solver/ and post/ are printed; with it those of the sources that differ from that commit. A
header that differs is seen through one batch that includes it. All batches are printed too where
the checks themselves differ, and where git knows no such commit: a checkout may come without its
history.
"""
import json
import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SOURCES = ('mesher/', 'solver/', 'post/')
CHECKS = ('.clang-tidy', 'workflows/tidy.sh', 'workflows/tidy_batches.py', 'workflows/packages.txt')


def batches_by_object(build):
    """Source file that the compiler is given, by the object file that it makes."""
    batches = {}
    for entry in json.loads((build / 'compile_commands.json').read_text()):
        place = os.path.relpath(entry['file'], build)
        if (place if not place.startswith('..') else os.path.relpath(entry['file'], ROOT)).startswith(SOURCES):
            batches[re.search(r' -o (\S+)', entry['command'])[1]] = entry['file']
    return batches


def differing(commit):
    """Paths that differ from a commit, or None where git cannot say."""
    git = ['git', '-C', str(ROOT)]
    try:
        changed = subprocess.run([*git, 'diff', '--name-only', '--diff-filter=d', commit, '--'], capture_output=True, text=True, check=True)
        added = subprocess.run([*git, 'ls-files', '--others', '--exclude-standard'], capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return None
    return set((changed.stdout + added.stdout).splitlines())


def includes_by_object(build):
    """Paths, relative to the root of the sources, of all inputs of an object file."""
    text = subprocess.run(['ninja', '-C', str(build), '-t', 'deps'], capture_output=True, text=True, check=True).stdout
    includes = {}
    for block in text.split('\n\n'):
        lines = block.strip().splitlines()
        if lines and ': #deps' in lines[0]:
            paths = (os.path.relpath(os.path.join(build, line.strip()), ROOT) for line in lines[1:])
            includes[lines[0].split(': #deps')[0]] = {path for path in paths if path.startswith(SOURCES)}
    return includes


def chosen(changed, batches, includes):
    """A nearly minimal set of batches that contains all changed sources."""
    wanted = {path for path in changed if path.startswith(SOURCES) and path.endswith(('.cpp', '.hpp'))}
    # A source file is in one batch only, so these batches come first.
    found = {name for name in batches if any(path.endswith('.cpp') for path in includes.get(name, set()) & wanted)}
    for name in found:
        wanted -= includes[name]
    while wanted:
        best = max(batches, key=lambda name: (len(includes.get(name, set()) & wanted), name))
        seen = includes.get(best, set()) & wanted
        if not seen:  # the rest is in no batch of this build
            break
        found.add(best)
        wanted -= seen
    return {batches[name] for name in found}


def main():
    build = Path(sys.argv[1]).resolve()
    batches = batches_by_object(build)
    changed = differing(sys.argv[2]) if len(sys.argv) > 2 and sys.argv[2] else None
    if changed is None or changed & set(CHECKS):
        looked_at = set(batches.values())
    else:
        looked_at = chosen(changed, batches, includes_by_object(build))
    print(f'tidy: {len(looked_at)} of {len(set(batches.values()))} batches', file=sys.stderr)
    print('\n'.join(sorted(looked_at)))


if __name__ == '__main__':
    main()
