#pragma once

/// Erosion laws: the rate at which fines leave the soil and porosity grows (D^S n_L/Dt = phi_e for
/// a rigid skeleton, Eq. 1 of the paper). Each law is one file of this folder;
/// docs/develop/contributing.md says how to add one.
///
///   phi_e = state(n_e - residual, c) . rate . <D - D_cr> . <1 - c/c_cr>,   <x> = max(x, 0)
///
/// The law gives `state`, a dimensionless number; D is the drive (physics/drive). As a function of
/// the scaled time S = integral of rate <D - D_cr> dt, erosion does not depend on the drive.

#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "physics/drive/drive_law.hpp"
#include "physics/local_state.hpp"

namespace suffuse {

/// An erosion law. Its functions are called only with 0 < porosity and 0 < erodible_fraction.
struct ErosionLaw {
  std::string_view word;         ///< value of `law` in a scene
  std::string_view equation;     ///< the state, for the scene reference
  std::string_view rate_symbol;  ///< symbol of the key `rate`
  std::string_view drive = {};   ///< the drive of this law; empty: the scene gives it
  bool depends_on_concentration = false;

  /// The state. Null: the law erodes nothing.
  double (*state)(const LocalState& state) = nullptr;
  /// Porosity after a scaled time; may exceed that of fully eroded soil. Null: no closed form,
  /// because the state depends on the concentration.
  double (*porosity_after)(const LocalState& state, double scaled_time) = nullptr;
  /// Exact porosity after a scaled time, for laws whose `porosity_after` is no closed form;
  /// otherwise null.
  double (*exact_porosity)(const LocalState& state, double scaled_time) = nullptr;
  /// Scaled time until all fines are eroded. Null: infinite.
  double (*exhaustion)(const LocalState& state) = nullptr;

  [[nodiscard]] bool erodes() const { return state != nullptr; }
};

/// n_e that does not erode under any drive: one number, or linear in |q| between pairs (m/s, n_e)
/// and constant beyond them.
struct ResidualFraction {
  std::vector<std::pair<double, double>> pairs;  ///< empty: all fines can erode

  [[nodiscard]] bool depends_on_flux() const { return pairs.size() > 1; }
  /// `flux`: |q|, m/s; may be unset if the residual does not depend on it.
  [[nodiscard]] double at(double flux) const;
};

/// The law of a soil and its parameters.
struct ErosionModel {
  const ErosionLaw* law = nullptr;  ///< null: erodes nothing
  double rate = 0.0;                ///< in the `rate_unit` of the drive
  double start = 0.0;               ///< t_0, s
  double porosity_max = 1.0;        ///< n_L,max
  const DriveLaw* drive = drive_laws().front();
  double threshold = 0.0;  ///< D_cr, in the drive's unit
  ResidualFraction residual = {};
  double critical_concentration = std::numeric_limits<double>::infinity();  ///< c_cr
  double length = 0.0;  ///< l over which |q| is averaged, m; 0: |q| of the place
};

/// All laws, in the order of physics/CMakeLists.txt and the scene reference.
std::span<const ErosionLaw* const> erosion_laws();
/// The law of soil that does not erode: the first law and the default.
const ErosionLaw* no_erosion();
/// The law with the name `word`. Throws std::invalid_argument if there is none.
const ErosionLaw* erosion_law(std::string_view word);

/// "constant law, 0.001 1/s" or "first-order law, shear-stress, 0.01 1/(Pa s)", for legends. `rate`
/// is given as text.
std::string law_text(const ErosionModel& model, const std::string& rate);

/// Whether the soil can erode at some time under some flow.
bool erodes(const ErosionModel& model);

/// Whether the soil can erode and its rate depends on the flow.
bool depends_on_flux(const ErosionModel& model);

/// Whether the soil can erode and its rate depends on the fines in the liquid.
bool depends_on_concentration(const ErosionModel& model);

/// Part of n_e = n_L,max - n_L that can erode at |q| in m/s; not below zero.
double erodible_fraction(const ErosionModel& model, double porosity, double flux);

/// rate <D - D_cr> at a value of D, 1/s.
double drive_rate(const ErosionModel& model, double drive);

/// S from `from` to `to` (s), counted from the start of erosion. D varies linearly from
/// `drive_from` to `drive_to` and may cross the threshold.
double scaled_time(const ErosionModel& model, double from, double to, double drive_from,
                   double drive_to);

/// Porosity a scaled time after `porosity`, by erosion alone and without an effect of the fines in
/// the liquid: exact, or to about 1e-13. Not above that of soil fully eroded at `flux`, m/s.
double porosity_after_scaled(const ErosionModel& model, double porosity, double scaled_time,
                             double flux);

/// phi_e at a time, 1/s, for a D that depends at most on |q|. `flux`, m/s, may be unset if D does
/// not depend on it. Zero before the start and after all fines are eroded.
double erosion_rate(const ErosionModel& model, double porosity, double time, double flux);

/// Porosity at time `to` of soil that had `porosity` at time `from`, by erosion alone, for a D that
/// depends at most on |q|. D varies linearly between its values at `flux_from` and `flux_to`, m/s.
/// The accuracy does not depend on the length of the interval.
double porosity_after(const ErosionModel& model, double porosity, double from, double to,
                      double flux_from, double flux_to);
/// Porosity at time `to` under a constant |q|: `flux`, m/s.
inline double porosity_after(const ErosionModel& model, double porosity, double from, double to,
                             double flux) {
  return porosity_after(model, porosity, from, to, flux, flux);
}

/// Porosity at time `time` from the law's exact solution; NaN if the law has none or depends on an
/// unset flux.
double exact_porosity(const ErosionModel& model, double initial_porosity, double time, double flux);

/// Whether `exact_porosity` is valid under any flow.
bool has_exact_porosity(const ErosionModel& model);

/// Time at which soil of this initial porosity has lost all its fines, s: the start if it has none;
/// infinity if that never happens or depends on the flow.
double exhaustion_time(const ErosionModel& model, double initial_porosity);

/// Times at which the erosion rate of soil of this initial porosity is not smooth, ascending, s:
/// start and exhaustion, if they exist.
std::vector<double> breakpoints(const ErosionModel& model, double initial_porosity);

}  // namespace suffuse
