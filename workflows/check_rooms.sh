#!/usr/bin/env bash
# Includes between the rooms of the sources go down only (docs/develop/architecture.md). check_rooms.sh [ROOT]
#
# Prints a line for each include that goes up, for each loose source file in solver/ but main.cpp,
# for each source file that is too long, and for too many rooms or arrows (pairs of rooms, one of
# which includes the other) in solver/. Exit code 1 if there is any.
set -eu
cd "${1:-$(dirname "${BASH_SOURCE[0]}")/..}"

# A room is a folder; it may include itself and the rooms before it.
rooms='solver/physics mesher/common mesher/mesh mesher/scene mesher/case solver/files solver/results solver/ranks solver/grid solver/linear '
rooms+='solver/solid solver/equilibrium solver/boundary solver/motion solver/mixed solver/bounds solver/flow solver/coupling solver/field '
rooms+='solver/points solver/explicit solver/formulation solver/driver solver/tools solver/main.cpp '
rooms+='post/drawing post/values post/tables post/checks post/figures post/report post/commands'
# The other programs, and all that they may include.
below_mesher='solver/physics,mesher/common,mesher/mesh,mesher/scene,mesher/case'
others="mesher:$below_mesher post:$below_mesher,solver/files,solver/results"
max_rooms=20 max_arrows=98 max_lines=500
# The schema is one list that is read from top to bottom. The other file is still to be divided.
long_files='mesher/scene/scene_keys.cpp mesher/common/hdf5_io.cpp'

mapfile -t files < <(find solver mesher post -name '*.[ch]pp' | sort)
awk -v rooms="$rooms" -v others="$others" -v max_rooms=$max_rooms -v max_arrows=$max_arrows \
  -v max_lines=$max_lines -v long_files="$long_files" '
  BEGIN {
    count = split(rooms, name)
    for (i = 1; i <= count; ++i) {
      rank[name[i]] = i
      part = name[i]; sub(/.*\//, "", part)
      room_of_part[part] = name[i]
    }
    count = split(others, name)
    for (i = 1; i <= count; ++i) {
      split(name[i], pair, ":")
      below[pair[1]] = "," pair[2] ","
    }
  }
  function problem(text) { print text; ++problems }
  function end_file() {
    if (file != "" && length_of_file > max_lines && index(" " long_files " ", " " file " ") == 0) {
      problem(file ": has " length_of_file " lines; expected at most " max_lines)
    }
  }
  function start_file(parts, depth) {
    end_file()
    file = FILENAME
    depth = split(file, parts, "/")
    program = parts[1]
    room = depth > 2 || file == "solver/main.cpp" ? parts[1] "/" parts[2] : parts[1]
    known = room in rank || parts[1] in below
    if (!known && depth == 2) problem(file ": is a loose file; expected it in a folder of solver/")
    if (!known && depth > 2) problem(file ": is in a folder without a place in the order of check_rooms.sh")
    if (!(room in rank)) room = parts[1]
    if (known && file ~ /^solver\/.*\//) is_room[room] = 1
  }
  FNR == 1 { start_file() }
  { length_of_file = FNR }
  known && /^[ \t]*#[ \t]*include[ \t]*"/ {
    path = $0; sub(/^[^"]*"/, "", path); sub(/".*/, "", path)
    part = path; sub(/\/.*/, "", part)
    place = file ":" FNR ": includes \"" path "\""
    inner = room in rank
    if (!(part in room_of_part)) {
      if (inner) problem(place "; expected ROOM/FILE with a known room")
      next
    }
    target = room_of_part[part]
    if (target == room) next
    if (inner && rank[target] > rank[room]) problem(place "; " room " stands below " target)
    if (program in below && target !~ ("^" program "/") && index(below[program], "," target ",") == 0) problem(place "; " program " must not include " target)
    if (file ~ /^solver\/.*\// && target ~ /^solver\// && !((room, target) in arrow)) { arrow[room, target] = 1; ++arrows }
  }
  END {
    end_file()
    found = 0
    for (r in is_room) ++found
    if (found > max_rooms) problem("solver/: has " found " rooms; expected at most " max_rooms)
    if (arrows > max_arrows) problem("solver/: has " arrows " arrows between rooms; expected at most " max_arrows)
    print "check_rooms: " found " rooms, " arrows + 0 " arrows, " problems + 0 " problems"
    exit problems > 0
  }' "${files[@]}"
