/// Steady flow of the mixed elements where it depends on the pressure itself.

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/errors.hpp"
#include "mixed/implicit_mixed.hpp"

namespace suffuse {
namespace {

/// Puts back what a variable held, at the end of its scope.
template <class Value>
class Restored {
 public:
  explicit Restored(Value& variable) : variable_(variable), before_(variable) {}
  ~Restored() { variable_ = std::move(before_); }
  Restored(const Restored&) = delete;
  Restored& operator=(const Restored&) = delete;

 private:
  Value& variable_;
  Value before_;
};

}  // namespace

template <int Dim>
typename ImplicitMixed<Dim>::Stage ImplicitMixed<Dim>::nonlinear_steady(
    const FlowForcing<Dim>& forcing) {
  constexpr double forever = std::numeric_limits<double>::infinity();
  constexpr double growth = 4.0;
  constexpr int max_steps = 200;
  if (!has_retention()) return solve_stage(last_steady_, forever, forcing, last_steady_flux_);

  MixedState<Dim> state = last_steady_;
  if (state.air.empty()) {
    state = saturated_stage(forcing).state;
    state.air = air_at(state.face_pressure, forcing.coefficients.porosity);
  }
  // Steps of growing length, as from a saturated model that drains.
  double pores = 0.0;
  double fastest = flux_scale_;
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    pores += grid_.volume[e] * forcing.coefficients.porosity[e];
    fastest = std::max(fastest, gravity_flux(e, forcing.coefficients));
  }
  if (fastest == 0.0) return solve_stage(state, forever, forcing, last_steady_flux_);
  const double filling = pores / fastest;
  double duration = filling;
  for (int step = 0; step < max_steps; ++step) {
    try {
      if (duration > 1e4 * filling) {
        return solve_stage(state, forever, forcing, last_steady_flux_);
      }
    } catch (const NotConverged&) {
      // A longer step brings the state nearer.
    }
    try {
      state = solve_stage(state, duration, forcing, last_steady_flux_).state;
      duration *= growth;
    } catch (const NotConverged&) {
      duration /= growth * growth;
    }
  }
  throw NotConverged("no steady flow was found under these boundary conditions");
}

template <int Dim>
typename ImplicitMixed<Dim>::Stage ImplicitMixed<Dim>::saturated_stage(
    const FlowForcing<Dim>& forcing) {
  const Restored retention(ignore_retention_);
  ignore_retention_ = true;
  return solve_stage(last_steady_, std::numeric_limits<double>::infinity(), forcing,
                     last_steady_flux_);
}

template <int Dim>
MixedStep<Dim> ImplicitMixed<Dim>::saturated_steady(const FlowForcing<Dim>& forcing) {
  if (soils_.saturated()) return steady(forcing);
  set_up(forcing.conditions);
  const Restored faces(open_);
  Stage stage = saturated_stage(forcing);
  return {std::move(stage.state), {}, std::move(stage.face_flux), std::move(stage.flux_through)};
}

template ImplicitMixed<2>::Stage ImplicitMixed<2>::nonlinear_steady(const FlowForcing<2>&);
template MixedStep<2> ImplicitMixed<2>::saturated_steady(const FlowForcing<2>&);
template ImplicitMixed<3>::Stage ImplicitMixed<3>::nonlinear_steady(const FlowForcing<3>&);
template MixedStep<3> ImplicitMixed<3>::saturated_steady(const FlowForcing<3>&);

}  // namespace suffuse
