# To be sourced by tests of workflows, whose arguments go to make (BIN=FOLDER, -j2). They work in a folder of their own, whose name has
# spaces; the number of checks that failed is in `failures`.
workflows=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
work=$scratch/"with spaces"
mkdir -p "$work/my scenes"
make_arguments=("$@")
programs=$workflows/../build/release/bin
for argument in "$@"; do [[ $argument != BIN=* ]] || programs=${argument#BIN=}; done
failures=0

# expect WHAT EXPECTED FOUND
expect() {
  if [ "$2" == "$3" ]; then
    echo "ok: $1"
  else
    echo "FAILED: $1"
    diff <(echo "$2") <(echo "$3") | sed 's/^</  expected/; s/^>/  found/; /^[0-9-]/d' || true
    failures=$((failures + 1))
  fi
}

# finish WHAT: ends the test.
finish() { [ "$failures" -eq 0 ] || { echo "$failures of the checks of $1 failed"; exit 1; }; }

# run_make TARGET VARIABLE...: sets `code` to the exit code and writes the output to the log.
log=$scratch/log
run_make() {
  code=0
  make -C "$workflows" "${make_arguments[@]}" OUT="$work/o ut" "$@" > "$log" 2>&1 || code=$?
}
# run_script SCRIPT VARIABLE...: likewise a script that make calls, without the Makefile, which takes seconds to read.
run_script() {
  code=0
  env OUT_FOLDER="$work/o ut" PROGRAMS="$programs" MAKE=make TOLERANCE=1e-12 CALLED_FROM="$PWD" "${@:2}" \
    /usr/bin/python3 "$workflows/$1" > "$log" 2>&1 || code=$?
}

# said PATTERN: the first match in the log.
said() { grep -o -- "$1" "$log" | head -1; }

# inventory FOLDER: paths, times (to the nanosecond) and sizes of all files, without hidden ones, which are notes of make.
inventory() { find "$1" -type f -not -name '.*' -printf '%P %T@ %s\n' | sort; }
# redone FOLDER: paths of the files that are not as in the inventory `before`.
redone() { comm -13 <(echo "$before") <(inventory "$1") | cut -d' ' -f1; }

# statuses FOLDER: which runs of a sweep have ended and been looked at, and when.
statuses() { (cd "$1" && find . \( -name '*.status' -o -name '*.assessed' \) -printf '%P %T@\n' | sort); }

# expect_nothing_new TABLE COMMAND...: the command, called again, makes no run in the folder `out`, and the same table.
expect_nothing_new() {
  local before
  before=$(statuses "$out")
  cp "$out/$1" "$scratch/table"
  "${@:2}"
  expect 'a second call makes nothing' "$before" "$(statuses "$out")"
  expect 'and the same table' same "$(cmp "$scratch/table" "$out/$1" && echo same)"
}

# cells TABLE ROW COLUMN...: cells of the row that begins with ROW, by the names of their columns.
cells() {
  awk -F, -v row="$2" -v wanted="${*:3}" 'NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i; n = split(wanted, names, " ") }
    $1 == row { for (k = 1; k <= n; ++k) printf "%s%s", $at[names[k]], k < n ? " " : "\n" }' "$1"
}

# column NAME: that column of sweep.csv in the folder `out`, its name first, without texts in quotes.
column() {
  sed 's/"[^"]*"//g' "$out/sweep.csv" | awk -F, -v name="$1" 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == name) at = i } { print $at }'
}

# tree PID: prints the process and all its descendants.
tree() { echo "$1"; for child in $(pgrep -P "$1"); do tree "$child"; done; }
