#include "solid/pores.hpp"

#include "grid/face_flux.hpp"
#include "grid/parallel.hpp"

namespace suffuse {

void PoreState::open(const std::vector<double>& gained, const std::vector<double>& volume) {
  for (std::size_t e = 0; e < gained.size(); ++e) porosity[e] += gained[e] / volume[e];
}

template <int Dim>
ElementField<Dim> initial_pore_volume(const Grid<Dim>& grid, const SoilMap<Dim>& soils) {
  // The initial porosity is a linear function, so its values at the field nodes are exact; points
  // moved off the Gauss positions would not reproduce it.
  ElementField<Dim> result(grid.mesh.element_count());
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    for (int j = 0; j <= Dim; ++j) {
      const Vector<Dim> x = FieldNodes<Dim>::position(grid.mesh, e, j);
      result[e][j] = grid.volume[e] / (Dim + 1) * soils.soil_of_element(e).initial_porosity(x);
    }
  }
  return result;
}

template <int Dim>
ElementField<Dim> pore_field(const Grid<Dim>& grid, const Skeleton<Dim>& solid) {
  if (solid.moves()) {
    const std::vector<double> porosity = solid.element_porosity();
    ElementField<Dim> even(grid.mesh.element_count());
    for (int e = 0; e < grid.mesh.element_count(); ++e) {
      even[e].fill(porosity[e] * grid.volume[e] / (Dim + 1));
    }
    return even;
  }
  ElementField<Dim> result = initial_pore_volume(grid, solid.soils());
  const MaterialPoints<Dim>& points = solid.soils().points();
  for (int p = 0; p < points.size(); ++p) {
    const double volume = points.volume[p] * (solid.porosity()[p] - solid.initial_porosity()[p]);
    for (int j = 0; j <= Dim; ++j) {
      result[points.element[p]][j] += volume * FieldNodes<Dim>::basis(points.barycentric[p][j]);
    }
  }
  return result;
}

template <int Dim>
std::vector<double> acting_element_flux(const Grid<Dim>& grid, const Skeleton<Dim>& solid,
                                        const FluxHistory& history, int threads) {
  const SoilMap<Dim>& soils = solid.soils();
  std::vector<double> result;
  if (!soils.exchange_depends_on().flux) return result;
  result.reserve(grid.mesh.elements.size());
  for (const Vector<Dim>& q : element_flux(grid, history.mean)) {
    const auto e = static_cast<int>(result.size());
    result.push_back(acting_flux(grid, soils, e, q.norm(), history.duration));
  }
  if (!soils.exchange_depends_on().surroundings) return result;
  PointFlows flows = point_flows(grid, soils, history.mean, history.duration, threads);
  solid.find_eroding_flux(flows);
  const std::vector<double> eroding = element_means(soils, flows.eroding_flux);
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    if (soils.erosion_of_element(e).length > 0.0) result[e] = eroding[e];
  }
  return result;
}

template <int Dim>
std::vector<double> PoreForecast<Dim>::of_points_at(double time) const {
  if (!solid_.exchanges_within(time_, time)) return {};
  const SoilMap<Dim>& soils = solid_.soils();
  PointFlows ahead =
      point_flows(grid_, soils, flux_.extrapolated(time - time_), flux_.duration, threads_);
  ahead.take_liquid(liquid_);
  solid_.find_eroding_flux(ahead);
  return solid_.porosity_after(time_, time, ahead);
}

template <int Dim>
PoreState PoreForecast<Dim>::at(double time) const {
  PoreState result = now_;
  const std::vector<double> after = of_points_at(time);
  if (after.empty()) return result;
  const SoilMap<Dim>& soils = solid_.soils();
  const std::vector<double>& before = solid_.porosity();
  for_each_index(grid_.mesh.element_count(), threads_, [&](int e) {
    double growth = 0.0;
    for (int p = soils.points_begin(e); p < soils.points_begin(e + 1); ++p) {
      growth += soils.points().volume[p] * (after[p] - before[p]);
    }
    const double porosity = now_.porosity[e] + growth / grid_.volume[e];
    result.porosity[e] = porosity;
    if (liquid_.motion == LiquidMotion::flows_on) return;
    // The volume of water (1 - c) n S does not change.
    const double air = now_.air_volume.empty() ? 0.0 : now_.air_volume[e] / grid_.volume[e];
    result.concentration[e] =
        1.0 - (1.0 - now_.concentration[e]) * (now_.porosity[e] - air) / (porosity - air);
  });
  return result;
}

template ElementField<2> initial_pore_volume(const Grid<2>&, const SoilMap<2>&);
template ElementField<2> pore_field(const Grid<2>&, const Skeleton<2>&);
template std::vector<double> acting_element_flux(const Grid<2>&, const Skeleton<2>&,
                                                 const FluxHistory&, int);
template std::vector<double> acting_element_flux(const Grid<3>&, const Skeleton<3>&,
                                                 const FluxHistory&, int);
template class PoreForecast<2>;
template ElementField<3> initial_pore_volume(const Grid<3>&, const SoilMap<3>&);
template ElementField<3> pore_field(const Grid<3>&, const Skeleton<3>&);
template class PoreForecast<3>;

}  // namespace suffuse
