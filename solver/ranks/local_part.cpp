#include "ranks/local_part.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "common/errors.hpp"

namespace suffuse {
namespace {

/// First element of a rank.
int first_of(int rank, int count, int elements) {
  return static_cast<int>(static_cast<long>(elements) * rank / count);
}

/// Throws InputError if a node comes before one that an earlier element uses.
template <int Dim>
void check_order(const Mesh<Dim>& whole) {
  int used = 0;
  for (const auto& nodes : whole.elements) {
    for (const int i : nodes) {
      if (i > used) {
        throw InputError(
            "the nodes of the mesh are not numbered in the order of its elements; "
            "expected a case that this version of suffuse-mesher made");
      }
      used = std::max(used, i + 1);
    }
  }
}

/// Number of nodes that the elements before this one use.
template <int Dim>
int nodes_before(const Mesh<Dim>& whole, int element) {
  int used = 0;
  for (int e = 0; e < element; ++e) used = std::max(used, std::ranges::max(whole.elements[e]) + 1);
  return used;
}

/// Which faces the elements of a mesh have, each named by its nodes.
template <int Dim>
class FacesOfElements {
 public:
  explicit FacesOfElements(const Mesh<Dim>& mesh) : mesh_(mesh), of_node_(mesh.nodes.size()) {
    for (int e = 0; e < mesh.element_count(); ++e) {
      for (const int i : mesh.elements[e]) of_node_[i].push_back(e);
    }
  }
  [[nodiscard]] bool contain(const std::array<int, Dim>& face) const {
    return std::ranges::any_of(of_node_[face[0]], [&](int e) {
      const auto& nodes = mesh_.elements[e];
      return std::ranges::all_of(face,
                                 [&](int i) { return std::ranges::find(nodes, i) != nodes.end(); });
    });
  }

 private:
  const Mesh<Dim>& mesh_;
  std::vector<std::vector<int>> of_node_;
};

}  // namespace

template <int Dim>
LocalMesh<Dim> local_mesh(const Mesh<Dim>& whole, int rank, int count, int rings) {
  const int elements = whole.element_count();
  if (elements < count) {
    throw InputError("got " + std::to_string(count) + " ranks for a mesh of " +
                     std::to_string(elements) + " elements; expected at most one for each");
  }
  check_order(whole);
  const int first = first_of(rank, count, elements);
  const int last = first_of(rank + 1, count, elements);
  std::vector<char> touched(whole.nodes.size(), 0);
  for (int e = first; e < last; ++e) {
    for (const int i : whole.elements[e]) touched[i] = 1;
  }
  for (int ring = 1; ring < rings; ++ring) {
    const std::vector<char> before = touched;
    for (const auto& nodes : whole.elements) {
      if (std::ranges::none_of(nodes, [&](int i) { return before[i] != 0; })) continue;
      for (const int i : nodes) touched[i] = 1;
    }
  }
  LocalMesh<Dim> part;
  PartNumbers& numbers = part.numbers;
  std::vector<int> local(whole.nodes.size(), -1);
  for (int e = 0; e < elements; ++e) {
    const auto& nodes = whole.elements[e];
    if (std::ranges::none_of(nodes, [&](int i) { return touched[i] != 0; })) continue;
    numbers.element.push_back(e);
    for (const int i : nodes) local[i] = 0;
  }
  for (int i = 0; i < whole.node_count(); ++i) {
    if (local[i] < 0) continue;
    local[i] = static_cast<int>(numbers.node.size());
    numbers.node.push_back(i);
    part.mesh.nodes.push_back(whole.nodes[i]);
  }
  part.mesh.region_names = whole.region_names;
  for (const long e : numbers.element) {
    auto nodes = whole.elements[e];
    for (int& i : nodes) i = local[i];
    part.mesh.elements.push_back(nodes);
    part.mesh.element_region.push_back(whole.element_region[e]);
  }
  const FacesOfElements<Dim> faces(part.mesh);
  for (const BoundarySet<Dim>& set : whole.boundaries) {
    BoundarySet<Dim> here{set.name, {}};
    for (auto face : set.faces) {
      if (std::ranges::any_of(face, [&](int i) { return local[i] < 0; })) continue;
      for (int& i : face) i = local[i];
      if (faces.contain(face)) here.faces.push_back(face);
    }
    part.mesh.boundaries.push_back(std::move(here));
  }
  const auto place = [](const std::vector<long>& list, long number) {
    return static_cast<int>(std::ranges::lower_bound(list, number) - list.begin());
  };
  numbers.first_element = place(numbers.element, first);
  numbers.last_element = place(numbers.element, last);
  numbers.first_node = place(numbers.node, nodes_before(whole, first));
  numbers.last_node = place(numbers.node, nodes_before(whole, last));
  return part;
}

namespace {

/// The points whose element is from `first` to `last`, both numbers of the part.
template <int Dim>
MaterialPoints<Dim> points_in(const MaterialPoints<Dim>& whole, const PartNumbers& numbers,
                              int first, int last) {
  MaterialPoints<Dim> here;
  int p = 0;
  for (int e = first; e < last; ++e) {
    const auto global = numbers.element[static_cast<std::size_t>(e)];
    while (p < whole.size() && whole.element[p] < global) ++p;
    for (; p < whole.size() && whole.element[p] == global; ++p) {
      here.element.push_back(e);
      here.barycentric.push_back(whole.barycentric[p]);
      here.volume.push_back(whole.volume[p]);
    }
  }
  return here;
}

}  // namespace

template <int Dim>
Case<Dim> local_case(const Case<Dim>& whole, LocalMesh<Dim> local) {
  const PartNumbers& numbers = local.numbers;
  Case<Dim> here;
  here.document = whole.document;
  here.mesh = std::move(local.mesh);
  here.solid_points = points_in(whole.solid_points, numbers, 0, here.mesh.element_count());
  here.liquid_points =
      points_in(whole.liquid_points, numbers, numbers.first_element, numbers.last_element);
  return here;
}

template <int Dim>
OwnPart<Dim> own_part(const Case<Dim>& whole, const std::shared_ptr<const Ranks>& ranks) {
  if (ranks->count() == 1) return {};
  // Liquid points pass at most two elements in a step.
  const int rings = whole.document.scene.formulation == Formulation::double_point ? 2 : 1;
  LocalMesh<Dim> local = local_mesh(whole.mesh, ranks->rank(), ranks->count(), rings);
  auto part = std::make_shared<RankPart>(RankPart{ranks, local.numbers});
  return {std::move(part), local_case(whole, std::move(local))};
}

template OwnPart<2> own_part(const Case<2>&, const std::shared_ptr<const Ranks>&);
template OwnPart<3> own_part(const Case<3>&, const std::shared_ptr<const Ranks>&);
template LocalMesh<2> local_mesh(const Mesh<2>&, int, int, int);
template LocalMesh<3> local_mesh(const Mesh<3>&, int, int, int);
template Case<2> local_case(const Case<2>&, LocalMesh<2>);
template Case<3> local_case(const Case<3>&, LocalMesh<3>);

}  // namespace suffuse
