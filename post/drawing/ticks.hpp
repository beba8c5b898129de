#pragma once

/// Ticks of axes and colour bars: round numbers and their text.

#include <string>
#include <vector>

namespace suffuse {

/// Whether low and high are one value up to round-off: they differ by no more than 1e-9 of the
/// larger. An axis between such ends has no ticks, and VTK searches them for ever.
bool is_one_value(double low, double high);

/// 5 to 11 evenly spaced round numbers that enclose [low, high]. Where low and high are one value
/// they enclose an interval around it.
std::vector<double> round_ticks(double low, double high);

/// The label of a tick, six digits at most: 0.5, 3e-5.
std::string tick_text(double tick);

/// A number with at most `digits` digits, as written by hand: 0.5, 88681, 1.235e-5. Numbers below
/// 0.001 and from a million on have an exponent.
std::string digits_text(double value, int digits);

/// Ends and labelled ticks of a logarithmic axis.
struct LogarithmicTicks {
  double low = 0.0;
  double high = 0.0;
  std::vector<double> ticks;
};

/// The ends are 1, 2 or 5 times a power of ten and enclose [low, high], with low > 0. Ticks are at
/// all such numbers in between; on an axis longer than three decades, at powers of ten only.
LogarithmicTicks logarithmic_ticks(double low, double high);

/// The label of a tick of a logarithmic axis: 0.001, 500, 2e-4.
std::string logarithmic_tick_text(double tick);

}  // namespace suffuse
