#include "tools/failing_soil.hpp"

#include <cmath>

#include "boundary/boundary_loads.hpp"
#include "boundary/free_water.hpp"
#include "boundary/soil_depth.hpp"

namespace suffuse {
namespace {

/// Additional cohesion per point, Pa: half of the unit weight times `depth` at smaller depths, 0
/// elsewhere.
template <int Dim>
std::vector<double> surface_cohesion(const SoilMap<Dim>& soils, const SoilState<Dim>& state,
                                     double depth, const std::vector<double>& depths) {
  std::vector<double> cohesion(depths.size(), 0.0);
  const std::array<double, 3>& gravity = soils.scene().gravity;
  const double acceleration = std::hypot(gravity[0], gravity[1], gravity[2]);
  for (std::size_t p = 0; p < depths.size(); ++p) {
    if (depths[p] >= depth) continue;
    const Soil& soil = soils.soil_of_region(state.region[p]);
    const double density = soil.grain_density * state.solid_volume[p] / state.points.volume[p] +
                           state.liquid_mass[state.points.element[p]];
    cohesion[p] = 0.5 * density * acceleration * depth;
  }
  return cohesion;
}

}  // namespace

template <int Dim>
SafetyFactor find_safety_factor(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                                const SoilState<Dim>& state, const FailingSoil& failing,
                                Displacements displacements, int threads,
                                const StrengthReductionLimits& limits) {
  const Supports<Dim> supports = scene_supports(grid, soils);
  const PointsByElement sorted(grid.mesh.element_count(), state.points.element);
  const ElementClasses classes(grid, state.points, sorted);
  std::vector<PointSkeleton> skeleton;
  SoilMass mass{.solid = {}, .liquid = state.liquid_mass};
  for (int p = 0; p < state.points.size(); ++p) {
    const Soil& soil = soils.soil_of_region(state.region[p]);
    skeleton.push_back(skeleton_at(soil.skeleton, state.fines_left[p]));
    // Other laws than those with a strength would yield under the loads of a trial in one step.
    const bool is_elastic = soil.skeleton.moves() &&
                            !(failing.includes(soil.region) && soil.skeleton.law->has_strength());
    if (is_elastic) skeleton.back().law = skeleton_law("elastic");
    mass.solid.push_back(state.solid_volume[p] * soil.grain_density);
  }
  NodalLoads<Dim> loads = displacements == Displacements::linear
                              ? NodalLoads<Dim>(grid)
                              : NodalLoads<Dim>(grid, std::make_shared<QuadraticShapes<Dim>>(grid));
  const std::vector<double> volume = soil_volumes(state.points, sorted, classes);
  add_weight(grid, state.points, volume, mass, soils.scene().gravity, loads);
  const PointsByElement at_start(grid.mesh.element_count(), soils.points().element);
  BoundaryLoads<Dim> boundaries(grid, soils, at_start);
  boundaries.place(state.surfaces);
  boundaries.add(sorted, volume, state.time, loads);
  if (has_free_water(grid, soils)) {
    add_free_water(grid, sorted, volume, state.pressure, state.liquid_mass, soils.scene().gravity,
                   loads);
  }
  std::vector<double> kept;
  if (failing.depth > 0.0) {
    kept = surface_cohesion(soils, state, failing.depth,
                            depths_below_surface(grid, supports, state.points, sorted));
  }
  const SolidBody<Dim> body{grid,
                            state.points,
                            sorted,
                            skeleton,
                            classes,
                            {},
                            unit_weights(state.points, volume, mass, soils.scene().gravity)};
  return find_safety_factor<Dim>(body, supports, loads, state.pressure, threads, limits, kept);
}

template SafetyFactor find_safety_factor(const Grid<2>&, const SoilMap<2>&, const SoilState<2>&,
                                         const FailingSoil&, Displacements, int,
                                         const StrengthReductionLimits&);
template SafetyFactor find_safety_factor(const Grid<3>&, const SoilMap<3>&, const SoilState<3>&,
                                         const FailingSoil&, Displacements, int,
                                         const StrengthReductionLimits&);

}  // namespace suffuse
