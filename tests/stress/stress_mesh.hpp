#pragma once

/// Meshes for the stress study, and what can be done to them and to points.

#include <algorithm>
#include <functional>
#include <random>
#include <string>

#include "case/case_file.hpp"

namespace suffuse::stress {

/// Random numbers, the same for the same seed on every platform.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  /// In [0, 1).
  double share() { return static_cast<double>(engine_() >> 11U) * 0x1.0p-53; }
  double between(double low, double high) { return low + (high - low) * share(); }
  /// Uniform in the logarithm.
  double decades(double low, double high);
  int below(int count) { return static_cast<int>(share() * count); }
  bool chance(double probability) { return share() < probability; }

 private:
  std::mt19937_64 engine_;
};

/// 0.5 m x 1 m, 4 x 8 cells of two right triangles, region `specimen`.
Mesh<2> plain_column();
/// A plain column with other heights of its rows: `level(share of the height)` in m.
Mesh<2> column_with_levels(const std::function<double(double)>& level);
/// Regions by the place of an element's centroid: `region(centroid)` names them.
template <int Dim, class Region>
void name_regions(Mesh<Dim>& mesh, const Region& region) {
  mesh.region_names.clear();
  for (int e = 0; e < mesh.element_count(); ++e) {
    const std::string name = region(element_centroid(mesh, e));
    auto known = std::ranges::find(mesh.region_names, name);
    if (known == mesh.region_names.end()) {
      known = mesh.region_names.insert(known, name);
    }
    mesh.element_region[e] = static_cast<int>(known - mesh.region_names.begin());
  }
}
/// Moves inner nodes at random by up to `amount` in each direction, or by half as much, a quarter
/// and so on where an element would lose more than nine tenths of its area.
void jitter_nodes(Mesh<2>& mesh, double amount, unsigned seed);
/// Elements with an angle of more than 90 degrees, in three dimensions between their sides.
template <int Dim>
int obtuse_elements(const Mesh<Dim>& mesh);
/// A column of right triangles in cells of 1 : `aspect`.
Mesh<2> flat_column(double aspect);
/// Rows shifted against each other, so flat that the smallest angle is about `degrees`, the largest
/// nearly 180.
Mesh<2> obtuse_column(double degrees);

enum class Placement { anywhere, on_edges, on_nodes };
/// Puts points at other places of their elements.
void place(MaterialPoints<2>& points, Placement placement, unsigned seed);
/// Each point twice, of half the volume.
void duplicate(MaterialPoints<2>& points);
/// One point per element, with all its volume.
void join(MaterialPoints<2>& points);
/// Removes the points of every `every`-th element.
void drop(MaterialPoints<2>& points, int every);

}  // namespace suffuse::stress
