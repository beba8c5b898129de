#include "figures/sweep_figures.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "common/closest_name.hpp"
#include "common/errors.hpp"
#include "figures/axes.hpp"
#include "figures/sweep_axes.hpp"
#include "files/number_text.hpp"
#include "results/reader.hpp"
#include "tables/table_output.hpp"

namespace suffuse {
namespace {

constexpr double low_share = 0.1;
constexpr double high_share = 0.9;
constexpr std::size_t most_groups = 10;
/// Least number of runs in a group of sampled x: the 10 % quantile then depends on more than the
/// least value.
constexpr std::size_t least_runs_of_a_group = 5;
constexpr std::size_t least_groups = 4;
constexpr double logarithmic_range = 30.0;
constexpr int time_intervals = 200;

/// Light, middle and dark: they differ in grey too.
constexpr Color band_color{0.80, 0.87, 0.95};
constexpr Color run_color{0.45, 0.55, 0.65};
/// Colour of the curves of single runs: many lines in a darker colour would hide the band.
constexpr Color thin_color{0.62, 0.70, 0.78};
constexpr Color median_color{0.70, 0.20, 0.0};

std::string sweep_count_text(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " run" : " runs");
}

Curve line(const std::string& label, std::vector<double> x, std::vector<double> y) {
  Curve curve;
  curve.label = label;
  curve.x = std::move(x);
  curve.y = std::move(y);
  return curve;
}

Curve points(const std::string& label, std::vector<double> x, std::vector<double> y) {
  Curve curve = line(label, std::move(x), std::move(y));
  curve.markers = true;
  curve.hollow = true;
  curve.color = run_color;
  return curve;
}

/// Quantiles of values that share an x.
struct Quantiles {
  std::vector<double> x, low, median, high;

  void add(double at, std::vector<double> values) {
    std::ranges::sort(values);
    x.push_back(at);
    low.push_back(quantile(values, low_share));
    median.push_back(quantile(values, 0.5));
    high.push_back(quantile(values, high_share));
  }
  [[nodiscard]] Curve band() const {
    Curve curve = line("10 to 90 %", x, high);
    curve.low = low;
    curve.color = band_color;
    return curve;
  }
  [[nodiscard]] Curve middle(const std::string& label) const {
    Curve curve = line(label, x, median);
    curve.width = 3.0F;
    curve.color = median_color;
    return curve;
  }
};

/// The pairs in which both numbers are finite.
std::pair<std::vector<double>, std::vector<double>> finite_pairs(const std::vector<double>& x,
                                                                 const std::vector<double>& y) {
  std::pair<std::vector<double>, std::vector<double>> found;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) continue;
    found.first.push_back(x[i]);
    found.second.push_back(y[i]);
  }
  return found;
}

[[noreturn]] void refuse_without_numbers(const std::string& option, const std::string& column) {
  throw InputError(InputProblem{"suffuse-post sweep", option,
                                "no number in the column \"" + column + '"',
                                "a number of one run at least"});
}

std::vector<std::size_t> order_of(const std::vector<double>& x) {
  std::vector<std::size_t> order(x.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return x[i]; });
  return order;
}

std::vector<double> picked(const std::vector<double>& values,
                           const std::vector<std::size_t>& rows) {
  std::vector<double> found;
  found.reserve(rows.size());
  for (const std::size_t row : rows) found.push_back(values[row]);
  return found;
}

Chart over_key_chart(const std::vector<double>& x, const std::vector<double>& y) {
  Chart chart;
  const auto groups = groups_of(x);
  Quantiles quantiles;
  for (const auto& group : groups) {
    auto at = picked(x, group);
    quantiles.add(quantile(at, 0.5), picked(y, group));
  }
  if (!groups.empty()) chart.curves.push_back(quantiles.band());
  chart.curves.push_back(points(sweep_count_text(x.size()), x, y));
  if (!groups.empty()) {
    chart.curves.push_back(
        quantiles.middle("median of each of " + std::to_string(groups.size()) + " groups"));
  } else {
    const auto order = order_of(x);
    chart.curves.insert(chart.curves.begin(), line("", picked(x, order), picked(y, order)));
    chart.curves.front().color = run_color;
  }
  const auto [least, largest] = std::ranges::minmax(x);
  chart.logarithmic_x = least > 0.0 && largest > logarithmic_range * least;
  return chart;
}

/// A column of history.csv or ledger.csv, against time.
Curve in_time(const ResultsReader& run, const std::string& column) {
  const Table history = run.history();
  const Table ledger = run.ledger();
  for (const Table* table : {&history, &ledger}) {
    if (!table->has(column)) continue;
    Curve curve = line("", table->column("t"), table->column(column));
    if (curve.x.empty()) throw FileError(run.folder() + ": its tables have no rows yet");
    curve.width = 1.0F;
    curve.color = thin_color;
    return curve;
  }
  std::vector<std::string> known = history.names;
  known.insert(known.end(), ledger.names.begin(), ledger.names.end());
  throw InputError(InputProblem{"suffuse-post sweep", "--over-time", '"' + column + '"',
                                quoted_list(known), closest_column(column, known)});
}

/// The value at `x`, linear between the points of a curve, whose x ascend and enclose `x`.
double value_at(const Curve& curve, double x) {
  const auto above = std::ranges::lower_bound(curve.x, x);
  const auto at = static_cast<std::size_t>(above - curve.x.begin());
  if (above == curve.x.end()) return curve.y.back();
  if (at == 0 || *above == x) return curve.y[at];
  const double share = (x - curve.x[at - 1]) / (curve.x[at] - curve.x[at - 1]);
  return curve.y[at - 1] + share * (curve.y[at] - curve.y[at - 1]);
}

/// The times of the rows if they are the same in all runs; otherwise evenly spaced times up to the
/// earliest end of a run.
std::vector<double> common_times(const std::vector<Curve>& runs) {
  const auto same = [&](const Curve& run) { return run.x == runs.front().x; };
  if (std::ranges::all_of(runs, same)) return runs.front().x;
  double start = runs.front().x.front();
  double end = runs.front().x.back();
  for (const Curve& run : runs) {
    start = std::max(start, run.x.front());
    end = std::min(end, run.x.back());
  }
  std::vector<double> times;
  for (int k = 0; k <= time_intervals; ++k)
    times.push_back(start + (end - start) * k / time_intervals);
  return times;
}

}  // namespace

double quantile(const std::vector<double>& sorted, double share) {
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  if (below + 1 == sorted.size()) return sorted.back();
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[below + 1] - sorted[below]);
}

std::vector<std::vector<std::size_t>> groups_of(const std::vector<double>& x) {
  const auto order = order_of(x);
  const std::size_t different = std::set<double>(x.begin(), x.end()).size();
  std::vector<std::vector<std::size_t>> groups;
  if (2 * different <= x.size()) {
    for (const std::size_t row : order) {
      if (groups.empty() || x[groups.back().front()] != x[row]) groups.emplace_back();
      groups.back().push_back(row);
    }
    return groups;
  }
  const std::size_t count = std::min(most_groups, x.size() / least_runs_of_a_group);
  if (count < least_groups) return {};
  for (std::size_t g = 0; g < count; ++g) {
    groups.emplace_back(order.begin() + static_cast<std::ptrdiff_t>(g * x.size() / count),
                        order.begin() + static_cast<std::ptrdiff_t>((g + 1) * x.size() / count));
  }
  return groups;
}

std::vector<Chart> over_key_charts(const SweepTable& sweep, const std::string& x,
                                   const std::vector<std::string>& y, const Scene* scene) {
  std::vector<Chart> charts;
  for (const auto& column : y) {
    const auto [at, values] = finite_pairs(sweep.numbers(x, "--x"), sweep.numbers(column, "--y"));
    if (at.empty()) refuse_without_numbers("--y", column);
    Chart& chart = charts.emplace_back(over_key_chart(at, values));
    chart.title = "Runs of a sweep over a key";
    chart.x_label = axis_text(x, scene);
    chart.y_label = axis_text(column);
  }
  return charts;
}

std::vector<Chart> distribution_charts(const SweepTable& sweep, const std::vector<std::string>& y) {
  std::vector<Chart> charts;
  ChartTable table{{"share of runs"}, {"10 %"}, {"50 %"}, {"90 %"}};
  for (const auto& column : y) {
    const auto numbers = sweep.numbers(column, "--y");
    auto values = finite_pairs(numbers, numbers).first;
    if (values.empty()) refuse_without_numbers("--y", column);
    std::ranges::sort(values);
    std::vector<double> shares;
    for (std::size_t i = 0; i < values.size(); ++i) {
      shares.push_back(values.size() == 1 ? 50.0
                                          : 100.0 * static_cast<double>(i) /
                                                static_cast<double>(values.size() - 1));
    }
    std::vector<double> marks{low_share, 0.5, high_share};
    table.front().push_back(axis_text(column));
    for (std::size_t k = 0; k < marks.size(); ++k) {
      table[k + 1].push_back(short_text(quantile(values, marks[k])));
    }
    Curve marked = points("10, 50 and 90 %", {}, {});
    marked.color = median_color;
    marked.hollow = false;
    for (const double share : marks) {
      marked.x.push_back(quantile(values, share));
      marked.y.push_back(100.0 * share);
    }
    Chart& chart = charts.emplace_back();
    chart.title = "Distribution over the runs of a sweep";
    chart.x_label = axis_text(column);
    chart.y_label = "runs with less (%)";
    chart.curves = {line(sweep_count_text(values.size()), values, shares), marked};
  }
  charts.front().table = table;
  return charts;
}

std::vector<Chart> over_time_charts(const SweepTable& sweep,
                                    const std::vector<std::string>& columns) {
  std::vector<ResultsReader> readers;
  for (const auto& folder : sweep.results()) readers.emplace_back(folder);
  std::vector<Chart> charts;
  for (const auto& column : columns) {
    std::vector<Curve> runs;
    runs.reserve(readers.size());
    for (const auto& reader : readers) runs.push_back(in_time(reader, column));
    Quantiles quantiles;
    for (const double t : common_times(runs)) {
      std::vector<double> values;
      values.reserve(runs.size());
      for (const Curve& run : runs) values.push_back(value_at(run, t));
      quantiles.add(t, std::move(values));
    }
    runs.front().label = sweep_count_text(runs.size());
    Chart& chart = charts.emplace_back();
    chart.title = "Runs of a sweep in time";
    chart.x_label = seconds_label;
    chart.y_label = axis_text(column);
    chart.curves.push_back(quantiles.band());
    chart.curves.insert(chart.curves.end(), runs.begin(), runs.end());
    chart.curves.push_back(quantiles.middle("median"));
    set_axes({}, "suffuse-post sweep", chart);
  }
  return charts;
}

}  // namespace suffuse
