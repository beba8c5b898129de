# The tables of docs/evidence/stability.md from those of the sweeps: awk -F, -v form=markdown|check [-v what=WHATS.csv] -f report.awk TABLE.csv
# WHATS.csv: the name of a sweep and what it does, from suffuse-stress --list.
BEGIN {
  while (what != "" && (getline line < what) > 0) {
    comma = index(line, ",")
    does[substr(line, 1, comma - 1)] = substr(line, comma + 1)
  }
}
FNR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i; next }
{
  sweep = $at["sweep"]
  if (!(sweep in runs)) sweeps[++count] = sweep
  ++runs[sweep]; ++of[sweep, $at["verdict"]]; ++of["all", $at["verdict"]]; ++runs["all"]
  seconds[sweep] += $at["seconds"]; seconds["all"] += $at["seconds"]
  if ($at["seconds"] > slowest[sweep]) slowest[sweep] = $at["seconds"]
  if ($at["residual"] > residual[sweep]) residual[sweep] = $at["residual"]
  explicit = $at["scheme"] ~ /explicit|mixed|material/
  if ($at["verdict"] == "pass" && sweep != "energy") {
    if ($at["bounded"]) { ++bounded; if ($at["overshoot"] > promised) promised = $at["overshoot"] }
    else if (!explicit && $at["overshoot"] > elsewhere) {
      elsewhere = $at["overshoot"]; where = sweep ", " $at["scheme"] ", " $at["parameters"]
    }
    if ($at["porosity_error"] > porosity) porosity = $at["porosity_error"]
    if ($at["discharge_error"] > discharge) discharge = $at["discharge_error"]
    if ($at["fitted_min"] < fitted) fitted = $at["fitted_min"]
  }
  if ($at["verdict"] == "refused") {
    message = $NF
    sub(/^--set [^\n]*}: /, "", message)
    sub(/^.*--set [^ ]*: /, "", message); sub(/^stress.toml(:[0-9]+)?: /, "", message)
    sub(/^suffuse-solver: error: /, "", message); sub(/^[^ ]*\.case\.h5: /, "", message)
    gsub(/;/, ",", message)
    # The same sentence with other numbers is the same message.
    key = message; gsub(/-?[0-9][-+0-9.e]*/, "#", key)
    if (!(key in times)) { keys[++kinds] = key; example[key] = message; of_sweep[key] = sweep }
    ++times[key]
  }
  if ($at["verdict"] == "failed") failures = failures "failed: " sweep ", " $at["scheme"] ", " $at["parameters"] ", seed " $at["seed"] ": " $NF "\n"
}
function number(x) { return x == 0 ? "0" : sprintf("%.1e", x) }
END {
  if (form == "check") {
    for (k = 1; k <= count; ++k) {
      s = sweeps[k]
      printf "%-14s %4d runs: %4d pass, %3d refused, %d failed; %.0f s, the longest %.1f s\n", s, runs[s], of[s, "pass"], of[s, "refused"], of[s, "failed"], seconds[s], slowest[s]
    }
    printf "%s", failures
    printf "%d runs, %d failed\n", runs["all"], of["all", "failed"]
    exit of["all", "failed"] > 0
  }
  print "| sweep | what | runs | pass | refused | failed | largest residual | longest run, s |"
  print "|---|---|---|---|---|---|---|---|"
  for (k = 1; k <= count; ++k) {
    s = sweeps[k]
    printf "| %s | %s | %d | %d | %d | %d | %s | %.1f |\n", s, does[s], runs[s], of[s, "pass"], of[s, "refused"], of[s, "failed"], number(residual[s]), slowest[s]
  }
  printf "| all | | %d | %d | %d | %d | | |\n\n", runs["all"], of["all", "pass"], of["all", "refused"], of["all", "failed"]
  printf "Of the sweep `energy` the residual is the largest drift or growth of energy. Processor time in all: %.0f s.\n\n", seconds["all"]
  printf "- Pressures have bounds in %d runs; they leave them by %s of their range. Elsewhere by up to %s (%s).\n", bounded, number(promised), number(elsewhere), where
  printf "- Mean porosities that are known are met to %s, discharges that are known to %s (implicit, tolerance 1e-3).\n", number(porosity), number(discharge)
  printf "- The least-squares field of $c$ of double-point snapshots falls to %.2g; the points themselves stay in $[0, 1)$.\n\n", fitted
  print "What was refused, with numbers of the first run that was:\n"
  print "| runs | sweep | message |"
  print "|---|---|---|"
  for (k = 1; k <= kinds; ++k) {
    text = example[keys[k]]; gsub(/\|/, "\\|", text)
    printf "| %d | %s | %s |\n", times[keys[k]], of_sweep[keys[k]], text
  }
}
