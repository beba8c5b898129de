#!/usr/bin/env python3
"""Does tidy_batches.py choose the batches that have what changed?"""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
sys.dont_write_bytecode = True
from tidy_batches import chosen  # noqa: E402

batches = {'flow.o': 'flow.cxx', 'grid.o': 'grid.cxx', 'post.o': 'post.cxx', 'new.o': 'new.cxx'}
includes = {
    'flow.o': {'solver/flow/flow.cpp', 'solver/flow/flow.hpp', 'solver/grid/grid.hpp', 'mesher/mesh/mesh.hpp'},
    'grid.o': {'solver/grid/grid.cpp', 'solver/grid/grid.hpp', 'mesher/mesh/mesh.hpp'},
    'post.o': {'post/drawing/chart.cpp', 'mesher/mesh/mesh.hpp'},
}
expected = [
    ('nothing', [], []),
    ('a test and a document', ['tests/solver/grid_test.cpp', 'docs/theory/README.md'], []),
    ('a source file', ['solver/grid/grid.cpp'], ['grid.cxx']),
    ('two of two batches', ['solver/grid/grid.cpp', 'post/drawing/chart.cpp'], ['grid.cxx', 'post.cxx']),
    ('a header that one batch includes', ['solver/flow/flow.hpp'], ['flow.cxx']),
    ('a header that a batch includes which is looked at anyway', ['mesher/mesh/mesh.hpp', 'post/drawing/chart.cpp'], ['post.cxx']),
    ('two headers that one batch includes', ['solver/flow/flow.hpp', 'solver/grid/grid.hpp'], ['flow.cxx']),
    ('a header that nothing includes', ['solver/flow/unused.hpp'], []),
]
failures = 0
for what, changed, wanted in expected:
    found = sorted(chosen(changed, batches, includes))
    print(f'ok: {what}' if found == wanted else f'FAILED: {what}: expected {wanted}, found {found}')
    failures += found != wanted
sys.exit(1 if failures else 0)
