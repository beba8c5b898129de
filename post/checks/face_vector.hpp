#pragma once

/// Faces of elements as vectors.

#include "mesh/mesh.hpp"

namespace suffuse {

/// The area of the face opposite to a corner of an element, m2 (m in two dimensions), times its
/// unit normal out of the element.
template <int Dim>
Vector<Dim> face_vector(const Mesh<Dim>& mesh, int element, int corner) {
  // The gradient of the corner's barycentric coordinate is normal to the face, into the element,
  // and 1 over the height above the face.
  Vector<Dim> gradient;
  const Vector<Dim> centre = element_centroid(mesh, element);
  for (int d = 0; d < Dim; ++d) {
    const Vector<Dim> x = centre + Vector<Dim>::Unit(d);
    gradient[d] = barycentric<Dim>(mesh, element, x)[corner] - 1.0 / (Dim + 1);
  }
  return -Dim * element_volume(mesh, element) * gradient;
}

}  // namespace suffuse
