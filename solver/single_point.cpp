#include "single_point.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>

#include "case/errors.hpp"
#include "flow/steady_nodal.hpp"
#include "physics/liquid.hpp"

namespace suffuse {
namespace {

/// Transport and flow meet at the latest after so many flow steps.
constexpr long most_steps_per_interval = 1000;
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

double between(double a, double b, double share) {
  return a + share * (b - a);
}

std::vector<double> between(const std::vector<double>& a, const std::vector<double>& b,
                            double share) {
  std::vector<double> result(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) result[i] = between(a[i], b[i], share);
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
    flow_.set_pressure(std::move(steady.pressure));
    flow_.set_velocity(std::move(steady.velocity));
  } else {
    flow_.set_velocity(VectorField<Dim>(grid_.mesh.node_count(), Vector<Dim>::Zero()));
  }
  state_.water_mass.resize(grid_.mesh.element_count());
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    state_.water_mass[e] = scene.liquid.density * coefficients_.water_volume[e] *
                           density_ratio(flow_.pressure()[e], scene.liquid.bulk_modulus);
  }
  state_.crossed = accounts_.totals();
  initial_ = stored(state_);
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
  const double allowed = transport_safety * transport_.steps_allowed(state_.liquid, per_step);
  // The flow may have grown since: go up by doubling.
  const long most = std::min(most_steps_per_interval, 2 * last_steps_);
  return std::max(1L, allowed < static_cast<double>(most) ? static_cast<long>(allowed) : most);
}

template <int Dim>
auto SinglePoint<Dim>::advance(long steps, double dt, const std::vector<double>& observation_times)
    -> Interval {
  Interval interval;
  interval.begin = state_;
  flow_.reset_volumes();
  auto next = observation_times.begin();
  const auto observe = [&](double time, double step_begin, const std::vector<double>& before) {
    FlowMoment<Dim> moment;
    moment.time = time;
    moment.dt = dt;
    moment.pressure = between(before, flow_.pressure(), (time - step_begin) / dt);
    moment.velocity = flow_.velocity_at(time - (step_begin + 0.5 * dt));
    interval.moments.push_back(std::move(moment));
  };
  {
    const PassTimer timer(flow_pass_);
    std::vector<double> before;
    for (long s = 0; s < steps; ++s) {
      const double step_begin = interval.begin.time + static_cast<double>(s) * dt;
      const double step_end =
          s + 1 == steps ? std::numeric_limits<double>::infinity() : step_begin + dt;
      const bool observed = next != observation_times.end() && *next <= step_end;
      if (observed) before = flow_.pressure();
      flow_.step(dt);
      for (; next != observation_times.end() && *next <= step_end; ++next) {
        observe(*next, step_begin, before);
      }
    }
    flow_pass_.calls += steps;
  }
  const double duration = static_cast<double>(steps) * dt;
  catch_up(duration);
  last_steps_ = steps;
  last_dt_ = dt;
  interval.end = state_;
  return interval;
}

template <int Dim>
void SinglePoint<Dim>::catch_up(double duration) {
  const std::vector<double>& volume = flow_.volumes().liquid;
  std::vector<double> grains_crossed(grid_.face_count(), 0.0);
  const double allowed =
      plan_.transport ? transport_safety * transport_.steps_allowed(state_.liquid, volume) : 1.0;
  const long substeps = allowed >= 1.0 ? 1 : static_cast<long>(std::ceil(1.0 / allowed));
  std::vector<double> part = volume;
  if (substeps > 1) {
    for (double& v : part) v /= static_cast<double>(substeps);
  }
  const double begin = state_.time;
  for (long s = 0; s < substeps; ++s) {
    const double from = begin + duration * static_cast<double>(s) / static_cast<double>(substeps);
    const double to = begin + duration * static_cast<double>(s + 1) / static_cast<double>(substeps);
    ElementField<Dim> eroded(grid_.mesh.element_count(), ElementValues<Dim>{});
    if (plan_.erosion) {
      const PassTimer timer(erosion_pass_);
      std::vector<double> porosity = skeleton_.porosity_after(state_.porosity, from, to);
      eroded = skeleton_.eroded_volume(state_.porosity, porosity);
      state_.porosity = std::move(porosity);
      ++erosion_pass_.calls;
    }
    if (plan_.transport) {
      const PassTimer timer(transport_pass_);
      const std::vector<double> crossed = transport_.advance(state_.liquid, part, eroded);
      for (std::size_t f = 0; f < crossed.size(); ++f) grains_crossed[f] += crossed[f];
      ++transport_pass_.calls;
    }
  }
  state_.time = begin + duration;

  const PassTimer timer(water_pass_);
  ++water_pass_.calls;
  move_water(grains_crossed);
  warn_of_unstated_inflow();
  for (std::size_t f = 0; f < volume.size(); ++f) last_volume_rate_[f] = volume[f] / duration;
  update_flow();
  // The masses are what is conserved; the pressure follows from them.
  const LiquidProperties& liquid = case_.document.scene.liquid;
  if (case_.document.scene.flow.porosity_gradient_term) {
    std::vector<double> pressure(state_.water_mass.size());
    for (std::size_t e = 0; e < pressure.size(); ++e) {
      const double ratio = state_.water_mass[e] / (liquid.density * coefficients_.water_volume[e]);
      if (!(ratio > 0.0)) {
        std::ostringstream message;
        message << "element " << e << " at ("
                << element_centroid(grid_.mesh, static_cast<int>(e)).transpose()
                << ") has no water left at t = " << state_.time << " s";
        throw NumericalError(message.str());
      }
      pressure[e] = pressure_from_density_ratio(ratio, liquid.bulk_modulus);
    }
    flow_.set_pressure(std::move(pressure));
  } else {
    for (std::size_t e = 0; e < state_.water_mass.size(); ++e) {
      state_.water_mass[e] = liquid.density * coefficients_.water_volume[e] *
                             density_ratio(flow_.pressure()[e], liquid.bulk_modulus);
    }
  }
}

template <int Dim>
void SinglePoint<Dim>::move_water(const std::vector<double>& grains_crossed) {
  const double density = case_.document.scene.liquid.density;
  const bool conservative = case_.document.scene.flow.porosity_gradient_term;
  const FaceVolumes& volumes = flow_.volumes();
  std::vector<double> water(grid_.face_count());
  std::vector<double> fines(grid_.face_count());
  for (int f = 0; f < grid_.face_count(); ++f) {
    const double excess = (1.0 - coefficients_.face_concentration[f]) * volumes.density_excess[f];
    water[f] = density * ((volumes.liquid[f] - grains_crossed[f]) + excess);
    fines[f] = grain_density_ * grains_crossed[f];
    if (!conservative) water[f] *= coefficients_.porosity[grid_.face_left[f]];
  }
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    for (int k = 0; k <= Dim; ++k) {
      state_.water_mass[e] -= grid_.element_face_sign[e][k] * water[grid_.element_face[e][k]];
    }
  }
  accounts_.book(water, fines);
  state_.crossed = accounts_.totals();
}

template <int Dim>
void SinglePoint<Dim>::warn_of_unstated_inflow() {
  if (!plan_.transport) return;
  const auto& entries = case_.document.scene.boundaries;
  for (int f = 0; f < grid_.face_count(); ++f) {
    const FaceCondition& condition = conditions_[f];
    if (condition.boundary < 0 || condition.concentration_given ||
        inflow_warned_[condition.boundary] || flow_.volumes().liquid[f] >= 0.0) {
      continue;
    }
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
SinglePointState<Dim> SinglePoint<Dim>::state_at(const Interval& interval, double time) const {
  const SinglePointState<Dim>& a = interval.begin;
  const SinglePointState<Dim>& b = interval.end;
  if (time >= b.time) return b;
  const double share = (time - a.time) / (b.time - a.time);
  SinglePointState<Dim> result = a;
  result.time = time;
  result.water_mass = between(a.water_mass, b.water_mass, share);
  for (std::size_t k = 0; k < a.crossed.size(); ++k) {
    result.crossed[k].water_in = between(a.crossed[k].water_in, b.crossed[k].water_in, share);
    result.crossed[k].fines_in = between(a.crossed[k].fines_in, b.crossed[k].fines_in, share);
    result.crossed[k].water_out = between(a.crossed[k].water_out, b.crossed[k].water_out, share);
    result.crossed[k].fines_out = between(a.crossed[k].fines_out, b.crossed[k].fines_out, share);
  }
  result.porosity = skeleton_.porosity_after(a.porosity, a.time, time);
  const ElementField<Dim> eroded = skeleton_.eroded_volume(a.porosity, result.porosity);
  const ElementField<Dim> eroded_by_end = skeleton_.eroded_volume(a.porosity, b.porosity);
  for (std::size_t e = 0; e < eroded.size(); ++e) {
    for (int j = 0; j <= Dim; ++j) {
      const double moved =
          b.liquid.fines_volume[e][j] - a.liquid.fines_volume[e][j] - eroded_by_end[e][j];
      result.liquid.pore_volume[e][j] += eroded[e][j];
      result.liquid.fines_volume[e][j] += eroded[e][j] + share * moved;
    }
  }
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
  const auto [low, high] = std::minmax_element(moment.pressure.begin(), moment.pressure.end());
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
  for (const Sums& s : sums) {
    result.push_back(
        {s.solid.value(), s.erodible.value(), s.water.value(), s.fines.value(), s.eroded.value()});
  }
  return result;
}

template <int Dim>
LedgerRow SinglePoint<Dim>::ledger(const SinglePointState<Dim>& state) const {
  return ledger_row(state.time, stored(state)[0], state.crossed[0], initial_[0]);
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
    row.ledger = ledger_row(state.time, now[r + 1], state.crossed[r + 1], initial_[r + 1]);
    rows.push_back(row);
  }
  return rows;
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
  result.node = {std::move(velocity)};

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
  return {flow_pass_, erosion_pass_, transport_pass_, water_pass_};
}

template <int Dim>
std::vector<std::string> SinglePoint<Dim>::take_warnings() {
  return std::exchange(warnings_, {});
}

template class SinglePoint<2>;

}  // namespace suffuse
