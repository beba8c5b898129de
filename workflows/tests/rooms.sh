#!/usr/bin/env bash
# Does check_sources.py find what it must? Works on a tree of a few files, in a folder of its own.
set -euo pipefail

. "$(dirname "${BASH_SOURCE[0]}")/expect.sh"
work=$scratch/sources

# file PATH INCLUDE...: writes a source file with these includes.
file() {
  local path=$1
  shift
  mkdir -p "$work/$(dirname "$path")"
  printf '#include "%s"\n' "$@" > "$work/$path"
}

# problems WHAT LINES: those that are found. The listed rooms are small here, which is left out.
problems() { expect "$1" "$2" "$("$workflows/check_sources.py" "$work" | grep -v 'lower that$' | sed '$d' || true)"; }

file solver/main.cpp driver/run.hpp
file solver/driver/run.hpp flow/flow.hpp results/writer.hpp
file solver/flow/flow.hpp mesh/mesh.hpp flow/parts.hpp physics/liquid.hpp
file solver/results/writer.hpp mesh/mesh.hpp
file mesher/mesh/mesh.hpp physics/liquid.hpp
file mesher/main.cpp mesh/mesh.hpp geometry.hpp
file post/commands/main.cpp results/writer.hpp drawing/chart.hpp
problems 'includes that go down' ''

file solver/flow/flow.hpp grid/grid.hpp driver/run.hpp
problems 'an include that goes up' 'solver/flow/flow.hpp:2: includes "driver/run.hpp"; solver/flow stands below solver/driver'
file solver/flow/flow.hpp grid/grid.hpp
file solver/physics/laws/law.cpp scene/scene.hpp
problems 'one from a folder within a room' \
  'solver/physics/laws/law.cpp:1: includes "scene/scene.hpp"; solver/physics stands below mesher/scene'
rm -r "$work/solver/physics"
file post/drawing/chart.cpp flow/flow.hpp
problems 'one of post into the solver' 'post/drawing/chart.cpp:1: includes "flow/flow.hpp"; post must not include solver/flow'
file post/drawing/chart.cpp drawing/ticks.hpp
file solver/flow/parts.cpp parts.hpp
problems 'one without a room' 'solver/flow/parts.cpp:1: includes "parts.hpp"; expected ROOM/FILE with a known room'
rm "$work/solver/flow/parts.cpp"

file solver/run.cpp driver/run.hpp
problems 'a loose file' 'solver/run.cpp: is a loose file; expected it in a folder of solver/'
rm "$work/solver/run.cpp"
file solver/cellar/wine.cpp mesh/mesh.hpp
problems 'a room without a place' 'solver/cellar/wine.cpp: is in a folder without a place in the order of check_sources.py'
rm -r "$work/solver/cellar"

seq -f '// %g' 501 > "$work/solver/flow/long.cpp"
problems 'a long file' 'solver/flow/long.cpp: has 501 lines; expected at most 500'
sed -i 1d "$work/solver/flow/long.cpp"
problems 'and one that is just short enough' ''

# A class counts with the bodies of its members; braces in comments and texts do not count.
{ echo 'class Large {'; seq -f '  int member_%g;  // {' 110; echo '};'; } > "$work/solver/flow/large.hpp"
{ echo 'void Large::act() {'; seq -f '  call("{", %g);' 490; echo '}'; } > "$work/solver/flow/large.cpp"
problems 'a large class' 'solver: Large has 604 lines; expected at most 600'
rm "$work"/solver/flow/large.?pp

# Functions with a body in unnamed namespaces of one program.
# unnamed PATH LINE...: writes a source file with these lines in an unnamed namespace.
unnamed() {
  mkdir -p "$work/$(dirname "$1")"
  { printf '#include "physics/liquid.hpp"\nnamespace suffuse {\nnamespace {\n\n'; printf '%s\n' "${@:2}"
    printf '\n}  // namespace\n\nint share(int value) {\n  return value;\n}\n}  // namespace suffuse\n'; } > "$work/$1"
}

head_of='double head_of(const Liquid& liquid, double pressure) {'
unnamed solver/flow/heads.cpp "$head_of" '  return pressure / weight(liquid);' '}'
unnamed solver/grid/names.cpp 'double depth_of(double head);' '// double head_of(double depth) {' 'const double head_of_water = 1.0;'
unnamed solver/physics/laws/heads.cpp "$head_of" '  return pressure;' '}'
unnamed post/drawing/heads.cpp "$head_of" '  return pressure;' '}'
problems 'functions that no two files of a program share' ''
twice='is a function in the unnamed namespaces of solver/flow/heads.cpp and solver/grid/heads.cpp; expected two names'
unnamed solver/grid/heads.cpp 'std::vector<double> head_of(' '    const std::vector<double>& depths) {' '  return depths;' '}'
problems 'two overloads in two files' "head_of: $twice"
unnamed solver/grid/heads.cpp 'template <int Dim>' 'const Grid<Dim>& head_of(const Grid<Dim>& grid, int) noexcept {' '  return grid;' '}'
problems 'a template and a function' "head_of: $twice"
unnamed solver/grid/heads.cpp '  head_of(grid);' 'struct Heads {' '  double head_of(double depth) const { return depth; }' '};'
problems 'a member and a call, which are something else' ''

rooms=(common mesh scene case physics files results grid linear solid equilibrium boundary motion mixed flow coupling field points explicit)
for ((i = 5; i < 19; ++i)); do file "solver/${rooms[i]}/all.hpp" "${rooms[@]:0:i}"; done
problems 'too many arrows' 'solver/: has 107 arrows between rooms; expected at most 98'
expect 'the exit code' 1 "$("$workflows/check_sources.py" "$work" > /dev/null; echo $?)"
finish 'these checks'
