# runs.csv of `suffuse-post table`, then paper-says.csv: each row of the latter with the values of its
# column in the runs it names. `exact` may name a column too. Fields have no commas and no quotes.
BEGIN { FS = OFS = "," }

NR == FNR && FNR == 1 { for (i = 1; i <= NF; ++i) column[$i] = i; next }
NR == FNR { for (name in column) value[$1, name] = $column[name]; known[$1]; next }

FNR == 1 { print "quantity", "unit", "paper_says", "exact", "single_point", "double_point", "runs"; next }
{
  print $1, $2, $3, $4 in column ? of($7 == "" ? $6 : $7, $4) : $4, of($6, $5), of($7, $5),
        $6 ($6 != "" && $7 != "" ? " " : "") $7
}

function of(run, name) {
  if (run == "") return ""
  if (!(run in known) || !(name in column)) {
    print FILENAME ":" FNR ": no column " name " of a run " run > "/dev/stderr"
    exit 2
  }
  # Counts as they are, other numbers to four digits, words as they are.
  return value[run, name] ~ /^-?[0-9]+[.e]/ ? sprintf("%.4g", value[run, name]) : value[run, name]
}
