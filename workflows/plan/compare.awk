# Largest difference between two tables of the same run, column by column, relative to the column's
# largest value: awk -F, -f compare.awk [-v leave="COLUMN COLUMN"] A.csv B.csv
# Prints the difference and its column; 0 when all values are the same. Rows must be at the same times.

function size(x) { return x < 0 ? -x : x }

function fail(message) {
  print message > "/dev/stderr"
  failed = 1
  exit 1
}

BEGIN { count = split(leave, names, " "); for (i = 1; i <= count; ++i) left_out[names[i]] = 1 }

FNR == 1 {
  ++file
  if (file == 1) { header = $0; columns = split($0, column) }
  else if ($0 != header) fail("columns differ: " FILENAME)
  next
}

file == 1 {
  rows = FNR
  for (c = 1; c <= NF; ++c) value[FNR, c] = $c
}

file == 2 {
  ++compared
  if (FNR > rows || $1 != value[FNR, 1]) fail("row " FNR " is at another time: " FILENAME)
  for (c = 1; c <= NF; ++c) {
    if (size($c) > largest[c]) largest[c] = size($c)
    if (size(value[FNR, c]) > largest[c]) largest[c] = size(value[FNR, c])
    difference = size($c - value[FNR, c])
    if (difference > apart[c]) apart[c] = difference
  }
}

END {
  if (failed) exit 1
  if (file != 2 || compared + 1 != rows) fail("numbers of rows differ")
  worst = 0
  where = "-"
  for (c = 1; c <= columns; ++c) {
    if (column[c] in left_out || apart[c] == 0) continue
    relative = apart[c] / largest[c]
    if (every) printf "%s %.3g\n", column[c], relative
    if (relative > worst) { worst = relative; where = column[c] }
  }
  printf "%.3g %s\n", worst, where
}
