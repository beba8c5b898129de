#include "mixed/implicit_mixed.hpp"

#include <numbers>

#include "mixed/quadratic_newton.hpp"
#include "mixed/retention_newton.hpp"
#include "mixed/sealed_pieces.hpp"
#include "mixed/stage_end.hpp"

namespace suffuse {
namespace {

/// Alexander's gamma: both stages last gamma dt, so their matrices are alike.
constexpr double stage_share = 1.0 - 0.5 * std::numbers::sqrt2;

/// Guess of the flux from a velocity; empty without quadratic drag.
template <int Dim>
VectorField<Dim> flux_guess(const VectorField<Dim>& velocity, const FlowCoefficients<Dim>& c) {
  VectorField<Dim> flux(c.quadratic_drag.empty() ? 0 : velocity.size());
  for (std::size_t e = 0; e < flux.size(); ++e) flux[e] = c.porosity[e] * velocity[e];
  return flux;
}

template <int Dim>
MixedStep<Dim> step_to(StageEnd<Dim> end, std::vector<double> face_volume) {
  return {std::move(end.state), std::move(face_volume), std::move(end.face_flux),
          std::move(end.flux_through)};
}

/// Restores the values at the end of its scope.
struct Restored {
  explicit Restored(std::vector<char>& of) : values(of), before(of) {}
  ~Restored() { values = std::move(before); }
  Restored(const Restored&) = delete;
  Restored& operator=(const Restored&) = delete;

  std::vector<char>& values;
  std::vector<char> before;
};

}  // namespace

template <int Dim>
struct ImplicitMixed<Dim>::Parts {
  Parts(const MixedModel<Dim>& model, const std::vector<FaceCondition>& conditions)
      : faces(model, conditions),
        system(model, faces.kinds()),
        guess{std::vector<double>(conditions.size(), 0.0)} {}

  StageFaces<Dim> faces;
  PressureSystem<Dim> system;
  StageGuess guess;
};

template <int Dim>
MixedStep<Dim> ImplicitMixed<Dim>::step(const MixedState<Dim>& start, double dt,
                                        const std::vector<const FlowForcing<Dim>*>& forcing) {
  set_up(forcing.front()->conditions);
  if (stages().size() == 1) return one_stage(start, dt, *forcing.back());
  if (!has_retention()) return two_stages(start, dt, *forcing.front(), *forcing.back());
  // The second stage starts from extrapolated contents, which may exceed full or fall below dry.
  try {
    return two_stages(start, dt, *forcing.front(), *forcing.back());
  } catch (const NotConverged&) {
    return one_stage(start, dt, *forcing.back());
  }
}

template <int Dim>
MixedStep<Dim> ImplicitMixed<Dim>::one_stage(const MixedState<Dim>& start, double dt,
                                             const FlowForcing<Dim>& forcing) {
  StageEnd<Dim> end =
      solve_stage(start, dt, forcing, flux_guess(start.velocity, forcing.coefficients));
  std::vector<double> volume = end.face_flux;
  for (double& v : volume) v *= dt;
  return step_to(std::move(end), std::move(volume));
}

template <int Dim>
MixedStep<Dim> ImplicitMixed<Dim>::two_stages(const MixedState<Dim>& start, double dt,
                                              const FlowForcing<Dim>& early,
                                              const FlowForcing<Dim>& late) {
  const double duration = stage_share * dt;
  const StageEnd<Dim> first =
      solve_stage(start, duration, early, flux_guess(start.velocity, early.coefficients));
  constexpr double ahead = (1.0 - stage_share) / stage_share;
  MixedState<Dim> base = start;
  for (std::size_t f = 0; f < first.rise.size(); ++f) {
    base.face_pressure[f] += ahead * first.rise[f];
  }
  for (std::size_t e = 0; e < start.velocity.size(); ++e) {
    base.velocity[e] += ahead * (first.state.velocity[e] - start.velocity[e]);
    if (start.air.empty()) continue;
    for (int k = 0; k <= Dim; ++k) {
      base.air[e][k] += ahead * (first.state.air[e][k] - start.air[e][k]);
    }
  }
  StageEnd<Dim> second =
      solve_stage(base, duration, late, flux_guess(first.state.velocity, late.coefficients));
  std::vector<double> volume(first.rise.size());
  for (std::size_t f = 0; f < volume.size(); ++f) {
    volume[f] = dt * ((1.0 - stage_share) * first.face_flux[f] + stage_share * second.face_flux[f]);
  }
  return step_to(std::move(second), std::move(volume));
}

template <int Dim>
StageEnd<Dim> ImplicitMixed<Dim>::solve_stage(const MixedState<Dim>& base, double duration,
                                              const FlowForcing<Dim>& forcing,
                                              const VectorField<Dim>& guessed_flux,
                                              bool saturated) {
  PressureSystem<Dim>& system = parts_->system;
  StageGuess& guess = parts_->guess;
  MixedStage<Dim> stage(model_, system.matrix(), parts_->faces, base, duration, forcing, guess,
                        saturated);
  std::vector<double> surplus;
  if (!stage.is_nonlinear()) surplus = balance_sealed_pieces(stage);
  iterations_ = 1;
  if (stage.is_nonlinear()) {
    iterations_ = RetentionNewton<Dim>(stage, system).solve();
  } else if (!stage.coefficients.quadratic_drag.empty()) {
    QuadraticNewton<Dim>(stage, system).solve(guessed_flux);
  } else {
    system.solve_linear(stage);
  }
  std::vector<double> rise = stage.rise();
  if (!stage.is_nonlinear()) level_sealed_pieces(stage, surplus, rise);
  StageEnd<Dim> end(stage, std::move(rise));
  guess.flux_scale = stage.largest_of_faces([&](int f) { return std::abs(end.face_flux[f]); });
  if (stage.is_steady()) return end;
  stage.for_each_face([&](int f) { guess.rise_rate[f] = end.rise[f] / duration; });
  return end;
}

template <int Dim>
MixedStep<Dim> ImplicitMixed<Dim>::steady(const FlowForcing<Dim>& forcing) {
  set_up(forcing.conditions);
  StageEnd<Dim> end = has_retention()
                          ? draining_steady(forcing)
                          : solve_stage(last_steady_, infinity, forcing, last_steady_flux_);
  last_steady_ = end.state;
  for (std::size_t e = 0; e < last_steady_flux_.size(); ++e) {
    last_steady_flux_[e] = forcing.coefficients.porosity[e] * end.state.velocity[e];
  }
  return step_to(std::move(end), {});
}

template <int Dim>
MixedStep<Dim> ImplicitMixed<Dim>::saturated_steady(const FlowForcing<Dim>& forcing) {
  if (soils().saturated()) return steady(forcing);
  set_up(forcing.conditions);
  const Restored open(parts_->faces.open());
  return step_to(solve_stage(last_steady_, infinity, forcing, last_steady_flux_, true), {});
}

template <int Dim>
StageEnd<Dim> ImplicitMixed<Dim>::draining_steady(const FlowForcing<Dim>& forcing) {
  constexpr double growth = 4.0;
  constexpr int max_steps = 200;
  const FlowCoefficients<Dim>& c = forcing.coefficients;
  MixedState<Dim> state = last_steady_;
  if (state.air.empty()) {
    state = solve_stage(last_steady_, infinity, forcing, last_steady_flux_, true).state;
    state.air = suffuse::air_at(model_, state.face_pressure, c.porosity);
  }
  // Pseudo-time steps of growing length, from the saturated state.
  double pores = 0.0;
  double fastest = parts_->guess.flux_scale;
  for (const int e : model_.grid.own_elements()) {
    pores += model_.grid.volume[e] * c.porosity[e];
    fastest = std::max(fastest, model_.gravity_flux(e, c));
  }
  pores = sum_of_all(model_.grid.ranks(), pores);
  fastest = largest_of_all(model_.grid.ranks(), fastest);
  if (fastest == 0.0) return solve_stage(state, infinity, forcing, last_steady_flux_);
  const double filling = pores / fastest;
  double duration = filling;
  for (int step = 0; step < max_steps; ++step) {
    try {
      if (duration > 1e4 * filling) return solve_stage(state, infinity, forcing, last_steady_flux_);
    } catch (const NotConverged&) {
      // Further steps bring the state nearer.
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
ImplicitMixed<Dim>::ImplicitMixed(const Grid<Dim>& grid, ImplicitSettings settings,
                                  Vector<Dim> gravity, FlowSoils<Dim> soils,
                                  std::vector<LeakyFace> walls)
    : model_{grid, settings, std::move(gravity), std::move(soils), std::move(walls)} {
  for (const Vector<Dim>& normal : grid.face_normal) model_.face_area.push_back(normal.norm());
}

template <int Dim>
ImplicitMixed<Dim>::~ImplicitMixed() = default;

template <int Dim>
void ImplicitMixed<Dim>::set_up(const std::vector<FaceCondition>& conditions) {
  const bool fit = parts_ && parts_->faces.fit(conditions);
  if (!any_of_all(model_.grid.ranks(), !fit)) return;
  earlier_counts_ = counts();
  parts_ = std::make_unique<Parts>(model_, conditions);
  last_steady_.face_pressure.assign(conditions.size(), 0.0);
  last_steady_.velocity.assign(model_.grid.volume.size(), Vector<Dim>::Zero());
  last_steady_flux_ = last_steady_.velocity;
}

template <int Dim>
std::vector<double> ImplicitMixed<Dim>::stages() const {
  if (model_.settings.stepping == TimeStepping::monotone) return {1.0};
  return {stage_share, 1.0};
}

template <int Dim>
bool ImplicitMixed<Dim>::is_nonlinear() const {
  return has_retention() || (parts_ && parts_->faces.any_switch());
}

template <int Dim>
SolveCounts ImplicitMixed<Dim>::counts() const {
  SolveCounts result = earlier_counts_;
  if (parts_) result += parts_->system.counts();
  return result;
}

template <int Dim>
ElementField<Dim> ImplicitMixed<Dim>::air_at(const std::vector<double>& face_pressure,
                                             const std::vector<double>& porosity) const {
  return suffuse::air_at(model_, face_pressure, porosity);
}

template <int Dim>
std::vector<double> ImplicitMixed<Dim>::relative_conductivity(
    const std::vector<double>& face_pressure) const {
  if (soils().saturated()) return {};
  const SideStates<Dim> sides(model_, face_pressure);
  std::vector<double> result(model_.grid.volume.size(), 0.0);
  for_each_index(model_.grid.mesh.element_count(), model_.settings.threads, [&](int e) {
    for (int k = 0; k <= Dim; ++k) result[e] += sides.at(e, k).relative_conductivity / (Dim + 1);
  });
  return result;
}

template <int Dim>
void ImplicitMixed<Dim>::archive(StateArchive& archive,
                                 const std::vector<FaceCondition>& conditions) {
  set_up(conditions);
  std::vector<double> followed = parts_->faces.correction().followed();
  archive(parts_->faces, parts_->system, on_elements(followed), earlier_counts_,
          on_faces(parts_->guess.rise_rate), parts_->guess.flux_scale, last_steady_,
          on_elements(last_steady_flux_));
  // The faces may have set up another correction.
  if (archive.restores()) parts_->faces.correction().restore(std::move(followed));
}

template class ImplicitMixed<2>;
template class ImplicitMixed<3>;

}  // namespace suffuse
