#include "coupling/moved_air.hpp"

#include <algorithm>
#include <cmath>

#include "grid/face_flux.hpp"

namespace suffuse {
namespace {

/// Adds `missing`, m3, to the air at the sides of an element in equal parts, as far as each side
/// has room or air. If no side has any, the rest is added in equal parts nevertheless.
template <int Dim>
void distribute(double missing, double room, ElementValues<Dim>& air) {
  ElementValues<Dim> space;  // of each side
  for (int k = 0; k <= Dim; ++k) space[k] = std::max(0.0, missing > 0.0 ? room - air[k] : air[k]);
  const double sign = missing > 0.0 ? 1.0 : -1.0;
  double left = std::abs(missing);
  for (int round = 0; round <= Dim; ++round) {
    const auto open = std::ranges::count_if(space, [](double s) { return s > 0.0; });
    if (open == 0) break;
    const double part = left / static_cast<double>(open);
    for (int k = 0; k <= Dim; ++k) {
      const double taken = std::min(part, space[k]);
      air[k] += sign * taken;
      space[k] -= taken;
      left -= taken;
    }
  }
  for (double& side : air) side += sign * left / (Dim + 1);
}

/// Sets each element's volume of air from the balance, exactly: the air `before` the step, plus the
/// volume that `liquid` (through faces, m3) and solid have left.
template <int Dim>
void take_place(const Grid<Dim>& grid, const ElementField<Dim>& before,
                const std::vector<double>& porosity, const std::vector<double>& liquid,
                const std::vector<double>& solid_gain, ElementField<Dim>& air) {
  for (std::size_t e = 0; e < air.size(); ++e) {
    double left = element_sum<Dim>(before[e]) - solid_gain[e];
    for (int k = 0; k <= Dim; ++k) {
      left += grid.element_face_sign[e][k] * liquid[grid.element_face[e][k]];
    }
    const double room = porosity[e] * grid.volume[e] / (Dim + 1);
    distribute<Dim>(left - element_sum<Dim>(air[e]), room, air[e]);
  }
}

}  // namespace

template <int Dim>
MovedAir<Dim>::MovedAir(const Grid<Dim>& grid, const MixedState<Dim>& flow,
                        const std::vector<double>& porosity, const std::vector<double>& soil_share,
                        const std::vector<double>& face_volume)
    : grid_(grid), solid_(face_volume.size(), 0.0), water_(solid_) {
  const std::vector<double> saturation = saturation_of(grid, flow.air, porosity);
  for (int f = 0; f < grid.face_count(); ++f) {
    // Soil that swells or sinks at the outer boundary of the mesh keeps its saturation there: water
    // crosses. It is the water before the boundary, if any. In free space air crosses, which is not
    // counted.
    if (grid.is_outer(f)) {
      const int e = grid.face_left[f];
      water_[f] =
          (flow.face_pressure[f] > 0.0 ? 1.0 : soil_share[e] * saturation[e]) * face_volume[f];
      continue;
    }
    // Porosity and saturation are those of the element that the soil comes from.
    const double pores = taken_in(f, -face_volume[f], porosity);
    solid_[f] = (1.0 - pores) * face_volume[f];
    water_[f] = pores * taken_in(f, -face_volume[f], saturation) * face_volume[f];
  }
}

template <int Dim>
double MovedAir<Dim>::taken_in(int face, double volume,
                               const std::vector<double>& of_element) const {
  return of_element[volume > 0.0 ? grid_.face_right[face] : grid_.face_left[face]];
}

template <int Dim>
double MovedAir<Dim>::pores_gained(int e) const {
  return outflow(grid_, e, solid_);
}

template <int Dim>
double MovedAir<Dim>::water(int face, double solid, const std::vector<double>& saturation) const {
  if (grid_.is_outer(face)) return water_[face];
  const double beyond = solid - solid_[face];
  return water_[face] - taken_in(face, beyond, saturation) * beyond;
}

template <int Dim>
std::vector<double> saturation_of(const Grid<Dim>& grid, const ElementField<Dim>& air,
                                  const std::vector<double>& porosity) {
  std::vector<double> result(air.size());
  for (std::size_t e = 0; e < air.size(); ++e) {
    result[e] = 1.0 - element_sum<Dim>(air[e]) / (porosity[e] * grid.volume[e]);
  }
  return result;
}

template <int Dim>
void move_liquid(const Grid<Dim>& grid, const SolidMotion& motion, const MixedState<Dim>& flow,
                 std::vector<double> porosity, const std::vector<double>& soil_share,
                 MixedStep<Dim>& step) {
  if (soil_share.empty()) {
    for (int f = 0; f < grid.face_count(); ++f) {
      step.face_volume[f] += motion.face_volume[f] - motion.solid_face_volume[f];
    }
    return;
  }
  const MovedAir<Dim> moved(grid, flow, porosity, soil_share, motion.face_volume);
  for (std::size_t e = 0; e < porosity.size(); ++e) {
    porosity[e] += moved.pores_gained(static_cast<int>(e)) / grid.volume[e];
  }
  const std::vector<double> saturation = saturation_of(grid, step.end.air, porosity);
  for (int f = 0; f < grid.face_count(); ++f) {
    step.face_volume[f] += moved.water(f, motion.solid_face_volume[f], saturation);
  }
  take_place(grid, flow.air, porosity, step.face_volume, motion.solid_gain, step.end.air);
}

template class MovedAir<2>;
template class MovedAir<3>;
template void move_liquid(const Grid<2>&, const SolidMotion&, const MixedState<2>&,
                          std::vector<double>, const std::vector<double>&, MixedStep<2>&);
template void move_liquid(const Grid<3>&, const SolidMotion&, const MixedState<3>&,
                          std::vector<double>, const std::vector<double>&, MixedStep<3>&);
template std::vector<double> saturation_of(const Grid<2>&, const ElementField<2>&,
                                           const std::vector<double>&);
template std::vector<double> saturation_of(const Grid<3>&, const ElementField<3>&,
                                           const std::vector<double>&);

}  // namespace suffuse
