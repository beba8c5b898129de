#include "flow/implicit_flow.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "case/errors.hpp"
#include "grid/face_flux.hpp"
#include "grid/parallel.hpp"
#include "physics/drag.hpp"
#include "physics/liquid.hpp"
#include "results/pass_timer.hpp"

namespace suffuse {
namespace {

/// A step may be so much longer or shorter than the one before.
constexpr double most_growth = 4.0;
/// Where the length alone would change the matrix.
constexpr double worth_a_matrix = 1.5;
constexpr double most_shrinkage = 0.1;
constexpr double safety = 0.85;
/// Water that does not fit its pores is let out over so many steps at least, and no faster than the
/// flow passes through an element: at once, it would be a jump of the flux that no step is too
/// short for.
constexpr double slow_release = 4.0;
/// Of the tolerance: what a kept flow may lack of it before that is mended.
constexpr double mended_share = 0.01;
/// Of the tolerance: how far from steady a flow may be that is kept.
constexpr double kept_share = 0.02;
/// A step never differs from what is left before an event by less than this share of itself.
constexpr double sliver = 1e-9;
/// Of the step that ends on an event: in this, coefficients get where the event makes them jump to.
constexpr double event_share = 1e-2;
/// Boundary values that change within this share of the run over the tolerance jump: in one step,
/// as time has no digits for those that could follow.
constexpr double jump_share = 1e-12;

ImplicitSettings scheme_settings(const Scene& scene, const FlowOptions& options) {
  ImplicitSettings settings;
  settings.bulk_modulus = scene.liquid.bulk_modulus;
  settings.inertia = options.inertia;
  settings.stepping = scene.time.stepping;
  settings.threads = options.threads;
  return settings;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

double largest(const std::vector<double>& values) {
  double result = 0.0;
  for (const double v : values) result = std::max(result, std::abs(v));
  return result;
}

}  // namespace

template <int Dim>
ImplicitFlow<Dim>::ImplicitFlow(const Case<Dim>& c, const Grid<Dim>& grid,
                                const Skeleton<Dim>& solid, const FlowOptions& options)
    : FlowSolver<Dim>(c, grid, solid, options.threads),
      options_(options),
      tolerance_(this->scene().time.tolerance),
      end_(this->scene().time.end),
      scheme_(grid, scheme_settings(this->scene(), options), this->gravity()),
      follows_pores_(options.inertia || this->has_ergun() || this->gravity().norm() > 0.0) {
  for (const Soil& soil : this->scene().soils) {
    follows_pores_ |=
        soil.conductivity_law->depends_on_porosity() || soil.erosion.momentum_transfer;
  }
  for (const FaceCondition& condition : this->conditions_) {
    follows_pores_ |= condition.kind == FaceKind::velocity;
  }
}

template <int Dim>
void ImplicitFlow<Dim>::update(double time, const PoreState& pores,
                               const std::vector<double>& face_concentration) {
  FlowSolver<Dim>::update(time, pores, face_concentration);
  if (expected_) learn_from_expected();
  if (keep_ && !same_resistance(this->coefficients_, kept_coefficients_)) keep_ = false;
}

template <int Dim>
void ImplicitFlow<Dim>::archive(StateArchive& archive) {
  FlowSolver<Dim>::archive(archive);
  scheme_.archive(archive, this->conditions_);
  archive(used_, expected_, density_drift_, joining_);
  archive(now_, pressure_, last_dt_, mending_, next_dt_, before_, at_rest_);
  archive(flux_scale_, knows_flux_scale_, pressure_scale_, lowest_bound_, highest_bound_,
          has_bounds_);
  archive(keep_, kept_coefficients_, mismatch_, outflow_rate_, source_, eos_error_);
  archive(solving_, keeping_, rejected_);
}

template <int Dim>
void ImplicitFlow<Dim>::start() {
  const Grid<Dim>& grid = this->grid();
  const bool stiff = std::isinf(this->scene().liquid.bulk_modulus);
  now_.state.face_pressure.assign(grid.face_count(), 0.0);
  now_.state.velocity.assign(grid.mesh.element_count(), Vector<Dim>::Zero());
  now_.face_flux.assign(grid.face_count(), 0.0);
  now_.flux_through = now_.face_flux;
  for (int f = 0; f < grid.face_count(); ++f) {
    const FaceCondition& condition = this->conditions_[f];
    if (condition.kind == FaceKind::pressure) now_.state.face_pressure[f] = condition.value;
  }
  find_scales();
  // Water without compressibility and inertia has no start-up: it flows at once.
  const bool at_once = stiff && !options_.inertia;
  if (this->scene().initial_flow == InitialFlow::steady || at_once) {
    MixedStep<Dim> steady = scheme_.steady({this->coefficients_, this->conditions_, {}});
    now_ = {std::move(steady.end), steady.face_flux, steady.flux_through};
    at_rest_ = false;
  }
  pressure_ = element_means(now_.state.face_pressure);
  const auto [low, high] =
      std::minmax_element(now_.state.face_pressure.begin(), now_.state.face_pressure.end());
  if (!at_once) {
    lowest_bound_ = std::min(lowest_bound_, *low);
    highest_bound_ = std::max(highest_bound_, *high);
  }
  pressure_scale_ = std::max(pressure_scale_, *high - *low);
  flux_scale_ = std::max(flux_scale_, largest(now_.face_flux));
  raise_scales_over_round_off();
  warn_of_obtuse_angles();

  if (options_.step_given) {
    next_dt_ = options_.step;
  } else if (!at_rest_) {
    next_dt_ = 1e-2 * end_;
  } else {
    // Short against everything that can happen at first, so that the flow it gives is the one right
    // after the start.
    double fastest = 0.0;
    const LiquidProperties& liquid = this->scene().liquid;
    for (int e = 0; e < grid.mesh.element_count(); ++e) {
      const double resistance = this->coefficients_.drag[e] / this->coefficients_.porosity[e];
      double size = 0.0;
      for (const Vector<Dim>& g : grid.shape_gradient[e]) size = std::max(size, g.norm());
      const double relaxation =
          this->coefficients_.mixture_density[e] / this->coefficients_.drag[e];
      const double diffusivity =
          liquid.bulk_modulus * grid.volume[e] / (resistance * this->coefficients_.water_volume[e]);
      if (options_.inertia) {
        fastest = std::max(fastest, 1.0 / relaxation);
        if (std::isfinite(diffusivity)) {
          fastest = std::max(fastest, std::sqrt(diffusivity / relaxation) * size);
        }
      } else if (std::isfinite(diffusivity)) {
        fastest = std::max(fastest, diffusivity * size * size);
      }
    }
    next_dt_ = fastest > 0.0 ? std::min(1e-2 / fastest, 1e-2 * end_) : 1e-2 * end_;
  }
}

template <int Dim>
void ImplicitFlow<Dim>::find_scales() {
  // The fluxes and pressures that the boundary conditions can drive, now and at each of their
  // kinks: errors are relative to the largest.
  const BoundaryValues<Dim>& values = this->boundary_values();
  std::vector<double> times{0.0};
  if (values.vary()) {
    times.insert(times.end(), values.events().begin(), values.events().end());
    times.push_back(end_);
  }
  bool prescribes = false;
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const double time : times) {
    FlowForcing<Dim> forcing{this->coefficients_, this->conditions_, {}};
    values.update(time, forcing.conditions);
    for (const FaceCondition& condition : forcing.conditions) {
      if (condition.kind == FaceKind::pressure) {
        low = std::min(low, condition.value);
        high = std::max(high, condition.value);
      }
      prescribes |= condition.fixes_flux() && condition.value != 0.0;
    }
    try {
      const MixedStep<Dim> steady = scheme_.steady(forcing);
      flux_scale_ = std::max(flux_scale_, largest(steady.face_flux));
      const auto [least, most] =
          std::minmax_element(steady.end.face_pressure.begin(), steady.end.face_pressure.end());
      pressure_scale_ = std::max(pressure_scale_, *most - *least);
    } catch (const NumericalError&) {
      // Boundaries that prescribe fluxes alone may have no steady flow: then the flow itself sets
      // the scales as it goes.
    }
  }
  const bool heavy = this->gravity().norm() > 0.0;
  has_bounds_ = low <= high && !prescribes && !heavy;
  lowest_bound_ = low;
  highest_bound_ = high;
  if (low <= high) pressure_scale_ = std::max(pressure_scale_, high - low);
}

template <int Dim>
void ImplicitFlow<Dim>::raise_scales_over_round_off() {
  // Water at rest flows by round-off, and no step is short enough for the relative error of that: a
  // billionth of the pressure of water as high as the model, of the flux that drives, and of an
  // element's water in the whole run, are nothing.
  constexpr double nothing = 1e-9;
  const Grid<Dim>& grid = this->grid();
  const LiquidProperties& liquid = this->scene().liquid;
  Vector<Dim> low = grid.mesh.nodes.front();
  Vector<Dim> high = low;
  for (const Vector<Dim>& x : grid.mesh.nodes) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  double pressure = nothing * liquid.density * conductivity_gravity * (high - low).norm();
  if (std::isfinite(liquid.bulk_modulus)) {
    // The equation of state has so many digits.
    pressure = std::max(pressure, 1e-12 * liquid.bulk_modulus);
  }
  double flux = 0.0;
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    double steepest = 0.0;
    for (const Vector<Dim>& g : grid.shape_gradient[e]) steepest = std::max(steepest, g.norm());
    const double mobility = this->coefficients_.porosity[e] / this->coefficients_.drag[e];
    flux = std::max({flux, mobility * pressure * grid.volume[e] * steepest * steepest,
                     nothing * this->coefficients_.water_volume[e] / end_});
  }
  pressure_scale_ = std::max(pressure_scale_, pressure);
  knows_flux_scale_ = flux_scale_ > flux;
  flux_scale_ = std::max(flux_scale_, flux);
}

template <int Dim>
void ImplicitFlow<Dim>::warn_of_obtuse_angles() {
  constexpr double strong_contrast = 100.0;
  const Grid<Dim>& grid = this->grid();
  int obtuse = 0;
  double least = std::numeric_limits<double>::infinity();
  double most = 0.0;
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    double widest = 0.0;
    for (int a = 0; a <= Dim; ++a) {
      for (int b = 0; b < a; ++b) {
        const auto& g = grid.shape_gradient[e];
        widest = std::max(widest, g[a].dot(g[b]) / (g[a].norm() * g[b].norm()));
      }
    }
    if (widest > 1e-9) ++obtuse;
    const double resistance = this->coefficients_.drag[e] / this->coefficients_.porosity[e];
    least = std::min(least, resistance);
    most = std::max(most, resistance);
  }
  if (obtuse == 0 || most < strong_contrast * least) return;
  std::ostringstream message;
  message.precision(3);
  message
      << obtuse << " of " << grid.mesh.element_count()
      << " elements have obtuse angles, and conductivities differ by a factor of " << most / least
      << ": pressures may leave the range of their boundary values; history.csv has by how much "
         "(pressure_overshoot)";
  this->warn(message.str());
}

template <int Dim>
void ImplicitFlow<Dim>::find_forcing(const FlowInterval<Dim>& interval, double time,
                                     FlowForcing<Dim>& forcing) const {
  if (follows_pores_) {
    forcing.coefficients = coefficients_at(interval, time);
  } else {
    forcing.coefficients = this->coefficients_;
  }
  join_to_last_step(interval.begin, time, forcing.coefficients);
  if (forcing.conditions.empty()) forcing.conditions = this->conditions_;
  this->boundary_values().update(time, forcing.conditions);
}

template <int Dim>
void ImplicitFlow<Dim>::join_to_last_step(double begin, double time,
                                          FlowCoefficients<Dim>& coefficients) const {
  // What drifts is liquid all the same, no lighter and no heavier than what it consists of.
  const auto [lightest, heaviest] =
      std::minmax(this->scene().liquid.density, this->scene().soils.front().grain_density);
  for (std::size_t e = 0; e < density_drift_.size(); ++e) {
    double& density = coefficients.mixture_density[e];
    density = std::clamp(density + density_drift_[e] * (time - begin), lightest, heaviest);
  }
  const double share = 1.0 - (time - begin) / joining_;
  if (options_.step_given || used_.porosity.empty() || !(share > 0.0)) return;
  const FlowCoefficients<Dim>& now = this->coefficients_;
  const auto join = [&](const std::vector<double>& before, const std::vector<double>& after,
                        std::vector<double>& values) {
    for (std::size_t e = 0; e < values.size(); ++e) {
      if (after[e] > 0.0) values[e] *= 1.0 + share * (before[e] / after[e] - 1.0);
    }
  };
  join(used_.water_volume, now.water_volume, coefficients.water_volume);
  if (!follows_pores_) return;
  join(used_.mixture_density, now.mixture_density, coefficients.mixture_density);
  join(used_.porosity, now.porosity, coefficients.porosity);
  join(used_.drag, now.drag, coefficients.drag);
  join(used_.quadratic_drag, now.quadratic_drag, coefficients.quadratic_drag);
}

template <int Dim>
FlowCoefficients<Dim> ImplicitFlow<Dim>::coefficients_at(const FlowInterval<Dim>& interval,
                                                         double time) const {
  // What an event at the end of a step begins or ends is not yet to be seen.
  const double before = time - sliver * (time - interval.begin);
  return this->coefficients_of(before, interval.pores.at(before),
                               this->coefficients_.face_concentration);
}

template <int Dim>
void ImplicitFlow<Dim>::learn_from_expected() {
  const FlowCoefficients<Dim>& now = this->coefficients_;
  double off = 0.0;
  density_drift_.resize(now.drag.size(), 0.0);
  // Points that cross from element to element make densities scatter: a drift is what lasts.
  const bool scattered = this->scene().formulation == Formulation::double_point;
  const double weight = scattered ? last_dt_ / (last_dt_ + time_through_an_element()) : 1.0;
  for (std::size_t e = 0; e < now.drag.size(); ++e) {
    const double drift = (now.mixture_density[e] - expected_->mixture_density[e]) / last_dt_;
    density_drift_[e] += weight * (drift - density_drift_[e]);
    const double resistance = expected_->drag[e] / expected_->porosity[e];
    off = std::max(off, std::abs(resistance * now.porosity[e] / now.drag[e] - 1.0));
  }
  expected_.reset();
  if (options_.step_given) return;
  // They were right at the begin: what they lack on the mean is half of it.
  const double error = 0.5 * off / tolerance_;
  if (error > 1.0) {
    const double share = std::max(safety * std::pow(error, -0.5), most_shrinkage);
    next_dt_ = std::min(next_dt_, share * last_dt_);
  }
}

template <int Dim>
bool ImplicitFlow<Dim>::jumps(double begin, double dt) const {
  if (!(dt <= jump_share * end_ / tolerance_)) return false;
  const auto& knots = this->boundary_values().events();
  const auto is_knot = [&](double time) {
    return std::any_of(knots.begin(), knots.end(),
                       [&](double knot) { return is_same_time(knot, time); });
  };
  return is_knot(begin) && is_knot(begin + dt);
}

template <int Dim>
double ImplicitFlow<Dim>::length_of_step(double begin, double until, double longest) const {
  const double left = until - begin;
  if (options_.step_given) {
    // The given step is the longest one: what is left is divided evenly.
    return left / std::max(1.0, std::ceil(left / options_.step * (1.0 - sliver)));
  }
  if (jumps(begin, left)) return left;
  double dt = std::min(next_dt_, longest);
  // No sliver before the end: two halves are better than nine tenths and one.
  if (dt < left && left < 2.0 * dt) dt = 0.5 * left;
  return dt * (1.0 + sliver) >= left ? left : dt;
}

template <int Dim>
double ImplicitFlow<Dim>::error_of(const MixedStep<Dim>& step, double dt) const {
  const double flux_scale = std::max(flux_scale_, largest(step.flux_through));
  const double ahead = before_ ? dt / last_dt_ : 0.0;
  const auto farthest_from_predicted = [&](const auto& values, const auto& now,
                                           const std::vector<double>* before) {
    return largest_of(this->grid().face_count(), this->threads(), 0.0, [&](int f) {
      const double predicted = before ? now[f] + ahead * (now[f] - (*before)[f]) : now[f];
      return std::abs(values[f] - predicted);
    });
  };
  const double flux_error = farthest_from_predicted(step.flux_through, now_.flux_through,
                                                    before_ ? &before_->flux_through : nullptr);
  const double pressure_error =
      farthest_from_predicted(step.end.face_pressure, now_.state.face_pressure,
                              before_ ? &before_->state.face_pressure : nullptr);
  double error = flux_scale > 0.0 ? flux_error / flux_scale : 0.0;
  if (pressure_scale_ > 0.0) {
    error = std::max(error, pressure_error / pressure_scale_);
  }
  // What swings to and fro within the time that nobody notices moves next to nothing.
  const double weight = dt / (dt + options_.unnoticed);
  // The prediction's own error, of one order less than the step's, is what this measures.
  return 0.5 * weight * error / tolerance_;
}

template <int Dim>
double ImplicitFlow<Dim>::time_through_an_element() const {
  const std::vector<double>& water = this->coefficients_.water_volume;
  return *std::min_element(water.begin(), water.end()) / largest(now_.face_flux);
}

template <int Dim>
std::vector<double> ImplicitFlow<Dim>::source_with(double dt) const {
  std::vector<double> source = outflow_rate_;
  const double rate = 1.0 / std::max(slow_release * dt, time_through_an_element());
  for (std::size_t e = 0; e < mismatch_.size(); ++e) source[e] += rate * mismatch_[e];
  return source;
}

template <int Dim>
MixedStep<Dim> ImplicitFlow<Dim>::accepted_step(const FlowInterval<Dim>& interval, double& dt) {
  const std::vector<double> shares = scheme_.stages();
  bool cut_short = true;  // by an event or by transport, if at all
  for (;;) {
    forcing_.resize(shares.size());
    std::vector<const FlowForcing<Dim>*> views;
    for (std::size_t stage = 0; stage < shares.size(); ++stage) {
      FlowForcing<Dim>& forcing = forcing_[stage];
      find_forcing(interval, interval.begin + shares[stage] * dt, forcing);
      views.push_back(&forcing);
      if (mismatch_.empty()) continue;
      // Shorter steps change it by less: else it would be a jump that no step is too short for.
      forcing.source = between(source_, source_with(dt), std::min(1.0, dt / mending_));
    }
    MixedStep<Dim> step = scheme_.step(now_.state, dt, views);
    ++solving_.calls;
    const auto accepted = [&] {
      if (!mismatch_.empty()) source_ = forcing_.back().source;
      used_ = forcing_.back().coefficients;
      if (follows_pores_) expected_ = coefficients_at(interval, interval.begin + dt);
      return std::move(step);
    };
    if (options_.step_given) return accepted();
    // From rest, and where boundary values jump, what was before tells nothing.
    const bool told = !(at_rest_ && last_dt_ == 0.0) && !jumps(interval.begin, dt);
    const double error = told ? error_of(step, dt) : 0.0;
    const double order = (before_ ? 2.0 : 1.0) + options_.unnoticed / (dt + options_.unnoticed);
    const double wanted = error > 0.0 ? safety * std::pow(error, -1.0 / order) : most_growth;
    if (error <= 1.0) {
      // That it was cut short by others says nothing against a longer one.
      double next = dt * std::clamp(wanted, most_shrinkage, most_growth);
      // A step of another length is another matrix, which is not worth a little of length.
      if (!follows_pores_ && wanted >= 1.0 && wanted < worth_a_matrix) next = dt;
      next_dt_ = cut_short && wanted >= 1.0 ? std::max(next, next_dt_) : next;
      return accepted();
    }
    ++rejected_;
    cut_short = false;
    dt *= std::clamp(wanted, most_shrinkage, 0.9);
    if (!(dt > 1e-14 * interval.begin) || dt < 1e-20 * end_) {
      std::ostringstream message;
      message << "no step is short enough for time.tolerance = " << tolerance_
              << " at t = " << interval.begin
              << " s: something that drives or resists the flow changes at once; take a larger "
                 "tolerance or give time.step";
      throw NumericalError(message.str());
    }
  }
}

template <int Dim>
MixedStep<Dim> ImplicitFlow<Dim>::kept(double dt) const {
  MixedStep<Dim> step{now_.state, now_.face_flux, now_.face_flux, now_.face_flux};
  for (double& volume : step.face_volume) volume *= dt;
  return step;
}

template <int Dim>
FaceVolumes ImplicitFlow<Dim>::volumes_of(const MixedStep<Dim>& step) const {
  const Grid<Dim>& grid = this->grid();
  const double modulus = this->scene().liquid.bulk_modulus;
  FaceVolumes result{step.face_volume, std::vector<double>(grid.face_count(), 0.0)};
  if (std::isinf(modulus)) return result;
  const std::vector<double> end = element_means(step.end.face_pressure);
  for_each_index(grid.face_count(), this->threads(), [&](int f) {
    const double volume = step.face_volume[f];
    const int from = volume < 0.0 ? grid.face_right[f] : grid.face_left[f];
    const double upwind = from >= 0
                              ? 0.5 * (pressure_[from] + end[from])
                              : 0.5 * (now_.state.face_pressure[f] + step.end.face_pressure[f]);
    result.density_excess[f] = volume * std::expm1(upwind / modulus);
  });
  return result;
}

template <int Dim>
void ImplicitFlow<Dim>::remember(MixedStep<Dim> step, double dt) {
  Point next{std::move(step.end), std::move(step.face_flux), std::move(step.flux_through)};
  // A passing peak, as at a start from rest, is no measure of what follows where one is known.
  if (!knows_flux_scale_) flux_scale_ = std::max(flux_scale_, largest(next.flux_through));
  const auto [low, high] =
      std::minmax_element(next.state.face_pressure.begin(), next.state.face_pressure.end());
  pressure_scale_ = std::max(pressure_scale_, *high - *low);
  before_ = std::move(now_);
  now_ = std::move(next);
  pressure_ = element_means(now_.state.face_pressure);
  last_dt_ = dt;
  // Were it the last step, which may have become short because of what it has to join, shorter
  // steps would follow for ever.
  for (double* time : {&joining_, &mending_}) *time = std::max(dt, *time - 0.5 * dt);
}

template <int Dim>
FlowProgress ImplicitFlow<Dim>::advance(const FlowInterval<Dim>& interval) {
  const double until = this->next_breakpoint(interval.begin, interval.latest);
  const double left = until - interval.begin;
  double dt = length_of_step(interval.begin, until, interval.longest);
  // The first step from rest gives the flow right after the start: what was before tells nothing.
  const bool leaves_rest = at_rest_;
  MixedStep<Dim> step;
  if (keep_) {
    const PassTimer timer(keeping_);
    ++keeping_.calls;
    step = kept(dt);
    if (!options_.step_given) next_dt_ = std::max(next_dt_, most_growth * dt);
  } else {
    const PassTimer timer(solving_);
    step = accepted_step(interval, dt);
  }
  FlowProgress progress{1, dt, dt < left ? interval.begin + dt : until, volumes_of(step)};

  remember(std::move(step), dt);
  if (leaves_rest) before_.reset();
  at_rest_ = false;
  this->take_boundary_values(interval.begin, progress.end);
  meet_breakpoint(progress.end, dt);
  return progress;
}

template <int Dim>
void ImplicitFlow<Dim>::meet_breakpoint(double time, double dt) {
  const auto is_now = [time](double other) { return is_same_time(other, time); };
  if (std::ranges::none_of(this->breakpoints(), is_now)) {
    if (keep_) return;
    const PassTimer timer(solving_);
    keep_if_steady(time);
    return;
  }
  // A kink: what was before tells nothing of what comes.
  if (!keep_) before_.reset();
  // Soil that begins to erode may resist at once (momentum_transfer).
  if (follows_pores_) joining_ = std::min(joining_, event_share * dt);
  const bool boundary_kink = std::ranges::any_of(this->boundary_values().events(), is_now);
  // Where erosion starts the kept flow still looks right, and is not.
  if (boundary_kink || follows_pores_ || this->gravity().norm() > 0.0) keep_ = false;
}

template <int Dim>
bool ImplicitFlow<Dim>::same_resistance(const FlowCoefficients<Dim>& a,
                                        const FlowCoefficients<Dim>& b) const {
  constexpr double round_off = 1e-12;
  const bool heavy = this->gravity().norm() > 0.0;
  const auto same = [](double x, double y) { return std::abs(x - y) <= round_off * std::abs(y); };
  const bool prescribes_velocity =
      std::any_of(this->conditions_.begin(), this->conditions_.end(),
                  [](const FaceCondition& c) { return c.kind == FaceKind::velocity; });
  for (std::size_t e = 0; e < a.drag.size(); ++e) {
    if (!same(a.drag[e] / a.porosity[e], b.drag[e] / b.porosity[e])) return false;
    if (heavy && !same(a.mixture_density[e], b.mixture_density[e])) return false;
    if (prescribes_velocity && !same(a.porosity[e], b.porosity[e])) return false;
    if (!a.quadratic_drag.empty() && !same(a.quadratic_drag[e], b.quadratic_drag[e])) return false;
  }
  return true;
}

template <int Dim>
void ImplicitFlow<Dim>::keep_if_steady(double time) {
  if (!options_.reuse_steady || !before_) return;
  // Sealed water is steady only while nothing disturbs it, its own round-off included.
  const bool open = std::any_of(this->conditions_.begin(), this->conditions_.end(),
                                [](const auto& c) { return c.kind == FaceKind::pressure; });
  if (!open && std::isfinite(this->scene().liquid.bulk_modulus)) return;
  const double close = kept_share * tolerance_;
  if (largest_difference(now_.face_flux, before_->face_flux) > close * flux_scale_) return;
  // Between two kinks boundary values are linear: different at their ends means they are moving.
  const BoundaryValues<Dim>& values = this->boundary_values();
  if (values.vary()) {
    std::vector<FaceCondition> later = this->conditions_;
    const auto next =
        std::upper_bound(values.events().begin(), values.events().end(), time * (1.0 + 1e-14));
    values.update(next != values.events().end() ? *next : end_, later);
    for (std::size_t f = 0; f < later.size(); ++f) {
      if (later[f].value != this->conditions_[f].value) return;
    }
  }
  MixedStep<Dim> steady;
  try {
    steady = scheme_.steady({this->coefficients_, this->conditions_, source_});
  } catch (const NumericalError&) {
    return;  // Fluxes that do not balance have no steady flow.
  }
  if (largest_difference(now_.face_flux, steady.face_flux) > close * flux_scale_) return;
  if (largest_difference(now_.state.face_pressure, steady.end.face_pressure) >
      close * pressure_scale_) {
    return;
  }
  keep_ = true;
  now_ = {std::move(steady.end), steady.face_flux, steady.flux_through};
  used_ = this->coefficients_;
  pressure_ = element_means(now_.state.face_pressure);
  kept_coefficients_ = this->coefficients_;
}

template <int Dim>
void ImplicitFlow<Dim>::mend_kept() {
  std::vector<double> source = source_with(last_dt_);
  // What all elements let out may come together at one face.
  double together = 0.0;
  for (std::size_t e = 0; e < source.size(); ++e) together += std::abs(source[e] - source_[e]);
  if (together <= mended_share * tolerance_ * flux_scale_) return;
  MixedStep<Dim> steady = scheme_.steady({this->coefficients_, this->conditions_, source});
  if (largest_difference(now_.face_flux, steady.face_flux) >
      kept_share * tolerance_ * flux_scale_) {
    // More than may be missing at once: the flow is on its way again and has to be followed.
    keep_ = false;
    return;
  }
  source_ = std::move(source);
  now_ = {std::move(steady.end), steady.face_flux, steady.flux_through};
}

template <int Dim>
void ImplicitFlow<Dim>::match_masses(double time, const std::vector<double>& water_mass) {
  const LiquidProperties& liquid = this->scene().liquid;
  const std::size_t elements = water_mass.size();
  const bool stiff = std::isinf(liquid.bulk_modulus);
  std::vector<double> mismatch(elements);
  eos_error_ = 0.0;
  for (std::size_t e = 0; e < elements; ++e) {
    const double volume = this->coefficients_.water_volume[e];
    const double fills =
        water_mass[e] / (liquid.density * density_ratio(pressure_[e], liquid.bulk_modulus));
    if (!(fills > 0.0)) {
      std::ostringstream message;
      message << "element " << e << " at ("
              << element_centroid(this->grid().mesh, static_cast<int>(e)).transpose()
              << ") has no water left at t = " << time << " s";
      throw NumericalError(message.str());
    }
    mismatch[e] = fills - volume;
    eos_error_ = std::max(eos_error_, std::abs(mismatch[e]) / volume);
  }
  // Water without compressibility fits by construction; its round-off has nowhere to go.
  if (stiff) return;
  // What the step made is what it would make again: let out as it comes. The rest later. Over short
  // steps round-off would be a large rate.
  if (outflow_rate_.empty()) outflow_rate_.assign(elements, 0.0);
  if (source_.empty()) source_.assign(elements, 0.0);
  if (last_dt_ > 0.0 && !mismatch_.empty()) {
    for (std::size_t e = 0; e < elements; ++e) {
      const double growth = mismatch[e] - mismatch_[e];
      const double digits = 16.0 * std::numeric_limits<double>::epsilon() *
                            (this->coefficients_.water_volume[e] + std::abs(mismatch[e]));
      const double certain = std::copysign(std::max(0.0, std::abs(growth) - digits), growth);
      outflow_rate_[e] = certain / mending_ + source_[e];
    }
  }
  mismatch_ = std::move(mismatch);
  if (keep_) mend_kept();
}

template <int Dim>
std::vector<double> ImplicitFlow<Dim>::element_means(
    const std::vector<double>& face_pressure) const {
  const Grid<Dim>& grid = this->grid();
  std::vector<double> result(grid.mesh.element_count(), 0.0);
  for_each_index(grid.mesh.element_count(), this->threads(), [&](int e) {
    for (const int f : grid.element_face[e]) result[e] += face_pressure[f] / (Dim + 1);
  });
  return result;
}

template <int Dim>
double ImplicitFlow<Dim>::overshoot(const std::vector<double>& face_pressure) const {
  if (!has_bounds_ || pressure_scale_ == 0.0) return 0.0;
  const auto [low, high] = std::minmax_element(face_pressure.begin(), face_pressure.end());
  return std::max({0.0, *high - highest_bound_, lowest_bound_ - *low}) / pressure_scale_;
}

template <int Dim>
FlowState<Dim> ImplicitFlow<Dim>::state(double time) const {
  const Grid<Dim>& grid = this->grid();
  FlowState<Dim> result;
  result.time = time;
  result.dt = last_dt_ > 0.0 ? last_dt_ : next_dt_;
  result.pressure = pressure_;
  result.face_flux = now_.face_flux;
  result.eos_error = eos_error_;
  result.pressure_overshoot = overshoot(now_.state.face_pressure);
  // Nodes: what the linear fields of the elements around have there, on the mean.
  result.node_pressure.assign(grid.mesh.node_count(), 0.0);
  result.velocity.assign(grid.mesh.node_count(), Vector<Dim>::Zero());
  const std::vector<Vector<Dim>> flux = element_flux(grid, now_.face_flux);
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    for (int k = 0; k <= Dim; ++k) {
      const int i = grid.mesh.elements[e][k];
      const double weight = grid.volume[e] / (Dim + 1) / grid.node_volume[i];
      const double at_vertex =
          (Dim + 1) * pressure_[e] - Dim * now_.state.face_pressure[grid.element_face[e][k]];
      result.node_pressure[i] += weight * at_vertex;
      result.velocity[i] += weight / this->coefficients_.porosity[e] * flux[e];
    }
  }
  this->prescribe_at_nodes(result.node_pressure);
  return result;
}

template <int Dim>
std::vector<PassTiming> ImplicitFlow<Dim>::passes() const {
  const SolveCounts counts = scheme_.counts();
  return {solving_,
          {"flow, rejected steps", rejected_, 0.0},
          {"flow, matrices factored", counts.factorisations, 0.0},
          {"flow, conjugate gradients", counts.iterations, 0.0},
          keeping_};
}

template class ImplicitFlow<2>;

}  // namespace suffuse
