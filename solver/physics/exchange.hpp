#pragma once

/// Exchange of fines between the solid and the liquid at one place, over a step: erosion by a law
/// and its drive, and deposition, phi_d = lambda_d |q| c. Erosion increases porosity, deposition
/// reduces it, and deposits can erode again.

#include <cmath>
#include <cstdint>
#include <limits>

#include "physics/conductivity/conductivity_law.hpp"
#include "physics/erosion/erosion_law.hpp"
#include "physics/viscosity/viscosity_law.hpp"

namespace suffuse {

/// Deposition of fines in a soil (Iwasaki 1937; with room, Herzig and others 1970).
struct DepositionModel {
  double coefficient = 0.0;     ///< lambda_d, 1/m
  double porosity_min = unset;  ///< n_min at which no room is left; unset: no limit
  double flux_max = std::numeric_limits<double>::infinity();  ///< deposits below this |q|, m/s

  [[nodiscard]] bool deposits() const { return coefficient > 0.0; }
  [[nodiscard]] bool has_room_limit() const { return !std::isnan(porosity_min); }
  /// Whether fines can be deposited at this porosity.
  [[nodiscard]] bool has_room_at(double porosity) const {
    return !has_room_limit() || porosity > porosity_min;
  }
  /// Factor on `coefficient`: (n - n_min) / (n_0 - n_min), or 1 without a limit.
  [[nodiscard]] double room(double initial_porosity, double porosity) const {
    return has_room_limit() ? (porosity - porosity_min) / (initial_porosity - porosity_min) : 1.0;
  }
};

/// Laws and parameters of the exchange in one soil.
struct ExchangeModel {
  ErosionModel erosion;
  DepositionModel deposition;
  ConductivityModel conductivity;
  bool ergun = false;              ///< drag has also a term in the square of the flux
  double water_density = unset;    ///< rho_w, kg/m3
  double water_viscosity = unset;  ///< mu_0, Pa s
  ViscosityModel viscosity;

  /// Whether the soil can exchange fines.
  [[nodiscard]] bool exchanges() const { return erodes(erosion) || deposition.deposits(); }
  /// Whether the rate depends on the flow.
  [[nodiscard]] bool depends_on_flux() const {
    return suffuse::depends_on_flux(erosion) || deposition.deposits();
  }
  /// Whether the rate depends on the fines in the liquid.
  [[nodiscard]] bool depends_on_concentration() const {
    return suffuse::depends_on_concentration(erosion) || deposition.deposits() ||
           (drive_depends_on_conductivity() && viscosity.depends_on_concentration());
  }
  [[nodiscard]] bool drive_depends_on_conductivity() const {
    return erodes(erosion) && erosion.drive->depends_on_conductivity;
  }
};

/// The solid at a place.
struct SoilPlace {
  double initial_porosity = unset;  ///< n_0
  double porosity = unset;          ///< n_L
  double conductivity_factor;       ///< k at this place over that of the model
};

/// Motion of the liquid at a place during a step.
enum class LiquidMotion : std::uint8_t {
  stays,     ///< at rest: exchange changes its concentration
  flows_on,  ///< is renewed at constant concentration
  passes     ///< as `flows_on`; points book deposition along their paths (double-point)
};

/// The liquid at a place over a step. Values that no law uses may stay unset.
struct PlaceFlow {
  double flux_start = unset;       ///< |q| at the start, m/s; linear in time until the end
  double flux_end = unset;         ///< m/s
  double deposition_flux = unset;  ///< |q| for deposition, m/s, if it is not that of erosion
  double resistance = 1.0;       ///< gradient along the flow over |q|/k in saturated soil (bedding)
  double concentration = unset;  ///< c at the start
  double saturation = 1.0;       ///< liquid per pore volume
  LiquidMotion motion = LiquidMotion::stays;

  [[nodiscard]] double flux() const { return 0.5 * (flux_start + flux_end); }
};

/// Volumes per volume of soil, or rates of these in 1/s.
struct Exchange {
  double eroded = 0.0;
  double deposited = 0.0;

  [[nodiscard]] double into_liquid() const { return eroded - deposited; }
};

/// D at |q| = `flux`, m/s, in the unit of the drive; 1 for erosion by time alone.
double drive_at(const ExchangeModel& model, const SoilPlace& place, const PlaceFlow& flow,
                double flux);

/// phi_e and phi_d at a time (s) and the flow at the start of the step, 1/s.
Exchange exchange_rate(const ExchangeModel& model, const SoilPlace& place, const PlaceFlow& flow,
                       double time);

/// Exchange between `from` and `to` (s). Exact, or to about 1e-13, if it does not depend on the
/// fines in the liquid; otherwise integrated to 1e-11. The drive varies linearly from its value at
/// the start to that at the end, found with the porosity there. The volume of fines stays positive,
/// and porosity does not exceed that of fully eroded soil.
Exchange exchange_over(const ExchangeModel& model, const SoilPlace& place, const PlaceFlow& flow,
                       double from, double to);

/// k of the soil filled with liquid of concentration `concentration`, m/s.
inline double conductivity_at(const ConductivityModel& soil, const ViscosityModel& liquid,
                              double initial_porosity, double porosity, double concentration) {
  const double k = soil.at(initial_porosity, porosity);
  return liquid.depends_on_concentration() ? k / liquid.ratio(concentration) : k;
}

}  // namespace suffuse
