#include "mesh/faces.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace suffuse {

template <int Dim>
std::array<int, Dim> face_key(std::array<int, Dim> nodes) {
  std::ranges::sort(nodes);
  return nodes;
}

template <int Dim>
std::array<int, Dim> face_opposite(const std::array<int, Dim + 1>& element, int corner) {
  std::array<int, Dim> face{};
  for (int d = 0; d < Dim; ++d) face[d] = element[(corner + 1 + d) % (Dim + 1)];
  return face;
}

template <int Dim>
Vector<Dim> face_normal(const Mesh<Dim>& mesh, const std::array<int, Dim>& face) {
  const Vector<Dim> side = mesh.nodes[face[1]] - mesh.nodes[face[0]];
  if constexpr (Dim == 2) {
    return {side[1], -side[0]};
  } else {
    return side.cross(mesh.nodes[face[2]] - mesh.nodes[face[0]]);
  }
}

template <int Dim>
FaceTable<Dim>::FaceTable(const Mesh<Dim>& mesh) {
  keys_.reserve(mesh.elements.size() * (Dim + 1));
  for (const auto& element : mesh.elements) {
    for (int corner = 0; corner <= Dim; ++corner) {
      keys_.push_back(face_key<Dim>(face_opposite<Dim>(element, corner)));
    }
  }
  std::ranges::sort(keys_);
}

template <int Dim>
int FaceTable<Dim>::owners(const std::array<int, Dim>& face) const {
  const auto [first, last] = std::equal_range(keys_.begin(), keys_.end(), face_key<Dim>(face));
  return static_cast<int>(last - first);
}

template std::array<int, 2> face_key<2>(std::array<int, 2>);
template std::array<int, 3> face_key<3>(std::array<int, 3>);
template std::array<int, 2> face_opposite<2>(const std::array<int, 3>&, int);
template std::array<int, 3> face_opposite<3>(const std::array<int, 4>&, int);
template Vector<2> face_normal<2>(const Mesh<2>&, const std::array<int, 2>&);
template Vector<3> face_normal<3>(const Mesh<3>&, const std::array<int, 3>&);
template class FaceTable<2>;
template class FaceTable<3>;

}  // namespace suffuse
