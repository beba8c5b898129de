#include "boundary/boundary_loads.hpp"

#include <algorithm>
#include <cmath>

#include "boundary/free_water.hpp"
#include "physics/head.hpp"

namespace suffuse {
namespace {

template <int Dim>
std::vector<int> faces_of(const Grid<Dim>& grid, const std::string& boundary) {
  std::vector<int> faces;
  for (const BoundarySet<Dim>& set : grid.mesh.boundaries) {
    if (set.name != boundary) continue;
    for (const auto& nodes : set.faces) faces.push_back(grid.find_face(nodes));
  }
  std::ranges::sort(faces);
  return faces;
}

/// Pressure of the outer water at a place, Pa; 0 above its level.
template <int Dim>
double outside_pressure(const Scene& scene, double head, const Vector<Dim>& x) {
  const double above = has_gravity(scene.gravity) ? head - height(x, scene.gravity) : head;
  return std::max(0.0, above) * unit_weight(scene.liquid.density, scene.gravity);
}

/// Faces of elements with soil at outer water: those of a boundary, and those behind elements that
/// the soil has left. `passed` has the elements that are known to be left.
template <int Dim>
std::vector<int> faces_at_water(const Grid<Dim>& grid, const PointsByElement& sorted,
                                const std::vector<int>& boundary, std::vector<char>& passed) {
  std::vector<int> faces;
  std::vector<int> left;
  const auto add = [&](int element, int face) {
    if (!sorted.is_empty(element)) {
      faces.push_back(face);
    } else if (passed[element] == 0) {
      passed[element] = 1;
      left.push_back(element);
    }
  };
  for (const int f : boundary) add(grid.face_left[f], f);
  while (!left.empty()) {
    const int e = left.back();
    left.pop_back();
    for (int k = 0; k <= Dim; ++k) {
      if (const int next = grid.across(e, k); next >= 0) add(next, grid.element_face[e][k]);
    }
  }
  return faces;
}

}  // namespace

template <int Dim>
Supports<Dim> scene_supports(const Grid<Dim>& grid, const SoilMap<Dim>& soils) {
  std::vector<Support> on_face(grid.face_count(), Support::none);
  for (const BoundaryCondition& boundary : soils.scene().boundaries) {
    if (boundary.fix == Fixing::none) continue;
    const Support how = boundary.fix == Fixing::both ? Support::both : Support::normal;
    for (const int f : faces_of(grid, boundary.on)) on_face[f] = how;
  }
  for (const std::string& inside : soils.scene().names_of_slits()) {
    for (const int f : faces_of(grid, inside)) on_face[f] = Support::normal;
  }
  Supports<Dim> supports(grid, on_face);
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    if (!soils.is_soil(e) || soils.soil_of_element(e).skeleton.moves()) continue;
    supports.hold_element(grid.mesh, e);
  }
  return supports;
}

template <int Dim>
BoundaryLoads<Dim>::BoundaryLoads(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                                  const PointsByElement& sorted)
    : grid_(grid), scene_(soils.scene()), has_free_water_(has_free_water(grid, soils)) {
  for (int b = 0; b < static_cast<int>(scene_.boundaries.size()); ++b) {
    const BoundaryCondition& boundary = scene_.boundaries[b];
    if (!boundary.traction && !boundary.head) continue;
    if (boundary.is_well()) continue;  // it stands still, whatever its water presses on
    std::vector<int> faces = faces_of(grid, boundary.on);
    if (!boundary.traction) {
      water_.emplace_back(b, std::move(faces));
      continue;
    }
    std::erase_if(faces, [&](int f) { return sorted.is_empty(grid.face_left[f]); });
    if (faces.empty()) continue;
    boundary_.push_back(b);
    surfaces_.emplace_back(grid, sorted, faces);
    stress_.emplace_back(grid, sorted, std::move(faces), surfaces_.back().places());
  }
}

template <int Dim>
void BoundaryLoads<Dim>::add(const PointsByElement& sorted, const std::vector<double>& soil_volume,
                             double time, NodalLoads<Dim>& loads) const {
  for (std::size_t k = 0; k < surfaces_.size(); ++k) {
    const BoundaryCondition& boundary = scene_.boundaries[boundary_[k]];
    const VectorFunction::Components all = boundary.traction->value(time);
    add_traction(k, sorted, soil_volume, Eigen::Map<const Vector<Dim>>(all.data()), loads);
  }
  // Free water presses on the soil through the elements that the soil has left (`add_free_water`).
  std::vector<char> passed(grid_.mesh.elements.size(), has_free_water_ ? 1 : 0);
  std::vector<char> weighed(passed.size(), 0);
  for (const auto& [b, faces] : water_) {
    const std::vector<int> at_water = faces_at_water(grid_, sorted, faces, passed);
    const double head = scene_.boundaries[b].head->value(time);
    add_water(at_water, head, sorted, loads);
    if (!has_free_water_) add_weight(at_water, head, sorted, soil_volume, weighed, loads);
  }
}

template <int Dim>
void BoundaryLoads<Dim>::add_water(const std::vector<int>& faces, double head,
                                   const PointsByElement& sorted, NodalLoads<Dim>& loads) const {
  const auto pressure = [&](const Vector<Dim>& x) {
    return outside_pressure<Dim>(scene_, head, x);
  };
  LoadedSurface<Dim>(grid_, sorted, faces).add_pressures(grid_, sorted, pressure, loads);
}

template <int Dim>
void BoundaryLoads<Dim>::add_weight(const std::vector<int>& faces, double head,
                                    const PointsByElement& sorted,
                                    const std::vector<double>& soil_volume,
                                    std::vector<char>& weighed, NodalLoads<Dim>& loads) const {
  const Vector<Dim> g = Eigen::Map<const Vector<Dim>>(scene_.gravity.data());
  const std::vector<char> of_soil = nodes_of_soil(grid_, sorted);
  for (const int f : faces) {
    const int e = soil_at(grid_, sorted, f);
    const double above = grid_.volume[e] - soil_volume[e];
    if (weighed[e] != 0 || above <= 0.0) continue;
    if (outside_pressure<Dim>(scene_, head, element_centroid(grid_.mesh, e)) == 0.0) continue;
    weighed[e] = 1;
    const Vector<Dim> weight = scene_.liquid.density * above / (Dim + 1) * g;
    loads.add(
        grid_.mesh.elements[e], [&](std::size_t) { return Vector<Dim>(weight); },
        EdgeShare<Dim>::volume, of_soil);
  }
}

template <int Dim>
void BoundaryLoads<Dim>::add_traction(std::size_t surface, const PointsByElement& sorted,
                                      const std::vector<double>& soil_volume,
                                      const Vector<Dim>& traction, NodalLoads<Dim>& loads) const {
  double share = stress_[surface].share(grid_, surfaces_[surface].places());
  if (share > 0.0 && !stress_[surface].add(grid_, sorted, soil_volume, share * traction, loads)) {
    share = 0.0;
  }
  if (share == 1.0) return;
  surfaces_[surface].add_traction(grid_, sorted, (1.0 - share) * traction, loads);
}

template <int Dim>
void BoundaryLoads<Dim>::move(const PointsByElement& sorted, const NodeVectors<Dim>& displacement) {
  std::vector<LoadedSurface<Dim>> moved = surfaces_;
  for (LoadedSurface<Dim>& surface : moved) surface.move(grid_, sorted, displacement);
  surfaces_ = std::move(moved);
}

template <int Dim>
std::map<std::string, LoadedSurface<Dim>> BoundaryLoads<Dim>::surfaces() const {
  std::map<std::string, LoadedSurface<Dim>> result;
  for (std::size_t k = 0; k < surfaces_.size(); ++k) {
    result.emplace(scene_.boundaries[boundary_[k]].on, surfaces_[k]);
  }
  return result;
}

template <int Dim>
void BoundaryLoads<Dim>::place(const std::map<std::string, LoadedSurface<Dim>>& surfaces) {
  for (std::size_t k = 0; k < surfaces_.size(); ++k) {
    const auto found = surfaces.find(scene_.boundaries[boundary_[k]].on);
    if (found == surfaces.end() || !found->second.starts_as(surfaces_[k])) continue;
    surfaces_[k] = found->second;
  }
}

template <int Dim>
std::vector<double> BoundaryLoads<Dim>::breakpoints() const {
  std::vector<double> times;
  for (const int b : boundary_) {
    const BoundaryCondition& boundary = scene_.boundaries[b];
    const std::vector<double> more = boundary.traction->breakpoints();
    times.insert(times.end(), more.begin(), more.end());
  }
  return times;
}

template <int Dim>
double BoundaryLoads<Dim>::largest_change() const {
  double largest = 0.0;
  for (const int b : boundary_) {
    const VectorFunction& traction = *scene_.boundaries[b].traction;
    const VectorFunction::Components start = traction.value(0.0);
    for (const auto& [time, value] : traction.knots) {
      for (int d = 0; d < Dim; ++d) largest = std::max(largest, std::abs(value[d] - start[d]));
    }
  }
  return largest;
}

template Supports<2> scene_supports(const Grid<2>&, const SoilMap<2>&);
template Supports<3> scene_supports(const Grid<3>&, const SoilMap<3>&);
template class BoundaryLoads<2>;
template class BoundaryLoads<3>;

}  // namespace suffuse
