#include "figures/boundary_figures.hpp"

#include <algorithm>

#include "common/errors.hpp"
#include "figures/run_curves.hpp"
#include "values/refusal.hpp"
#include "values/specimen.hpp"

namespace suffuse {
namespace {

/// A boundary of a run.
struct RunBoundary {
  std::size_t run;
  std::string label;
  Table table;
};

std::vector<RunBoundary> all_boundaries(const std::vector<ResultsReader>& runs) {
  const std::vector<std::string> labels = run_labels(runs);
  std::vector<RunBoundary> all;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    for (NamedTable& boundary : runs[r].boundaries()) {
      require_curve(runs[r], boundary.table, "boundaries.csv");
      const std::string label = runs.size() == 1 ? boundary.name : labels[r] + ": " + boundary.name;
      all.push_back({r, label, std::move(boundary.table)});
    }
  }
  return all;
}

/// Each boundary has a style of its own, the same in both charts. Dashes differ too, as curves of
/// two boundaries often lie on one another.
Curve boundary_curve(const RunBoundary& boundary, std::size_t number, std::size_t count,
                     const char* column) {
  constexpr std::array<Dash, 5> dashes{Dash::solid, Dash::dashed, Dash::dash_dot, Dash::dotted,
                                       Dash::dash_dot_dot};
  const RunStyle style = curve_style(number);
  Curve curve;
  curve.label = boundary.label;
  curve.x = boundary.table.column("t");
  curve.y = boundary.table.column(column);
  curve.markers = true;
  curve.joined = true;
  curve.marker = style.marker;
  curve.hollow = style.hollow;
  curve.color = style.color;
  curve.dash = dashes.at(number % dashes.size());
  return with_fewer_markers(std::move(curve), number, count);
}

bool lost_fines(const RunBoundary& boundary) {
  return std::ranges::any_of(boundary.table.column("fines_out"), [](double m) { return m > 0.0; });
}

}  // namespace

std::vector<Chart> boundary_charts(const std::vector<ResultsReader>& runs) {
  const std::vector<RunBoundary> boundaries = all_boundaries(runs);
  Chart discharge{"Liquid that leaves through each boundary",
                  "time (s)",
                  "discharge out of the model (m3/s per metre of thickness)",
                  {}};
  Chart fines{
      "Grains that left through each boundary", "time (s)", "mass (kg per metre of thickness)", {}};
  for (std::size_t b = 0; b < boundaries.size(); ++b) {
    const std::size_t count = boundaries.size();
    discharge.curves.push_back(boundary_curve(boundaries[b], b, count, "discharge"));
    if (lost_fines(boundaries[b])) {
      fines.curves.push_back(boundary_curve(boundaries[b], b, count, "fines_out"));
    }
  }
  if (discharge.curves.empty()) {
    throw FileError(runs.front().folder() +
                    ": its scene has no boundary that liquid crosses; expected " +
                    missing_key("[[boundary]]", "on = \"top\" and head = 2.0"));
  }
  std::vector<Chart> charts{discharge};
  if (!fines.curves.empty()) charts.push_back(fines);
  return charts;
}

}  // namespace suffuse
