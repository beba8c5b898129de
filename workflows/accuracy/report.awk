# What the runs reached, for people: awk -F, -f report.awk -v form=FORM accuracy.csv left-out.csv
#
# form: markdown, the sections of docs/evidence/accuracy.md; check, verdicts on the runs, exit 1 when one is wrong.
# left-out.csv has the columns problem, scheme, size, points_per_element, tolerance, steps, seconds.

function words(scheme,    part) {
  split(scheme, part, "-")
  return formulation[part[1]] " | " way[part[2]]
}

function plain(scheme,    text) {
  text = words(scheme)
  sub(/ \| /, ", ", text)
  return text
}

function seconds_text(s) {
  if (s >= 100) return sprintf("%.0f", s)
  return s >= 0.01 ? sprintf("%.2g", s) : sprintf("%.1g", s)
}

function times_text(ratio) {
  return sprintf(ratio >= 10 ? "%.0f times" : "%.2g times", ratio)
}

# Fastest run of a scheme with at most this error; empty when there is none.
function time_to(problem, scheme, most,    i, best) {
  best = ""
  for (i = 1; i <= runs; ++i)
    if (problem_of[i] == problem && scheme_of[i] == scheme && error_of[i] <= most)
      if (best == "" || seconds_of[i] < best) best = seconds_of[i]
  return best
}

# Number of the most exact run of a scheme; 0 when there is none.
function most_exact(problem, scheme,    i, best) {
  best = 0
  for (i = 1; i <= runs; ++i)
    if (problem_of[i] == problem && scheme_of[i] == scheme && (!best || error_of[i] < error_of[best])) best = i
  return best
}

# How many times longer than the implicit scheme of its formulation, at the smallest error both reach.
function times_longer(problem, scheme,    mine, other, part, both, default_scheme) {
  split(scheme, part, "-")
  default_scheme = (part[1] == "sp" ? "sp" : "dp") "-implicit"
  mine = most_exact(problem, scheme)
  other = most_exact(problem, default_scheme)
  if (!mine || !other) return ""
  both = error_of[mine] > error_of[other] ? error_of[mine] : error_of[other]
  return time_to(problem, scheme, both) / time_to(problem, default_scheme, both)
}

function problem_section(problem,    s, k, best, ratio, scheme) {
  print "### " problem "\n"
  print "![Wall time against error, " problem "](images/accuracy-" problem ".png)\n"
  print "| formulation | scheme | s to 1e-2 | s to 1e-3 | s to 1e-4 | best error | in s | longer than implicit |"
  print "|---|---|---:|---:|---:|---:|---:|---:|"
  for (s = 1; s <= schemes; ++s) {
    scheme = scheme_name[s]
    best = most_exact(problem, scheme)
    if (!best) continue
    printf "| %s |", words(scheme)
    for (k = 2; k <= 4; ++k) {
      printf " %s |", time_cell(problem, scheme, 10 ^ -k * (1 + 1e-9))
    }
    ratio = times_longer(problem, scheme)
    printf " %.1e | %s | %s |\n", error_of[best], seconds_text(seconds_of[best]),
      scheme ~ /^(sp|dp)-implicit$/ || ratio == "" ? "" : times_text(ratio)
  }
  print ""
  if (problem ~ /^fines-/) saving_lines(problem)
  left_out_lines(problem)
}

function left_out_lines(problem,    i, s, text, own) {
  text = ""
  for (s = 1; s <= schemes; ++s) {
    own = ""
    for (i = 1; i <= omitted; ++i)
      if (omitted_problem[i] == problem && omitted_scheme[i] == scheme_name[s])
        own = own (own == "" ? "" : ", ") omitted_text[i]
    if (own != "") text = text (text == "" ? "" : "; ") plain(scheme_name[s]) ": " own
  }
  if (text != "")
    print "Left out, by size" (text ~ /\// ? " / points per element" : "") ", with the seconds they would take: " text ".\n"
}

# The shortest run of a scheme that was left out; empty when there is none.
function shortest_left_out(problem, scheme,    i, best) {
  best = ""
  for (i = 1; i <= omitted; ++i)
    if (omitted_problem[i] == problem && omitted_scheme[i] == scheme && (best == "" || omitted_seconds[i] < best))
      best = omitted_seconds[i]
  return best
}

# Seconds to an error; where it is not reached, what the shortest run left out would take at least.
function time_cell(problem, scheme, most,    t) {
  t = time_to(problem, scheme, most)
  if (t != "") return seconds_text(t)
  t = shortest_left_out(problem, scheme)
  return t == "" ? "-" : "> " seconds_text(t)
}

# How much less the implicit scheme takes to an error of 1e-3 than the paper's without mass scaling: in the same
# formulation, and the quickest here beside the paper's double-point one.
function saving_lines(problem,    k, pair, part, explicit, implicit, bound, text) {
  text = ""
  split("sp-explicit sp-implicit,paper-explicit dp-implicit,paper-explicit sp-implicit", pair, ",")
  for (k = 1; k <= 3; ++k) {
    split(pair[k], part, " ")
    explicit = time_to(problem, part[1], 1.000000001e-3)
    implicit = time_to(problem, part[2], 1.000000001e-3)
    bound = ""
    if (explicit == "") { explicit = shortest_left_out(problem, part[1]); bound = "more than " }
    if (explicit == "" || implicit == "") continue
    text = text (text == "" ? "" : "; ") plain(part[2]) " takes " seconds_text(implicit) " s to 1e-3, " \
      plain(part[1]) " " bound seconds_text(explicit) " s, " bound times_text(explicit / implicit) " as long"
  }
  if (text != "") print toupper(substr(text, 1, 1)) substr(text, 2) ".\n"
}

function verdict(right, sentence) {
  print (right ? "ok: " : "WRONG: ") sentence
  if (!right) wrong = 1
}

function check(    p, s, ratio, k, first) {
  for (p = 1; p <= problems; ++p)
    for (s = 1; s <= schemes; ++s)
      if (!most_exact(problem_name[p], scheme_name[s]) && !((problem_name[p], scheme_name[s]) in is_omitted))
        verdict(0, problem_name[p] ": no run of " scheme_name[s])
  for (s = 1; s <= schemes; ++s) {
    if (scheme_name[s] !~ /^(sp|paper)-explicit$/) continue
    ratio = times_longer("fines-constant", scheme_name[s])
    if (ratio != "")
      verdict(ratio >= 10, sprintf("fines-constant: %s takes %.3g times as long as the implicit scheme", scheme_name[s], ratio))
  }
  # Mass scaling slows a flow from rest: no mesh helps.
  for (p = 1; p <= problems; ++p) {
    if (problem_name[p] !~ /^(fines-log|startup)$/) continue
    for (s = 1; s <= schemes; ++s)
      if (scheme_name[s] ~ /-scaled$/ && (k = most_exact(problem_name[p], scheme_name[s])))
        verdict(error_of[k] > 0.05, sprintf("%s: %s stays %.2g away, its flow has not settled", problem_name[p],
                                            scheme_name[s], error_of[k]))
  }
}

BEGIN {
  formulation["sp"] = "single-point"; formulation["dp"] = "double-point"
  formulation["paper"] = "double-point, paper's mode"
  way["scaled"] = "explicit, mass scaling 1e4"; way["explicit"] = "explicit"
  way["drag"] = "explicit, implicit drag"; way["implicit"] = "implicit"
  schemes = split("sp-scaled sp-explicit sp-drag sp-implicit dp-scaled dp-explicit dp-drag dp-implicit " \
                  "paper-scaled paper-explicit paper-drag paper-implicit", scheme_name, " ")
}

FNR == 1 {
  ++file
  split("", at)
  for (i = 1; i <= NF; ++i) at[$i] = i
  next
}

file == 1 {
  ++runs
  problem_of[runs] = $at["problem"]; scheme_of[runs] = $at["scheme"]
  error_of[runs] = $at["error_l1"] + 0; seconds_of[runs] = $at["seconds"] + 0
  if (!($at["problem"] in known)) { known[$at["problem"]] = 1; problem_name[++problems] = $at["problem"] }
  # awk reads "nan" as 0 or not a number, and neither is an error a run can have.
  if ($at["error_l1"] !~ /^[0-9.]+(e[-+]?[0-9]+)?$/ || !(error_of[runs] > 0) || !(seconds_of[runs] > 0)) {
    print "WRONG: " $at["problem"] ", " $at["scheme"] ", size " $at["size"] ": error " $at["error_l1"] " in " $at["seconds"] " s"
    wrong = 1
  }
}

file == 2 {
  omitted_problem[++omitted] = $at["problem"]
  is_omitted[$at["problem"], $at["scheme"]] = 1
  omitted_scheme[omitted] = $at["scheme"]
  omitted_seconds[omitted] = $at["seconds"] + 0
  omitted_text[omitted] = $at["size"] " m" ($at["scheme"] ~ /^sp/ ? "" : " / " $at["points_per_element"]) \
    ($at["tolerance"] == "" || $at["tolerance"] == "1e-3" ? "" : ", tolerance " $at["tolerance"]) " " $at["seconds"] + 0 " s"
}

END {
  if (form == "markdown") for (p = 1; p <= problems; ++p) problem_section(problem_name[p])
  else check()
  exit wrong
}
