#include "flow/flow_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "boundary/suction.hpp"
#include "common/errors.hpp"
#include "common/short_number.hpp"
#include "grid/parallel.hpp"
#include "physics/drag.hpp"
#include "physics/head.hpp"
#include "physics/liquid.hpp"

namespace suffuse {

template <int Dim>
FlowSolver<Dim>::FlowSolver(const Case<Dim>& c, const Grid<Dim>& grid, const Skeleton<Dim>& solid,
                            int threads)
    : conditions_(face_conditions(c, grid)),
      scene_(c.document.scene),
      grid_(grid),
      boundary_values_(c, grid),
      soils_(solid.soils()),
      skeleton_(solid),
      threads_(threads),
      grain_density_(scene_.soils.front().grain_density) {
  initial_porosity_.reserve(grid.mesh.elements.size());
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    initial_porosity_.push_back(
        soils_.soil_of_element(e).initial_porosity(element_centroid(grid.mesh, e)));
  }
  breakpoints_ = soils_.erosion_breakpoints(grid.ranks());
  kinks_ = boundary_values_.breakpoints();
  const std::vector<double> of_loads = solid.load_breakpoints();
  kinks_.insert(kinks_.end(), of_loads.begin(), of_loads.end());
  std::ranges::sort(kinks_);
  breakpoints_.insert(breakpoints_.end(), kinks_.begin(), kinks_.end());
  std::ranges::sort(breakpoints_);
  has_ergun_ = std::ranges::count(scene_.soils, SoilDrag::ergun, &Soil::drag) > 0;
}

template <int Dim>
void FlowSolver<Dim>::archive(StateArchive& archive) {
  archive(on_faces(conditions_), boundary_values_, coefficients_, suction_warned_, warnings_);
}

template <int Dim>
double FlowSolver<Dim>::next_breakpoint(double start, double latest) const {
  for (const double time : breakpoints_) {
    if (time > start && !is_same_time(time, start)) return std::min(time, latest);
  }
  return latest;
}

template <int Dim>
void FlowSolver<Dim>::refuse_dry(int element, double time) const {
  throw NumericalError(element_text(grid_, element) +
                       " has no water left at t = " + short_number(time) + " s");
}

template <int Dim>
void FlowSolver<Dim>::refuse_locked(double time, const std::vector<double>& concentration) const {
  const double most = scene_.liquid.viscosity_model.maximum_concentration;
  together(grid_.ranks(), [&] {
    const auto richest = std::ranges::max_element(concentration);
    if (*richest < most) return;
    throw NumericalError("fluidised grains lock: concentration " + short_number(*richest) + " in " +
                         element_text(grid_, static_cast<int>(richest - concentration.begin())) +
                         " at t = " + short_number(time) +
                         " s, where the liquid flows below c_m = " + short_number(most) + " only");
  });
}

template <int Dim>
Vector<Dim> FlowSolver<Dim>::gravity() const {
  Vector<Dim> g;
  for (int d = 0; d < Dim; ++d) g[d] = scene_.gravity[d];
  return g;
}

template <int Dim>
void FlowSolver<Dim>::update(double time, const PoreState& pores,
                             const std::vector<double>& face_concentration) {
  if (scene_.liquid.viscosity_model.depends_on_concentration()) {
    refuse_locked(time, pores.concentration);
  }
  coefficients_ = coefficients_of(time, pores, face_concentration);
}

template <int Dim>
FlowCoefficients<Dim> FlowSolver<Dim>::coefficients_of(
    double time, const PoreState& pores, const std::vector<double>& face_concentration) const {
  FlowCoefficients<Dim> result;
  const int elements = grid_.mesh.element_count();
  result.porosity = pores.porosity;
  result.water_volume = pores.water_volume;
  result.mixture_density.resize(elements);
  result.drag.resize(elements);
  result.quadratic_drag.resize(has_ergun_ ? elements : 0);
  result.face_concentration = face_concentration;
  const double water_density = scene_.liquid.density;
  const bool has_air = soils_.free_space().drains() && !skeleton_.filling().empty();
  for_each_index(elements, threads_, [&](int e) {
    const double porosity = pores.porosity[e];
    const double concentration = pores.concentration[e];
    const ExchangeModel& model = soils_.exchange_of_element(e);
    // Fines in air, which conducts well, would drive water in circles: only those in soil weigh.
    const double weighs = !has_air ? 1.0 : soils_.is_soil(e) ? skeleton_.filling()[e].share : 0.0;
    result.mixture_density[e] =
        mixture_density(weighs * concentration, water_density, grain_density_);
    const SurfaceSoil soil = surface_soil(e, porosity);
    result.drag[e] =
        darcy_drag(porosity, water_density,
                   soils_.conductivity_factor(e) * soil.easier *
                       conductivity_at(model.conductivity, model.viscosity, start_porosity(e),
                                       soil.porosity, concentration));
    if (soils_.soil_of_element(e).drag == SoilDrag::ergun) {
      const double grain_size =
          ergun_grain_size(soils_.soil_of_element(e).conductivity, start_porosity(e), water_density,
                           scene_.liquid.viscosity);
      result.quadratic_drag[e] =
          ergun_quadratic_drag(porosity, water_density, grain_size) / soil.easier;
    }
    if (soils_.soil_of_element(e).erosion.momentum_transfer) {
      const double flux = pores.flux.empty() ? unset : pores.flux[e];
      const Exchange rate = exchange_rate(
          model, {start_porosity(e), porosity, soils_.conductivity_factor(e)},
          {.flux_start = flux, .flux_end = flux, .concentration = concentration}, time);
      result.drag[e] += grain_density_ * rate.eroded / porosity;
    }
  });
  return result;
}

template <int Dim>
double FlowSolver<Dim>::start_porosity(int element) const {
  if (soils_.region_of_element(element) == grid_.mesh.element_region[element]) {
    return initial_porosity_[element];
  }
  const int first = soils_.points_begin(element);
  const int last = soils_.points_begin(element + 1);
  double sum = 0.0;
  for (int p = first; p < last; ++p) sum += skeleton_.initial_porosity()[p];
  return sum / (last - first);
}

template <int Dim>
typename FlowSolver<Dim>::SurfaceSoil FlowSolver<Dim>::surface_soil(int element,
                                                                    double porosity) const {
  /// An element of water conducts like soil of this share of the element's thickness.
  constexpr double thinnest = 1e-3;
  const std::vector<SoilFilling>& filling = skeleton_.filling();
  if (filling.empty()) return {porosity, 1.0};
  const SoilFilling& part = filling[element];
  if (part.share == 1.0) return {porosity + part.excess, 1.0};
  if (!soils_.is_soil(element)) return {initial_porosity_[element], 1.0};
  if (part.share == 0.0) return {initial_porosity_[element], 1.0 / thinnest};
  return {part.porosity, 1.0 / std::max(part.share, thinnest)};
}

template <int Dim>
std::vector<double> FlowSolver<Dim>::node_means(const std::vector<double>& pressure) const {
  std::vector<double> result = means_at_nodes(grid_, pressure, 0.0);
  prescribe_at_nodes({}, result);
  grid_.node_rows().exchange(result);
  return result;
}

template <int Dim>
void FlowSolver<Dim>::prescribe_at_nodes(const std::vector<double>& face_pressure,
                                         std::vector<double>& node_pressure) const {
  for (std::size_t f = 0; f < face_pressure.size(); ++f) {
    if (conditions_[f].kind != FaceKind::seepage) continue;
    const bool is_open = face_pressure[f] >= 0.0;
    for (const int i : grid_.face_nodes[f]) {
      node_pressure[i] = is_open ? 0.0 : std::min(node_pressure[i], 0.0);
    }
  }
  std::vector<double> prescribed(node_pressure.size(), 0.0);
  std::vector<int> faces(node_pressure.size(), 0);
  for (int f = 0; f < grid_.face_count(); ++f) {
    if (conditions_[f].kind != FaceKind::pressure) continue;
    // Water of one head stands over the face: the pressure varies from node to node.
    const bool has_head = scene_.boundaries[conditions_[f].boundary].head.has_value();
    const double density = has_head ? scene_.liquid.density : 0.0;
    for (const int i : grid_.face_nodes[f]) {
      prescribed[i] += conditions_[f].value +
                       density * gravity().dot(grid_.mesh.nodes[i] - grid_.face_centre(f));
      ++faces[i];
    }
  }
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (faces[i] > 0) node_pressure[i] = prescribed[i] / faces[i];
  }
}

template <int Dim>
void FlowSolver<Dim>::check_suction(double time) {
  const PressuresAt now{time, pressure()};
  refuse_dry_outflow(grid_, soils_, conditions_, now);
  if (suction_warned_ || gravity().norm() == 0.0) return;
  std::string warning = suction_warning(grid_, soils_, now);
  if (warning.empty()) return;
  suction_warned_ = true;
  warn(std::move(warning));
}

template <int Dim>
std::vector<double> EarlierFlow<Dim>::face_pressure(const Grid<Dim>& grid) const {
  if (!state.face_pressure.empty()) return state.face_pressure;
  std::vector<double> result;
  for (const auto& nodes : grid.face_nodes) {
    double sum = 0.0;
    for (const int node : nodes) sum += state.node_pressure[node];
    result.push_back(sum / Dim);
  }
  return result;
}

template struct EarlierFlow<2>;
template struct EarlierFlow<3>;
template class FlowSolver<2>;
template class FlowSolver<3>;

}  // namespace suffuse
