#pragma once

/// Erosion laws: how fast fines leave the soil, and so how porosity grows where they are eroded in
/// place (D^S n_L/Dt = phi_e for a rigid skeleton, Eq. 1 of the paper). Each law is one file of
/// this folder; docs/contributing.md says how to add one.
///
///   phi_e = state(n_e - residual, c) . rate . <D - D_cr> . <1 - c/c_cr>,   <x> = max(x, 0)
///
/// The law gives `state`, a number without a unit; D is what drives erosion (physics/drive). In the
/// scaled time S = integral of rate <D - D_cr> dt erosion is the same whatever drives it.

#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "physics/drive/drive_law.hpp"
#include "physics/local_state.hpp"

namespace suffuse {

/// A law, as its file declares it. Its functions are called where something can erode:
/// 0 < porosity, 0 < erodible_fraction.
struct ErosionLaw {
  std::string_view word;         ///< what `law` is in a scene
  std::string_view equation;     ///< the state, for the scene reference
  std::string_view rate_symbol;  ///< of the key `rate`
  std::string_view drive = {};   ///< the one that the word stands for; empty: the scene says
  bool depends_on_concentration = false;

  /// The state. Null: the law erodes nothing.
  double (*state)(const LocalState& state) = nullptr;
  /// Porosity after a scaled time; may be above where nothing is left to erode. Null: no closed
  /// form, as the state depends on what is in the liquid.
  double (*porosity_after)(const LocalState& state, double scaled_time) = nullptr;
  /// Porosity after a scaled time, found another way where `porosity_after` is not a closed form;
  /// otherwise null.
  double (*exact_porosity)(const LocalState& state, double scaled_time) = nullptr;
  /// Scaled time until nothing is left to erode. Null: fines never run out.
  double (*exhaustion)(const LocalState& state) = nullptr;

  [[nodiscard]] bool erodes() const { return state != nullptr; }
};

/// n_e that stays whatever the drive: one number, or linear in |q| between pairs (m/s, n_e) and
/// constant beyond them.
struct ResidualFraction {
  std::vector<std::pair<double, double>> pairs;  ///< none: nothing stays

  [[nodiscard]] bool depends_on_flux() const { return pairs.size() > 1; }
  /// `flux`: |q|, m/s; may be unset where the residual does not depend on it.
  [[nodiscard]] double at(double flux) const;
};

/// One soil's law with its numbers.
struct ErosionModel {
  const ErosionLaw* law = nullptr;  ///< null: erodes nothing
  double rate = 0.0;                ///< in the unit of the drive
  double start = 0.0;               ///< t_0, s
  double porosity_max = 1.0;        ///< n_L,max
  const DriveLaw* drive = drive_laws().front();
  double threshold = 0.0;  ///< D_cr, in the drive's unit
  ResidualFraction residual = {};
  double critical_concentration = std::numeric_limits<double>::infinity();  ///< c_cr
};

/// Every law there is, in the order of the scene reference: the order in physics/CMakeLists.txt.
std::span<const ErosionLaw* const> erosion_laws();
/// The law of soil that does not erode, which a scene has by default: the first of the list.
const ErosionLaw* no_erosion();
/// The law that a scene calls `word`. Throws std::invalid_argument where there is none.
const ErosionLaw* erosion_law(std::string_view word);

/// "constant law, 0.001 1/s" or "first-order law, shear-stress, 0.01 1/(Pa s)": for legends. `rate`
/// as text.
std::string law_text(const ErosionModel& model, const std::string& rate);

/// The model erodes, at some time and under some flow.
bool erodes(const ErosionModel& model);

/// The model erodes, and how fast depends on the flow.
bool depends_on_flux(const ErosionModel& model);

/// The model erodes, and how fast depends on the fines in the liquid.
bool depends_on_concentration(const ErosionModel& model);

/// Part of n_e = n_L,max - n_L that can erode at |q| in m/s; not below zero.
double erodible_fraction(const ErosionModel& model, double porosity, double flux);

/// rate <D - D_cr> at a value of D, 1/s.
double drive_rate(const ErosionModel& model, double drive);

/// S from `from` to `to` (s), of which only what comes after the start of erosion counts; D goes
/// linearly from `drive_from` to `drive_to` and may cross the threshold.
double scaled_time(const ErosionModel& model, double from, double to, double drive_from,
                   double drive_to);

/// Porosity of soil that had `porosity`, a scaled time later, by erosion alone and with no fines in
/// the liquid that count: exact, or to about 1e-13. Never above what can erode at `flux`, m/s.
double porosity_after_scaled(const ErosionModel& model, double porosity, double scaled_time,
                             double flux);

/// phi_e at a time, 1/s, where D depends on |q| alone: `flux`, m/s, may be unset where it does not
/// depend on it. Zero before the start and once nothing is left to erode.
double erosion_rate(const ErosionModel& model, double porosity, double time, double flux);

/// Porosity at time `to` of soil that had `porosity` at time `from`, by erosion alone, where D
/// depends on |q| alone, which goes linearly from `flux_from` to `flux_to`, m/s. Split at the start
/// of erosion and at exhaustion, so the length of the interval costs no accuracy.
double porosity_after(const ErosionModel& model, double porosity, double from, double to,
                      double flux_from, double flux_to);
/// Porosity at time `to` under a constant |q|: `flux`, m/s.
inline double porosity_after(const ErosionModel& model, double porosity, double from, double to,
                             double flux) {
  return porosity_after(model, porosity, from, to, flux, flux);
}

/// Porosity at time `time` from the law's exact solution; not a number where the law has none, or
/// depends on a flux that is unset.
double exact_porosity(const ErosionModel& model, double initial_porosity, double time, double flux);

/// Whether `exact_porosity` holds under any flow.
bool has_exact_porosity(const ErosionModel& model);

/// When soil of this initial porosity has lost all its fines, s: the start where it has none;
/// infinity where they never run out, or at a time that depends on the flow.
double exhaustion_time(const ErosionModel& model, double initial_porosity);

/// Times at which the erosion rate of soil of this initial porosity is not smooth, ascending, s:
/// start and exhaustion, as far as they exist.
std::vector<double> breakpoints(const ErosionModel& model, double initial_porosity);

}  // namespace suffuse
