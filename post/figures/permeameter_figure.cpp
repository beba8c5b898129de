#include "figures/permeameter_figure.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/closest_name.hpp"
#include "common/errors.hpp"
#include "figures/run_curves.hpp"
#include "files/number_text.hpp"
#include "values/refusal.hpp"

namespace suffuse {
namespace {

constexpr double hour = 3600.0;
const std::vector<std::string> measured_columns{"fines_lost", "conductance"};

/// Each line has its own dashes, because colours may be lost in print.
Curve line_of(const std::string& label, std::size_t run) {
  constexpr std::array<Dash, 5> dashes{Dash::solid, Dash::dashed, Dash::dash_dot, Dash::dotted,
                                       Dash::dash_dot_dot};
  Curve line;
  line.label = label;
  line.dash = dashes.at(run % dashes.size());
  line.color = curve_style(run).color;
  return line;
}

Curve lost_of(const ResultsReader& run, Curve curve) {
  const Table ledger = run.ledger();
  require_curve(run, ledger, "ledger.csv");
  // A stage may start with fines in the liquid.
  const double fines = ledger.column("erodible").front() + ledger.column("fines").front();
  if (!(fines > 0.0)) {
    throw FileError(
        run.folder() + ": has no fines at the start that could be lost; expected " +
        missing_key("soil.NAME.erosion", "erosion = { law = \"constant\", rate = 1e-3 }"));
  }
  for (std::size_t row = 0; row < ledger.rows(); ++row) {
    const double lost = ledger.column("fines_out")[row] - ledger.column("fines_in")[row];
    curve.x.push_back(ledger.column("t")[row] / hour);
    curve.y.push_back(100.0 * lost / fines);
  }
  return curve;
}

/// Conductance of a run. Empty where gravity acts, because pressures then differ without a flow,
/// and where nothing flows.
Curve conductance_of(const ResultsReader& run, Curve curve) {
  if (std::ranges::any_of(run.scene().scene.gravity, [](double g) { return g != 0.0; })) return {};
  const Table history = run.history();
  double start = 0.0;
  for (std::size_t row = 0; row < history.rows(); ++row) {
    const double pressure =
        history.column("pressure_max")[row] - history.column("pressure_min")[row];
    if (!(pressure > 0.0)) continue;
    const double conductance = history.column("flux_out")[row] / pressure;
    if (start <= 0.0) start = conductance;
    if (start <= 0.0) continue;
    curve.x.push_back(history.column("t")[row] / hour);
    curve.y.push_back(conductance / start);
  }
  return curve;
}

}  // namespace

MeasuredPoints read_measured_points(const std::string& path) {
  MeasuredPoints measured = read_measured(path);
  if (measured.runs.empty()) refuse_measured(path, "no row", "at least one");
  const Table& first = measured.runs.front().table;
  if (!first.has("hours")) refuse_measured(path, "no column \"hours\"", "times in hours");
  if (std::ranges::none_of(measured_columns, [&](const auto& name) { return first.has(name); })) {
    refuse_measured(path, "no column of values", quoted_list(measured_columns));
  }
  return measured;
}

std::vector<Chart> fines_lost_charts(const std::vector<ResultsReader>& runs,
                                     const MeasuredPoints& measured) {
  const std::vector<std::string> labels = run_labels(runs);
  Chart lost{"Fines that have left", "time (h)", "per cent of the fines at the start", {}};
  Chart conductance{
      "Discharge over difference of pressures", "time (h)", "over that at the start (-)", {}};
  for (std::size_t r = 0; r < runs.size(); ++r) {
    lost.curves.push_back(lost_of(runs[r], line_of(labels[r], r)));
    const Curve curve = conductance_of(runs[r], line_of(labels[r], r));
    if (curve.x.size() > 1) conductance.curves.push_back(curve);
  }
  const bool both = !conductance.curves.empty();
  add_measured(measured, "hours", "fines_lost", labels, lost);
  add_measured(measured, "hours", "conductance", labels, conductance);
  lost.extra_y = {0.0};
  conductance.extra_y = {0.0};
  return both ? std::vector{lost, conductance} : std::vector{lost};
}

}  // namespace suffuse
