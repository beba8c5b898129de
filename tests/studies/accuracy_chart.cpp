#include "studies/accuracy_chart.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/closest_name.hpp"
#include "common/errors.hpp"
#include "files/number_text.hpp"
#include "studies/text_table.hpp"

namespace suffuse {
namespace {

const std::string command = "suffuse-studies accuracy";

/// How a scheme steps in time, and how its runs are drawn.
struct Stepping {
  const char* name;
  const char* label;
  Marker marker;
  Dash dash;
  Color color;
};

/// Markers and dashes distinguish schemes in print without colours.
constexpr std::array<Stepping, 4> steppings{
    {{"scaled", "explicit, mass scaling 10 000", Marker::diamond, Dash::dotted, {0.84, 0.37, 0.0}},
     {"explicit", "explicit", Marker::square, Dash::dashed, {0.0, 0.0, 0.0}},
     {"drag",
      "explicit, drag stepped implicitly",
      Marker::target,
      Dash::dash_dot,
      {0.0, 0.55, 0.4}},
     {"implicit", "implicit", Marker::circle, Dash::solid, {0.0, 0.4, 0.75}}}};

struct Formulation {
  const char* name;
  const char* label_end;
  bool single_point;
};

constexpr std::array<Formulation, 3> formulations{
    {{"sp", "", true}, {"dp", "", false}, {"paper", ", paper's mode", false}}};

std::vector<std::string> schemes() {
  std::vector<std::string> names;
  for (const auto& f : formulations) {
    for (const auto& stepping : steppings)
      names.push_back(std::string(f.name) + "-" + stepping.name);
  }
  return names;
}

InputError wrong(const std::string& where, const std::string& key, const std::string& found,
                 const std::string& expected, const std::string& suggestion = {}) {
  return InputError(InputProblem{where, key, found, expected, suggestion});
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

/// A paler shade, for runs that are not among the best.
Color pale(const Color& color) {
  Color mixed{};
  for (std::size_t k = 0; k < 3; ++k) mixed.at(k) = 1.0 - 0.35 * (1.0 - color.at(k));
  return mixed;
}

Curve markers(const std::vector<AccuracyRun>& runs, const Stepping& stepping, bool hollow) {
  Curve curve;
  curve.markers = true;
  curve.marker = stepping.marker;
  curve.dash = stepping.dash;
  curve.color = stepping.color;
  curve.hollow = hollow;
  for (const auto& run : runs) {
    curve.x.push_back(run.error);
    curve.y.push_back(run.seconds);
  }
  return curve;
}

void add_scheme(Chart& chart, const std::vector<AccuracyRun>& runs, const Stepping& stepping,
                const Formulation& formulation) {
  std::vector<AccuracyRun> own;
  const std::string name = std::string(formulation.name) + "-" + stepping.name;
  std::ranges::copy_if(runs, std::back_inserter(own),
                       [&](const AccuracyRun& run) { return run.scheme == name; });
  if (own.empty()) return;
  const bool hollow = !std::string(formulation.label_end).empty();
  Curve all = markers(own, stepping, hollow);
  all.color = pale(stepping.color);
  Curve best = markers(best_runs(own), stepping, hollow);
  best.joined = true;
  best.label = std::string(stepping.label) + formulation.label_end;
  // This line lies below the lines of all schemes.
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
    chart.logarithmic_x = true;
    chart.logarithmic_y = true;
    for (const auto& run : own) {
      chart.extra_x.push_back(run.error);
      chart.extra_y.push_back(run.seconds);
    }
  }
  for (const auto& formulation : formulations) {
    for (const auto& stepping : steppings)
      add_scheme(charts[formulation.single_point ? 0 : 1], own, stepping, formulation);
  }
  return charts;
}

}  // namespace suffuse
