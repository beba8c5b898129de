#include "driver/row_checks.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "case/errors.hpp"

namespace suffuse {
namespace {

void check_finite(const HistoryRow& row) {
  for (const auto& [name, member, unit] : history_columns) {
    if (std::isfinite(row.*member)) continue;
    std::ostringstream message;
    message << name << " is no longer a number at t = " << row.t << " s";
    throw NumericalError(message.str());
  }
}

}  // namespace

std::vector<std::string> RowChecks::check(const HistoryRow& row) {
  check_finite(row);
  std::vector<std::string> warnings = {check_compression(row), check_mass_scaling(row.speed_max),
                                       check_momentum(row.speed_max)};
  std::erase(warnings, "");
  return warnings;
}

/// The equation of state holds for small changes of volume only.
std::string RowChecks::check_compression(const HistoryRow& row) {
  constexpr double small = 0.1;
  const double modulus = scene_.liquid.bulk_modulus;
  // A flow that becomes unstable shows first in how pressures of points scatter about those of the
  // nodes.
  const double pressure =
      std::max({std::abs(row.pressure_min), std::abs(row.pressure_max), row.pressure_scatter});
  std::ostringstream message;
  message << "pressures reach " << pressure << " Pa at t = " << row.t << " s, "
          << pressure / modulus << " times the water's bulk modulus";
  if (pressure >= modulus) {
    throw NumericalError(message.str() +
                         ": water cannot be compressed like that; look at the boundary conditions");
  }
  if (pressure < small * modulus || compression_warned_) return "";
  compression_warned_ = true;
  return message.str() + ": the liquid is no longer weakly compressible";
}

/// Scaled masses slow the pressure wave, which must stay ten times faster than the flow:
/// S <= (0.1 c / v)^2.
std::string RowChecks::check_mass_scaling(double speed) {
  const double scaling = scene_.time.mass_scaling;
  const double wave = std::sqrt(scene_.liquid.bulk_modulus / scene_.liquid.density);
  if (scaling_warned_ || scaling <= 1.0 || speed * std::sqrt(scaling) <= 0.1 * wave) return "";
  scaling_warned_ = true;
  std::ostringstream message;
  message << "mass_scaling = " << scaling << " slows the pressure wave to "
          << wave / std::sqrt(scaling) << " m/s, less than ten times the flow's " << speed
          << " m/s: pressures are not to be trusted";
  return message.str();
}

/// The pressure is convected and the momentum is not. Waves between an inlet and an outlet then
/// grow by 1 + v / c with every way back, unless drag damps them by as much.
std::string RowChecks::check_momentum(double speed) {
  if (momentum_warned_ || !(speed > speed_that_drag_follows_)) return "";
  momentum_warned_ = true;
  std::ostringstream message;
  message << "the liquid reaches " << speed << " m/s; above " << speed_that_drag_follows_
          << " m/s it passes the model before drag brings it to its speed, and the momentum that "
             "it carries along is not in the equations: pressures and fluxes are not to be "
             "trusted";
  return message.str();
}

}  // namespace suffuse
