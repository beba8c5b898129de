#include "figures/gradation_figure.hpp"

#include <algorithm>
#include <array>

#include "common/errors.hpp"
#include "figures/run_curves.hpp"
#include "scene/grading_checks.hpp"
#include "values/refusal.hpp"

namespace suffuse {
namespace {

/// A soil with a gradation, and what it is called in the figure.
struct GradedSoil {
  std::string name;
  std::string run;
  Gradation gradation;
};

bool equal(const Gradation& a, const Gradation& b) {
  return std::ranges::equal(a.points(), b.points(),
                            [](const GradationPoint& p, const GradationPoint& q) {
                              return p.size == q.size && p.finer == q.finer;
                            });
}

/// Soils with a gradation; those of equal name and gradation are one. Where a name stands for
/// several gradations, the run is named too.
std::vector<GradedSoil> graded_soils(const std::vector<ResultsReader>& runs) {
  const std::vector<std::string> labels = run_labels(runs);
  std::vector<GradedSoil> soils;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    for (const Soil& soil : runs[r].scene().scene.soils) {
      const bool known = std::ranges::any_of(soils, [&](const GradedSoil& other) {
        return other.name == soil.region && equal(other.gradation, soil.gradation);
      });
      if (soil.gradation.empty() || known) continue;
      soils.push_back({soil.region, labels[r], soil.gradation});
    }
  }
  const std::vector<GradedSoil> all = soils;
  for (GradedSoil& soil : soils) {
    if (std::ranges::count(all, soil.name, &GradedSoil::name) > 1) {
      soil.name = soil.run + ": " + soil.name;
    }
  }
  return soils;
}

/// Dashes and markers differ, so that curves can be told apart without colours.
Curve grading_curve(const GradedSoil& soil, std::size_t number) {
  constexpr std::array<Dash, 5> dashes{Dash::solid, Dash::dashed, Dash::dash_dot, Dash::dotted,
                                       Dash::dash_dot_dot};
  const RunStyle style = curve_style(number);
  const auto fines = fines_content(soil.gradation);
  Curve curve;
  curve.label = soil.name;
  // Tolerance for round-off: F* is often at a point of the curve.
  constexpr double same = 1e-9;
  for (const GradationPoint& point : soil.gradation.points()) {
    if (fines && curve.marked.empty() && fines->size <= point.size * (1.0 + same)) {
      curve.marked = {curve.x.size()};
      if (fines->size < point.size * (1.0 - same)) {
        curve.x.push_back(fines->size);
        curve.y.push_back(fines->finer);
      }
    }
    curve.x.push_back(point.size);
    curve.y.push_back(point.finer);
  }
  if (fines) {
    curve.label += ": F* = " + percent_text(fines->finer) + " at " + three_digits(fines->size) +
                   " mm, H/F = " + three_digits(fines->ratio);
  }
  curve.markers = fines.has_value();
  curve.joined = true;
  curve.marker = style.marker;
  curve.hollow = style.hollow;
  curve.color = style.color;
  curve.dash = dashes.at(number % dashes.size());
  return curve;
}

ChartTable transposed(const ChartTable& table) {
  ChartTable result(table.front().size());
  for (const auto& row : table) {
    for (std::size_t i = 0; i < row.size(); ++i) result[i].push_back(row[i]);
  }
  return result;
}

/// A row for each check and a column for each soil, or the other way round if there are more soils
/// than checks.
ChartTable verdicts_of(const std::vector<GradedSoil>& soils) {
  ChartTable by_soil{{"internal stability"}};
  for (const GradingVerdict& verdict : check_grading(soils.front().gradation)) {
    by_soil.front().push_back(verdict.check);
  }
  for (const GradedSoil& soil : soils) {
    auto& row = by_soil.emplace_back(std::vector{soil.name});
    for (const GradingVerdict& verdict : check_grading(soil.gradation)) {
      row.push_back(stability_text(verdict));
    }
  }
  return by_soil.size() > by_soil.front().size() ? by_soil : transposed(by_soil);
}

}  // namespace

Chart gradation_chart(const std::vector<ResultsReader>& runs) {
  const std::vector<GradedSoil> soils = graded_soils(runs);
  if (soils.empty()) {
    throw FileError(
        runs.front().folder() + ": no soil of its scene has a gradation; expected " +
        missing_key("soil.NAME.gradation", "gradation = [[0.1, 0], [1.0, 60], [4.0, 100]]"));
  }
  Chart chart{"Gradation", "grain size d (mm)", "finer than d by mass, F (%)", {}};
  for (std::size_t i = 0; i < soils.size(); ++i) chart.curves.push_back(grading_curve(soils[i], i));
  chart.extra_y = {0.0, 100.0};
  chart.logarithmic_x = true;
  chart.table = verdicts_of(soils);
  return chart;
}

}  // namespace suffuse
