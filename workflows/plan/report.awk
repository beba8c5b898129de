# From the lines of measure.sh, with a header, to a table for people, and to a verdict:
#     awk -F, -f report.awk [-v form=markdown] plan.csv
# Exits 1 when a run with the plan differs from the one without by more than its bound, or fewer than 20 scenes (all, of
# fewer) have all their estimates within a factor of two. Wall time is judged from 5 s on: below, the machine's moods decide.

function ratio(estimate, actual, judged,    r) {
  if (estimate == "") { missed = 1; return "none (!)" }
  r = estimate / actual
  if (judged && (r > 2 || r < 0.5)) { missed = 1; return sprintf("%.2f (!)", r) }
  return judged ? sprintf("%.2f", r) : sprintf("(%.2f)", r)
}

function line(cells,    count, part, i, text) {
  count = split(cells, part, "|")
  if (form == "markdown") {
    for (i = 1; i <= count; ++i) text = text "| " part[i] " "
    print text "|"
    return
  }
  text = sprintf("%-22s", part[1])
  for (i = 2; i <= count; ++i) text = text sprintf("%" width[i] "s", part[i])
  print text
}

BEGIN {
  split("0 9 9 10 11 9 12 12 22 9 8 9 8 8", width, " ")
}

FNR == 1 {
  for (i = 1; i <= NF; ++i) at[$i] = i
  line("scene|s, plan|s, all|speed-up|of passes|steps|steps, all|difference|where largest|bound|steps|seconds|memory|disk")
  if (form == "markdown")
    line("---|---:|---:|---:|---:|---:|---:|---:|---|---:|---:|---:|---:|---:")
  next
}

function of_skips(text) { return $at["steps_no_skip"] == "" ? "" : text }
function speed_up(of) { return of_skips(sprintf("%.2f", $at[of "_no_skip"] / ($at[of] > 0 ? $at[of] : 1))) }

{
  missed = 0
  difference = sprintf("%.1e", $at["difference"])
  if ($at["difference"] == 0) difference = "0"
  if ($at["difference"] > $at["bound"]) { wrong = 1; difference = difference " (!)" }
  line(sprintf("%s|%.3g|%s|%s|%s|%d|%s|%s|%s|%s|%s|%s|%s|%s", $at["scene"], $at["seconds"],
               of_skips(sprintf("%.3g", $at["seconds_no_skip"])), speed_up("seconds"), speed_up("passes"), $at["steps"],
               $at["steps_no_skip"], of_skips(difference), $at["column"], $at["bound"],
               ratio($at["estimate_steps"], $at["steps"], 1),
               ratio($at["estimate_seconds"], $at["seconds"], $at["seconds"] >= 5),
               ratio($at["estimate_memory"], $at["memory"], 1),
               ratio($at["estimate_disk"], $at["disk"], 1)))
  ++scenes
  if (!missed) ++near
}

END {
  if (near < (scenes < 20 ? scenes : 20)) wrong = 1
  exit wrong
}
