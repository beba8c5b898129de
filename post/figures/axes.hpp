#pragma once

/// The user's options for the axes of charts.

#include <string>

#include "drawing/chart.hpp"
#include "figures/figure_options.hpp"

namespace suffuse {

/// The label of an axis of times in seconds.
inline const std::string seconds_label = "time (s)";

/// Applies the options to a chart. Times get the unit that fits their length, or that of the
/// options; with a range of the x-axis but no unit they stay in s. Throws InputError, naming
/// `command`.
void set_axes(const AxisOptions& options, const std::string& command, Chart& chart);

/// Two numbers, `a:b` or `a,b` with a below b by more than round-off. Throws InputError, naming
/// `command` and `option`.
std::array<double, 2> parse_range(const std::string& text, const std::string& command,
                                  const std::string& option);

}  // namespace suffuse
