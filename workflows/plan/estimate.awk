# The numbers of an estimate in what suffuse-solver --explain says: steps, seconds, bytes of memory, bytes
# on disk, and what it rests on (whole or part).

/^estimate: [0-9]+ steps, / {
  count = split(substr($0, length("estimate: ") + 1), part, ", ")
  for (i = 1; i <= count; ++i) {
    split(part[i], word, " ")
    if (word[2] == "steps") steps = word[1]
    else if (word[2] in seconds_in) seconds = word[1] * seconds_in[word[2]]
    else if (part[i] ~ / of memory/) memory = word[1] * bytes_in[word[2]]
    else if (word[2] in bytes_in) disk = word[1] * bytes_in[word[2]]
  }
}

/^estimate: none, / { none = 1; rests = "none" }
/^estimate: from a trial of the / { rests = /whole run/ ? "whole" : "part" }

BEGIN {
  seconds_in["s"] = 1; seconds_in["min"] = 60; seconds_in["h"] = 3600
  bytes_in["kB"] = 1e3; bytes_in["MB"] = 1e6; bytes_in["GB"] = 1e9
}

END {
  if (none) { print ",,,,none"; exit }
  if (steps == "" || seconds == "" || memory == "" || disk == "" || rests == "") {
    print "no estimate in " FILENAME > "/dev/stderr"
    exit 1
  }
  printf "%d,%.3g,%.3g,%.3g,%s\n", steps, seconds, memory, disk, rests
}
