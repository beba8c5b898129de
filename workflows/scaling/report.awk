# From the lines of measure.sh to the tables of the report (Markdown):
#     awk -F, -f report.awk FILE.csv...
# Points are solid points in single-point runs, liquid points in double-point ones.

function points_of(i) { return liquid[i] > 0 ? liquid[i] : solid[i] }

# The exponent b of cost = a points^b, by least squares, over runs of one mode from 1e4 points on.
function exponent(mode, cost,    i, n, x, y, sx, sy, sxx, sxy) {
  for (i = 1; i <= runs; ++i) {
    if (modes[i] != mode || threads[i] != 1 || points_of(i) < 0.9e4 || !(cost[i] > 0)) continue
    x = log(points_of(i)); y = log(cost[i] / steps[i])
    ++n; sx += x; sy += y; sxx += x * x; sxy += x * y
  }
  return n < 2 ? "-" : sprintf("%.2f", (n * sxy - sx * sy) / (n * sxx - sx * sx))
}

function run_of(mode, size, thread,    key) { key = mode SUBSEP size SUBSEP thread; return key in index_of ? index_of[key] : 0 }

function power(size,    p) { p = int(log(size) / log(10) + 0.5); return sprintf("10<sup>%d</sup>", p) }

function header(first, last,    s, text, rule) {
  text = "| " first " |"; rule = "|---|"
  for (s = 1; s <= sizes; ++s) { text = text " " power(size_at[s]) " |"; rule = rule "---:|" }
  if (last != "") { text = text " " last " |"; rule = rule "---:|" }
  print text; print rule
}

# What a table says of run i, "" if nothing; two is the same run on two threads, 0: none.
function cell(what, i, two) {
  if (what == "all") return 1e9 * passes[i] / (steps[i] * points_of(i))
  if (what == "flow") return 1e9 * flow[i] / (steps[i] * points_of(i))
  if (what == "memory") return memory[i] / points_of(i)
  return two ? (passes[i] / steps[i]) / (passes[two] / steps[two]) : ""
}

# A row per mode, a column per size; costs get their exponent.
function table(form, what,    m, s, i, value, line, costs) {
  costs = what == "all" || what == "flow"
  header("mode", costs ? "exponent" : "")
  for (m = 1; m <= mode_count; ++m) {
    line = "| " mode_at[m] " |"
    for (s = 1; s <= sizes; ++s) {
      i = run_of(mode_at[m], size_at[s], 1)
      value = i ? cell(what, i, run_of(mode_at[m], size_at[s], 2)) : ""
      line = line (value == "" ? " |" : sprintf(" " form " |", value))
    }
    if (what == "all") line = line " " exponent(mode_at[m], passes) " |"
    if (what == "flow") line = line " " exponent(mode_at[m], flow) " |"
    print line
  }
}

FNR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i; next }

{
  ++runs
  modes[runs] = $at["mode"]; threads[runs] = $at["threads"]; elements[runs] = $at["elements"]
  solid[runs] = $at["solid_points"]; liquid[runs] = $at["liquid_points"]; steps[runs] = $at["steps"]
  memory[runs] = $at["memory"]; bytes[runs] = $at["case_bytes"]
  mesher[runs] = $at["mesher"]; ledger[runs] = $at["ledger"]; picture[runs] = $at["picture"]
  solver[runs] = $at["solver"]; passes[runs] = $at["passes"]; flow[runs] = $at["flow"]
  movement[runs] = $at["movement"]; erosion[runs] = $at["erosion"]; other[runs] = $at["coefficients"]
  # Columns are rounded to squares: the power of ten names them.
  size = 10 ^ int(log(elements[runs]) / log(10) + 0.5)
  if (!(size in seen_size)) { seen_size[size] = 1; size_at[++sizes] = size }
  if (!(modes[runs] in seen_mode)) { seen_mode[modes[runs]] = 1; mode_at[++mode_count] = modes[runs] }
  index_of[modes[runs] SUBSEP size SUBSEP threads[runs]] = runs
}

END {
  for (i = 1; i <= sizes; ++i) for (j = i + 1; j <= sizes; ++j) if (size_at[j] < size_at[i]) { t = size_at[i]; size_at[i] = size_at[j]; size_at[j] = t }

  print "Nanoseconds per point and step of the flow, everything in the step loop, one thread; meshes of so many elements:\n"
  table("%.1f", "all")
  print "\nOf it, the flow (implicit: with its linear systems):\n"
  table("%.1f", "flow")
  print "\nHow many times faster two threads are (step loop):\n"
  table("%.2f", "threads")
  print "\nPeak memory of the solver, bytes per point:\n"
  table("%.0f", "memory")
  print "\nThe pipeline by stage, one thread, s of wall time:\n"
  print "| mode | elements | points | steps | mesher | solver | of it steps | ledger | picture | case, MB |"
  print "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|"
  for (m = 1; m <= mode_count; ++m) for (s = 1; s <= sizes; ++s) {
    i = run_of(mode_at[m], size_at[s], 1)
    if (i) printf "| %s | %d | %d | %d | %.2f | %.2f | %.2f | %.2f | %.2f | %.3g |\n", modes[i], elements[i], points_of(i), steps[i], mesher[i], solver[i], passes[i], ledger[i], picture[i], bytes[i] / 1e6
  }
}
