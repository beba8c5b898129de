#include "single_point.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>

#include "case/errors.hpp"
#include "flow/locking.hpp"
#include "flow/steady_nodal.hpp"
#include "physics/liquid.hpp"

namespace suffuse {
namespace {

/// Transport and flow meet at the latest after so many flow steps.
constexpr long most_steps_per_interval = 1000;
/// Solving for the steady flow of more elements than this would take longer than the warning is
/// worth.
constexpr int most_elements_checked = 100000;
/// Relative growth of porosity in which the flow may still use the porosity from before it.
constexpr double most_porosity_growth = 2e-3;
/// Share of its limit that a transport step takes.
constexpr double transport_safety = 0.9;

/// Adds the time it lives to a pass.
class PassTimer {
 public:
  explicit PassTimer(PassTiming& pass) : pass_(pass), start_(std::chrono::steady_clock::now()) {}
  PassTimer(const PassTimer&) = delete;
  PassTimer& operator=(const PassTimer&) = delete;
  ~PassTimer() {
    pass_.seconds +=
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  PassTiming& pass_;
  std::chrono::steady_clock::time_point start_;
};

std::vector<double> between(const std::vector<double>& a, const std::vector<double>& b,
                            double share) {
  std::vector<double> result(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) result[i] = a[i] + share * (b[i] - a[i]);
  return result;
}

template <int Dim>
Vector<Dim> gravity_of(const Scene& scene) {
  Vector<Dim> g;
  for (int d = 0; d < Dim; ++d) g[d] = scene.gravity[d];
  return g;
}

ExplicitSettings flow_settings(const Scene& scene, int threads) {
  ExplicitSettings settings;
  settings.bulk_modulus = scene.liquid.bulk_modulus;
  settings.mass_scaling = scene.time.mass_scaling;
  settings.drag = scene.time.drag;
  settings.porosity_gradient_term = scene.flow.porosity_gradient_term;
  settings.threads = threads;
  return settings;
}

}  // namespace

template <int Dim>
SinglePoint<Dim>::SinglePoint(const Case<Dim>& c, const Plan& plan, const SolverOptions& options)
    : case_(c),
      plan_(plan),
      grid_(c.mesh),
      conditions_(face_conditions(c, grid_)),
      skeleton_(c, grid_),
      operator_(grid_, conditions_, gravity_of<Dim>(c.document.scene),
                c.document.scene.flow.porosity_gradient_term),
      flow_(operator_, flow_settings(c.document.scene, options.threads)),
      transport_(grid_, conditions_),
      accounts_(grid_),
      grain_density_(c.document.scene.soils.front().grain_density),
      last_volume_rate_(grid_.face_count(), 0.0),
      inflow_warned_(c.document.scene.boundaries.size(), false) {
  initialise();
}

template <int Dim>
void SinglePoint<Dim>::initialise() {
  const Scene& scene = case_.document.scene;
  state_.porosity = skeleton_.initial_porosity();
  state_.liquid.pore_volume = skeleton_.initial_pore_volume();
  state_.liquid.fines_volume.assign(grid_.mesh.element_count(), ElementValues<Dim>{});
  update_flow();
  if (scene.initial_flow == InitialFlow::steady) {
    NodalFlowState<Dim> steady = steady_flow(operator_);
    if (steady.imbalance > 1e-6) {
      std::ostringstream message;
      message << "the steady initial flow leaves a net outflow of " << steady.imbalance
              << " times the largest face flux in an element: linear velocities cannot follow this "
                 "flow on this mesh; it will store or release water at first";
      warnings_.push_back(message.str());
    }
    warn_of_locking(steady.velocity);
    flow_.set_pressure(std::move(steady.pressure));
    flow_.set_velocity(std::move(steady.velocity));
  } else {
    if (grid_.mesh.element_count() <= most_elements_checked) {
      warn_of_locking(steady_flow(operator_).velocity);
    }
    flow_.set_velocity(VectorField<Dim>(grid_.mesh.node_count(), Vector<Dim>::Zero()));
  }
  state_.water_mass.resize(grid_.mesh.element_count());
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    state_.water_mass[e] = scene.liquid.density * coefficients_.water_volume[e] *
                           density_ratio(flow_.pressure()[e], scene.liquid.bulk_modulus);
  }
  state_.crossed.resize(accounts_.count());
  initial_ = stored(state_);
}

template <int Dim>
void SinglePoint<Dim>::warn_of_locking(const VectorField<Dim>& steady_velocity) {
  const Scene& scene = case_.document.scene;
  if (grid_.mesh.element_count() > most_elements_checked) return;
  if (!scene.flow.porosity_gradient_term) return;
  const auto deviation =
      deviation_from_mixed_flow(operator_, coefficients_, gravity_of<Dim>(scene), steady_velocity);
  if (!deviation || *deviation < locked_deviation) return;
  std::ostringstream message;
  message.precision(2);
  message
      << "the explicit scheme does not follow this flow on this mesh: its steady flux differs by "
      << 100.0 * *deviation
      << " % from that of mixed finite elements (volumetric locking). Fluxes, pressures and fines "
         "will be wrong; porosity is not touched. Take mesh.structure = \"crossed\", or smaller "
         "elements if it is";
  warnings_.push_back(message.str());
}

template <int Dim>
void SinglePoint<Dim>::update_flow() {
  const Scene& scene = case_.document.scene;
  const int elements = grid_.mesh.element_count();
  coefficients_.porosity.resize(elements);
  coefficients_.water_volume.resize(elements);
  coefficients_.mixture_density.resize(elements);
  coefficients_.drag.resize(elements);
  for (int e = 0; e < elements; ++e) {
    const double pores = element_sum<Dim>(state_.liquid.pore_volume[e]);
    const double fines = element_sum<Dim>(state_.liquid.fines_volume[e]);
    const double porosity = pores / grid_.volume[e];
    const Soil& soil = skeleton_.soil_of_element(e);
    coefficients_.porosity[e] = porosity;
    coefficients_.water_volume[e] = pores - fines;
    coefficients_.mixture_density[e] =
        mixture_density(fines / pores, scene.liquid.density, grain_density_);
    coefficients_.drag[e] = darcy_drag(porosity, scene.liquid.density, soil.conductivity);
    if (soil.erosion.momentum_transfer) {
      const double rate = erosion_rate(skeleton_.erosion_of_element(e), porosity, state_.time);
      coefficients_.drag[e] += grain_density_ * rate / porosity;
    }
  }
  if (plan_.transport) {
    coefficients_.face_concentration =
        transport_.face_concentration(state_.liquid, last_volume_rate_);
  } else {
    coefficients_.face_concentration.assign(grid_.face_count(), 0.0);
  }
  operator_.update(coefficients_);
  flow_.update(coefficients_);
}

template <int Dim>
StabilityLimit SinglePoint<Dim>::current_limit() const {
  const Scene& scene = case_.document.scene;
  return stability_limit(grid_, coefficients_, operator_.node_porosity(), scene.liquid.bulk_modulus,
                         scene.time.mass_scaling, scene.time.drag);
}

template <int Dim>
long SinglePoint<Dim>::steps_before_transport(double dt) const {
  std::vector<double> per_step = last_volume_rate_;
  for (double& volume : per_step) volume *= dt;
  double allowed = transport_safety * transport_.steps_allowed(state_.liquid, per_step);
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    const ErosionModel& model = skeleton_.erosion_of_element(e);
    const double porosity = coefficients_.porosity[e];
    const double rate = erosion_rate(model, porosity, std::max(state_.time, model.start));
    if (rate > 0.0) allowed = std::min(allowed, most_porosity_growth * porosity / (rate * dt));
  }
  // The flow may have grown since: go up by doubling.
  const long most = std::min(most_steps_per_interval, 2 * last_steps_);
  return std::max(1L, allowed < static_cast<double>(most) ? static_cast<long>(allowed) : most);
}

template <int Dim>
auto SinglePoint<Dim>::advance(long steps, double dt, const std::vector<double>& times)
    -> std::vector<Observation> {
  const double begin = state_.time;
  std::vector<Observation> seen;
  flow_.reset_volumes();
  auto next = times.begin();
  struct {
    std::vector<double> pressure;
    FaceVolumes volumes;
  } before;
  // Within a step flux is constant, so volumes are linear; erosion and transport follow with those.
  const auto observe = [&](double time, double step_begin) {
    const double share = (time - step_begin) / dt;
    const FaceVolumes volumes{
        between(before.volumes.liquid, flow_.volumes().liquid, share),
        between(before.volumes.density_excess, flow_.volumes().density_excess, share)};
    PassTimings outputs_are_not_the_run;
    Observation observation;
    observation.state = advanced(state_, volumes, time - begin, outputs_are_not_the_run);
    observation.state.time = time;
    observation.flow = {time, dt, between(before.pressure, flow_.pressure(), share),
                        flow_.velocity_at(time - (step_begin + 0.5 * dt))};
    seen.push_back(std::move(observation));
  };
  for (long s = 0; s < steps; ++s) {
    const double step_begin = begin + static_cast<double>(s) * dt;
    const double step_end =
        s + 1 == steps ? std::numeric_limits<double>::infinity() : step_begin + dt;
    if (next != times.end() && *next <= step_end) before = {flow_.pressure(), flow_.volumes()};
    {
      const PassTimer timer(timings_.flow);
      flow_.step(dt);
    }
    for (; next != times.end() && *next <= step_end; ++next) observe(*next, step_begin);
  }
  timings_.flow.calls += steps;

  const double duration = static_cast<double>(steps) * dt;
  state_ = advanced(state_, flow_.volumes(), duration, timings_);
  warn_of_unstated_inflow();
  last_volume_rate_ = flow_.volumes().liquid;
  for (double& rate : last_volume_rate_) rate /= duration;
  synchronise_flow();
  last_steps_ = steps;
  last_dt_ = dt;
  return seen;
}

template <int Dim>
SinglePointState<Dim> SinglePoint<Dim>::advanced(const SinglePointState<Dim>& begin,
                                                 const FaceVolumes& volumes, double duration,
                                                 PassTimings& timings) const {
  SinglePointState<Dim> state = begin;
  std::vector<double> grains_crossed(grid_.face_count(), 0.0);
  const double allowed =
      plan_.transport ? transport_safety * transport_.steps_allowed(state.liquid, volumes.liquid)
                      : 1.0;
  const double substeps = allowed >= 1.0 ? 1.0 : std::ceil(1.0 / allowed);
  std::vector<double> part = volumes.liquid;
  if (substeps > 1.0) {
    for (double& v : part) v /= substeps;
  }
  for (double s = 0.0; s < substeps; ++s) {
    const double from = begin.time + duration * s / substeps;
    const double to = begin.time + duration * (s + 1.0) / substeps;
    ElementField<Dim> eroded(grid_.mesh.element_count(), ElementValues<Dim>{});
    if (plan_.erosion) {
      const PassTimer timer(timings.erosion);
      std::vector<double> porosity = skeleton_.porosity_after(state.porosity, from, to);
      eroded = skeleton_.eroded_volume(state.porosity, porosity);
      state.porosity = std::move(porosity);
      ++timings.erosion.calls;
    }
    if (plan_.transport) {
      const PassTimer timer(timings.transport);
      const std::vector<double> crossed = transport_.advance(state.liquid, part, eroded);
      for (std::size_t f = 0; f < crossed.size(); ++f) grains_crossed[f] += crossed[f];
      ++timings.transport.calls;
    }
  }
  state.time = begin.time + duration;
  const PassTimer timer(timings.water);
  ++timings.water.calls;
  move_water(state, volumes, grains_crossed);
  return state;
}

template <int Dim>
void SinglePoint<Dim>::move_water(SinglePointState<Dim>& state, const FaceVolumes& volumes,
                                  const std::vector<double>& grains_crossed) const {
  const double density = case_.document.scene.liquid.density;
  const bool conservative = case_.document.scene.flow.porosity_gradient_term;
  std::vector<double> water(grid_.face_count());
  std::vector<double> fines(grid_.face_count());
  for (int f = 0; f < grid_.face_count(); ++f) {
    const double excess = (1.0 - coefficients_.face_concentration[f]) * volumes.density_excess[f];
    water[f] = density * ((volumes.liquid[f] - grains_crossed[f]) + excess);
    fines[f] = grain_density_ * grains_crossed[f];
    if (!conservative) water[f] *= coefficients_.porosity[grid_.face_left[f]];
  }
  for (int e = 0; e < grid_.mesh.element_count() && conservative; ++e) {
    for (int k = 0; k <= Dim; ++k) {
      state.water_mass[e] -= grid_.element_face_sign[e][k] * water[grid_.element_face[e][k]];
    }
  }
  accounts_.book(water, fines, state.crossed);
}

template <int Dim>
void SinglePoint<Dim>::synchronise_flow() {
  const PassTimer timer(timings_.water);
  update_flow();
  const LiquidProperties& liquid = case_.document.scene.liquid;
  std::vector<double> pressure = flow_.pressure();
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    const double reference_mass = liquid.density * coefficients_.water_volume[e];
    if (!case_.document.scene.flow.porosity_gradient_term) {
      // Without the third term of Eq. 2 strain alone is integrated, and the mass made to follow it.
      state_.water_mass[e] = reference_mass * density_ratio(pressure[e], liquid.bulk_modulus);
      continue;
    }
    // The masses are what is conserved; the pressure follows from them.
    const double ratio = state_.water_mass[e] / reference_mass;
    if (!(ratio > 0.0)) {
      std::ostringstream message;
      message << "element " << e << " at (" << element_centroid(grid_.mesh, e).transpose()
              << ") has no water left at t = " << state_.time << " s";
      throw NumericalError(message.str());
    }
    pressure[e] = pressure_from_density_ratio(ratio, liquid.bulk_modulus);
  }
  flow_.set_pressure(std::move(pressure));
}

template <int Dim>
void SinglePoint<Dim>::warn_of_unstated_inflow() {
  if (!plan_.transport) return;
  const auto& entries = case_.document.scene.boundaries;
  for (int f = 0; f < grid_.face_count(); ++f) {
    const FaceCondition& condition = conditions_[f];
    if (condition.boundary < 0 || condition.concentration_given ||
        inflow_warned_[condition.boundary]) {
      continue;
    }
    // Round-off of a flow at rest is no inflow.
    const double pores = element_sum<Dim>(state_.liquid.pore_volume[grid_.face_left[f]]);
    if (flow_.volumes().liquid[f] >= -1e-12 * pores) continue;
    inflow_warned_[condition.boundary] = true;
    std::ostringstream message;
    message << "liquid enters through boundary \"" << entries[condition.boundary].on
            << "\" at t = " << state_.time
            << " s and the scene gives it no concentration: clean water is taken (concentration 0)";
    warnings_.push_back(message.str());
  }
}

template <int Dim>
FlowMoment<Dim> SinglePoint<Dim>::moment() const {
  FlowMoment<Dim> result;
  result.time = state_.time;
  result.dt = last_dt_ > 0.0 ? last_dt_ : plan_.step;
  result.pressure = flow_.pressure();
  result.velocity = flow_.velocity();
  return result;
}

template <int Dim>
std::vector<double> SinglePoint<Dim>::face_fluxes(const VectorField<Dim>& velocity) const {
  std::vector<double> result(grid_.face_count());
  for (int f = 0; f < grid_.face_count(); ++f) result[f] = operator_.face_flux(f, velocity);
  return result;
}

template <int Dim>
HistoryRow SinglePoint<Dim>::history_row(const SinglePointState<Dim>& state,
                                         const FlowMoment<Dim>& moment) const {
  HistoryRow row;
  row.t = state.time;
  row.dt = moment.dt;
  const MaterialPoints<Dim>& points = skeleton_.points();
  CompensatedSum pores;
  CompensatedSum volume;
  for (int p = 0; p < points.size(); ++p) {
    const bool erodes = skeleton_.erosion_of_element(points.element[p]).law != ErosionLaw::none;
    if (skeleton_.erodes() && !erodes) continue;
    pores.add(points.volume[p] * state.porosity[p]);
    volume.add(points.volume[p]);
  }
  row.porosity_mean = pores.value() / volume.value();

  const std::vector<double> flux = face_fluxes(moment.velocity);
  const std::vector<double> concentration = transport_.face_concentration(state.liquid, flux);
  CompensatedSum in;
  CompensatedSum out;
  CompensatedSum fines_out;
  for (int f = 0; f < grid_.face_count(); ++f) {
    if (!grid_.is_outer(f)) continue;
    if (flux[f] < 0.0) {
      in.add(-flux[f]);
    } else {
      out.add(flux[f]);
      fines_out.add(flux[f] * concentration[f]);
    }
  }
  row.flux_in = in.value();
  row.flux_out = out.value();
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
  // At the nodes: single elements carry patterns that push nothing.
  const std::vector<double> pressure = node_pressure(moment.pressure).values;
  const auto [low, high] = std::minmax_element(pressure.begin(), pressure.end());
  row.pressure_min = *low;
  row.pressure_max = *high;
  for (const Vector<Dim>& v : moment.velocity) row.speed_max = std::max(row.speed_max, v.norm());
  return row;
}

template <int Dim>
std::vector<Stored> SinglePoint<Dim>::stored(const SinglePointState<Dim>& state) const {
  struct Sums {
    CompensatedSum solid, erodible, water, fines, eroded;
  };
  std::vector<Sums> sums(grid_.mesh.region_names.size() + 1);
  const auto book = [&](int element, CompensatedSum Sums::*member, double mass) {
    (sums[0].*member).add(mass);
    (sums[grid_.mesh.element_region[element] + 1].*member).add(mass);
  };
  const MaterialPoints<Dim>& points = skeleton_.points();
  for (int p = 0; p < points.size(); ++p) {
    const int e = points.element[p];
    const double mass = grain_density_ * points.volume[p];
    const double n = state.porosity[p];
    book(e, &Sums::solid, mass * (1.0 - n));
    book(e, &Sums::erodible, mass * (skeleton_.soil_of_point(p).porosity_max() - n));
    book(e, &Sums::eroded, mass * (n - skeleton_.initial_porosity()[p]));
  }
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    book(e, &Sums::water, state.water_mass[e]);
    for (const double volume : state.liquid.fines_volume[e]) {
      book(e, &Sums::fines, grain_density_ * volume);
    }
  }
  std::vector<Stored> result;
  result.reserve(sums.size());
  for (const Sums& s : sums) {
    result.push_back(
        {s.solid.value(), s.erodible.value(), s.water.value(), s.fines.value(), s.eroded.value()});
  }
  return result;
}

template <int Dim>
LedgerRow SinglePoint<Dim>::ledger(const SinglePointState<Dim>& state) const {
  return ledger_row(state.time, stored(state)[0], state.crossed[0].totals(), initial_[0]);
}

template <int Dim>
std::vector<RegionRow> SinglePoint<Dim>::region_rows(const SinglePointState<Dim>& state) const {
  const std::vector<Stored> now = stored(state);
  std::vector<double> volume(grid_.mesh.region_names.size(), 0.0);
  for (int p = 0; p < skeleton_.points().size(); ++p) {
    volume[grid_.mesh.element_region[skeleton_.points().element[p]]] +=
        skeleton_.points().volume[p];
  }
  std::vector<RegionRow> rows;
  for (std::size_t r = 0; r < volume.size(); ++r) {
    RegionRow row;
    row.region = static_cast<int>(r);
    row.porosity_mean = 1.0 - now[r + 1].solid / (grain_density_ * volume[r]);
    row.ledger = ledger_row(state.time, now[r + 1], state.crossed[r + 1].totals(), initial_[r + 1]);
    rows.push_back(row);
  }
  return rows;
}

/// Element pressures carry patterns that push no node, large on unstructured meshes; the mean of
/// the elements around a node is almost free of them. Where a pressure is prescribed, that is it.
template <int Dim>
Field SinglePoint<Dim>::node_pressure(const std::vector<double>& pressure) const {
  Field result{"pressure", "Pa", 1, std::vector<double>(grid_.mesh.node_count(), 0.0)};
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    for (const int i : grid_.mesh.elements[e]) {
      result.values[i] += grid_.volume[e] / (Dim + 1) / grid_.node_volume[i] * pressure[e];
    }
  }
  std::vector<double> prescribed(result.values.size(), 0.0);
  std::vector<int> faces(result.values.size(), 0);
  for (int f = 0; f < grid_.face_count(); ++f) {
    if (conditions_[f].kind != FaceKind::pressure) continue;
    for (const int i : grid_.face_nodes[f]) {
      prescribed[i] += conditions_[f].value;
      ++faces[i];
    }
  }
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (faces[i] > 0) result.values[i] = prescribed[i] / faces[i];
  }
  return result;
}

template <int Dim>
Snapshot SinglePoint<Dim>::snapshot(const SinglePointState<Dim>& state,
                                    const FlowMoment<Dim>& moment, long step) const {
  using Nodes = FieldNodes<Dim>;
  const int elements = grid_.mesh.element_count();
  Snapshot result;
  result.time = state.time;
  result.step = step;

  Field porosity{"porosity", "1", 1, {}};
  Field concentration{"concentration", "1", 1, {}};
  Field fines{"fines_fraction", "1", 1, {}};
  Field water{"water_fraction", "1", 1, {}};
  Field erodible{"erodible_fraction", "1", 1, {}};
  Field darcy_flux{"darcy_flux", "m/s", Dim, {}};
  Field region{"region", "1", 1, {}};
  Field vertex_porosity{"porosity", "1", Dim + 1, {}};
  Field vertex_concentration{"concentration", "1", Dim + 1, {}};
  Field vertex_fines{"fines_fraction", "1", Dim + 1, {}};
  Field vertex_water{"water_fraction", "1", Dim + 1, {}};

  const std::vector<double> flux = face_fluxes(moment.velocity);
  ElementField<Dim> concentration_at_nodes(elements);
  ElementField<Dim> fines_at_nodes(elements);
  for (int e = 0; e < elements; ++e) {
    const ElementValues<Dim>& pores = state.liquid.pore_volume[e];
    const ElementValues<Dim>& grains = state.liquid.fines_volume[e];
    const double pore_sum = element_sum<Dim>(pores);
    const double grain_sum = element_sum<Dim>(grains);
    const double n = pore_sum / grid_.volume[e];
    const double n_f = grain_sum / grid_.volume[e];
    porosity.values.push_back(n);
    concentration.values.push_back(grain_sum / pore_sum);
    fines.values.push_back(n_f);
    water.values.push_back(n - n_f);
    erodible.values.push_back(skeleton_.soil_of_element(e).porosity_max() - n);
    region.values.push_back(grid_.mesh.element_region[e]);

    // The Raviart-Thomas field of the face fluxes, at the centroid.
    Vector<Dim> q = Vector<Dim>::Zero();
    const Vector<Dim> centre = element_centroid(grid_.mesh, e);
    for (int k = 0; k <= Dim; ++k) {
      q += grid_.element_face_sign[e][k] * flux[grid_.element_face[e][k]] *
           (centre - grid_.mesh.nodes[grid_.mesh.elements[e][k]]) / (Dim * grid_.volume[e]);
    }
    darcy_flux.values.insert(darcy_flux.values.end(), q.begin(), q.end());

    const double node_volume = grid_.volume[e] / (Dim + 1);
    ElementValues<Dim> n_node;
    for (int j = 0; j <= Dim; ++j) {
      n_node[j] = pores[j] / node_volume;
      fines_at_nodes[e][j] = grains[j] / node_volume;
      concentration_at_nodes[e][j] = grains[j] / pores[j];
    }
    const auto n_vertex = Nodes::at_vertices(n_node);
    const auto f_vertex = Nodes::at_vertices(fines_at_nodes[e]);
    const auto c_vertex = Nodes::at_vertices(concentration_at_nodes[e]);
    for (int k = 0; k <= Dim; ++k) {
      vertex_porosity.values.push_back(n_vertex[k]);
      vertex_fines.values.push_back(f_vertex[k]);
      vertex_water.values.push_back(n_vertex[k] - f_vertex[k]);
      vertex_concentration.values.push_back(c_vertex[k]);
    }
  }
  result.cell = {std::move(porosity),      {"pressure", "Pa", 1, moment.pressure},
                 std::move(concentration), std::move(fines),
                 std::move(water),         std::move(erodible),
                 std::move(darcy_flux),    std::move(region)};
  result.element_vertex = {std::move(vertex_porosity), std::move(vertex_concentration),
                           std::move(vertex_fines), std::move(vertex_water)};

  Field velocity{"liquid_velocity", "m/s", Dim, {}};
  for (const Vector<Dim>& v : moment.velocity) {
    velocity.values.insert(velocity.values.end(), v.begin(), v.end());
  }
  result.node = {std::move(velocity), node_pressure(moment.pressure)};

  Field point_solid{"solid_fraction", "1", 1, {}};
  Field point_erodible{"erodible_fraction", "1", 1, {}};
  Field point_concentration{"concentration", "1", 1, {}};
  Field point_fines{"fines_fraction", "1", 1, {}};
  Field point_rate{"erosion_rate", "1/s", 1, {}};
  Field point_pressure{"pressure", "Pa", 1, {}};
  const MaterialPoints<Dim>& points = skeleton_.points();
  for (int p = 0; p < points.size(); ++p) {
    const int e = points.element[p];
    const double n = state.porosity[p];
    point_solid.values.push_back(1.0 - n);
    point_erodible.values.push_back(skeleton_.soil_of_point(p).porosity_max() - n);
    point_concentration.values.push_back(
        Nodes::value(concentration_at_nodes[e], points.barycentric[p]));
    point_fines.values.push_back(Nodes::value(fines_at_nodes[e], points.barycentric[p]));
    point_rate.values.push_back(erosion_rate(skeleton_.erosion_of_element(e), n, state.time));
    point_pressure.values.push_back(moment.pressure[e]);
  }
  result.solid = {{"porosity", "1", 1, state.porosity},
                  std::move(point_solid),
                  std::move(point_erodible),
                  std::move(point_concentration),
                  std::move(point_fines),
                  std::move(point_rate),
                  std::move(point_pressure)};
  return result;
}

template <int Dim>
std::vector<PassTiming> SinglePoint<Dim>::passes() const {
  return {timings_.flow, timings_.erosion, timings_.transport, timings_.water};
}

template <int Dim>
std::vector<std::string> SinglePoint<Dim>::take_warnings() {
  return std::exchange(warnings_, {});
}

template class SinglePoint<2>;

}  // namespace suffuse
