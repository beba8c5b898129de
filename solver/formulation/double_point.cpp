#include "formulation/double_point.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "case/errors.hpp"
#include "flow/extrapolated_flux.hpp"
#include "formulation/coupling.hpp"
#include "grid/face_flux.hpp"
#include "physics/liquid.hpp"
#include "results/pass_timer.hpp"

namespace suffuse {
namespace {

/// Relative growth of porosity in which the flow may still use the porosity from before it.
constexpr double most_growth_lagrangian = 1e-3;
/// Steps of transport between two meetings with a flow that could go further: whoever looks in
/// between has them done again, once.
constexpr double most_lagrangian_steps = 4.0;
/// Of the density of the liquid, between elements.
constexpr int smoothing_rounds = 4;
/// Liquid that needs more steps of transport than this between two meetings goes nowhere sensible.
constexpr double most_substeps = 1e4;

}  // namespace

template <int Dim>
DoublePoint<Dim>::DoublePoint(const Case<Dim>& c, const Plan& plan)
    : case_(c),
      plan_(plan),
      grid_(c.mesh),
      skeleton_(c, grid_),
      flow_(make_flow(c, grid_, skeleton_, plan.flow)),
      carried_flow_(c.document.scene.flow.integration == PressureIntegration::material_point
                        ? dynamic_cast<ExplicitFlow<Dim>*>(flow_.get())
                        : nullptr),
      accounts_(grid_),
      densities_{c.document.scene.liquid.density, c.document.scene.soils.front().grain_density},
      transport_(grid_, flow_->conditions(), birth_settings(), densities_,
                 c.document.scene.liquid.bulk_modulus, plan.flow.threads),
      transfer_(grid_, skeleton_, densities_.grain) {
  initialise();
}

template <int Dim>
InjectionSettings DoublePoint<Dim>::birth_settings() const {
  std::vector<double> volume(grid_.mesh.element_count(), 0.0);
  std::vector<int> count(grid_.mesh.element_count(), 0);
  const MaterialPoints<Dim>& points = case_.liquid_points;
  for (int p = 0; p < points.size(); ++p) {
    volume[points.element[p]] += points.volume[p];
    ++count[points.element[p]];
  }
  InjectionSettings result;
  result.random = case_.document.scene.points.seeding == Seeding::random;
  result.seed = case_.document.scene.points.seed;
  for (const int e : grid_.face_left) {
    result.point_volume.push_back(volume[e] / count[e]);
    result.points_per_element.push_back(count[e]);
  }
  return result;
}

template <int Dim>
void DoublePoint<Dim>::initialise() {
  for (const ElementValues<Dim>& pores : skeleton_.initial_pore_volume()) {
    initial_pores_.push_back(element_sum<Dim>(pores));
  }
  state_.porosity = skeleton_.initial_porosity();
  bends_ = bends_of_porosity();
  state_.pending.assign(grid_.mesh.node_count(), 0.0);
  state_.crossed.resize(accounts_.count());
  last_motion_ = {VectorField<Dim>(grid_.mesh.node_count(), Vector<Dim>::Zero()),
                  std::vector<double>(grid_.face_count(), 0.0), 1.0};
  update_flow();
  flow_->start();
  last_motion_.entered = end_rate_ = flow_->moment(0.0).face_flux;
  place_liquid();
  initial_ = stored(state_);
  if (carried_flow_ != nullptr) {
    carried_ = std::make_unique<CarriedLiquid<Dim>>(grid_, *carried_flow_, transport_, densities_,
                                                    plan_.flow.threads, state_.entering);
    carried_->blocks().fill(state_.liquid, grid_.mesh.element_count());
    carried_->on_start = [this](double duration) { start_carried(duration); };
    carried_->on_moved = [this](const auto& crossings) { book_carried(crossings); };
  }
  update_flow();
}

template <int Dim>
void DoublePoint<Dim>::archive(StateArchive& archive) {
  // Points that carry the flow are elsewhere; here they are a copy, if somebody asked.
  if (carried_ != nullptr) state_.liquid = {};
  archive(state_, *flow_, last_dt_, last_motion_, end_rate_, last_steps_, steps_, timings_);
  if (carried_ != nullptr) archive(*carried_);
}

template <int Dim>
void DoublePoint<Dim>::place_liquid() {
  const MaterialPoints<Dim>& points = case_.liquid_points;
  LiquidPoints<Dim>& liquid = state_.liquid;
  liquid.reserve(points.size());
  liquid.element = points.element;
  liquid.barycentric = points.barycentric;
  liquid.fines_mass.assign(points.size(), 0.0);
  const double modulus = case_.document.scene.liquid.bulk_modulus;
  const std::vector<double>& pressure = flow_->pressure();
  for (int p = 0; p < points.size(); ++p) {
    const int e = points.element[p];
    liquid.id.push_back(p);
    liquid.water_mass.push_back(densities_.water * density_ratio(pressure[e], modulus) *
                                points.volume[p]);
    if (carried_flow_ == nullptr) continue;
    Vector<Dim> velocity = Vector<Dim>::Zero();
    for (int a = 0; a <= Dim; ++a) {
      velocity +=
          points.barycentric[p][a] * carried_flow_->scheme().velocity()[grid_.mesh.elements[e][a]];
    }
    liquid.pressure.push_back(pressure[e]);
    liquid.velocity.push_back(velocity);
  }
  state_.entering = transport_.nothing_entered(points.size());
}

template <int Dim>
std::vector<double> DoublePoint<Dim>::element_porosity(const std::vector<double>& porosity) const {
  std::vector<double> result = initial_pores_;
  const MaterialPoints<Dim>& solid = skeleton_.points();
  for (int s = 0; s < solid.size(); ++s) {
    result[solid.element[s]] += solid.volume[s] * (porosity[s] - skeleton_.initial_porosity()[s]);
  }
  for (int e = 0; e < grid_.mesh.element_count(); ++e) result[e] /= grid_.volume[e];
  return result;
}

template <int Dim>
std::vector<double> DoublePoint<Dim>::point_volumes(const LiquidPoints<Dim>& liquid,
                                                    const std::vector<double>& pressure) const {
  const double modulus = case_.document.scene.liquid.bulk_modulus;
  std::vector<double> result(liquid.size());
  int ratio_of = -1;
  double ratio = 1.0;
  for (int p = 0; p < liquid.size(); ++p) {
    if (carried_flow_ != nullptr) {
      ratio = density_ratio(liquid.pressure[p], modulus);
    } else if (liquid.element[p] != ratio_of) {
      ratio_of = liquid.element[p];
      ratio = density_ratio(pressure[ratio_of], modulus);
    }
    result[p] = liquid_volume(liquid.water_mass[p], liquid.fines_mass[p], densities_, ratio);
  }
  return result;
}

template <int Dim>
auto DoublePoint<Dim>::liquid_content() const -> LiquidContent {
  const int elements = grid_.mesh.element_count();
  LiquidContent content{std::vector<double>(elements, 0.0), std::vector<double>(elements, 0.0)};
  const auto add = [&](int e, double water_mass, double fines_mass) {
    content.grains[e] += fines_mass / densities_.grain;
    content.liquid[e] += liquid_volume(water_mass, fines_mass, densities_, 1.0);
  };
  if (carried_ != nullptr) {
    const PointBlocks<Dim>& points = carried_->blocks();
    for (int e = 0; e < elements; ++e) {
      for (int slot = 0; slot < points.count(e); ++slot) {
        add(e, points.water_mass(e, slot), points.fines_mass(e, slot));
      }
    }
    return content;
  }
  const LiquidPoints<Dim>& points = state_.liquid;
  for (int p = 0; p < points.size(); ++p) {
    add(points.element[p], points.water_mass[p], points.fines_mass[p]);
  }
  return content;
}

template <int Dim>
PoreState DoublePoint<Dim>::pores() const {
  const auto [grains, volume] = liquid_content();
  PoreState content;
  content.porosity = element_porosity(state_.porosity);
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    content.concentration.push_back(volume[e] > 0.0 ? grains[e] / volume[e] : 0.0);
    content.water_volume.push_back(content.porosity[e] * grid_.volume[e] *
                                   (1.0 - content.concentration[e]));
  }
  const Scene& scene = case_.document.scene;
  const bool heavy =
      std::any_of(scene.gravity.begin(), scene.gravity.end(), [](double g) { return g != 0.0; });
  if (heavy && scene.time.scheme == FlowScheme::implicit_mixed) {
    content.concentration = weighed_concentration(content.concentration, volume);
  }
  if (skeleton_.erodes_by_flux()) {
    for (const Vector<Dim>& q : element_flux(grid_, last_motion_.entered)) {
      content.flux.push_back(q.norm() / last_motion_.duration);
    }
  }
  return content;
}

template <int Dim>
std::vector<double> DoublePoint<Dim>::weighed_concentration(
    std::vector<double> concentration, const std::vector<double>& volume) const {
  const auto& region = grid_.mesh.element_region;
  std::vector<double> grains_of_region(grid_.mesh.region_names.size(), 0.0);
  std::vector<double> volume_of_region(grains_of_region.size(), 0.0);
  for (std::size_t e = 0; e < volume.size(); ++e) {
    grains_of_region[region[e]] += volume[e] * concentration[e];
    volume_of_region[region[e]] += volume[e];
  }
  for (int round = 0; round < smoothing_rounds; ++round) {
    std::vector<double> grains(grid_.mesh.node_count(), 0.0);
    std::vector<double> liquid(grains.size(), 0.0);
    for (int e = 0; e < grid_.mesh.element_count(); ++e) {
      if (!skeleton_.is_soil(e)) continue;
      for (const int i : grid_.mesh.elements[e]) {
        grains[i] += volume[e] * concentration[e];
        liquid[i] += volume[e];
      }
    }
    for (int e = 0; e < grid_.mesh.element_count(); ++e) {
      double mean = 0.0;
      for (const int i : grid_.mesh.elements[e]) {
        mean += liquid[i] > 0.0 ? grains[i] / liquid[i] / (Dim + 1) : 0.0;
      }
      concentration[e] = mean;
    }
  }
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    const int r = region[e];
    if (skeleton_.is_soil(e) || volume_of_region[r] <= 0.0) continue;
    concentration[e] = grains_of_region[r] / volume_of_region[r];
  }
  return concentration;
}

template <int Dim>
PoreState DoublePoint<Dim>::pores_at(double time) const {
  PoreState content = pores();
  if (plan_.erodes(state_.time, time)) {
    const std::vector<double> before = std::exchange(
        content.porosity,
        element_porosity(skeleton_.porosity_after(state_.porosity, state_.time, time,
                                                  point_flux(motion_ahead(time - state_.time)))));
    for (std::size_t e = 0; e < before.size(); ++e) {
      const double clean = (1.0 - content.concentration[e]) * before[e] / content.porosity[e];
      content.concentration[e] = 1.0 - clean;
    }
  }
  return content;
}

template <int Dim>
std::vector<double> DoublePoint<Dim>::point_flux(const LiquidMotion<Dim>& motion) const {
  if (!skeleton_.erodes_by_flux()) return {};
  return flux_magnitude_at(grid_, motion.entered, skeleton_.points(), 1.0 / motion.duration);
}

template <int Dim>
std::vector<double> DoublePoint<Dim>::point_flux(const FluxInTime& flux) const {
  if (!skeleton_.erodes_by_flux()) return {};
  const MaterialPoints<Dim>& points = skeleton_.points();
  std::vector<double> result(points.size());
  for (int p = 0; p < points.size(); ++p) {
    result[p] = mean_magnitude_at(grid_, flux, points.element[p], points.position(grid_.mesh, p));
  }
  return result;
}

template <int Dim>
LiquidMotion<Dim> DoublePoint<Dim>::motion_ahead(double ahead) const {
  if (!skeleton_.erodes_by_flux()) return last_motion_;
  std::vector<double> mean = last_motion_.entered;
  for (double& rate : mean) rate /= last_motion_.duration;
  return {{}, mean_rate_ahead(mean, end_rate_, last_motion_.duration, ahead), 1.0};
}

template <int Dim>
void DoublePoint<Dim>::update_flow() {
  // The density of what crosses a face plays no part: points carry it.
  flow_->update(state_.time, pores(), std::vector<double>(grid_.face_count(), 0.0));
}

template <int Dim>
long DoublePoint<Dim>::steps_before_transport(double dt) const {
  LiquidMotion<Dim> one_step = last_motion_;
  for (double& volume : one_step.entered) volume *= dt / last_motion_.duration;
  one_step.duration = dt;
  const std::vector<double>& porosity = flow_->coefficients().porosity;
  std::vector<double> flux;
  for (const Vector<Dim>& q : element_flux(grid_, last_motion_.entered)) {
    flux.push_back(q.norm() / last_motion_.duration);
  }
  return steps_to_meeting(skeleton_, porosity, flux, state_.time, dt,
                          transport_.share_allowed(one_step, porosity), most_growth_lagrangian,
                          last_steps_);
}

template <int Dim>
double DoublePoint<Dim>::longest_interval() const {
  return most_lagrangian_steps * transport_safety * last_motion_.duration *
         transport_.share_allowed(last_motion_, flow_->coefficients().porosity);
}

template <int Dim>
LiquidMotion<Dim> DoublePoint<Dim>::motion(const Passed<Dim>& passed, double duration) const {
  LiquidMotion<Dim> result{passed.node_shift, passed.volumes.liquid, duration};
  const double rate = duration > 0.0 ? 1.0 / duration : 0.0;
  for (Vector<Dim>& flux : result.node_flux) flux *= rate;
  return result;
}

template <int Dim>
auto DoublePoint<Dim>::advance(
    double target, const std::function<std::vector<double>(double reached)>& times_until)
    -> std::vector<Observation> {
  const double begin = state_.time;
  std::vector<Observation> seen;
  FlowInterval<Dim> interval;
  interval.begin = begin;
  interval.target = target;
  interval.end_on_target = case_.document.scene.output.exact;
  interval.steps_allowed = [this](double dt) { return steps_before_transport(dt); };
  interval.longest = [this] { return longest_interval(); };
  interval.pores_at = [this](double time) { return pores_at(time); };
  interval.times_until = times_until;
  interval.see = [&](FlowState<Dim> moment, const Passed<Dim>& passed) {
    Observation observation;
    if (carried_ != nullptr) {
      observation.state = look_at_carried(moment);
    } else {
      observation.state = look_at_followed(moment, passed);
    }
    observation.state.time = moment.time;
    observation.state.empty_total = state_.empty_total;
    observation.flow = std::move(moment);
    seen.push_back(std::move(observation));
  };
  const FlowProgress<Dim> progress = flow_->run(interval);
  last_motion_ = motion(progress.passed, progress.duration);
  if (carried_ != nullptr) {
    finish_carried(begin + progress.duration);
  } else {
    state_ = advanced(std::move(state_), last_motion_, point_flux(last_motion_), flow_->pressure(),
                      timings_);
  }
  if (!seen.empty() && is_end(seen.back().state.time, begin, progress.duration)) {
    const double time = seen.back().state.time;
    seen.back().state = {};  // gone before its successor comes
    seen.back().state = state_;
    if (carried_ != nullptr) seen.back().state.liquid = carried_->blocks().points(false);
    seen.back().state.time = time;
  }
  if (skeleton_.erodes_by_flux()) end_rate_ = flow_->moment(state_.time).face_flux;
  flow_->warn_of_unstated_inflow(state_.time, last_motion_.entered);
  {
    const PassTimer timer(timings_.coefficients);
    update_flow();
    ++timings_.coefficients.calls;
  }
  steps_ += progress.steps;
  last_steps_ = progress.steps;
  last_dt_ = progress.dt;
  return seen;
}

template <int Dim>
auto DoublePoint<Dim>::look_at_followed(const FlowState<Dim>& moment,
                                        const Passed<Dim>& passed) const -> State {
  // From the begin of the interval, aside, and not from the last look: whoever looks more often
  // sees the same.
  PassTimings outputs_are_not_the_run;
  const double duration = moment.time - state_.time;
  if (!(duration > 0.0)) return state_;
  return advanced(state_, motion(passed, duration), point_flux(moment.flux_in_time),
                  moment.pressure, outputs_are_not_the_run);
}

template <int Dim>
auto DoublePoint<Dim>::state() const -> const State& {
  if (carried_ != nullptr && state_.liquid.size() == 0) {
    state_.liquid = carried_->blocks().points(false);
  }
  return state_;
}

template <int Dim>
void DoublePoint<Dim>::start_carried(double duration) {
  state_.liquid = {};
  const double begin = state_.time;
  carried_interval_ = {begin, begin + 0.5 * duration, state_};
  carried_->blocks().note_fines();
  erode_carried(begin, carried_interval_.middle, point_flux(motion_ahead(duration)));
  carried_->set_porosity(element_porosity(state_.porosity));
}

template <int Dim>
void DoublePoint<Dim>::finish_carried(double end) {
  erode_carried(carried_interval_.middle, end, point_flux(last_motion_));
  state_.time = end;
}

template <int Dim>
void DoublePoint<Dim>::erode_carried(double from, double to, const std::vector<double>& flux) {
  if (!has_to_erode(state_, from, to)) return;
  const PassTimer timer(timings_.erosion);
  ++timings_.erosion.calls;
  PointBlocks<Dim>& points = carried_->blocks();
  std::vector<double> porosity =
      eroded_porosity(state_.porosity, from, to, flux, [&](int e) { return points.count(e) > 0; });
  book(transfer_.transfer(state_.porosity, porosity, element_porosity(state_.porosity), densities_,
                          points, state_.pending),
       state_);
  state_.porosity = std::move(porosity);
}

template <int Dim>
void DoublePoint<Dim>::book_carried(const std::vector<CarriedCrossing>& crossings) {
  for (const CarriedCrossing& point : crossings) {
    book(PointCrossing{point.from, point.to, point.water_mass, point.fines_mass}, state_);
    book(PointCrossing{point.from, point.to, point.water_mass, point.fines_noted},
         carried_interval_.not_eroded);
  }
  const PointBlocks<Dim>& points = carried_->blocks();
  state_.empty_total += empty_elements([&](int e) { return points.count(e) > 0; });
}

template <int Dim>
auto DoublePoint<Dim>::look_at_carried(const FlowState<Dim>& moment) const -> State {
  // What has eroded for the time after the look is taken back: it goes on from the begin.
  const bool early = moment.time < carried_interval_.middle;
  const double eroded_until = early ? carried_interval_.begin : carried_interval_.middle;
  State result = early ? carried_interval_.not_eroded : state_;
  result.entering = state_.entering;
  for (const PointCrossing& crossing :
       carried_->look(moment.time, early, result.liquid, result.entering)) {
    book(crossing, result);
  }
  if (has_to_erode(result, eroded_until, moment.time)) {
    erode(result, eroded_until, moment.time, point_flux(moment.flux_in_time), moment.pressure);
  }
  return result;
}

template <int Dim>
auto DoublePoint<Dim>::advanced(State state, const LiquidMotion<Dim>& motion,
                                const std::vector<double>& flux,
                                const std::vector<double>& pressure, PassTimings& timings) const
    -> State {
  if (motion.along_faces()) return followed(std::move(state), motion, flux, pressure, timings);
  const double begin = state.time;
  const double substeps = this->substeps(motion, begin, element_porosity(state.porosity));
  LiquidMotion<Dim> part = motion;
  part.duration /= substeps;
  for (double& volume : part.entered) volume /= substeps;
  // Half a step of erosion, a step of movement, half a step of erosion: second order. Halves that
  // meet are one.
  const auto time_at = [&](double step) { return begin + motion.duration * step / substeps; };
  double eroded_until = begin;
  for (double s = 0.0; s < substeps; ++s) {
    if (has_to_erode(state, eroded_until, time_at(s + 0.5))) {
      const PassTimer timer(timings.erosion);
      erode(state, eroded_until, time_at(s + 0.5), flux, pressure);
      ++timings.erosion.calls;
    }
    eroded_until = time_at(s + 0.5);
    const PassTimer timer(timings.movement);
    move(state, part, pressure);
    ++timings.movement.calls;
  }
  const PassTimer timer(timings.erosion);
  state.time = begin + motion.duration;
  if (has_to_erode(state, eroded_until, state.time)) {
    erode(state, eroded_until, state.time, flux, pressure);
  }
  return state;
}

template <int Dim>
double DoublePoint<Dim>::substeps(const LiquidMotion<Dim>& motion, double begin,
                                  const std::vector<double>& porosity) const {
  const double allowed = transport_safety * transport_.share_allowed(motion, porosity);
  const double result = transport_substeps(allowed);
  if (!(result <= most_substeps)) {
    std::ostringstream message;
    message << "the flow has run away: at t = " << begin << " s liquid would cross "
            << "thousands of elements in " << motion.duration << " s";
    throw NumericalError(message.str());
  }
  return result;
}

template <int Dim>
auto DoublePoint<Dim>::followed(State state, const LiquidMotion<Dim>& motion,
                                const std::vector<double>& flux,
                                const std::vector<double>& pressure, PassTimings& timings) const
    -> State {
  if (!(motion.duration > 0.0)) return state;
  const double begin = state.time;
  double done = 0.0;
  for (const double end : pieces(state, motion)) {
    LiquidMotion<Dim> part = motion;
    part.duration = begin + end * motion.duration - state.time;
    for (double& volume : part.entered) volume *= end - done;
    follow(state, part, flux, pressure, timings);
    done = end;
  }
  state.time = begin + motion.duration;
  return state;
}

template <int Dim>
std::vector<double> DoublePoint<Dim>::pieces(const State& state,
                                             const LiquidMotion<Dim>& motion) const {
  // Porosity is taken to be linear in time within a piece.
  std::vector<double> smooth;
  for (const double bend : bends_) {
    const double share = (bend - state.time) / motion.duration;
    if (share > 1e-9 && share < 1.0 - 1e-9) smooth.push_back(share);
  }
  smooth.push_back(1.0);
  const double all = substeps(motion, state.time, element_porosity(state.porosity));
  std::vector<double> ends;
  double done = 0.0;
  for (const double end : smooth) {
    const double parts = std::ceil((end - done) * all * (1.0 - 1e-9));
    for (double k = 1.0; k < parts; ++k) ends.push_back(done + (end - done) * k / parts);
    ends.push_back(end);
    done = end;
  }
  return ends;
}

template <int Dim>
void DoublePoint<Dim>::follow(State& state, const LiquidMotion<Dim>& part,
                              const std::vector<double>& flux, const std::vector<double>& pressure,
                              PassTimings& timings) const {
  const double end = state.time + part.duration;
  std::vector<double> porosity = state.porosity;
  const bool erodes = has_to_erode(state, state.time, end);
  if (erodes) {
    const PassTimer timer(timings.erosion);
    const std::vector<int> begins = element_begins(state.liquid, grid_.mesh.element_count());
    porosity = eroded_porosity(state.porosity, state.time, end, flux,
                               [&](int e) { return begins[e + 1] > begins[e]; });
  }
  WalkedPoints<Dim> walked;
  {
    const PassTimer timer(timings.movement);
    walked = transport_.follow(state.liquid, state.entering, part, element_porosity(state.porosity),
                               element_porosity(porosity), pressure);
    ++timings.movement.calls;
  }
  if (erodes) {
    const PassTimer timer(timings.erosion);
    book(transfer_.transfer_on_the_way(state.porosity, porosity,
                                       point_volumes(state.liquid, pressure), state.liquid,
                                       walked.takes, state.pending),
         state);
    ++timings.erosion.calls;
  }
  const PassTimer timer(timings.movement);
  for (const PointCrossing& crossing : transport_.settle(state.liquid, state.entering, walked)) {
    book(crossing, state);
  }
  state.empty_total += empty_elements(element_begins(state.liquid, grid_.mesh.element_count()));
  state.porosity = std::move(porosity);
  state.time = end;
}

template <int Dim>
std::vector<double> DoublePoint<Dim>::bends_of_porosity() const {
  std::vector<double> result;
  const MaterialPoints<Dim>& solid = skeleton_.points();
  const std::vector<double>& initial = skeleton_.initial_porosity();
  const auto regions = static_cast<int>(grid_.mesh.region_names.size());
  for (int r = 0; r < regions; ++r) {
    double least = 1.0;
    double most = 0.0;
    ErosionModel model;
    for (int s = 0; s < solid.size(); ++s) {
      if (grid_.mesh.element_region[solid.element[s]] != r) continue;
      model = skeleton_.erosion_of_element(solid.element[s]);
      least = std::min(least, initial[s]);
      most = std::max(most, initial[s]);
    }
    if (model.law == ErosionLaw::none || !(model.rate > 0.0)) continue;
    result.push_back(model.start);
    if (model.law == ErosionLaw::constant && least == most) {
      result.push_back(model.start + (model.porosity_max - most) / model.rate);
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

template <int Dim>
bool DoublePoint<Dim>::has_to_erode(const State& state, double from, double to) const {
  return plan_.erodes(from, to) ||
         std::any_of(state.pending.begin(), state.pending.end(), [](double v) { return v != 0.0; });
}

template <int Dim>
std::vector<double> DoublePoint<Dim>::eroded_porosity(const std::vector<double>& porosity,
                                                      double from, double to,
                                                      const std::vector<double>& flux,
                                                      const HasLiquid& has_liquid) const {
  std::vector<double> result = skeleton_.porosity_after(porosity, from, to, flux);
  const MaterialPoints<Dim>& solid = skeleton_.points();
  for (int s = 0; s < solid.size(); ++s) {
    const int e = solid.element[s];
    const bool waits =
        skeleton_.soil_of_element(e).erosion.empty_elements == EmptyElements::dry && !has_liquid(e);
    if (waits) result[s] = porosity[s];
  }
  return result;
}

template <int Dim>
void DoublePoint<Dim>::erode(State& state, double from, double to, const std::vector<double>& flux,
                             const std::vector<double>& pressure) const {
  const std::vector<int> begins = element_begins(state.liquid, grid_.mesh.element_count());
  std::vector<double> porosity = eroded_porosity(state.porosity, from, to, flux,
                                                 [&](int e) { return begins[e + 1] > begins[e]; });
  const auto exchanged =
      transfer_.transfer(state.porosity, porosity, element_porosity(state.porosity), begins,
                         point_volumes(state.liquid, pressure), state.liquid, state.pending);
  state.porosity = std::move(porosity);
  book(exchanged, state);
}

template <int Dim>
void DoublePoint<Dim>::book(const typename GrainTransfer<Dim>::Result& exchanged,
                            State& state) const {
  // At a border of regions grains of one may join liquid of the other.
  for (std::size_t r = 0; r < exchanged.eroded.size(); ++r) {
    const double left = exchanged.eroded[r] - exchanged.received[r];
    CrossedSums& account = state.crossed[r + 1];
    (left > 0.0 ? account.fines_out : account.fines_in).add(std::abs(left));
  }
}

template <int Dim>
void DoublePoint<Dim>::move(State& state, const LiquidMotion<Dim>& motion,
                            const std::vector<double>& pressure) const {
  for (const PointCrossing& crossing :
       transport_.move(state.liquid, state.entering, motion, element_porosity(state.porosity),
                       pressure, VectorField<Dim>{})) {
    book(crossing, state);
  }
  state.empty_total += empty_elements(element_begins(state.liquid, grid_.mesh.element_count()));
}

template <int Dim>
void DoublePoint<Dim>::book(const PointCrossing& point, State& state) const {
  const auto leave = [&](CrossedSums& account) {
    account.water_out.add(point.water_mass);
    account.fines_out.add(point.fines_mass);
    ++account.points_out;
  };
  const auto enter = [&](CrossedSums& account) {
    account.water_in.add(point.water_mass);
    account.fines_in.add(point.fines_mass);
    ++account.points_in;
  };
  CrossedSums& from = state.crossed[point.from + 1];
  CrossedSums& to = state.crossed[point.to + 1];
  point.from < 0 ? enter(from) : leave(from);
  point.to < 0 ? leave(to) : enter(to);
}

template <int Dim>
int DoublePoint<Dim>::empty_elements(const HasLiquid& has_liquid) const {
  int empty = 0;
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    if (skeleton_.is_soil(e) && !has_liquid(e)) ++empty;
  }
  return empty;
}

template <int Dim>
std::vector<PassTiming> DoublePoint<Dim>::passes() const {
  std::vector<PassTiming> result = flow_->passes();
  if (carried_ != nullptr) result.push_back(carried_->exchange());
  result.insert(result.end(),
                {timings_.erosion, carried_ != nullptr ? carried_->movement() : timings_.movement,
                 timings_.coefficients});
  return result;
}

template <int Dim>
std::vector<std::string> DoublePoint<Dim>::take_warnings() {
  return flow_->take_warnings();
}

template class DoublePoint<2>;

}  // namespace suffuse
