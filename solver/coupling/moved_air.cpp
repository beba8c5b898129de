#include "coupling/moved_air.hpp"

#include <algorithm>
#include <cmath>

#include "grid/face_flux.hpp"

namespace suffuse {
namespace {

/// Largest gap over the room of an element for gap, water and air. Points leave an element all at
/// once: the rest of the room is for the solid of one that is still there.
constexpr double largest_gap = 0.9;

/// The largest gap of an element, m3.
template <int Dim>
double gap_limit(const Grid<Dim>& grid, const ElementPores& pores, int e) {
  const double room = pores.porosity[e] * grid.volume[e] + pores.gap[e];
  return largest_gap * pores.soil_share[e] * room;
}

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
/// volume that `liquid` (through faces, m3) has left, plus the growth of the room.
template <int Dim>
void take_place(const Grid<Dim>& grid, const ElementField<Dim>& before,
                const std::vector<double>& porosity, const std::vector<double>& liquid,
                const std::vector<double>& room_gained, ElementField<Dim>& air) {
  for (std::size_t e = 0; e < air.size(); ++e) {
    double left = element_sum<Dim>(before[e]) + room_gained[e];
    for (int k = 0; k <= Dim; ++k) {
      left += grid.element_face_sign[e][k] * liquid[grid.element_face[e][k]];
    }
    const double room = porosity[e] * grid.volume[e] / (Dim + 1);
    distribute<Dim>(left - element_sum<Dim>(air[e]), room, air[e]);
  }
}

/// Soil swells at an outer face by the volume `moved`, m3. Returns the part that the gap takes, and
/// reduces the gap by it. The gap takes all, up to a size of `limit`. With water outside, which
/// follows the soil, soil only closes a gap, or shrinks back to the boundary.
double taken_by_gap(double& gap, double moved, double limit, bool water_outside) {
  double taken = gap - std::clamp(gap - moved, -limit, limit);
  if (water_outside)
    taken = moved > 0.0 ? std::clamp(gap, 0.0, moved) : std::clamp(gap, moved, 0.0);
  gap -= taken;
  return taken;
}

}  // namespace

template <int Dim>
ElementPores element_pores(const Grid<Dim>& grid, std::vector<double> without_solid,
                           std::vector<double> porosity, std::vector<double> soil_share) {
  std::vector<double> gap = std::move(without_solid);
  for (std::size_t e = 0; e < gap.size(); ++e) gap[e] = grid.volume[e] * (gap[e] - porosity[e]);
  return {std::move(porosity), std::move(soil_share), std::move(gap)};
}

template <int Dim>
std::optional<int> element_with_full_gap(const Grid<Dim>& grid, const ElementPores& pores) {
  constexpr double nearly = 0.95;
  if (pores.soil_share.empty()) return {};
  for (int f = 0; f < grid.face_count(); ++f) {
    const int e = grid.face_left[f];
    const bool holds_soil = grid.is_outer(f) && pores.soil_share[e] > 0.0;
    if (holds_soil && std::abs(pores.gap[e]) > nearly * gap_limit(grid, pores, e)) return e;
  }
  return {};
}

template <int Dim>
MovedAir<Dim>::MovedAir(const Grid<Dim>& grid, const std::vector<FaceCondition>& conditions,
                        const MixedState<Dim>& flow, ElementPores pores,
                        const std::vector<double>& face_volume)
    : grid_(grid), solid_(face_volume.size(), 0.0), water_(solid_) {
  const std::vector<double> saturation = saturation_of(grid, flow.air, pores.porosity);
  std::vector<double> of_soil = pores.porosity;
  for (std::size_t e = 0; e < of_soil.size(); ++e)
    of_soil[e] /= 1.0 - pores.gap[e] / grid.volume[e];
  for (int f = 0; f < grid.face_count(); ++f) {
    // Before the outer boundary of the mesh is water, or air, which is not counted.
    if (grid.is_outer(f)) {
      const int e = grid.face_left[f];
      const bool under_pressure = flow.face_pressure[f] > 0.0;
      const bool water_outside = under_pressure && conditions[f].kind == FaceKind::pressure;
      const double limit = gap_limit(grid, pores, e);
      solid_[f] = taken_by_gap(pores.gap[e], face_volume[f], limit, water_outside);
      if (under_pressure) water_[f] = face_volume[f] - solid_[f];
      continue;
    }
    // Porosity and saturation are those of the element that the soil comes from.
    const double porosity = taken_in(f, -face_volume[f], of_soil);
    solid_[f] = (1.0 - porosity) * face_volume[f];
    water_[f] = porosity * taken_in(f, -face_volume[f], saturation) * face_volume[f];
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
double MovedAir<Dim>::room_gained(int e, double solid) const {
  double result = -solid;
  for (int k = 0; k <= Dim; ++k) {
    const int f = grid_.element_face[e][k];
    if (grid_.is_outer(f)) result += grid_.element_face_sign[e][k] * solid_[f];
  }
  return result;
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
std::vector<double> move_liquid(const Grid<Dim>& grid, const std::vector<FaceCondition>& conditions,
                                const SolidMotion& motion, const MixedState<Dim>& flow,
                                ElementPores pores, MixedStep<Dim>& step) {
  std::vector<double> room;
  if (pores.soil_share.empty()) {
    for (int f = 0; f < grid.face_count(); ++f) {
      step.face_volume[f] += motion.face_volume[f] - motion.solid_face_volume[f];
    }
    for (const double gain : motion.solid_gain) room.push_back(0.0 - gain);
    return room;
  }
  const MovedAir<Dim> moved(grid, conditions, flow, pores, motion.face_volume);
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    pores.porosity[e] += moved.pores_gained(e) / grid.volume[e];
    room.push_back(moved.room_gained(e, motion.solid_gain[e]));
  }
  const std::vector<double> saturation = saturation_of(grid, step.end.air, pores.porosity);
  for (int f = 0; f < grid.face_count(); ++f) {
    step.face_volume[f] += moved.water(f, motion.solid_face_volume[f], saturation);
  }
  take_place(grid, flow.air, pores.porosity, step.face_volume, room, step.end.air);
  return room;
}

template class MovedAir<2>;
template class MovedAir<3>;
template ElementPores element_pores(const Grid<2>&, std::vector<double>, std::vector<double>,
                                    std::vector<double>);
template std::optional<int> element_with_full_gap(const Grid<2>&, const ElementPores&);
template std::vector<double> move_liquid(const Grid<2>&, const std::vector<FaceCondition>&,
                                         const SolidMotion&, const MixedState<2>&, ElementPores,
                                         MixedStep<2>&);
template ElementPores element_pores(const Grid<3>&, std::vector<double>, std::vector<double>,
                                    std::vector<double>);
template std::optional<int> element_with_full_gap(const Grid<3>&, const ElementPores&);
template std::vector<double> move_liquid(const Grid<3>&, const std::vector<FaceCondition>&,
                                         const SolidMotion&, const MixedState<3>&, ElementPores,
                                         MixedStep<3>&);
template std::vector<double> saturation_of(const Grid<2>&, const ElementField<2>&,
                                           const std::vector<double>&);
template std::vector<double> saturation_of(const Grid<3>&, const ElementField<3>&,
                                           const std::vector<double>&);

}  // namespace suffuse
