#include "flow/implicit_flow.hpp"

#include <algorithm>
#include <cmath>

#include "common/errors.hpp"
#include "flow/implicit_settings.hpp"
#include "flow/implicit_thresholds.hpp"
#include "grid/face_flux.hpp"
#include "physics/liquid.hpp"
#include "results/pass_timer.hpp"

namespace suffuse {
namespace {

/// Replaces forecast porosities by the present ones and keeps forecast resistances: nearly dry soil
/// holds less water than the error of a forecast of its pores.
template <int Dim>
void keep_pores(const std::vector<double>& porosity, FlowCoefficients<Dim>& ahead) {
  for (std::size_t e = 0; e < porosity.size(); ++e) {
    ahead.drag[e] *= porosity[e] / ahead.porosity[e];
    ahead.porosity[e] = porosity[e];
  }
}

/// Power that each element's drag dissipates, W.
template <int Dim>
std::vector<double> drag_losses(const Grid<Dim>& grid, const std::vector<double>& face_flux,
                                const FlowCoefficients<Dim>& coefficients) {
  std::vector<double> result;
  for (const Vector<Dim>& flux : element_flux(grid, face_flux)) {
    const std::size_t e = result.size();
    const double drag = coefficients.drag[e] / coefficients.porosity[e];
    result.push_back(drag * flux.squaredNorm() * grid.volume[e]);
  }
  return result;
}

}  // namespace

template <int Dim>
ImplicitFlow<Dim>::ImplicitFlow(const Case<Dim>& c, const Grid<Dim>& grid,
                                const Skeleton<Dim>& solid, const FlowOptions& options)
    : FlowSolver<Dim>(c, grid, solid, options.threads),
      options_(options),
      solid_(solid),
      scheme_(grid, scheme_settings(this->scene(), options), this->gravity(),
              flow_soils(this->scene(), solid.soils(), solid.filling()), leaky_faces(c, grid)),
      has_gravity_(this->gravity().norm() > 0.0),
      follows_pores_(depends_on_pores(this->scene(), this->conditions_, options) || has_gravity_),
      control_(
          step_settings(this->scene(), options, follows_pores_, this->conditions_, this->kinks())),
      blending_(blending_settings(this->scene(), options, follows_pores_)),
      reuse_({options.reuse_steady && !scheme_.has_retention() && !solid.moves(),
              this->scene().time.tolerance, has_gravity_,
              has_condition(this->conditions_, FaceKind::velocity)}) {}

template <int Dim>
FlowStep<Dim> ImplicitFlow<Dim>::solve(const FlowInterval<Dim>& interval) {
  FlowStep<Dim> step = propose(interval);
  if (reuse_.active()) {
    if (std::optional<MixedStep<Dim>> kept = steady_step(step.dt)) {
      step.found = *std::move(kept);
      step.is_kept = true;
      return step;
    }
  }
  const PassTimer timer(solving_);
  for (;;) {
    set_forcing(interval, step);
    if (const std::optional<Unsolved> why = try_step(step)) {
      if (is_shortest(step)) throw NumericalError(why->text);
      reject(step);
    } else if (accepts(interval, step)) {
      let_out_expansion(step);
      return step;
    }
  }
}

template <int Dim>
FlowStep<Dim> ImplicitFlow<Dim>::propose(const FlowInterval<Dim>& interval) {
  follow_soils();
  const double until = this->next_breakpoint(interval.start, interval.latest);
  FlowStep<Dim> step;
  step.start = interval.start;
  step.dt = control_.propose(interval.start, until, interval.longest);
  step.until = until;
  return step;
}

template <int Dim>
MixedStep<Dim> ImplicitFlow<Dim>::solved(const FlowStep<Dim>& step) {
  std::vector<const FlowForcing<Dim>*> stages;
  for (const FlowForcing<Dim>& forcing : step.forcing) stages.push_back(&forcing);
  return scheme_.step(now_.state, step.dt, stages);
}

template <int Dim>
std::optional<Unsolved> ImplicitFlow<Dim>::try_step(FlowStep<Dim>& step) try {
  ++solving_.calls;
  step.found = solved(step);
  return std::nullopt;
} catch (const NotConverged& error) {
  return Unsolved{error.what()};
}

template <int Dim>
bool ImplicitFlow<Dim>::accepts(const FlowInterval<Dim>& interval, FlowStep<Dim>& step) {
  const bool given = control_.has_given_step() || solid_.has_inertia();
  const double error = given ? 0.0 : error_of(step.found, step.start, step.dt);
  if (!control_.accept(step.start, error, previous_.has_value(), step.dt)) return false;
  if (scheme_.iterations() > implicit_thresholds.slow_iterations) control_.hold(step.dt);
  if (solid_.has_inertia()) control_.hold(implicit_thresholds.inertial_growth * step.dt);
  if (follows_pores_) step.expected = coefficients_at(interval, step.start + step.dt);
  return true;
}

template <int Dim>
bool ImplicitFlow<Dim>::is_shortest(const FlowStep<Dim>& step) const {
  const double share = solid_.has_inertia() ? implicit_thresholds.min_unsolved_inertial_step
                                            : implicit_thresholds.min_unsolved_step;
  return step.dt < share * this->scene().time.end;
}

template <int Dim>
void ImplicitFlow<Dim>::plan_anew(const FlowInterval<Dim>& interval, FlowStep<Dim>& step) const {
  const double planned = std::min(std::max(step.dt, control_.last_step()), interval.longest);
  step.dt = StepControl::up_to(planned, step.until - step.start);
}

template <int Dim>
FlowProgress ImplicitFlow<Dim>::commit(FlowStep<Dim> step) {
  const double end = step.dt < step.until - step.start ? step.start + step.dt : step.until;
  FlowProgress progress{1, step.dt, end, {}, std::move(step.room_gained), std::move(step.relative)};
  add_displaced_air(now_.state.air, step.found.end.air, progress.room_gained);
  progress.volumes = face_volumes(this->grid(), now_.state.face_pressure, pressure_, step.found,
                                  this->scene().liquid.bulk_modulus, this->threads());
  if (!step.is_kept) {
    const FlowForcing<Dim>& forcing = step.forcing.back();
    if (!forcing.source.empty()) relaxation_.set_source(forcing.source);
    blending_.record(forcing.coefficients);
    if (step.expected) blending_.expect(*std::move(step.expected));
  }
  remember(std::move(step.found), step.dt);
  this->update_boundary_values(step.start, end);
  if (is_breakpoint(end)) {
    pass_breakpoint(end, step.dt);
  } else if (!reuse_.active()) {
    reuse_if_steady(end);
  }
  return progress;
}

template <int Dim>
void ImplicitFlow<Dim>::set_forcing(const FlowInterval<Dim>& interval, FlowStep<Dim>& step) const {
  const std::vector<double> shares = scheme_.stages();
  step.forcing.resize(shares.size());
  std::vector<double> source;
  if (relaxation_.active()) source = relaxation_.next_source(step.dt, filling_time());
  for (std::size_t stage = 0; stage < shares.size(); ++stage) {
    FlowForcing<Dim>& forcing = step.forcing[stage];
    const double time = step.start + shares[stage] * step.dt;
    forcing.coefficients = follows_pores_ ? coefficients_at(interval, time) : this->coefficients_;
    blending_.blend(time - step.start, this->coefficients_, forcing.coefficients);
    if (scheme_.soils().air_moves()) {
      keep_pores(this->coefficients_.porosity, forcing.coefficients);
    }
    if (forcing.conditions.empty()) forcing.conditions = this->conditions_;
    this->boundary_values().update(time, forcing.conditions);
    forcing.source = source;
  }
}

template <int Dim>
FlowCoefficients<Dim> ImplicitFlow<Dim>::coefficients_at(const FlowInterval<Dim>& interval,
                                                         double time) const {
  // A breakpoint at the end of the step is not yet in effect.
  const double before = time - implicit_thresholds.end_margin * (time - interval.start);
  PoreState pores = interval.pores.at(before);
  if (this->scene().liquid.viscosity_model.depends_on_concentration()) {
    // Without transport the forecast may reach concentrations that moving liquid does not.
    const double most = 0.999 * this->scene().liquid.viscosity_model.maximum_concentration;
    for (double& c : pores.concentration) c = std::min(c, most);
  }
  return this->coefficients_of(before, pores, this->coefficients_.face_concentration);
}

template <int Dim>
double ImplicitFlow<Dim>::error_of(const MixedStep<Dim>& step, double start, double dt) const {
  const MixedFlow<Dim>* previous = previous_ ? &*previous_ : nullptr;
  using Span = std::span<const double>;
  const auto before = [&](const auto& field) { return previous ? field(*previous) : Span(); };
  const auto flux = [](const MixedFlow<Dim>& flow) { return Span(flow.flux_through); };
  if (scheme_.is_nonlinear()) {
    // Fronts and seepage faces are sharp: the error is the displaced volume.
    const auto air = [](const MixedState<Dim>& state) {
      return state.air.empty() ? Span()
                               : Span(state.air.front().data(), state.air.size() * (Dim + 1));
    };
    const auto air_of = [&](const MixedFlow<Dim>& flow) { return air(flow.state); };
    const double largest = std::max(scales_.flux_sum, sum_of_magnitudes(step.flux_through));
    const double passing = implicit_thresholds.passing_flux * this->scene().time.end;
    const double flux_scale = largest * (1.0 + passing / dt);
    return control_.error(
        start, dt,
        {{before(flux), now_.flux_through, step.flux_through, flux_scale, true},
         {before(air_of), air(now_.state), air(step.end), scales_.pore_volume, true}});
  }
  const auto pressure = [](const MixedFlow<Dim>& flow) { return Span(flow.state.face_pressure); };
  const ControlledField of_pressure{before(pressure), now_.state.face_pressure,
                                    step.end.face_pressure, scales_.pressure};
  // A sudden load drives an infinite flux out of its boundary for an instant: only pressures count.
  if (solid_.moves()) return control_.error(start, dt, {of_pressure});
  const double flux_scale = std::max(scales_.flux, largest_magnitude(step.flux_through));
  return control_.error(
      start, dt, {{before(flux), now_.flux_through, step.flux_through, flux_scale}, of_pressure});
}

template <int Dim>
void ImplicitFlow<Dim>::remember(MixedStep<Dim> step, double dt) {
  MixedFlow<Dim> end = end_of(std::move(step));
  scales_.include(end.state.face_pressure, end.flux_through);
  previous_.reset();
  if (control_.smooth()) previous_ = std::move(now_);
  now_ = std::move(end);
  pressure_ = element_pressure_now();
  if (reuse_.active()) control_.grow(dt);
  control_.finish(dt);
  blending_.finish(dt);
  relaxation_.finish(dt, filling_time());
}

template <int Dim>
void ImplicitFlow<Dim>::pass_breakpoint(double time, double dt) {
  if (!reuse_.active()) previous_.reset();
  control_.pass_kink();
  if (follows_pores_) blending_.shorten(dt);
  const bool boundary_kink = contains_time(this->kinks(), time);
  if (boundary_kink) relaxation_.pass_kink();
  // Where erosion starts, the steady flow still fits its coefficients, but not those to come.
  if (boundary_kink || follows_pores_ || has_gravity_) reuse_.stop();
}

template <int Dim>
void ImplicitFlow<Dim>::reuse_if_steady(double time) {
  const PassTimer timer(solving_);
  if (!reuse_.allowed() || !previous_) return;
  // Without a prescribed pressure round-off alone would change the level of compressible water.
  const bool sealed = !has_condition(this->conditions_, FaceKind::pressure);
  if (sealed && std::isfinite(this->scene().liquid.bulk_modulus)) return;
  if (!reuse_.is_close(now_.face_flux, previous_->face_flux, scales_.flux)) return;
  if (!boundary_values_rest(this->boundary_values(), this->conditions_, time,
                            this->scene().time.end)) {
    return;
  }
  MixedStep<Dim> steady;
  try {
    steady = scheme_.steady({this->coefficients_, this->conditions_, relaxation_.source()});
  } catch (const NumericalError&) {
    return;  // Fluxes that do not balance have no steady flow.
  }
  if (!reuse_.is_close(now_.face_flux, steady.face_flux, scales_.flux) ||
      !reuse_.is_close(now_.state.face_pressure, steady.end.face_pressure, scales_.pressure)) {
    return;
  }
  reuse_.start(this->coefficients_);
  blending_.record(this->coefficients_);
  replace_flow(std::move(steady));
  pressure_ = element_pressure_now();
}

template <int Dim>
void ImplicitFlow<Dim>::update(double time, const PoreState& pores,
                               const std::vector<double>& face_concentration) {
  FlowSolver<Dim>::update(time, pores, face_concentration);
  if (blending_.expects()) {
    // Points that change elements scatter densities and pores: only a lasting change is a drift.
    const bool scattered = this->scene().formulation == Formulation::double_point || solid_.moves();
    const double dt = control_.last_step();
    const double weight = scattered ? dt / (dt + filling_time()) : 1.0;
    // Resistances were right at the start of the step: their mean error is half that at its end.
    // Where viscosity follows a front of fines, an element's error is weighted with its power.
    std::vector<double> losses;
    if (this->scene().liquid.viscosity_model.depends_on_concentration()) {
      losses = drag_losses(this->grid(), now_.face_flux, this->coefficients_);
    }
    const double error = blending_.learn(this->coefficients_, dt, weight, losses);
    // Motion of the soil changes them too, and the expectation leaves motion out.
    const bool shown = solid_.has_inertia() || scheme_.soils().air_moves();
    if (!shown) control_.account_for(0.5 * error);
  }
  reuse_.check(this->coefficients_);
}

template <int Dim>
double ImplicitFlow<Dim>::filling_time() const {
  double smallest = std::ranges::min(this->coefficients_.water_volume);
  if (scheme_.soils().air_moves()) {
    // Elements of air hold next to no water.
    smallest = std::numeric_limits<double>::infinity();
    for (int e = 0; e < this->grid().mesh.element_count(); ++e) {
      smallest = std::min(smallest, this->coefficients_.porosity[e] * this->grid().volume[e]);
    }
  }
  return smallest / largest_magnitude(now_.face_flux);
}

template <int Dim>
FlowState<Dim> ImplicitFlow<Dim>::state(double time) const {
  FlowState<Dim> result;
  result.time = time;
  result.dt = control_.last_step() > 0.0 ? control_.last_step() : control_.next_step();
  result.pressure = pressure_;
  result.face_pressure = now_.state.face_pressure;
  result.face_flux = now_.face_flux;
  for (std::size_t e = 0; e < now_.state.air.size(); ++e) {
    const double pores = this->coefficients_.porosity[e] * this->grid().volume[e];
    result.saturation.push_back(1.0 - element_sum<Dim>(now_.state.air[e]) / pores);
  }
  result.relative_conductivity = scheme_.relative_conductivity(now_.state.face_pressure);
  result.eos_error = eos_error_;
  result.pressure_overshoot = scales_.overshoot(now_.state.face_pressure);
  NodalFields<Dim> nodes =
      nodal_fields(this->grid(), now_, pressure_, this->coefficients_.porosity,
                   Vector<Dim>(this->scene().liquid.density * this->gravity()));
  result.node_pressure = std::move(nodes.pressure);
  result.velocity = std::move(nodes.velocity);
  this->prescribe_at_nodes(result.node_pressure);
  return result;
}

template <int Dim>
void ImplicitFlow<Dim>::archive(StateArchive& archive) {
  FlowSolver<Dim>::archive(archive);
  scheme_.archive(archive, this->conditions_);
  archive(control_, blending_, relaxation_, reuse_, scales_);
  archive(now_, previous_, pressure_, eos_error_, solving_, reusing_);
  if (archive.restores()) follow_soils();
}

template <int Dim>
std::vector<PassTiming> ImplicitFlow<Dim>::passes() const {
  const SolveCounts counts = scheme_.counts();
  return {solving_,
          {"flow, rejected steps", control_.rejected(), 0.0},
          {"flow, systems solved", counts.solves, 0.0},
          {"flow, matrices factored", counts.factorisations, 0.0},
          {"flow, conjugate gradients", counts.iterations, 0.0},
          reusing_};
}

template class ImplicitFlow<2>;
template class ImplicitFlow<3>;

}  // namespace suffuse
