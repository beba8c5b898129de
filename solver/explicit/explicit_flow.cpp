#include "explicit/explicit_flow.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "common/errors.hpp"
#include "explicit/locking.hpp"
#include "explicit/steady_nodal.hpp"
#include "grid/face_flux.hpp"
#include "mixed/mixed_flow.hpp"
#include "physics/liquid.hpp"
#include "results/pass_timer.hpp"

namespace suffuse {
namespace {

/// Most elements: to solve for the steady flow of more takes too long for a warning.
constexpr int max_elements_checked = 100000;

/// Largest number of steps between two couplings.
constexpr long max_steps = 1000;
/// A step that falls below this share of the run goes on falling: the liquid locks.
constexpr double shortest_step = 1e-12;
/// Round-off of sums of steps, as a share of a step.
constexpr double round_off = 1e-12;

ExplicitSettings scheme_settings(const Scene& scene, int threads) {
  ExplicitSettings settings;
  settings.bulk_modulus = scene.liquid.bulk_modulus;
  settings.mass_scaling = scene.time.mass_scaling;
  settings.drag = scene.time.drag;
  settings.porosity_gradient_term = scene.flow.porosity_gradient_term;
  const bool double_point = scene.formulation == Formulation::double_point;
  // Double-point masses move with the points. In mixed integration the term would convect element
  // pressures explicitly, which fails under strong mass scaling, where p is near K.
  settings.pressure_moves_with_liquid = double_point;
  settings.threads = threads;
  return settings;
}

}  // namespace

template <int Dim>
ExplicitFlow<Dim>::ExplicitFlow(const Case<Dim>& c, const Grid<Dim>& grid,
                                const Skeleton<Dim>& solid, const FlowOptions& options)
    : FlowSolver<Dim>(c, grid, solid, options.threads),
      operator_(grid, this->conditions_, this->gravity(),
                this->scene().flow.porosity_gradient_term),
      scheme_(operator_, scheme_settings(this->scene(), options.threads)),
      step_(options.step),
      step_given_(options.step_given) {}

template <int Dim>
void ExplicitFlow<Dim>::update(double time, const PoreState& pores,
                               const std::vector<double>& face_concentration) {
  FlowSolver<Dim>::update(time, pores, face_concentration);
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
  archive(step_, last_steps_, last_dt_, timing_, assembled_limit_, element_limit_);
}

template <int Dim>
void ExplicitFlow<Dim>::start() {
  if (this->scene().initial_flow == InitialFlow::rest) {
    // On several ranks the steady flow of the check is not solved.
    if (this->grid().ranks().count() == 1 &&
        this->grid().mesh.element_count() <= max_elements_checked) {
      warn_of_locking(steady_flow(operator_).velocity);
    }
    scheme_.set_velocity(VectorField<Dim>(this->grid().mesh.node_count(), Vector<Dim>::Zero()));
    scheme_.set_pressure(element_pressure(this->grid(), this->pressure_at_rest(), this->threads()));
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
void ExplicitFlow<Dim>::start_from(const EarlierFlow<Dim>& earlier) {
  scheme_.set_pressure(earlier.state.pressure);
  scheme_.set_velocity(earlier.state.velocity);
}

template <int Dim>
void ExplicitFlow<Dim>::warn_of_locking(const VectorField<Dim>& steady_velocity) {
  if (this->grid().mesh.element_count() > max_elements_checked) return;
  // The mixed elements of the comparison have Darcy's drag only.
  if (!this->scene().flow.porosity_gradient_term || this->has_ergun()) return;
  const auto deviation = deviation_from_mixed_flow(operator_, this->coefficients_, steady_velocity);
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
  const Ranks& ranks = this->grid().ranks();
  constexpr double moved = 1.0 - sure_of_assembled;
  const LiquidProperties& liquid = this->scene().liquid;
  const TimeSettings& time = this->scene().time;
  StabilityLimit limit =
      stability_limit(this->grid(), this->coefficients_, operator_.node_porosity(),
                      liquid.bulk_modulus, time.mass_scaling, time.drag, speed);
  const double least = smallest_of_all(ranks, limit.step);
  if (least != limit.step) limit = {least, -1};
  // If points carry the flow, the bound by elements does not hold.
  const PressureIntegration integration = this->scene().flow.integration;
  const bool carried = integration == PressureIntegration::material_point;
  if (!carried && (step <= limit.step || !uses_assembled_limit(this->scene()))) return limit;
  // `element_limit_` is NaN at first, for which this is true.
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
  const std::string place = limit.element >= 0 ? element_text(this->grid(), limit.element) : "";
  message << "the stability limit fell to " << limit.step << " s at t = " << time << " s ("
          << this->grid().ranks().first_text(place) << ")";
  if (step_given_) {
    message << ", below time.step = " << step_ << " s; take a shorter step or leave it out";
    throw NumericalError(message.str());
  }
  step_ = 0.9 * limit.step;
  if (step_ < shortest_step * this->scene().time.end) {
    message << ": with such steps the run would not end";
    throw NumericalError(message.str());
  }
  message << "; the step is now " << step_ << " s";
  this->warn(message.str());
}

template <int Dim>
FlowStep<Dim> ExplicitFlow<Dim>::solve(const FlowInterval<Dim>& interval) {
  check_step(interval.start);
  const double until = this->next_breakpoint(interval.start, interval.latest);
  const double left = until - interval.start;
  const long to_the_end =
      std::max(1L, static_cast<long>(std::ceil(left / step_ * (1.0 - round_off))));
  // The time left until the latest end is divided evenly.
  FlowStep<Dim> steps{
      .start = interval.start, .dt = left / static_cast<double>(to_the_end), .until = until};
  // The flow may have grown since the last interval: take at most twice its number of steps.
  const long most = std::min({max_steps, 2 * last_steps_, to_the_end});
  const double allowed = interval.longest / steps.dt;
  steps.count =
      allowed < static_cast<double>(most) ? std::max(1L, static_cast<long>(allowed)) : most;
  if (steps.count < to_the_end) steps.until = steps.start_of(steps.count);
  if (carrier_ != nullptr) {
    steps.porosity = interval.pores.at(0.5 * (interval.start + steps.until)).porosity;
  }
  return steps;
}

template <int Dim>
FlowProgress ExplicitFlow<Dim>::commit(FlowStep<Dim> steps) {
  last_steps_ = steps.count;
  last_dt_ = steps.dt;
  scheme_.reset_volumes();
  if (carrier_ != nullptr) {
    take_carried_steps(steps);
  } else {
    const PassTimer timer(timing_);
    for (long s = 0; s < steps.count; ++s) step(steps.start_of(s), steps.dt);
  }
  scheme_.exchange();
  timing_.calls += steps.count;
  this->update_boundary_values(steps.start, steps.until);
  return {steps.count, steps.dt, steps.until, scheme_.volumes()};
}

template <int Dim>
void ExplicitFlow<Dim>::take_carried_steps(const FlowStep<Dim>& steps) {
  carrier_->before_steps(steps.porosity);
  for (long s = 0; s < steps.count; ++s) {
    const double start = steps.start_of(s);
    carrier_->before_step();
    {
      const PassTimer timer(timing_);
      step(start, steps.dt);
    }
    this->update_boundary_values(start, start + steps.dt);
    carrier_->after_step(steps.dt);
  }
}

template <int Dim>
void ExplicitFlow<Dim>::step(double start, double dt) {
  if (this->boundary_values().vary()) {
    operator_.set_boundary_values(this->boundary_values(), start, start + 0.5 * dt);
  }
  scheme_.step(dt);
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
FlowState<Dim> ExplicitFlow<Dim>::state(double time) const {
  FlowState<Dim> result;
  result.time = time;
  result.dt = last_dt_ > 0.0 ? last_dt_ : step_;
  result.pressure = scheme_.pressure();
  result.velocity = scheme_.velocity();
  result.node_pressure = this->node_means(result.pressure);
  result.face_flux.resize(this->grid().face_count());
  for (int f = 0; f < this->grid().face_count(); ++f) {
    result.face_flux[f] = operator_.face_flux(f, result.velocity);
  }
  this->grid().face_rows().exchange(result.face_flux);
  return result;
}

template <int Dim>
void ExplicitFlow<Dim>::match_masses(double time, const std::vector<double>& water_mass) {
  const LiquidProperties& liquid = this->scene().liquid;
  std::vector<double> pressure(water_mass.size());
  together(this->grid().ranks(), [&] {
    for (std::size_t e = 0; e < pressure.size(); ++e) {
      const double ratio = water_mass[e] / (liquid.density * this->coefficients_.water_volume[e]);
      if (!(ratio > 0.0)) this->refuse_dry(static_cast<int>(e), time);
      pressure[e] = pressure_from_density_ratio(ratio, liquid.bulk_modulus);
    }
  });
  scheme_.set_pressure(std::move(pressure));
}

template class ExplicitFlow<2>;

}  // namespace suffuse
