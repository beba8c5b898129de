# What --explain says of the explicit scheme, and run.json of the implicit one: steps and seconds of both.
BEGIN {
  print "conductivity_m_s,bulk_modulus_Pa,steps_implicit,flow_solved,seconds_implicit,steps_explicit,seconds_explicit_estimated"
}
function number(line) { sub(/.*: */, "", line); sub(/,.*/, "", line); return line }
function flush_run() {
  if (run == "") return
  split(run, value, "-K")
  explicit = run in steps_of ? steps_of[run] "," seconds_of[run] : "none,none"
  printf "%s,%s,%d,%d,%.2g,%s\n", value[1], value[2], steps, solved, wall, explicit
}
FNR == 1 {
  flush_run()
  run = pass = solved = ""
  split(FILENAME, part, "/k")
  name = part[length(part)]
  if (name ~ /explicit/) { sub(/-explicit.*/, "", name) } else { sub(/\.results.*/, "", name); run = name }
}
# estimate: 130 steps, 0.48 s on 1 thread, ...
/^estimate: [0-9].* steps, / {
  steps_of[name] = $2
  seconds_of[name] = sprintf("%.2g", $4 * ($5 == "h" ? 3600 : $5 == "min" ? 60 : 1))
}
/"steps":/ { steps = number($0) }
/"wall_seconds":/ { wall = number($0) }
/"name":/ { pass = $0 }
/"calls":/ && pass ~ /"flow"/ && solved == "" { solved = number($0) }
/"status":/ && !/"done"/ { print FILENAME ": the run did not end well" > "/dev/stderr"; failed = 1 }
END { flush_run(); exit failed }
