#include "formulation/single_point.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "flow/extrapolated_flux.hpp"
#include "formulation/coupling.hpp"
#include "formulation/observation.hpp"
#include "grid/face_flux.hpp"
#include "grid/parallel.hpp"
#include "physics/liquid.hpp"
#include "results/pass_timer.hpp"

namespace suffuse {
namespace {

/// Relative growth of porosity in which the flow may still use the porosity from before it.
constexpr double most_growth_eulerian = 2e-3;
/// Steps of transport between two meetings with a flow that could go further: whoever looks in
/// between has them done again, once.
constexpr double most_eulerian_steps = 16.0;

}  // namespace

template <int Dim>
SinglePoint<Dim>::SinglePoint(const Case<Dim>& c, const Plan& plan)
    : case_(c),
      plan_(plan),
      grid_(c.mesh),
      skeleton_(c, grid_, plan.flow.threads),
      flow_(make_flow(c, grid_, skeleton_, plan.flow)),
      transport_(grid_, flow_->conditions(), plan.flow.threads),
      accounts_(grid_),
      grain_density_(c.document.scene.soils.front().grain_density),
      last_volume_rate_(grid_.face_count(), 0.0) {
  initialise();
}

template <int Dim>
void SinglePoint<Dim>::initialise() {
  const Scene& scene = case_.document.scene;
  state_.porosity = skeleton_.initial_porosity();
  state_.liquid.pore_volume = skeleton_.initial_pore_volume();
  state_.liquid.fines_volume.assign(grid_.mesh.element_count(), ElementValues<Dim>{});
  update_flow();
  flow_->start();
  last_volume_rate_ = end_rate_ = flow_->face_flux(0.0);
  state_.water_mass.resize(grid_.mesh.element_count());
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    state_.water_mass[e] = scene.liquid.density * flow_->coefficients().water_volume[e] *
                           density_ratio(flow_->pressure()[e], scene.liquid.bulk_modulus);
  }
  state_.crossed.resize(accounts_.count());
  initial_ = stored(state_);
}

template <int Dim>
void SinglePoint<Dim>::archive(StateArchive& archive) {
  archive(state_, *flow_, last_dt_, last_volume_rate_, end_rate_, last_duration_);
  archive(last_steps_, steps_, timings_);
}

template <int Dim>
PoreState SinglePoint<Dim>::pores(const SinglePointState<Dim>& state) const {
  PoreState content;
  const int elements = grid_.mesh.element_count();
  content.porosity.resize(elements);
  content.water_volume.resize(elements);
  content.concentration.resize(elements);
  for_each_index(elements, threads(), [&](int e) {
    const double pores = element_sum<Dim>(state.liquid.pore_volume[e]);
    const double fines = element_sum<Dim>(state.liquid.fines_volume[e]);
    content.porosity[e] = pores / grid_.volume[e];
    content.water_volume[e] = pores - fines;
    content.concentration[e] = fines / pores;
  });
  if (skeleton_.erodes_by_flux()) content.flux = element_flux_magnitude();
  return content;
}

template <int Dim>
PoreState SinglePoint<Dim>::pores_at(double time) const {
  PoreState content = pores(state_);
  if (!plan_.erodes(state_.time, time)) return content;
  const std::vector<double> flux = point_flux(
      {mean_rate_ahead(last_volume_rate_, end_rate_, last_duration_, time - state_.time), {}, 1.0});
  const std::vector<double> porosity =
      skeleton_.porosity_after(state_.porosity, state_.time, time, flux);
  const MaterialPoints<Dim>& points = skeleton_.points();
  for_each_index(grid_.mesh.element_count(), threads(), [&](int e) {
    for (int p = skeleton_.points_begin(e); p < skeleton_.points_begin(e + 1); ++p) {
      const double growth = points.volume[p] * (porosity[p] - state_.porosity[p]) / grid_.volume[e];
      content.porosity[e] += growth;
      content.concentration[e] += (1.0 - content.concentration[e]) * growth / content.porosity[e];
    }
  });
  return content;
}

template <int Dim>
std::vector<double> SinglePoint<Dim>::element_flux_magnitude() const {
  std::vector<double> result(grid_.mesh.element_count());
  for_each_index(grid_.mesh.element_count(), threads(), [&](int e) {
    result[e] = flux_at(grid_, last_volume_rate_, e, element_centroid(grid_.mesh, e)).norm();
  });
  return result;
}

template <int Dim>
std::vector<double> SinglePoint<Dim>::point_flux(const FluxInTime& flux) const {
  if (!skeleton_.erodes_by_flux()) return {};
  const MaterialPoints<Dim>& points = skeleton_.points();
  std::vector<double> result(points.size());
  for_each_index(points.size(), threads(), [&](int p) {
    result[p] = mean_magnitude_at(grid_, flux, points.element[p], points.position(grid_.mesh, p));
  });
  return result;
}

template <int Dim>
void SinglePoint<Dim>::update_flow() {
  std::vector<double>& concentration = scratch_.face_concentration;
  if (plan_.carries(state_.time)) {
    transport_.face_concentration(state_.liquid, last_volume_rate_, scratch_.transport,
                                  concentration);
  } else {
    concentration.assign(grid_.face_count(), 0.0);
  }
  flow_->update(state_.time, pores(state_), concentration);
}

template <int Dim>
long SinglePoint<Dim>::steps_before_transport(double dt) const {
  std::vector<double> per_step = last_volume_rate_;
  for (double& volume : per_step) volume *= dt;
  return steps_to_meeting(skeleton_, flow_->coefficients().porosity, element_flux_magnitude(),
                          state_.time, dt, transport_.steps_allowed(state_.liquid, per_step),
                          most_growth_eulerian, last_steps_);
}

template <int Dim>
double SinglePoint<Dim>::longest_interval() const {
  if (!plan_.transport) return std::numeric_limits<double>::infinity();
  return most_eulerian_steps * transport_safety *
         transport_.steps_allowed(state_.liquid, last_volume_rate_);
}

template <int Dim>
auto SinglePoint<Dim>::advance(
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
    PassTimings outputs_are_not_the_run;
    Observation observation;
    // From the begin of the interval, aside, and not from the last look: whoever looks more often
    // sees the same.
    observation.state = state_;
    if (moment.time > begin) {
      follow(observation.state, passed.volumes, moment.time - begin, moment.flux_in_time,
             outputs_are_not_the_run);
    }
    observation.state.time = moment.time;
    observation.flow = std::move(moment);
    seen.push_back(std::move(observation));
  };
  const FlowProgress<Dim> progress = flow_->run(interval);

  const FaceVolumes& volumes = progress.passed.volumes;
  last_volume_rate_ = per_time(volumes.liquid, progress.duration);
  follow(state_, volumes, progress.duration, {last_volume_rate_, {}, 1.0}, timings_);
  if (!seen.empty() && is_end(seen.back().state.time, begin, progress.duration)) {
    const double time = std::exchange(seen.back().state, state_).time;
    seen.back().state.time = time;
  }
  if (plan_.transport) flow_->warn_of_unstated_inflow(state_.time, volumes.liquid);
  last_duration_ = progress.duration;
  end_rate_ = skeleton_.erodes_by_flux() ? flow_->face_flux(state_.time) : last_volume_rate_;
  synchronise_flow();
  steps_ += progress.steps;
  last_steps_ = progress.steps;
  last_dt_ = progress.dt;
  return seen;
}

template <int Dim>
void SinglePoint<Dim>::follow(SinglePointState<Dim>& state, const FaceVolumes& volumes,
                              double duration, const FluxInTime& flux_in_time,
                              PassTimings& timings) {
  const double begin = state.time;
  const bool carries = plan_.carries(begin + duration);
  const double allowed =
      carries ? transport_safety * transport_.steps_allowed(state.liquid, volumes.liquid) : 1.0;
  const double substeps = transport_substeps(allowed);
  scratch_.step_volume = volumes.liquid;
  if (substeps > 1.0) {
    for (double& v : scratch_.step_volume) v /= substeps;
  }
  if (carries) transport_.start(state.liquid, scratch_.step_volume, scratch_.transport);
  const std::vector<double> flux = point_flux(flux_in_time);
  for (double s = 0.0; s < substeps; ++s) {
    const double from = begin + duration * s / substeps;
    const double to = begin + duration * (s + 1.0) / substeps;
    scratch_.eroded.clear();
    if (plan_.erodes(from, to)) {
      const PassTimer timer(timings.erosion);
      skeleton_.erode(state.porosity, from, to, flux, scratch_.eroded);
      ++timings.erosion.calls;
    }
    if (plan_.carries(to)) {
      const PassTimer timer(timings.transport);
      transport_.advance(state.liquid, scratch_.eroded, scratch_.transport);
      ++timings.transport.calls;
    }
  }
  state.time = begin + duration;
  const PassTimer timer(timings.water);
  ++timings.water.calls;
  if (carries) {
    transport_.grains_crossed(scratch_.transport, scratch_.grains_crossed);
  } else {
    scratch_.grains_crossed.assign(grid_.face_count(), 0.0);
  }
  move_water(state, volumes);
}

template <int Dim>
void SinglePoint<Dim>::move_water(SinglePointState<Dim>& state, const FaceVolumes& volumes) {
  const double density = case_.document.scene.liquid.density;
  const bool conservative = case_.document.scene.flow.porosity_gradient_term;
  const FlowCoefficients<Dim>& coefficients = flow_->coefficients();
  std::vector<double>& water = scratch_.water;
  std::vector<double>& fines = scratch_.fines;
  water.resize(grid_.face_count());
  fines.resize(grid_.face_count());
  for_each_index(grid_.face_count(), threads(), [&](int f) {
    const double grains = scratch_.grains_crossed[f];
    const double excess = (1.0 - coefficients.face_concentration[f]) * volumes.density_excess[f];
    water[f] = density * ((volumes.liquid[f] - grains) + excess);
    fines[f] = grain_density_ * grains;
    if (!conservative) water[f] *= coefficients.porosity[grid_.face_left[f]];
  });
  accounts_.book(water, fines, state.crossed);
  if (!conservative) return;
  for_each_index(grid_.mesh.element_count(), threads(), [&](int e) {
    for (int k = 0; k <= Dim; ++k) {
      state.water_mass[e] -= grid_.element_face_sign[e][k] * water[grid_.element_face[e][k]];
    }
  });
}

template <int Dim>
void SinglePoint<Dim>::synchronise_flow() {
  const PassTimer timer(timings_.water);
  update_flow();
  const LiquidProperties& liquid = case_.document.scene.liquid;
  if (case_.document.scene.flow.porosity_gradient_term) {
    // The masses are what is conserved; the pressure follows from them.
    flow_->follow_masses(state_.time, state_.water_mass);
    return;
  }
  // Without the third term of Eq. 2 strain alone is integrated, and the mass made to follow it.
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    state_.water_mass[e] = liquid.density * flow_->coefficients().water_volume[e] *
                           density_ratio(flow_->pressure()[e], liquid.bulk_modulus);
  }
}

template <int Dim>
HistoryRow SinglePoint<Dim>::history_row(const SinglePointState<Dim>& state,
                                         const FlowState<Dim>& moment) const {
  HistoryRow row;
  row.t = state.time;
  row.porosity_mean = mean_porosity(skeleton_, state.porosity);
  flow_->describe(moment, row);

  const std::vector<double>& flux = moment.face_flux;
  std::vector<double> concentration;
  TransportScratch<Dim> scratch;
  transport_.face_concentration(state.liquid, flux, scratch, concentration);
  CompensatedSum fines_out;
  for (int f = 0; f < grid_.face_count(); ++f) {
    if (grid_.is_outer(f) && flux[f] > 0.0) fines_out.add(flux[f] * concentration[f]);
  }
  row.concentration_out = row.flux_out > 0.0 ? fines_out.value() / row.flux_out : 0.0;

  row.concentration_min = std::numeric_limits<double>::infinity();
  row.concentration_max = -row.concentration_min;
  for (std::size_t e = 0; e < state.liquid.fines_volume.size(); ++e) {
    for (int j = 0; j <= Dim; ++j) {
      const double c = state.liquid.fines_volume[e][j] / state.liquid.pore_volume[e][j];
      row.concentration_min = std::min(row.concentration_min, c);
      row.concentration_max = std::max(row.concentration_max, c);
    }
  }
  return row;
}

template <int Dim>
std::vector<Stored> SinglePoint<Dim>::stored(const SinglePointState<Dim>& state) const {
  std::vector<StoredSums> sums(accounts_.count());
  book_solid(skeleton_, grid_.mesh, grain_density_, state.porosity, sums);
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    for (StoredSums* sum : {&sums[0], &sums[grid_.mesh.element_region[e] + 1]}) {
      sum->water.add(state.water_mass[e]);
      for (const double volume : state.liquid.fines_volume[e]) {
        sum->fines.add(grain_density_ * volume);
      }
    }
  }
  std::vector<Stored> result;
  result.reserve(sums.size());
  for (const StoredSums& s : sums) result.push_back(s.totals());
  return result;
}

template <int Dim>
LedgerRow SinglePoint<Dim>::ledger(const SinglePointState<Dim>& state) const {
  return ledger_row(state.time, stored(state)[0], state.crossed[0].totals(), initial_[0]);
}

template <int Dim>
std::vector<RegionRow> SinglePoint<Dim>::region_rows(const SinglePointState<Dim>& state) const {
  return suffuse::region_rows(skeleton_, grid_, grain_density_, state.time, stored(state), initial_,
                              state.crossed);
}

template <int Dim>
Snapshot SinglePoint<Dim>::snapshot(const SinglePointState<Dim>& state,
                                    const FlowState<Dim>& moment, long step) const {
  return make_snapshot(grid_, skeleton_, state.porosity, state.liquid, moment, step);
}

template <int Dim>
std::vector<PassTiming> SinglePoint<Dim>::passes() const {
  std::vector<PassTiming> result = flow_->passes();
  result.insert(result.end(), {timings_.erosion, timings_.transport, timings_.water});
  return result;
}

template <int Dim>
std::vector<std::string> SinglePoint<Dim>::take_warnings() {
  return flow_->take_warnings();
}

template class SinglePoint<2>;

}  // namespace suffuse
