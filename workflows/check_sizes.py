#!/usr/bin/env python3
"""Sizes of the solver's rooms and classes (docs/develop/architecture.md). check_sizes.py [ROOT] [--list]

A room is a folder of solver/: at most 2500 lines, laws in folders of physics/ included. A class is its definition
and the bodies of its member functions in all files: at most 600 lines. Those listed below are larger; they may only
become smaller, and their numbers with them. Exit code 1 if anything is too large, or smaller than its number by more
than a tenth. --list prints the numbers.
"""
import re
import sys
from collections import Counter
from pathlib import Path

MOST_OF_ROOM = 2500
MOST_OF_CLASS = 600
LARGER = {'flow/': 2550, 'physics/': 2742}  # physics/: a file for each law
SLACK = 0.9


def end_of_block(text, start):
    """Position after the brace that closes the one at `start`."""
    depth = 0
    for match in re.compile(r'[{}]').finditer(text, start):
        depth += 1 if match.group() == '{' else -1
        if depth == 0:
            return match.end()
    return len(text)


def without_texts(source):
    """The source with comments and texts blank: braces in them do not count, lines do."""
    blank = lambda match: re.sub(r'[^\n]', ' ', match.group())
    return re.sub(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'', blank, source, flags=re.S)


def class_lines(source):
    """Lines of each class in one file."""
    text = without_texts(source)
    sizes = Counter()
    for match in re.finditer(r'^(?:class|struct) (\w+)[^;{}()]*\{', text, re.M):
        sizes[match[1]] += text.count('\n', match.start(), end_of_block(text, match.end() - 1)) + 1
    # Definitions of members start at the left margin, and so do those of classes.
    for match in re.finditer(r'^(?:template <[^\n]*>\n)?(?:[\w:&*<>,~\[\] ]+[ &*])?(\w+)(?:<\w+>)?::~?\w+\([^;{}]*?\)[^;{}]*\{',
                             text, re.M):
        sizes[match[1]] += text.count('\n', match.start(), end_of_block(text, match.end() - 1)) + 1
    return sizes


def main():
    roots = [argument for argument in sys.argv[1:] if argument != '--list']
    root = Path(roots[0]) if roots else Path(__file__).parent.parent
    rooms, classes = Counter(), Counter()
    for path in sorted((root / 'solver').glob('*/**/*.[ch]pp')):
        source = path.read_text()
        rooms[path.relative_to(root / 'solver').parts[0] + '/'] += source.count('\n')
        classes.update(class_lines(source))
    problems = []
    for sizes, most in ((rooms, MOST_OF_ROOM), (classes, MOST_OF_CLASS)):
        for name, lines in sizes.items():
            allowed = LARGER.get(name, most)
            if lines > allowed:
                problems.append(f'solver: {name} has {lines} lines; expected at most {allowed}')
            elif name in LARGER and lines < SLACK * allowed:
                problems.append(f'solver: {name} has {lines} lines, well below the {allowed} of check_sizes.py: lower that')
    print('\n'.join(problems + [f'check_sizes: {len(rooms)} rooms, {len(classes)} classes, {len(problems)} problems']))
    if '--list' in sys.argv:
        print(rooms.most_common(), classes.most_common(15))
    return 1 if problems else 0


if __name__ == '__main__':
    sys.exit(main())
