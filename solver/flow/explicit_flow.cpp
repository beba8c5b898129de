#include "flow/explicit_flow.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>

#include "case/errors.hpp"
#include "flow/locking.hpp"
#include "flow/steady_nodal.hpp"
#include "grid/face_flux.hpp"
#include "physics/liquid.hpp"
#include "results/pass_timer.hpp"

namespace suffuse {
namespace {

/// Solving for the steady flow of more elements than this would take longer than the warning is
/// worth.
constexpr int most_elements_checked = 100000;

ExplicitSettings scheme_settings(const Scene& scene, int threads) {
  ExplicitSettings settings;
  settings.bulk_modulus = scene.liquid.bulk_modulus;
  settings.mass_scaling = scene.time.mass_scaling;
  settings.drag = scene.time.drag;
  settings.porosity_gradient_term = scene.flow.porosity_gradient_term;
  const bool double_point = scene.formulation == Formulation::double_point;
  // Double-point masses move with the points. In mixed integration the term would convect element
  // pressures upwind, explicitly; under heavy mass scaling, where p nears K, that does not hold.
  settings.pressure_moves_with_liquid = double_point;
  settings.sum_displacements = double_point;
  settings.threads = threads;
  return settings;
}

}  // namespace

template <int Dim>
ExplicitFlow<Dim>::ExplicitFlow(const Case<Dim>& c, const Grid<Dim>& grid,
                                const RigidSkeleton<Dim>& skeleton, const FlowOptions& options)
    : FlowSolver<Dim>(c, grid, skeleton),
      operator_(grid, this->conditions_, this->gravity(),
                this->scene().flow.porosity_gradient_term),
      scheme_(operator_, scheme_settings(this->scene(), options.threads)),
      step_(options.step),
      step_given_(options.step_given) {}

template <int Dim>
void ExplicitFlow<Dim>::update(double time, const PoreState& content,
                               const std::vector<double>& face_concentration) {
  FlowSolver<Dim>::update(time, content, face_concentration);
  operator_.update(this->coefficients_);
  scheme_.update(this->coefficients_);
}

template <int Dim>
void ExplicitFlow<Dim>::archive(StateArchive& archive) {
  FlowSolver<Dim>::archive(archive);
  operator_.archive(archive);
  if (archive.restores()) {
    operator_.update(this->coefficients_);
    scheme_.update(this->coefficients_);
  }
  scheme_.archive(archive);
  archive(step_, timing_, assembled_limit_, element_limit_);
}

template <int Dim>
void ExplicitFlow<Dim>::start() {
  if (this->scene().initial_flow == InitialFlow::rest) {
    if (this->grid().mesh.element_count() <= most_elements_checked) {
      warn_of_locking(steady_flow(operator_).velocity);
    }
    scheme_.set_velocity(VectorField<Dim>(this->grid().mesh.node_count(), Vector<Dim>::Zero()));
    return;
  }
  NodalSteadyState<Dim> steady = steady_flow(operator_);
  if (steady.imbalance > 1e-6) {
    std::ostringstream message;
    message << "the steady initial flow leaves a net outflow of " << steady.imbalance
            << " times the largest face flux in an element: linear velocities cannot follow this "
               "flow on this mesh; it will store or release water at first";
    this->warn(message.str());
  }
  warn_of_locking(steady.velocity);
  scheme_.set_pressure(std::move(steady.pressure));
  scheme_.set_velocity(std::move(steady.velocity));
}

template <int Dim>
void ExplicitFlow<Dim>::warn_of_locking(const VectorField<Dim>& steady_velocity) {
  if (this->grid().mesh.element_count() > most_elements_checked) return;
  // The mixed elements it is compared with know Darcy's drag alone.
  if (!this->scene().flow.porosity_gradient_term || this->has_ergun()) return;
  const auto deviation =
      deviation_from_mixed_flow(operator_, this->coefficients_, this->gravity(), steady_velocity);
  if (!deviation || *deviation < locked_deviation) return;
  std::ostringstream message;
  message.precision(2);
  message
      << "the explicit scheme does not follow this flow on this mesh: its steady flux differs by "
      << 100.0 * *deviation
      << " % from that of mixed finite elements (volumetric locking). Fluxes, pressures and fines "
         "will be wrong; porosity is not touched. Take mesh.structure = \"crossed\", or smaller "
         "elements if it is";
  this->warn(message.str());
}

template <int Dim>
StabilityLimit ExplicitFlow<Dim>::current_limit(double step) const {
  std::vector<double> speed;
  if (this->has_ergun()) {
    for (const Vector<Dim>& v : scheme_.velocity()) speed.push_back(v.norm());
  }
  constexpr double moved = 1.0 - sure_of_assembled;
  const LiquidProperties& liquid = this->scene().liquid;
  const TimeSettings& time = this->scene().time;
  StabilityLimit limit =
      stability_limit(this->grid(), this->coefficients_, operator_.node_porosity(),
                      liquid.bulk_modulus, time.mass_scaling, time.drag, speed);
  // Where points carry the flow the bound by elements does not hold.
  const PressureIntegration integration = this->scene().flow.integration;
  const bool carried = integration == PressureIntegration::material_point;
  if (!carried && (step <= limit.step || !uses_assembled_limit(this->scene()))) return limit;
  // Not a number at first, which is far from everything.
  if (!(std::abs(limit.step - element_limit_) <= moved * limit.step)) {
    element_limit_ = limit.step;
    assembled_limit_ = assembled_limit(operator_, this->coefficients_, liquid.bulk_modulus,
                                       time.mass_scaling, time.drag, speed, integration);
  }
  const double assembled = sure_of_assembled * assembled_limit_;
  limit.step = carried ? assembled : std::max(limit.step, assembled);
  return limit;
}

template <int Dim>
void ExplicitFlow<Dim>::check_step(double time) {
  const StabilityLimit limit = current_limit(step_);
  if (step_ <= limit.step) return;
  std::ostringstream message;
  message << "the stability limit fell to " << limit.step << " s at t = " << time << " s (element "
          << limit.element << " at ("
          << element_centroid(this->grid().mesh, limit.element).transpose() << "))";
  if (step_given_) {
    message << ", below time.step = " << step_ << " s; take a shorter step or leave it out";
    throw NumericalError(message.str());
  }
  step_ = 0.9 * limit.step;
  message << "; the step is now " << step_ << " s";
  this->warn(message.str());
}

template <int Dim>
FlowProgress<Dim> ExplicitFlow<Dim>::run(const FlowInterval<Dim>& interval) {
  check_step(interval.begin);
  FlowProgress<Dim> progress;
  // A boundary value that turns or jumps begins another interval.
  const std::vector<double>& events = this->boundary_values().events();
  const auto event = std::ranges::upper_bound(events, interval.begin + 1e-9 * step_);
  const double target = event == events.end() ? interval.target : std::min(interval.target, *event);
  const double remaining = target - interval.begin;
  const long to_target =
      std::max(1L, static_cast<long>(std::ceil(remaining / step_ * (1.0 - 1e-12))));
  const double dt = interval.end_on_target ? remaining / static_cast<double>(to_target) : step_;
  const long steps = std::clamp(interval.steps_allowed(dt), 1L, to_target);
  progress.steps = steps;
  progress.dt = dt;
  progress.duration = static_cast<double>(steps) * dt;

  timing_.calls += steps;
  // Round-off must not push a time that a step ends on into the next interval.
  const double reached =
      interval.begin + static_cast<double>(steps) * dt * (1.0 + 1e-12) + 1e-12 * dt;
  const std::vector<double> times = interval.times_until(reached);
  if (carrier_ != nullptr) carrier_->start(progress.duration);
  scheme_.reset_volumes();
  // Steps too short to look at the clock before and after each, unless others come in between.
  std::optional<PassTimer> all_steps;
  if (carrier_ == nullptr) all_steps.emplace(timing_);
  auto next = times.begin();
  for (long s = 0; s < steps; ++s) {
    const double step_begin = interval.begin + static_cast<double>(s) * dt;
    const double step_end =
        s + 1 == steps ? std::numeric_limits<double>::infinity() : step_begin + dt;
    if (carrier_ != nullptr) carrier_->give(step_begin, dt);
    if (next == times.end() || *next > step_end) {
      step(step_begin, dt);
      carry(step_begin, dt);
      continue;
    }
    scheme_.remember_velocity();
    const std::vector<double> pressure = scheme_.pressure();
    const Passed<Dim> before = passed();
    step(step_begin, dt);
    // Flux is constant within a step, so what has passed is linear.
    for (; next != times.end() && *next <= step_end; ++next) {
      const double share = (*next - step_begin) / dt;
      this->take_boundary_values(carrier_ == nullptr ? interval.begin : step_begin, *next);
      FlowState<Dim> moment = moment_of(*next, between(pressure, scheme_.pressure(), share),
                                        scheme_.velocity_at((share - 0.5) * dt));
      moment.dt = dt;
      const Passed<Dim> so_far = between(before, passed(), share);
      moment.flux_in_time.mean = per_time(so_far.volumes.liquid, *next - interval.begin);
      interval.see(std::move(moment), so_far);
    }
    carry(step_begin, dt);
  }
  progress.passed = passed();
  this->take_boundary_values(interval.begin, interval.begin + progress.duration);
  return progress;
}

template <int Dim>
void ExplicitFlow<Dim>::step(double begin, double dt) {
  std::optional<PassTimer> timer;
  if (carrier_ != nullptr) timer.emplace(timing_);
  if (this->boundary_values().vary()) {
    operator_.set_boundary_values(this->boundary_values(), begin, begin + 0.5 * dt);
  }
  scheme_.step(dt);
}

template <int Dim>
void ExplicitFlow<Dim>::carry(double begin, double dt) {
  if (carrier_ == nullptr) return;
  this->take_boundary_values(begin, begin + dt);
  carrier_->take();
}

template <int Dim>
void ExplicitFlow<Dim>::node_flux(VectorField<Dim>& flux) const {
  const VectorField<Dim>& velocity = scheme_.velocity();
  flux.resize(velocity.size());
  for (std::size_t i = 0; i < flux.size(); ++i) {
    flux[i] = operator_.carried_porosity()[i] * velocity[i];
  }
}

template <int Dim>
Passed<Dim> ExplicitFlow<Dim>::passed() const {
  Passed<Dim> result{scheme_.volumes(), scheme_.displacements()};
  for (std::size_t i = 0; i < result.node_shift.size(); ++i) {
    result.node_shift[i] *= operator_.carried_porosity()[i];
  }
  return result;
}

template <int Dim>
FlowState<Dim> ExplicitFlow<Dim>::moment_of(double time, std::vector<double> pressure,
                                            VectorField<Dim> velocity) const {
  FlowState<Dim> result;
  result.time = time;
  result.dt = step_;
  result.node_pressure = this->node_means(pressure);
  result.face_flux.resize(this->grid().face_count());
  for (int f = 0; f < this->grid().face_count(); ++f) {
    result.face_flux[f] = operator_.face_flux(f, velocity);
  }
  result.pressure = std::move(pressure);
  result.velocity = std::move(velocity);
  return result;
}

template <int Dim>
FlowState<Dim> ExplicitFlow<Dim>::moment(double time) const {
  return moment_of(time, scheme_.pressure(), scheme_.velocity());
}

template <int Dim>
void ExplicitFlow<Dim>::follow_masses(double time, const std::vector<double>& water_mass) {
  const LiquidProperties& liquid = this->scene().liquid;
  std::vector<double> pressure(water_mass.size());
  for (std::size_t e = 0; e < pressure.size(); ++e) {
    const double ratio = water_mass[e] / (liquid.density * this->coefficients_.water_volume[e]);
    if (!(ratio > 0.0)) {
      std::ostringstream message;
      message << "element " << e << " at ("
              << element_centroid(this->grid().mesh, static_cast<int>(e)).transpose()
              << ") has no water left at t = " << time << " s";
      throw NumericalError(message.str());
    }
    pressure[e] = pressure_from_density_ratio(ratio, liquid.bulk_modulus);
  }
  scheme_.set_pressure(std::move(pressure));
}

template class ExplicitFlow<2>;

}  // namespace suffuse
