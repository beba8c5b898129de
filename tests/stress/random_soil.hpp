#pragma once

/// Soils at random, with laws of erosion and deposition whose rates suit a run, and liquid that
/// enters at random.

#include <string>

#include "stress/scenario.hpp"
#include "stress/stress_mesh.hpp"

namespace suffuse::stress {

/// Weight of water, N/m3.
inline constexpr double weight = 1000.0 * 9.81;

/// Scales of the flow of a run, for rates, thresholds and lengths of runs.
struct Scales {
  bool unsaturated = false;
  bool linear_drag = false;  ///< Darcy's drag only, next to faces that open and close
  bool uneven = false;       ///< the flux is far larger in places: deposits must be limited
  double porosity = 0.0;
  double conductivity = 0.0;  ///< m/s
  double gradient = 0.0;
  double end = 0.0;        ///< s
  double modulus = 0.0;    ///< Pa
  double inflow = 0.0;     ///< largest c of the inflow
  bool viscous = false;    ///< the liquid thickens with fines
  double locks_at = 0.62;  ///< c_m

  [[nodiscard]] double flux() const { return conductivity * gradient; }
  /// Volume that passes the inlet per area of it, m.
  [[nodiscard]] double passed(double duration) const { return flux() * duration; }
};

/// `key = value` of an inline table.
std::string entry(const std::string& key, double value);
/// `key = "value"` of an inline table.
std::string word(const std::string& key, const std::string& value);

/// A soil for `--set soil.NAME`: with erosion, deposition or both in a run of `end` s, and with a
/// retention where `scales` say that soil need not be saturated.
/// \param length  over which erosion averages the flux, which then drives it, m; 0: none
std::string random_soil(Random& random, const Scales& scales, double end, Scheme scheme,
                        double length = 0.0);

/// Values in time between `highest` and lower ones, negative if the flow reverses.
std::string flood(Random& random, double end, double highest, bool reverses);

/// Concentration of the inflow, an entry of a boundary's table.
std::string inflow_concentration(Random& random, const Scales& scales, double end);

/// Changes of the liquid itself.
Changes liquid_changes(const Scales& scales);

}  // namespace suffuse::stress
