#!/usr/bin/env python3
"""Does tidy.py choose the batches that have what changed?"""
from expectations import expect, finish
from tidy import chosen

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


def check_batches():
    for what, changed, wanted in expected:
        expect(what, wanted, sorted(chosen(changed, batches, includes)))


finish('batches that clang-tidy looks at', globals())
