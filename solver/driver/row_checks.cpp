#include "driver/row_checks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <utility>

#include "common/errors.hpp"

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

/// `value` rounded to two digits.
std::string rounded_value(double value) {
  std::ostringstream text;
  text.precision(2);
  text << value;
  return text.str();
}

}  // namespace

std::vector<std::string> RowChecks::check(const HistoryRow& row) {
  check_finite(row);
  const std::array<std::string, kinds> once = {check_compression(row),
                                               check_mass_scaling(row.speed_max),
                                               check_momentum(row.speed_max),
                                               check_fines_weight(row),
                                               check_packing(row),
                                               check_volume_defect(row),
                                               check_overshoot(row),
                                               check_creep(row)};
  std::vector<std::string> warnings;
  for (std::size_t k = 0; k < kinds; ++k) {
    if (once[k].empty() || is_said_[k]) continue;
    is_said_[k] = true;
    warnings.push_back(once[k]);
  }
  if (const std::string text = check_failure(row); !text.empty()) warnings.push_back(text);
  return warnings;
}

/// The equation of state is valid only for small changes of volume.
std::string RowChecks::check_compression(const HistoryRow& row) {
  constexpr double small = 0.1;
  const double modulus = scene_.liquid.bulk_modulus;
  // An instability appears first as scatter of point pressures about node pressures.
  const double pressure =
      std::max({std::abs(row.pressure_min), std::abs(row.pressure_max), row.pressure_scatter});
  std::ostringstream message;
  message << "pressures reach " << pressure << " Pa at t = " << row.t << " s, "
          << pressure / modulus << " times the water's bulk modulus";
  if (pressure >= modulus) {
    throw NumericalError(message.str() +
                         ": water cannot be compressed like that; look at the boundary conditions");
  }
  if (pressure < small * modulus) return "";
  return message.str() + ": the liquid is no longer weakly compressible";
}

/// Scaled masses slow the pressure wave, which must stay ten times faster than the flow:
/// S <= (0.1 c / v)^2.
std::string RowChecks::check_mass_scaling(double speed) {
  const double scaling = scene_.time.mass_scaling;
  const double wave = std::sqrt(scene_.liquid.bulk_modulus / scene_.liquid.density);
  if (scaling <= 1.0 || speed * std::sqrt(scaling) <= 0.1 * wave) return "";
  std::ostringstream message;
  message << "mass_scaling = " << scaling << " slows the pressure wave to "
          << wave / std::sqrt(scaling) << " m/s, less than ten times the flow's " << speed
          << " m/s: pressures are not to be trusted";
  return message.str();
}

/// The model convects pressure but not momentum. Waves between an inlet and an outlet then grow by
/// the factor 1 + v / c with every reflection, unless drag damps them as much.
std::string RowChecks::check_momentum(double speed) {
  if (!(speed > limits_.speed_that_drag_follows)) return "";
  std::ostringstream message;
  message << "the liquid reaches " << speed << " m/s; above " << limits_.speed_that_drag_follows
          << " m/s it passes the model before drag brings it to its speed, and the momentum that "
             "it carries along is not in the equations: pressures and fluxes are not to be "
             "trusted";
  return message.str();
}

/// Fluidised fines neither settle nor support each other in this model: their weight drives a flow,
/// which can erode more fines.
std::string RowChecks::check_fines_weight(const HistoryRow& row) {
  constexpr double most_of_it = 0.5;
  constexpr double noticed = 1e-3;  // concentration; the density changes by a per mille
  if (!(row.fines_weight_share > most_of_it)) return "";
  if (!(row.concentration_max > noticed)) return "";
  std::ostringstream message;
  message
      << "the weight of fluidised fines drives the flow more than the boundaries do: "
      << rounded_value(100.0 * row.fines_weight_share) << " % of its power at t = " << row.t
      << " s, with concentrations up to " << rounded_value(row.concentration_max)
      << ". That holds for fines that stay in the liquid; where they would settle, clog or stay "
         "in place, more is lost here than in the soil. Look at soil.NAME.erosion "
         "(critical_concentration, threshold, residual) and soil.NAME.deposition, or compute "
         "without gravity, with heads as pressures";
  return message.str();
}

/// Grains as dense as in a packing lock, and the liquid cannot flow.
std::string RowChecks::check_packing(const HistoryRow& row) {
  constexpr double packing = 0.62;  // the usual c_m of Krieger and Dougherty
  if (!(row.concentration_max > packing)) return "";
  std::ostringstream message;
  message << "the liquid holds " << rounded_value(row.concentration_max)
          << " of its volume in fines in " << row.concentration_max_at << " at t = " << row.t
          << " s: above about " << packing
          << " grains lock and such a liquid does not flow, so that what is computed there is not "
             "to be trusted. Look at soil.NAME.erosion (critical_concentration ends erosion "
             "before; drive \"time\" erodes where no water flows), at soil with little water, and "
             "at the concentrations that boundaries prescribe";
  return message.str();
}

/// In a mesh of equal elements the number of points per element varies as if random: among some
/// thousand elements one differs from the mean N by 5 sqrt(N).
std::string RowChecks::check_volume_defect(const HistoryRow& row) {
  constexpr double deviations = 5.0;
  const double points = scene_.points.liquid_per_element;
  const double expected = std::max(1.0, deviations / std::sqrt(points));
  if (!(row.volume_defect > expected)) return "";
  std::ostringstream message;
  message << "liquid points have " << rounded_value(1.0 + row.volume_defect)
          << " times the volume of the pores in " << row.volume_defect_at << " at t = " << row.t
          << " s: a volume_defect of " << rounded_value(row.volume_defect) << ", where up to "
          << rounded_value(expected) << " is usual with liquid_per_element = " << points
          << ". Points that come from large elements do not fit into small ones: make the elements "
             "more even, or take more points. Masses stay exact; concentrations there are rough";
  return message.str();
}

/// Obtuse angles and long second-order steps can cause pressures outside the range of the
/// boundaries. This is rare, so there is a warning only if it happened.
std::string RowChecks::check_overshoot(const HistoryRow& row) {
  constexpr double noticed = 0.01;  // of the range of pressures
  const bool second_order = scene_.time.stepping == TimeStepping::second_order;
  if (!limits_.obtuse_elements || row.pressure_overshoot < noticed) return "";
  if (*limits_.obtuse_elements == 0 && !second_order) return "";
  std::ostringstream message;
  message.precision(3);
  message << "pressures lie outside those of boundaries and start, by "
          << 100.0 * row.pressure_overshoot << " % of their range at t = " << row.t
          << " s (pressure_overshoot); volumes and masses balance all the same.";
  if (*limits_.obtuse_elements > 0) {
    message
        << " Obtuse angles can do so, above all where conductivities differ: "
        << *limits_.obtuse_elements
        << " elements have one; mesh.structure = \"free\", or \"regular\" for a column, makes few "
           "or none.";
  }
  if (second_order) {
    message << " Long steps of second order can do so: time.stepping = \"monotone\", or a shorter "
               "time.step.";
  }
  return message.str();
}

/// Soil that loses strength slowly comes to a new equilibrium with each small motion. Whether and
/// when no equilibrium is found depends on mesh and steps.
std::string RowChecks::check_creep(const HistoryRow& row) {
  if (row.has_failed || !(row.displacement_max > limits_.watched_motion)) {
    return "";
  }
  std::ostringstream message;
  message << "the soil has moved by " << rounded_value(row.displacement_max)
          << " m in equilibrium by t = " << row.t
          << " s, more than 1 % of its height: it may slide slowly, and a moment at which it fails "
             "depends on the mesh; --strength-reduction --state finds its factor of safety";
  return message.str();
}

std::string RowChecks::check_failure(const HistoryRow& row) {
  std::ostringstream message;
  const bool fell = std::exchange(falls_, row.has_inertia);
  if (row.failure_time != failure_warned_) {
    failure_warned_ = row.failure_time;
    message << "the soil has lost its equilibrium at t = " << row.failure_time
            << " s; from there on it moves with its inertia, until it has come to rest";
    if (!falls_) message << ", by t = " << row.t << " s";
  } else if (fell && !falls_) {
    message << "the soil has come to rest by t = " << row.t << " s";
  }
  return message.str();
}

}  // namespace suffuse
