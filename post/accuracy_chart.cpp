#include "accuracy_chart.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "case/closest_name.hpp"
#include "case/errors.hpp"
#include "results/number_text.hpp"
#include "text_table.hpp"

namespace suffuse {
namespace {

const std::string command = "suffuse-post accuracy";

struct Way {
  const char* name;
  const char* label;
  Marker marker;
  Dash dash;
  Color color;
};

/// Told apart by marker and dash where there are no colours.
constexpr std::array<Way, 4> ways{
    {{"scaled", "explicit, mass scaling 10 000", Marker::diamond, Dash::dotted, {0.84, 0.37, 0.0}},
     {"explicit", "explicit", Marker::square, Dash::dashed, {0.0, 0.0, 0.0}},
     {"drag",
      "explicit, drag stepped implicitly",
      Marker::target,
      Dash::dash_dot,
      {0.0, 0.55, 0.4}},
     {"implicit", "implicit", Marker::circle, Dash::solid, {0.0, 0.4, 0.75}}}};

struct Formulations {
  const char* name;
  const char* more;  ///< in labels
  bool single;
};

constexpr std::array<Formulations, 3> formulations{
    {{"sp", "", true}, {"dp", "", false}, {"paper", ", paper's mode", false}}};

std::vector<std::string> schemes() {
  std::vector<std::string> names;
  for (const auto& f : formulations) {
    for (const auto& way : ways) names.push_back(std::string(f.name) + "-" + way.name);
  }
  return names;
}

InputError wrong(const std::string& where, const std::string& key, const std::string& found,
                 const std::string& expected, const std::string& suggestion = {}) {
  return InputError(std::vector{InputProblem{where, key, found, expected, suggestion}});
}

double positive(const std::string& where, const std::string& key, const std::string& text) {
  const auto value = parse_number(text);
  if (!value || !std::isfinite(*value) || !(*value > 0.0)) {
    throw wrong(where, key, '"' + text + '"', "a positive number");
  }
  return *value;
}

std::string quantity_words(const std::string& quantity) {
  if (quantity == "concentration") return "concentration of fluidised grains";
  if (quantity.starts_with("mean_darcy_flux")) return "mean Darcy flux";
  return quantity;
}

/// A paler shade, for runs that others beat.
Color pale(const Color& color) {
  Color mixed{};
  for (std::size_t k = 0; k < 3; ++k) mixed.at(k) = 1.0 - 0.35 * (1.0 - color.at(k));
  return mixed;
}

Curve markers(const std::vector<AccuracyRun>& runs, const Way& way, bool hollow) {
  Curve curve;
  curve.markers = true;
  curve.marker = way.marker;
  curve.dash = way.dash;
  curve.color = way.color;
  curve.hollow = hollow;
  for (const auto& run : runs) {
    curve.x.push_back(run.error);
    curve.y.push_back(run.seconds);
  }
  return curve;
}

void add_scheme(Chart& chart, const std::vector<AccuracyRun>& runs, const Way& way,
                const Formulations& formulation) {
  std::vector<AccuracyRun> own;
  const std::string name = std::string(formulation.name) + "-" + way.name;
  std::ranges::copy_if(runs, std::back_inserter(own),
                       [&](const AccuracyRun& run) { return run.scheme == name; });
  if (own.empty()) return;
  const bool hollow = !std::string(formulation.more).empty();
  Curve all = markers(own, way, hollow);
  all.color = pale(way.color);
  Curve best = markers(best_runs(own), way, hollow);
  best.joined = true;
  best.label = std::string(way.label) + formulation.more;
  // What others beat lies below every line.
  chart.curves.insert(chart.curves.begin(), all);
  chart.curves.push_back(best);
}

}  // namespace

std::vector<AccuracyRun> read_accuracy_runs(const std::string& path) {
  const TextTable table = read_text_table(path);
  const std::size_t problem = table.column("problem");
  const std::size_t scheme = table.column("scheme");
  const std::size_t quantity = table.column("quantity");
  const std::size_t error = table.column("error_l1");
  const std::size_t seconds = table.column("seconds");
  const auto known = schemes();
  std::vector<AccuracyRun> runs;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const auto& row = table.rows[i];
    const std::string where = table.place(i);
    AccuracyRun run{row[problem], row[scheme], row[quantity],
                    positive(where, "error_l1", row[error]),
                    positive(where, "seconds", row[seconds])};
    if (std::ranges::find(known, run.scheme) == known.end()) {
      throw wrong(where, "scheme", '"' + run.scheme + '"', quoted_list(known),
                  closest_name(run.scheme, known));
    }
    runs.push_back(run);
  }
  return runs;
}

std::vector<AccuracyRun> best_runs(std::vector<AccuracyRun> runs) {
  std::ranges::sort(runs, [](const AccuracyRun& a, const AccuracyRun& b) {
    return a.seconds != b.seconds ? a.seconds < b.seconds : a.error < b.error;
  });
  std::vector<AccuracyRun> best;
  for (const auto& run : runs) {
    if (best.empty() || run.error < best.back().error) best.push_back(run);
  }
  return best;
}

std::vector<Chart> accuracy_charts(const std::vector<AccuracyRun>& runs,
                                   const std::string& problem) {
  std::vector<AccuracyRun> own;
  std::vector<std::string> known;
  for (const auto& run : runs) {
    if (run.problem == problem) own.push_back(run);
    if (std::ranges::find(known, run.problem) == known.end()) known.push_back(run.problem);
  }
  if (own.empty()) {
    throw wrong(command, "--problem", '"' + problem + '"', quoted_list(known),
                closest_name(problem, known));
  }
  const std::string x_label =
      "relative error of the " + quantity_words(own.front().quantity) + ", L1 (-)";
  std::vector<Chart> charts(2);
  charts[0].title = problem + ", single-point";
  charts[1].title = problem + ", double-point";
  for (auto& chart : charts) {
    chart.x_label = x_label;
    chart.y_label = "wall time of the solver (s)";
    chart.logarithmic = true;
    for (const auto& run : own) {
      chart.x_too.push_back(run.error);
      chart.y_too.push_back(run.seconds);
    }
  }
  for (const auto& formulation : formulations) {
    for (const auto& way : ways)
      add_scheme(charts[formulation.single ? 0 : 1], own, way, formulation);
  }
  return charts;
}

}  // namespace suffuse
