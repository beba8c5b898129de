#include "boundary_figures.hpp"

#include <algorithm>
#include <cstdio>

#include "case/errors.hpp"
#include "results/number_text.hpp"
#include "run_curves.hpp"
#include "specimen.hpp"

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
Curve curve_of(const RunBoundary& boundary, std::size_t number, std::size_t count,
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

std::string right_aligned(const std::string& text) {
  constexpr std::size_t width = 14;
  return std::string(width - std::min(width, text.size()), ' ') + text;
}

std::string right_aligned(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return right_aligned(std::string(text));
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
    discharge.curves.push_back(curve_of(boundaries[b], b, count, "discharge"));
    if (lost_fines(boundaries[b])) {
      fines.curves.push_back(curve_of(boundaries[b], b, count, "fines_out"));
    }
  }
  if (discharge.curves.empty()) {
    throw FileError(runs.front().folder() + ": its scene has no boundary that liquid crosses");
  }
  std::vector<Chart> charts{discharge};
  if (!fines.curves.empty()) charts.push_back(fines);
  return charts;
}

std::string boundaries_text(const ResultsReader& results) {
  constexpr std::array<const char*, 7> columns{"water_in",  "water_out",  "fines_in", "fines_out",
                                               "liquid_in", "liquid_out", "discharge"};
  const std::vector<NamedTable> boundaries = results.boundaries();
  if (boundaries.empty()) {
    throw FileError(results.folder() + ": boundaries.csv has no rows");
  }
  std::size_t width = 3;
  for (const NamedTable& b : boundaries) width = std::max(width, b.name.size());
  const auto line = [&](const std::string& name, const auto& cells) {
    std::string text = name + std::string(width - name.size(), ' ');
    for (const auto& value : cells) text += right_aligned(value);
    return text + "\n";
  };
  const bool flat = results.dimension() == 2;
  std::string text =
      results.folder() + ": " + results.status() +
      ", since the start until t = " + number_text(boundaries.front().table.column("t").back()) +
      " s" + (flat ? ", per metre of thickness\n" : "\n") +
      line("", std::array{"water in", "water out", "fines in", "fines out", "liquid in",
                          "liquid out", "discharge"}) +
      line("", std::array{"kg", "kg", "kg", "kg", "m3", "m3", "m3/s"});
  std::array<double, columns.size()> sum{};
  for (const NamedTable& b : boundaries) {
    std::array<double, columns.size()> last{};
    for (std::size_t k = 0; k < columns.size(); ++k) {
      last.at(k) = b.table.column(columns.at(k)).back();
      sum.at(k) += last.at(k);
    }
    text += line(b.name, last);
  }
  return text + line("all", sum);
}

}  // namespace suffuse
