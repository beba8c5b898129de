#!/usr/bin/env python3
"""clang-tidy on the sources: tidy.py BUILD JOBS [COMMIT|new]

Headers take most of its time, so it looks at the batches of files that are compiled as one. BUILD has compile_commands.json; ninja
knows what each batch includes. Without COMMIT it looks at all batches of mesher/, solver/ and post/; with it at those of the sources
that differ from that commit; with `new` from the commit where the branch left main, and on main from the previous one. A header that
differs is seen through one batch that includes it. All batches are looked at too where the checks themselves differ, and where git
knows no such commit: a checkout may come without its history.
"""
import concurrent.futures
import json
import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SOURCES = ('mesher/', 'solver/', 'post/')
CHECKS = ('.clang-tidy', 'workflows/tidy.py', 'workflows/packages.txt')


def batches_by_object(build):
    """Source file that the compiler is given, by the object file that it makes."""
    batches = {}
    for entry in json.loads((build / 'compile_commands.json').read_text()):
        place = os.path.relpath(entry['file'], build)
        if (place if not place.startswith('..') else os.path.relpath(entry['file'], ROOT)).startswith(SOURCES):
            batches[re.search(r' -o (\S+)', entry['command'])[1]] = entry['file']
    return batches


def git(*arguments):
    """What git says, or None where it cannot say."""
    try:
        return subprocess.run(['git', '-C', str(ROOT), *arguments], capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return None


def differing(commit):
    """Paths that differ from a commit, or None where git cannot say."""
    if commit == 'new':
        commit = git('merge-base', 'HEAD', 'origin/main') or git('merge-base', 'HEAD', 'main') or ''
        commit = 'HEAD^' if commit == git('rev-parse', 'HEAD') else commit
    changed = git('diff', '--name-only', '--diff-filter=d', commit, '--') if commit else None
    added = git('ls-files', '--others', '--exclude-standard')
    return None if changed is None or added is None else {*changed.splitlines(), *added.splitlines()}


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
    build, jobs = Path(sys.argv[1]).resolve(), int(sys.argv[2])
    batches = batches_by_object(build)
    changed = differing(sys.argv[3]) if len(sys.argv) > 3 else None
    if changed is None or changed & set(CHECKS):
        looked_at = set(batches.values())
    else:
        looked_at = chosen(changed, batches, includes_by_object(build))
    print(f'tidy: {len(looked_at)} of {len(set(batches.values()))} batches', file=sys.stderr)

    def look(batch):
        ended = subprocess.run(['clang-tidy', '-quiet', '--config-file=.clang-tidy', '-p', build, '--checks=-bugprone-suspicious-include',
                                '--extra-arg=-Wno-unknown-warning-option', r'--header-filter=/(mesher|solver|post)/.*\.[ch]pp$', batch],
                               cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        if ended.returncode:
            print(ended.stdout, flush=True)
        return ended.returncode == 0

    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        return 0 if all(list(pool.map(look, sorted(looked_at)))) else 1


if __name__ == '__main__':
    sys.exit(main())
