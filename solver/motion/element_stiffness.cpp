#include "motion/element_stiffness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/head.hpp"

namespace suffuse {
namespace {

/// Soil that lacks at most this share of an element fills it.
constexpr double missing_by_round_off = 1e-12;

}  // namespace

template <int Dim>
std::vector<double> oedometer_moduli(const SoilMap<Dim>& soils,
                                     const std::vector<PointSkeleton>& skeleton) {
  std::vector<double> result(skeleton.size(), 0.0);
  for (std::size_t p = 0; p < skeleton.size(); ++p) {
    if (!soils.soil_of_point(static_cast<int>(p)).skeleton.moves()) continue;
    result[p] = skeleton[p].parameters.oedometer_modulus();
  }
  return result;
}

template <int Dim>
std::vector<double> drained_compressibility(const Grid<Dim>& grid, const SolidPoints<Dim>& points,
                                            const std::vector<double>& modulus,
                                            bool has_free_water) {
  const Mesh<Dim>& mesh = grid.mesh;
  std::vector<double> stiffness(mesh.element_count(), 0.0);
  std::vector<double> volume(mesh.element_count(), 0.0);
  std::vector<char> at_soil(mesh.node_count(), 0);
  double softest = std::numeric_limits<double>::infinity();
  for (int p = 0; p < points.size(); ++p) {
    if (modulus[p] == 0.0) continue;
    const int e = points.element[p];
    softest = std::min(softest, modulus[p]);
    stiffness[e] += points.volume[p] * modulus[p];
    volume[e] += points.volume[p];
    for (const int i : mesh.elements[e]) at_soil[i] = 1;
  }
  std::vector<double> result(mesh.element_count(), 0.0);
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (volume[e] > 0.0) {
      result[e] = grid.volume[e] * volume[e] / stiffness[e];
    } else if (has_free_water &&
               std::ranges::any_of(mesh.elements[e], [&](int i) { return at_soil[i] != 0; })) {
      result[e] = grid.volume[e] / softest;
    }
  }
  return result;
}

template <int Dim>
std::vector<double> diffusivity(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                                const PointsByElement& sorted, std::vector<double> compressibility,
                                const std::vector<double>& initial_porosity,
                                const std::vector<double>& porosity) {
  const Scene& scene = soils.scene();
  std::vector<double> result = std::move(compressibility);
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    if (result[e] == 0.0) continue;
    const double modulus = grid.volume[e] / result[e];
    double conductivity = std::numeric_limits<double>::infinity();
    for (const int p : sorted.of(e)) {
      const Soil& soil = soils.soil_of_point(p);
      const double along = soil.conductivity_model().at(initial_porosity[p], porosity[p]);
      conductivity = std::min({conductivity, along, along * soil.anisotropy()});
    }
    result[e] = conductivity * modulus / unit_weight(scene.liquid.density, {});
  }
  return result;
}

std::vector<SoilFilling> soil_filling(const ElementClasses& classes, const SoilVolumes& own,
                                      const SoilVolumes& smoothed,
                                      const std::vector<double>& element_porosity) {
  std::vector<SoilFilling> result(classes.full.size());
  for (std::size_t e = 0; e < result.size(); ++e) {
    const double solid = 1.0 - element_porosity[e];
    const double of_soil = 1.0 - smoothed.porosity(e);
    double share = of_soil > 0.0 ? solid / of_soil : 0.0;
    if (share > 1.0 - missing_by_round_off) share = 1.0;
    const double full = classes.full[e];
    result[e] = {std::lerp(share, 1.0, full),
                 std::lerp(smoothed.porosity(e), own.porosity(e), full), 0.0};
    if (full > 0.0) result[e].excess = own.porosity(e) - element_porosity[e];
  }
  return result;
}

template std::vector<double> oedometer_moduli(const SoilMap<2>&, const std::vector<PointSkeleton>&);
template std::vector<double> oedometer_moduli(const SoilMap<3>&, const std::vector<PointSkeleton>&);
template std::vector<double> drained_compressibility(const Grid<2>&, const SolidPoints<2>&,
                                                     const std::vector<double>&, bool);
template std::vector<double> drained_compressibility(const Grid<3>&, const SolidPoints<3>&,
                                                     const std::vector<double>&, bool);
template std::vector<double> diffusivity(const Grid<2>&, const SoilMap<2>&, const PointsByElement&,
                                         std::vector<double>, const std::vector<double>&,
                                         const std::vector<double>&);
template std::vector<double> diffusivity(const Grid<3>&, const SoilMap<3>&, const PointsByElement&,
                                         std::vector<double>, const std::vector<double>&,
                                         const std::vector<double>&);

}  // namespace suffuse
