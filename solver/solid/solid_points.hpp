#pragma once

/// Moving solid points: their state, and the points in each element.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "grid/point_place.hpp"
#include "physics/skeleton/skeleton_response.hpp"

namespace suffuse {

/// State of the solid points. Solid volumes, which erosion changes, are in `SolidState`.
template <int Dim>
struct SolidPoints {
  SolidPoints() = default;
  /// Points without stress.
  /// \param volume  of soil with its pores, per point, m3 (per meter of thickness in 2D)
  SolidPoints(const Mesh<Dim>& mesh, const std::vector<PointPlace<Dim>>& places,
              std::vector<double> volume);

  [[nodiscard]] int size() const { return static_cast<int>(element.size()); }
  void archive(auto& archive) {
    archive(position, element, reference_volume, volume, skeleton, plastic_strain);
  }
  /// Reorders the points: point order[k] becomes point k.
  void reorder(const std::vector<int>& order);

  std::vector<Vector<Dim>> position;  ///< m
  std::vector<int> element;           ///< that holds the point
  /// Volume of soil with its pores at the start, m3: Kirchhoff stress refers to it.
  std::vector<double> reference_volume;
  std::vector<double> volume;  ///< present, m3
  std::vector<SkeletonState> skeleton;
  std::vector<double> plastic_strain;  ///< equivalent, since the start
};

/// The points of each element, in ascending order. All sums over them have this order, which
/// depends on neither threads nor earlier places.
class PointsByElement {
 public:
  PointsByElement() = default;
  PointsByElement(int element_count, const std::vector<int>& element_of_point);

  [[nodiscard]] std::span<const int> of(int element) const {
    return std::span(point_).subspan(begin_[element], begin_[element + 1] - begin_[element]);
  }
  [[nodiscard]] bool is_empty(int element) const { return begin_[element] == begin_[element + 1]; }

 private:
  std::vector<int> begin_;
  std::vector<int> point_;
};

/// Reorders values of points: value order[k] becomes value k.
template <class Value>
void reorder(const std::vector<int>& order, std::vector<Value>& values) {
  if (values.empty()) return;
  std::vector<Value> sorted;
  sorted.reserve(values.size());
  for (const int p : order) sorted.push_back(values[p]);
  values = std::move(sorted);
}

/// Per node: sum of the points' `volume`, m3, over the volume of the mesh that belongs to the node:
/// phi_i = sum_p N_i(x_p) V_p / V_i, without points and volumes of `rigid` elements.
/// \param rigid  per element; empty: none is rigid
template <int Dim>
std::vector<double> node_shares(const Grid<Dim>& grid, const SolidPoints<Dim>& points,
                                const std::vector<double>& volume,
                                const std::vector<char>& rigid = {});

}  // namespace suffuse
