#include "flow/implicit_flow.hpp"

#include <algorithm>
#include <cmath>

#include "boundary/reservoir_iteration.hpp"
#include "common/errors.hpp"
#include "flow/implicit_settings.hpp"
#include "grid/face_flux.hpp"
#include "mixed/implicit_thresholds.hpp"
#include "physics/head.hpp"
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

/// Power that each element's drag dissipates, W. Empty unless viscosity follows a front of fines:
/// then an element's error is weighted with it.
template <int Dim>
std::vector<double> drag_losses(const Scene& scene, const Grid<Dim>& grid,
                                const std::vector<double>& face_flux,
                                const FlowCoefficients<Dim>& coefficients) {
  std::vector<double> result;
  if (!scene.liquid.viscosity_model.depends_on_concentration()) return result;
  for (const Vector<Dim>& flux : element_flux(grid, face_flux)) {
    const std::size_t e = result.size();
    const double drag = coefficients.drag[e] / coefficients.porosity[e];
    result.push_back(drag * flux.squaredNorm() * grid.volume[e]);
  }
  return result;
}

/// A breakpoint at `time`, the end of a step or a stage after `start`, is not yet in effect.
double just_before(double start, double time) {
  return time - implicit_thresholds.end_margin * (time - start);
}

/// First step of soil that moves from the start, over the time of its change.
constexpr double first_step_of_soil = 1e-2;

/// Porosity of what fills each element: a gap before soil that moves is no pore.
std::vector<double> own_porosity(std::vector<double> n, const std::vector<double>& without_solid) {
  for (std::size_t e = 0; e < n.size(); ++e) n[e] /= n[e] + 1.0 - without_solid[e];
  return n;
}

/// The last flow of another run.
template <int Dim>
MixedFlow<Dim> flow_of(const EarlierFlow<Dim>& earlier, const Grid<Dim>& grid,
                       const std::vector<FaceCondition>& conditions,
                       const std::vector<double>& porosity) {
  MixedFlow<Dim> flow = flow_at_rest(grid, conditions, earlier.face_pressure(grid));
  flow.face_flux = flow.flux_through = earlier.state.face_flux;
  flow.state.velocity = element_flux(grid, flow.face_flux);
  for (std::size_t e = 0; e < porosity.size(); ++e) flow.state.velocity[e] /= porosity[e];
  return flow;
}

}  // namespace

template <int Dim>
ImplicitFlow<Dim>::ImplicitFlow(const Case<Dim>& c, const Grid<Dim>& grid,
                                const Skeleton<Dim>& solid, const FlowOptions& options)
    : FlowSolver<Dim>(c, grid, solid, options.threads),
      options_(options),
      solid_(solid),
      scheme_(grid, scheme_settings(this->scene(), options), this->gravity(),
              flow_soils(this->scene(), solid), leaky_faces(c, grid)),
      has_gravity_(this->gravity().norm() > 0.0),
      follows_pores_(depends_on_pores(this->scene(), options) ||
                     has_condition(grid, this->conditions_, FaceKind::velocity) || has_gravity_),
      control_(
          step_settings(this->scene(), options, follows_pores_, this->conditions_, this->kinks())),
      blending_(blending_settings(this->scene(), options, follows_pores_)),
      reuse_(grid, {options.reuse_steady && !scheme_.has_retention() && !solid.moves() &&
                        this->boundary_values().reservoir_rates().empty(),
                    this->scene().time.tolerance, has_gravity_,
                    has_condition(grid, this->conditions_, FaceKind::velocity)}) {}

// How it starts: at rest, in a steady flow, or as another run left it.

template <int Dim>
void ImplicitFlow<Dim>::start() {
  start_with(flow_at_rest(this->grid(), this->conditions_, this->pressure_at_rest()), nullptr);
}

template <int Dim>
void ImplicitFlow<Dim>::start_from(const EarlierFlow<Dim>& earlier) {
  start_with(flow_of(earlier, this->grid(), this->conditions_, this->coefficients_.porosity),
             &earlier.air);
}

template <int Dim>
bool ImplicitFlow<Dim>::flows_at_once() const {
  return std::isinf(this->scene().liquid.bulk_modulus) && !options_.inertia &&
         !scheme_.has_retention() && !this->scene().moves();
}

template <int Dim>
bool ImplicitFlow<Dim>::starts_at_rest() const {
  return this->scene().initial_flow != InitialFlow::steady && !flows_at_once();
}

template <int Dim>
void ImplicitFlow<Dim>::start_with(MixedFlow<Dim> flow, const ElementField<Dim>* air) {
  const Grid<Dim>& grid = this->grid();
  const Scene& scene = this->scene();
  now_ = std::move(flow);
  const FlowForcing<Dim> forcing{this->coefficients_, this->conditions_, {}};
  scales_ =
      find_scales(grid, scheme_, forcing, this->boundary_values(), scene.time.end, has_gravity_);
  const bool at_rest = starts_at_rest();
  if (!at_rest) now_ = end_of(scheme_.steady(forcing));
  now_.state.air =
      air ? *air : scheme_.air_at(now_.state.face_pressure, this->coefficients_.porosity);
  pressure_ = element_pressure_now();
  if (!flows_at_once()) scales_.include_in_bounds(grid.ranks(), now_.state.face_pressure);
  scales_.include(grid, now_.state.face_pressure, now_.face_flux);
  raise_over_round_off(scales_, grid, this->coefficients_, scene.liquid, scene.time.end);
  const double of_run = implicit_thresholds.first_step * scene.time.end;
  const double of_liquid = shortest_change({});
  const double first = at_rest ? std::min(of_run, of_liquid) : of_run;
  control_.start(first, !at_rest, of_liquid);
}

template <int Dim>
void ImplicitFlow<Dim>::start_steps(const MovingSolid& solid) {
  scales_.include_loads(solid.load_change, solid.stiffness);
  const double of_run = implicit_thresholds.first_step * this->scene().time.end;
  const double of_liquid = shortest_change({});
  const double shortest = shortest_change(solid.compressibility);
  const double of_soil = first_step_of_soil * solid.time_of_change;
  const double of_change = of_soil > 0.0 ? of_soil : starts_at_rest() ? of_liquid : shortest;
  // Loads, and with them pressures, may change suddenly.
  control_.start(std::min(of_run, of_change), false, shortest);
}

template <int Dim>
double ImplicitFlow<Dim>::shortest_change(const std::vector<double>& soil_storage) const {
  return implicit_thresholds.first_step / fastest_rate(this->grid(), this->coefficients_,
                                                       this->scene().liquid.bulk_modulus,
                                                       options_.inertia, soil_storage);
}

// A step.

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
    if (const std::optional<Unsolved> why = try_step(interval, step)) {
      if (is_shortest(step)) throw NumericalError(why->text);
      reject(step);
    } else if (accepts(interval, step)) {
      for (int repeat = 0; repeat < implicit_thresholds.expansion_repeats; ++repeat) {
        if (!let_out_expansion(step)) break;
        step.found = solved(step);
      }
      return step;
    }
  }
}

template <int Dim>
FlowStep<Dim> ImplicitFlow<Dim>::propose(const FlowInterval<Dim>& interval) {
  follow_soils();
  FlowStep<Dim> step;
  step.start = interval.start;
  step.until = this->next_breakpoint(interval.start, interval.latest);
  step.dt = control_.propose(interval.start, step.until, interval.longest);
  step.reservoir_rates = this->boundary_values().reservoir_rates(scheme_.stages().size());
  return step;
}

template <int Dim>
MixedStep<Dim> ImplicitFlow<Dim>::solved(const FlowStep<Dim>& step) {
  std::vector<const FlowForcing<Dim>*> stages;
  for (const FlowForcing<Dim>& forcing : step.forcing) stages.push_back(&forcing);
  return scheme_.step(now_.state, step.dt, stages);
}

template <int Dim>
std::optional<Unsolved> ImplicitFlow<Dim>::try_step(const FlowInterval<Dim>& interval,
                                                    FlowStep<Dim>& step) try {
  ++solving_.calls;
  const double height =
      scales_.pressure / unit_weight(this->scene().liquid.density, this->scene().gravity);
  ReservoirIteration reservoirs(step.reservoir_rates.size(), height / step.dt);
  for (int tries = 0; tries < ReservoirIteration::max_tries; ++tries) {
    set_forcing(interval, step);
    step.found = solved(step);
    const auto rates = this->boundary_values().stage_rates(
        step.found.face_volume, step.found.face_flux, step.dt, scheme_.stages());
    if (!reservoirs.agree(step.reservoir_rates, rates)) continue;
    if (control_.has_given_step() || reservoirs.follow(rates, step.forcing.size())) return {};
    break;
  }
  return Unsolved{"the levels of reservoirs and the flow from them do not agree"};
} catch (const NotConverged& error) {
  return Unsolved{error.what()};
}

template <int Dim>
bool ImplicitFlow<Dim>::accepts(const FlowInterval<Dim>& interval, FlowStep<Dim>& step) {
  const bool given = control_.has_given_step() || solid_.has_inertia();
  const double error = given ? 0.0 : error_of(step.found, step.start, step.dt);
  if (!control_.accept(step.start, error, previous_.has_value(), step.dt)) return false;
  if (scheme_.iterations() > implicit_thresholds.slow_iterations) control_.hold(step.dt);
  const double growth = control_.has_shortened() ? 1.0 : implicit_thresholds.inertial_growth;
  if (solid_.has_inertia()) control_.hold(growth * step.dt);
  if (follows_pores_) {
    step.expected = interval.pores.at(just_before(step.start, step.start + step.dt));
  }
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
  if (step.expected) {
    step.expected->open(step.room_gained, this->grid().volume);
    blending_.expect(coefficients_at(just_before(step.start, end), *std::move(step.expected)));
  }
  FlowProgress progress{1, step.dt, end, {}, std::move(step.room_gained), std::move(step.relative)};
  add_displaced_air(now_.state.air, step.found.end.air, progress.room_gained);
  progress.volumes = face_volumes(this->grid(), now_.state.face_pressure, pressure_, step.found,
                                  this->scene().liquid.bulk_modulus, this->threads());
  if (!step.is_kept) {
    const FlowForcing<Dim>& forcing = step.forcing.back();
    if (!forcing.source.empty()) relaxation_.set_source(forcing.source);
    blending_.record(forcing.coefficients);
  }
  this->update_boundary_values(
      step.start, end, this->boundary_values().reservoir_rates(step.found.face_volume, step.dt));
  const double share = this->scene().mesh.error ? control_.error_share(step.start, step.dt) : 0.0;
  errors_.record(previous_, now_, step.found, step.dt / control_.last_step(), share);
  remember(std::move(step.found), step.dt);
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
  const auto source = relaxation_.active() ? relaxation_.next_source(step.dt, filling_time())
                                           : std::vector<double>();
  for (std::size_t stage = 0; stage < shares.size(); ++stage) {
    FlowForcing<Dim>& forcing = step.forcing[stage];
    const double before = just_before(interval.start, step.start + shares[stage] * step.dt);
    forcing.coefficients =
        follows_pores_ ? coefficients_at(before, interval.pores.at(before)) : this->coefficients_;
    blending_.blend(shares[stage] * step.dt, this->coefficients_, forcing.coefficients);
    if (scheme_.soils().air_moves()) keep_pores(this->coefficients_.porosity, forcing.coefficients);
    if (forcing.conditions.empty()) forcing.conditions = this->conditions_;
    const bool has_mean = shares.size() == 1 && (solid_.moves() || scheme_.is_nonlinear());
    this->boundary_values().update(
        BoundaryTime::of_stage(step.start, step.dt, shares, stage, has_mean), step.reservoir_rates,
        forcing.conditions);
    forcing.source = source;
  }
}

template <int Dim>
FlowCoefficients<Dim> ImplicitFlow<Dim>::coefficients_at(double time, PoreState pores) const {
  if (this->scene().liquid.viscosity_model.depends_on_concentration()) {
    // Without transport the forecast may reach concentrations that moving liquid does not.
    const double most = 0.999 * this->scene().liquid.viscosity_model.maximum_concentration;
    for (double& c : pores.concentration) c = std::min(c, most);
  }
  return this->coefficients_of(time, pores, this->coefficients_.face_concentration);
}

template <int Dim>
double ImplicitFlow<Dim>::error_of(const MixedStep<Dim>& step, double start, double dt) const {
  using Span = std::span<const double>;
  const auto before = [&](const auto& field) { return previous_ ? field(*previous_) : Span(); };
  const Ranks& ranks = this->grid().ranks();
  if (scheme_.is_nonlinear()) {
    // Fronts and seepage faces are sharp: the error is the displaced volume.
    const NumberRange faces = this->grid().own_faces();
    const auto own_flux = [&](const std::vector<double>& values) {
      return Span(values).subspan(*faces.begin(), *faces.end() - *faces.begin());
    };
    const auto flux = [&](const MixedFlow<Dim>& flow) { return own_flux(flow.flux_through); };
    const NumberRange elements = this->grid().own_elements();
    const auto air = [&](const MixedState<Dim>& state) {
      if (state.air.empty()) return Span();
      constexpr std::ptrdiff_t sides = Dim + 1;
      const double* values = state.air.front().data();
      return Span(values + *elements.begin() * sides, values + *elements.end() * sides);
    };
    const auto air_of = [&](const MixedFlow<Dim>& flow) { return air(flow.state); };
    const double sum = sum_of_all(ranks, sum_of_magnitudes(own_flux(step.flux_through)));
    const double passing = implicit_thresholds.passing_flux * this->scene().time.end;
    const double flux_scale = std::max(scales_.flux_sum, sum) * (1.0 + passing / dt);
    const double of_flux = control_.error(
        start, dt, {{before(flux), flux(now_), own_flux(step.flux_through), flux_scale, true}});
    const double of_air = control_.error(
        start, dt, {{before(air_of), air(now_.state), air(step.end), scales_.pore_volume, true}});
    return std::max(sum_of_all(ranks, of_flux), sum_of_all(ranks, of_air));
  }
  const auto flux = [](const MixedFlow<Dim>& flow) { return Span(flow.flux_through); };
  const auto pressure = [](const MixedFlow<Dim>& flow) { return Span(flow.state.face_pressure); };
  const ControlledField of_pressure{before(pressure), now_.state.face_pressure,
                                    step.end.face_pressure, scales_.pressure};
  // A sudden load drives an infinite flux out of its boundary for an instant: only pressures count.
  if (solid_.moves()) return control_.error(start, dt, {of_pressure});
  const double flux_scale =
      std::max(scales_.flux, largest_of_all(ranks, largest_magnitude(step.flux_through)));
  const double own = control_.error(
      start, dt, {{before(flux), now_.flux_through, step.flux_through, flux_scale}, of_pressure});
  return largest_of_all(ranks, own);
}

template <int Dim>
void ImplicitFlow<Dim>::remember(MixedStep<Dim> step, double dt) {
  MixedFlow<Dim> end = end_of(std::move(step));
  scales_.include(this->grid(), end.state.face_pressure, end.flux_through);
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
  const bool sealed = !has_condition(this->grid(), this->conditions_, FaceKind::pressure);
  if (sealed && std::isfinite(this->scene().liquid.bulk_modulus)) return;
  if (!reuse_.is_close(now_.face_flux, previous_->face_flux, scales_.flux)) return;
  if (!boundary_values_rest(this->grid(), this->boundary_values(), this->conditions_, time,
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
    const double error = blending_.learn(
        this->grid(), this->coefficients_, dt, weight,
        drag_losses(this->scene(), this->grid(), now_.face_flux, this->coefficients_));
    if (!scheme_.soils().air_moves()) control_.account_for(0.5 * error);
  }
  reuse_.check(this->coefficients_);
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
  if (!result.saturation.empty()) result.porosity = this->coefficients_.porosity;
  if (solid_.moves()) result.porosity = own_porosity(result.porosity, solid_.element_porosity());
  result.relative_conductivity = scheme_.relative_conductivity(now_.state.face_pressure);
  result.eos_error = eos_error_;
  result.pressure_overshoot = scales_.overshoot(this->grid().ranks(), now_.state.face_pressure);
  auto nodes = nodal_fields(this->grid(), now_, pressure_, this->coefficients_.porosity,
                            Vector<Dim>(this->scene().liquid.density * this->gravity()));
  result.node_pressure = std::move(nodes.pressure);
  result.velocity = std::move(nodes.velocity);
  this->prescribe_at_nodes(result.face_pressure, result.node_pressure);
  this->grid().node_rows().exchange(result.node_pressure);
  this->grid().node_rows().exchange(result.velocity);
  return result;
}

template <int Dim>
std::optional<DischargeBounds> ImplicitFlow<Dim>::discharge_bounds() const {
  return errors_.find({this->grid(), this->scene(), this->coefficients_, this->conditions_,
                       scheme_.soils(), scheme_.walls(), now_.state.face_pressure, now_.face_flux,
                       scheme_.relative_conductivity(now_.state.face_pressure), this->threads()},
                      blending_.used());
}

template <int Dim>
void ImplicitFlow<Dim>::archive(StateArchive& archive) {
  FlowSolver<Dim>::archive(archive);
  scheme_.archive(archive, this->conditions_);
  archive(control_, blending_, relaxation_, reuse_, scales_);
  archive(now_, previous_, on_elements(pressure_), eos_error_, errors_, solving_, reusing_);
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
