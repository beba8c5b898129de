#include "figures/axes.hpp"

#include <algorithm>
#include <cmath>

#include "common/errors.hpp"
#include "drawing/ticks.hpp"
#include "files/number_text.hpp"
#include "tables/table_output.hpp"

namespace suffuse {

std::array<double, 2> parse_range(const std::string& text, const std::string& command,
                                  const std::string& option) {
  const auto between = text.find_first_of(":,");
  if (between != std::string::npos) {
    const auto low = parse_number(text.substr(0, between));
    const auto high = parse_number(text.substr(between + 1));
    if (low && high && std::isfinite(*low) && std::isfinite(*high) && !is_one_value(*low, *high)) {
      return {*low, *high};
    }
  }
  throw InputError(InputProblem{command, option, '"' + text + '"',
                                "LO:HI with LO below HI by more than round-off"});
}

namespace {

/// The unit of choice; without one s for a range of choice, otherwise one that fits the curves.
TimeUnit unit_of_times(const AxisOptions& options, const std::string& command, const Chart& chart) {
  if (!options.time_unit.empty()) return parse_time_unit(options.time_unit, command);
  if (!options.x_range.empty()) return {};
  double end = 0.0;
  for (const Curve& curve : chart.curves) {
    for (const double t : curve.x) end = std::max(end, t);
  }
  return fitting_time_unit(end);
}

}  // namespace

void set_axes(const AxisOptions& options, const std::string& command, Chart& chart) {
  if (chart.x_label == seconds_label) {
    const TimeUnit unit = unit_of_times(options, command, chart);
    const auto convert = [&](std::vector<double>& times) {
      for (double& t : times) t /= unit.seconds;
    };
    for (Curve& curve : chart.curves) convert(curve.x);
    convert(chart.extra_x);
    chart.x_label = "time (" + unit.name + ")";
  }
  chart.logarithmic_x = chart.logarithmic_x || options.log_x;
  chart.logarithmic_y = chart.logarithmic_y || options.log_y;
  const auto set = [&](const std::string& text, const std::string& option, bool logarithmic,
                       std::optional<std::array<double, 2>>& range) {
    if (text.empty()) return;
    range = parse_range(text, command, option);
    if (logarithmic && !((*range)[0] > 0.0)) {
      throw InputError(InputProblem{command, option, '"' + text + '"',
                                    "positive numbers on a logarithmic axis"});
    }
  };
  set(options.x_range, "--x-range", chart.logarithmic_x, chart.x_range);
  set(options.y_range, "--y-range", chart.logarithmic_y, chart.y_range);
}

}  // namespace suffuse
