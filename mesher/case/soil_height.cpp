#include "case/soil_height.hpp"

#include <algorithm>
#include <limits>

#include "physics/head.hpp"
#include "physics/skeleton/skeleton_law.hpp"

namespace suffuse {

template <int Dim>
double height_that_yields(const Case<Dim>& c) {
  const Scene& scene = c.document.scene;
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  for (int e = 0; e < c.mesh.element_count(); ++e) {
    const Soil* soil = scene.find_soil(c.mesh.region_names[c.mesh.element_region[e]]);
    if (!soil || !soil->skeleton.moves() || !soil->skeleton.law->yields()) continue;
    for (const int i : c.mesh.elements[e]) {
      const double z = height(c.mesh.nodes[i], scene.gravity);
      lowest = std::min(lowest, z);
      highest = std::max(highest, z);
    }
  }
  return std::max(0.0, highest - lowest);
}

template double height_that_yields(const Case<2>&);
template double height_that_yields(const Case<3>&);

}  // namespace suffuse
