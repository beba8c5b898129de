#include "deformation/element_classes.hpp"

namespace suffuse {

template <int Dim>
ElementClasses::ElementClasses(const Grid<Dim>& grid, const SolidPoints<Dim>& points,
                               const PointsByElement& sorted) {
  const int elements = grid.mesh.element_count();
  std::vector<char> beside_empty(grid.mesh.node_count(), 0);
  for (int e = 0; e < elements; ++e) {
    if (!sorted.is_empty(e)) continue;
    for (const int i : grid.mesh.elements[e]) beside_empty[i] = 1;
  }
  kind.assign(elements, ElementClass::empty);
  scale.assign(elements, 0.0);
  for (int e = 0; e < elements; ++e) {
    if (sorted.is_empty(e)) continue;
    bool full = true;
    for (const int i : grid.mesh.elements[e]) full = full && !beside_empty[i];
    kind[e] = full ? ElementClass::full : ElementClass::partial;
    double volume = 0.0;
    for (const int p : sorted.of(e)) volume += points.volume[p];
    scale[e] = full ? grid.volume[e] / volume : 1.0;
  }
}

template ElementClasses::ElementClasses(const Grid<2>&, const SolidPoints<2>&,
                                        const PointsByElement&);
template ElementClasses::ElementClasses(const Grid<3>&, const SolidPoints<3>&,
                                        const PointsByElement&);

}  // namespace suffuse
