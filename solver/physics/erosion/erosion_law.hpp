#pragma once

/// Erosion laws: how fast fines leave the soil, and so how porosity grows where they are eroded in
/// place (D^S n_L/Dt = phi_e for a rigid skeleton, Eq. 1 of the paper). Each law is one file of
/// this folder; docs/contributing.md says how to add one.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "physics/local_state.hpp"

namespace suffuse {

struct ErosionLaw;

/// Numbers beside the rate that only some laws ask for. A law declares those that it uses.
struct ErosionParameters {
  double threshold = 0.0;  ///< of what drives erosion, in its unit; below it nothing erodes
};

/// One soil's law with its numbers.
struct ErosionModel {
  const ErosionLaw* law = nullptr;  ///< null: erodes nothing
  double rate = 0.0;                ///< in the unit of the law
  double start = 0.0;               ///< t_0, s
  double porosity_max = 1.0;        ///< n_L,max
  ErosionParameters parameters = {};
};

/// A number that a law asks the scene for, under `[soil.NAME.erosion]`. It has a default, and is
/// not negative.
struct ErosionParameter {
  std::string_view key;
  std::string_view symbol;
  std::string_view unit;
  std::string_view sentence;  ///< for the scene reference
  double ErosionParameters::*value = nullptr;
};

/// A law, as its file declares it. Its functions are called after the start of erosion and where
/// something can erode: 0 < porosity < porosity_max, rate > 0. A step that would erode more than
/// there is may return a porosity above porosity_max.
struct ErosionLaw {
  std::string_view word;         ///< what `law` is in a scene
  std::string_view equation;     ///< phi_e, for the scene reference
  std::string_view rate_symbol;  ///< of the key `rate`
  std::string_view rate_unit;
  std::span<const ErosionParameter> parameters = {};
  bool depends_on_flux = false;

  /// phi_e, 1/s. Null: the law erodes nothing.
  double (*erosion_rate)(const ErosionModel& model, const LocalState& state) = nullptr;
  /// Porosity after `duration` (s); `state.flux` is the mean over that time.
  double (*porosity_after)(const ErosionModel& model, const LocalState& state,
                           double duration) = nullptr;
  /// Exact porosity after `duration` under a constant `state.flux`, by another way than
  /// `porosity_after` where that is not in closed form. Null: there is no exact solution.
  double (*exact_porosity)(const ErosionModel& model, const LocalState& state,
                           double duration) = nullptr;
  /// Time from the start until nothing is left to erode, s. Null: fines run out never, or at a time
  /// that depends on the flow.
  double (*exhaustion)(const ErosionModel& model, double initial_porosity) = nullptr;

  [[nodiscard]] bool erodes() const { return erosion_rate != nullptr; }
};

/// Every law there is, in the order of the scene reference: the order in physics/CMakeLists.txt.
std::span<const ErosionLaw* const> erosion_laws();
/// The law of soil that does not erode, which a scene has by default: the first of the list.
const ErosionLaw* no_erosion();
/// The law that a scene calls `word`. Throws std::invalid_argument where there is none.
const ErosionLaw* erosion_law(std::string_view word);

/// "constant law, 0.001 1/s": for legends. `rate` as text, in the law's unit.
std::string law_text(const ErosionLaw& law, const std::string& rate);

/// The model erodes, at some time and under some flow.
bool erodes(const ErosionModel& model);

/// The model erodes, and how fast depends on the flow.
bool depends_on_flux(const ErosionModel& model);

/// phi_e at a time, 1/s, with `flux` = |q| in m/s, which may be unset unless `depends_on_flux`.
/// Zero before the start and once nothing is left to erode.
double erosion_rate(const ErosionModel& model, double porosity, double time, double flux);

/// Porosity at time `to` of soil that had `porosity` at time `from`. Split at the start of erosion
/// and at exhaustion, so the length of the interval costs no accuracy: every law is integrated
/// exactly, or to about 1e-13. `flux`: mean of |q| over the interval, m/s; may be unset unless
/// `depends_on_flux`. Never above porosity_max.
double porosity_after(const ErosionModel& model, double porosity, double from, double to,
                      double flux);

/// The same at time `time`, from the law's exact solution under a constant `flux`; not a number
/// where the law has none, or depends on a flux that is unset.
double exact_porosity(const ErosionModel& model, double initial_porosity, double time, double flux);

/// Whether `exact_porosity` needs no flux: the law has an exact solution that does not depend on
/// it.
bool has_exact_porosity(const ErosionModel& model);

/// When soil of this initial porosity has lost all its fines, s: the start where it has none;
/// infinity where they never run out, or at a time that depends on the flow.
double exhaustion_time(const ErosionModel& model, double initial_porosity);

/// Times at which the erosion rate of soil of this initial porosity is not smooth, ascending, s:
/// start and exhaustion, as far as they exist.
std::vector<double> breakpoints(const ErosionModel& model, double initial_porosity);

}  // namespace suffuse
