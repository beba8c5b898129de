#include "flow/nodal_flow.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "flow/locking.hpp"
#include "flow/steady_nodal.hpp"
#include "grid/compensated_sum.hpp"
#include "physics/drag.hpp"
#include "physics/liquid.hpp"

namespace suffuse {
namespace {

/// Solving for the steady flow of more elements than this would take longer than the warning is
/// worth.
constexpr int most_elements_checked = 100000;

template <int Dim>
Vector<Dim> gravity_of(const Scene& scene) {
  Vector<Dim> g;
  for (int d = 0; d < Dim; ++d) g[d] = scene.gravity[d];
  return g;
}

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
NodalFlow<Dim>::NodalFlow(const Case<Dim>& c, const Grid<Dim>& grid,
                          const RigidSkeleton<Dim>& skeleton, int threads)
    : scene_(c.document.scene),
      grid_(grid),
      skeleton_(skeleton),
      conditions_(face_conditions(c, grid)),
      operator_(grid, conditions_, gravity_of<Dim>(scene_), scene_.flow.porosity_gradient_term),
      scheme_(operator_, scheme_settings(scene_, threads)),
      grain_density_(scene_.soils.front().grain_density),
      inflow_warned_(scene_.boundaries.size(), false) {
  const bool ergun = std::any_of(scene_.soils.begin(), scene_.soils.end(),
                                 [](const Soil& s) { return s.drag == SoilDrag::ergun; });
  if (!ergun) return;
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    const Soil& soil = skeleton.soil_of_element(e);
    const bool has_it = soil.drag == SoilDrag::ergun;
    grain_size_.push_back(
        has_it ? ergun_grain_size(soil.conductivity,
                                  soil.initial_porosity(element_centroid(grid.mesh, e)),
                                  scene_.liquid.density, scene_.liquid.viscosity)
               : std::numeric_limits<double>::infinity());
  }
}

template <int Dim>
void NodalFlow<Dim>::update(double time, const PoreContent& content,
                            const std::vector<double>& face_concentration) {
  const int elements = grid_.mesh.element_count();
  coefficients_.porosity = content.porosity;
  coefficients_.water_volume = content.water_volume;
  coefficients_.mixture_density.resize(elements);
  coefficients_.drag.resize(elements);
  coefficients_.quadratic_drag.resize(grain_size_.size());
  coefficients_.face_concentration = face_concentration;
  const double water_density = scene_.liquid.density;
  for (int e = 0; e < elements; ++e) {
    const double porosity = content.porosity[e];
    const Soil& soil = skeleton_.soil_of_element(e);
    coefficients_.mixture_density[e] =
        mixture_density(content.concentration[e], water_density, grain_density_);
    coefficients_.drag[e] = darcy_drag(porosity, water_density, soil.conductivity);
    if (!grain_size_.empty()) {
      coefficients_.quadratic_drag[e] =
          ergun_quadratic_drag(porosity, water_density, grain_size_[e]);
    }
    if (soil.erosion.momentum_transfer) {
      const double rate = erosion_rate(skeleton_.erosion_of_element(e), porosity, time);
      coefficients_.drag[e] += grain_density_ * rate / porosity;
    }
  }
  operator_.update(coefficients_);
  scheme_.update(coefficients_);
}

template <int Dim>
void NodalFlow<Dim>::start(std::vector<std::string>& warnings) {
  if (scene_.initial_flow == InitialFlow::rest) {
    if (grid_.mesh.element_count() <= most_elements_checked) {
      warn_of_locking(steady_flow(operator_).velocity, warnings);
    }
    scheme_.set_velocity(VectorField<Dim>(grid_.mesh.node_count(), Vector<Dim>::Zero()));
    return;
  }
  NodalFlowState<Dim> steady = steady_flow(operator_);
  if (steady.imbalance > 1e-6) {
    std::ostringstream message;
    message << "the steady initial flow leaves a net outflow of " << steady.imbalance
            << " times the largest face flux in an element: linear velocities cannot follow this "
               "flow on this mesh; it will store or release water at first";
    warnings.push_back(message.str());
  }
  warn_of_locking(steady.velocity, warnings);
  scheme_.set_pressure(std::move(steady.pressure));
  scheme_.set_velocity(std::move(steady.velocity));
}

template <int Dim>
void NodalFlow<Dim>::warn_of_locking(const VectorField<Dim>& steady_velocity,
                                     std::vector<std::string>& warnings) const {
  if (grid_.mesh.element_count() > most_elements_checked) return;
  // The mixed elements it is compared with know Darcy's drag alone.
  if (!scene_.flow.porosity_gradient_term || !grain_size_.empty()) return;
  const auto deviation =
      deviation_from_mixed_flow(operator_, coefficients_, gravity_of<Dim>(scene_), steady_velocity);
  if (!deviation || *deviation < locked_deviation) return;
  std::ostringstream message;
  message.precision(2);
  message
      << "the explicit scheme does not follow this flow on this mesh: its steady flux differs by "
      << 100.0 * *deviation
      << " % from that of mixed finite elements (volumetric locking). Fluxes, pressures and fines "
         "will be wrong; porosity is not touched. Take mesh.structure = \"crossed\", or smaller "
         "elements if it is";
  warnings.push_back(message.str());
}

template <int Dim>
StabilityLimit NodalFlow<Dim>::current_limit(double step) const {
  std::vector<double> speed;
  if (!grain_size_.empty()) {
    for (const Vector<Dim>& v : scheme_.velocity()) speed.push_back(v.norm());
  }
  constexpr double moved = 1e-3;
  const LiquidProperties& liquid = scene_.liquid;
  const TimeSettings& time = scene_.time;
  StabilityLimit limit = stability_limit(grid_, coefficients_, operator_.node_porosity(),
                                         liquid.bulk_modulus, time.mass_scaling, time.drag, speed);
  if (step <= limit.step || !uses_assembled_limit(scene_)) return limit;
  // Not a number at first, which is far from everything.
  if (!(std::abs(limit.step - element_limit_) <= moved * limit.step)) {
    element_limit_ = limit.step;
    assembled_limit_ = assembled_limit(operator_, coefficients_, liquid.bulk_modulus,
                                       time.mass_scaling, time.drag, speed);
  }
  limit.step = std::max(limit.step, (1.0 - moved) * assembled_limit_);
  return limit;
}

template <int Dim>
std::vector<double> NodalFlow<Dim>::face_fluxes(const VectorField<Dim>& velocity) const {
  std::vector<double> result(grid_.face_count());
  for (int f = 0; f < grid_.face_count(); ++f) result[f] = operator_.face_flux(f, velocity);
  return result;
}

template <int Dim>
VectorField<Dim> NodalFlow<Dim>::darcy_flux(const std::vector<double>& face_flux) const {
  VectorField<Dim> result(grid_.mesh.element_count(), Vector<Dim>::Zero());
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    const Vector<Dim> centre = element_centroid(grid_.mesh, e);
    for (int k = 0; k <= Dim; ++k) {
      result[e] += grid_.element_face_sign[e][k] * face_flux[grid_.element_face[e][k]] *
                   (centre - grid_.mesh.nodes[grid_.mesh.elements[e][k]]) / (Dim * grid_.volume[e]);
    }
  }
  return result;
}

template <int Dim>
std::vector<double> NodalFlow<Dim>::node_pressure(const std::vector<double>& pressure) const {
  std::vector<double> result(grid_.mesh.node_count(), 0.0);
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    for (const int i : grid_.mesh.elements[e]) {
      result[i] += grid_.volume[e] / (Dim + 1) / grid_.node_volume[i] * pressure[e];
    }
  }
  std::vector<double> prescribed(result.size(), 0.0);
  std::vector<int> faces(result.size(), 0);
  for (int f = 0; f < grid_.face_count(); ++f) {
    if (conditions_[f].kind != FaceKind::pressure) continue;
    for (const int i : grid_.face_nodes[f]) {
      prescribed[i] += conditions_[f].value;
      ++faces[i];
    }
  }
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (faces[i] > 0) result[i] = prescribed[i] / faces[i];
  }
  return result;
}

template <int Dim>
void NodalFlow<Dim>::describe(const FlowMoment<Dim>& moment, HistoryRow& row) const {
  row.dt = moment.dt;
  CompensatedSum in;
  CompensatedSum out;
  for (int f = 0; f < grid_.face_count(); ++f) {
    if (!grid_.is_outer(f)) continue;
    const double flux = operator_.face_flux(f, moment.velocity);
    if (flux < 0.0) in.add(-flux);
    if (flux > 0.0) out.add(flux);
  }
  row.flux_in = in.value();
  row.flux_out = out.value();
  // At the nodes: single elements carry patterns that push nothing.
  const std::vector<double> pressure = node_pressure(moment.pressure);
  const auto [low, high] = std::minmax_element(pressure.begin(), pressure.end());
  row.pressure_min = *low;
  row.pressure_max = *high;
  double square = 0.0;
  double volume = 0.0;
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    double smooth = 0.0;
    for (const int i : grid_.mesh.elements[e]) smooth += pressure[i] / (Dim + 1);
    const double off = moment.pressure[e] - smooth;
    square += grid_.volume[e] * off * off;
    volume += grid_.volume[e];
  }
  row.pressure_scatter = std::sqrt(square / volume);
  for (const Vector<Dim>& v : moment.velocity) row.speed_max = std::max(row.speed_max, v.norm());
}

template <int Dim>
void NodalFlow<Dim>::warn_of_unstated_inflow(double time, const std::vector<double>& entered,
                                             std::vector<std::string>& warnings) {
  for (int f = 0; f < grid_.face_count(); ++f) {
    const FaceCondition& condition = conditions_[f];
    if (condition.boundary < 0 || condition.concentration_given ||
        inflow_warned_[condition.boundary]) {
      continue;
    }
    // Round-off of a flow at rest is no inflow.
    const int e = grid_.face_left[f];
    if (entered[f] >= -1e-12 * coefficients_.porosity[e] * grid_.volume[e]) continue;
    inflow_warned_[condition.boundary] = true;
    std::ostringstream message;
    message << "liquid enters through boundary \"" << scene_.boundaries[condition.boundary].on
            << "\" at t = " << time
            << " s and the scene gives it no concentration: clean water is taken (concentration 0)";
    warnings.push_back(message.str());
  }
}

template class NodalFlow<2>;

}  // namespace suffuse
