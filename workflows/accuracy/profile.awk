# Concentration of fluidised grains in a column that clean water enters, along the paths of the liquid:
#
#     D c/Dt = (1 - c)(phi_e/n_L - c v p_drop/(K L)),  v = q/n_L,
#
# with the flux q that grows along the column as water expands on its way to lower pressures and whose mean
# is given. Parcels of liquid are followed by the midpoint rule. Nothing of the solver is in it.
#
#     awk -v law=constant -v rate=5e-3 -v flux=0.012 -v expansion=2.943e-4 -v times="8 16" -f profile.awk
#
# law: constant, logarithmic, first-order; n0, slope: porosity at the inlet and its gradient along the flow
# (constant law alone); start: of erosion, s; length, m; expansion: drop of the pressure over K; times in s,
# ascending. Prints t,x,y,concentration at `count` depths below y = length on the verticals `across`.

function fail(message) { print message > "/dev/stderr"; failed = 1; exit 1 }
function default(value, otherwise) { return value == "" ? otherwise : value }

# Eroded volume per volume and time at porosity n.
function phi(n) {
  if (n >= cap) return 0
  if (law == "constant") return rate
  if (law == "logarithmic") return -rate * log(n / cap)
  return rate * (cap - n)
}

# One step of Runge and Kutta's for a porosity that is the same everywhere.
function grown(n, h,    a, b, c, d, next_n) {
  a = phi(n); b = phi(n + h * a / 2); c = phi(n + h * b / 2); d = phi(n + h * c)
  next_n = n + h / 6 * (a + 2 * b + 2 * c + d)
  return next_n < cap ? next_n : cap
}

# Porosity at x beyond what it is at the inlet.
function beyond(x) { return slope * x }

# Flux over its mean at x: what expanded upstream, less the mean of that.
function relative_flux(x,    i) {
  i = int(x / length_ * cells)
  if (i >= cells) i = cells - 1
  return 1 + gain[i] + (gain[i + 1] - gain[i]) * (x / length_ * cells - i) - mean_gain
}

# Concentration at x by the parcels around it; the newest, at the inlet, is the last one.
function concentration(x,    low, high, middle) {
  low = oldest; high = newest
  if (x >= place[low]) return c_of[low]
  while (high - low > 1) {
    middle = int((low + high) / 2)
    if (place[middle] > x) low = middle
    else high = middle
  }
  return c_of[low] + (c_of[high] - c_of[low]) * (place[low] - x) / (place[low] - place[high])
}

function update_gain(    i, water, before) {
  gain[0] = 0; mean_gain = 0
  before = 1 - concentration(0)
  for (i = 1; i <= cells; ++i) {
    water = 1 - concentration(i * length_ / cells)
    gain[i] = gain[i - 1] + expansion / cells * (before + water) / 2
    mean_gain += (gain[i - 1] + gain[i]) / 2 / cells
    before = water
  }
}

# n: porosity at the inlet (less `beyond`) at the begin, the middle of the step.
function move(h, n, n_half,    p, v, x, c, q, local) {
  for (p = oldest; p <= newest; ++p) {
    local = n + beyond(place[p])
    q = flux * relative_flux(place[p])
    x = place[p] + h / 2 * q / local
    c = c_of[p] + h / 2 * (1 - c_of[p]) * (phi(local) - c_of[p] * q * expansion / length_) / local
    local = n_half + beyond(x)
    q = flux * relative_flux(x)
    place[p] += h * q / local
    c_of[p] += h * (1 - c) * (phi(local) - c * q * expansion / length_) / local
  }
  while (place[oldest + 1] > length_) ++oldest
  place[++newest] = 0
  c_of[newest] = 0
}

function report(t,    k, line, x) {
  for (line = 1; line <= lines; ++line)
    for (k = 0; k < count; ++k) {
      x = (k + 0.5) * length_ / count
      printf "%s,%s,%.12g,%.12g\n", t, at[line], length_ - x, concentration(x)
    }
}

BEGIN {
  if (law !~ /^(constant|logarithmic|first-order)$/) fail("law: got '" law "'")
  if (!(rate > 0) || !(flux > 0) || expansion == "" || times == "") fail("rate, flux, expansion and times are needed")
  n0 = default(n0, 0.3); slope = default(slope, 0); cap = default(cap, 0.4)
  start = default(start, 2); length_ = default(length_m, 1); count = default(count, 50)
  across = default(across, "0.31 0.77"); step = default(step, 0.01)
  if (slope != 0 && law != "constant") fail("slope: with the constant law alone")
  lines = split(across, at, " ")
  moments = split(times, moment, " ")
  cells = 100

  print "t,x,y,concentration"
  # What is there when erosion starts: clean, the first parcel beyond the outlet.
  oldest = 0; newest = 400
  for (p = 0; p <= newest; ++p) { place[p] = length_ * (1 - p / newest); c_of[p] = 0 }
  t = start; n = n0
  for (m = 1; m <= moments; ++m) {
    steps = int((moment[m] - t) / step + 1 - 1e-9)
    h = steps > 0 ? (moment[m] - t) / steps : 0
    for (s = 0; s < steps; ++s) {
      if (s % 5 == 0) update_gain()
      n_half = grown(n, h / 2)
      move(h, n, n_half)
      n = grown(n_half, h / 2)
    }
    t = moment[m]
    report(moment[m])
  }
}

END { if (failed) exit 1 }
