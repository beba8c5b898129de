#include "mesh/slit.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "mesh/faces.hpp"

namespace suffuse {
namespace {

template <int Dim>
class Slitting {
 public:
  using Face = std::array<int, Dim>;

  Slitting(Mesh<Dim>& mesh, const std::vector<BoundarySet<Dim>>& cuts)
      : mesh_(mesh), cuts_(cuts), elements_(mesh.elements) {
    for (const BoundarySet<Dim>& set : cuts) {
      for (const Face& face : set.faces) {
        cut_.insert(face_key<Dim>(face));
        for (const int node : face) around_[node];
      }
    }
    for (int e = 0; e < mesh.element_count(); ++e) {
      bool touches = false;
      for (const int node : mesh.elements[e]) {
        const auto found = around_.find(node);
        if (found == around_.end()) continue;
        found->second.push_back(e);
        touches = true;
      }
      for (int corner = 0; touches && corner <= Dim; ++corner) {
        owners_[face_key<Dim>(face_opposite<Dim>(mesh.elements[e], corner))].push_back(e);
      }
    }
  }

  std::vector<JoinedFace<Dim>> run() {
    for (const auto& [node, elements] : around_) part_fans(node, elements);
    for (BoundarySet<Dim>& set : mesh_.boundaries) {
      for (Face& face : set.faces) {
        const auto owners = owners_.find(face_key<Dim>(face));
        if (owners != owners_.end()) face = renamed(face, owners->second.front());
      }
    }
    std::vector<JoinedFace<Dim>> joined;
    for (const BoundarySet<Dim>& set : cuts_) {
      BoundarySet<Dim>& sides = mesh_.boundaries.emplace_back();
      sides.name = set.name;
      for (const Face& face : set.faces) {
        const std::vector<int>& owners = owners_.at(face_key<Dim>(face));
        if (owners.size() != 2) continue;  // another problem of the mesh
        const Face first = renamed(face, owners[0]);
        const Face second = renamed(face, owners[1]);
        if (first == second) {
          joined.push_back({set.name, face});
          continue;
        }
        sides.faces.push_back(first);
        sides.faces.push_back(second);
      }
    }
    mesh_.elements = std::move(elements_);
    return joined;
  }

 private:
  /// Gives every fan around a node, except the first, its own node.
  void part_fans(int node, const std::vector<int>& elements) {
    std::vector<std::size_t> fan(elements.size());
    std::iota(fan.begin(), fan.end(), 0U);
    const auto root = [&](std::size_t i) {
      while (fan[i] != i) i = fan[i] = fan[fan[i]];
      return i;
    };
    std::map<Face, std::size_t> seen;  // faces at the node, with the first element found
    for (std::size_t i = 0; i < elements.size(); ++i) {
      const auto& corners = mesh_.elements[elements[i]];
      for (int corner = 0; corner <= Dim; ++corner) {
        if (corners[corner] == node) continue;  // the face opposite to the node does not have it
        const Face face = face_key<Dim>(face_opposite<Dim>(corners, corner));
        if (cut_.contains(face)) continue;
        const auto [entry, is_new] = seen.emplace(face, i);
        if (is_new) continue;
        const auto [low, high] = std::minmax({root(i), root(entry->second)});
        fan[high] = low;
      }
    }
    std::map<std::size_t, int> node_of_fan{{root(0), node}};
    for (std::size_t i = 0; i < elements.size(); ++i) {
      const auto [entry, is_new] = node_of_fan.emplace(root(i), mesh_.node_count());
      if (is_new) mesh_.nodes.push_back(Vector<Dim>(mesh_.nodes[node]));
      std::ranges::replace(elements_[elements[i]], node, entry->second);
    }
  }

  /// A face of an element by the nodes that the element has now.
  [[nodiscard]] Face renamed(Face face, int element) const {
    const auto& before = mesh_.elements[element];
    for (int& node : face) {
      node = elements_[element][std::ranges::find(before, node) - before.begin()];
    }
    return face_key<Dim>(face);
  }

  Mesh<Dim>& mesh_;
  const std::vector<BoundarySet<Dim>>& cuts_;
  std::vector<std::array<int, Dim + 1>> elements_;  ///< with doubled nodes; `mesh_` has single ones
  std::set<Face> cut_;
  std::map<int, std::vector<int>> around_;   ///< elements around each node of the cuts
  std::map<Face, std::vector<int>> owners_;  ///< elements with each of their faces
};

}  // namespace

template <int Dim>
std::vector<JoinedFace<Dim>> slit(Mesh<Dim>& mesh, const std::vector<BoundarySet<Dim>>& cuts) {
  return cuts.empty() ? std::vector<JoinedFace<Dim>>{} : Slitting<Dim>(mesh, cuts).run();
}

template <int Dim>
bool is_slit(const Mesh<Dim>& mesh, const BoundarySet<Dim>& set) {
  if (set.faces.empty() || set.faces.size() % 2 != 0) return false;
  for (std::size_t i = 0; i < set.faces.size(); i += 2) {
    const auto& other = set.faces[i + 1];
    if (set.faces[i] == other) return false;
    for (const int node : set.faces[i]) {
      const bool met = std::ranges::any_of(
          other, [&](int opposite) { return mesh.nodes[opposite] == mesh.nodes[node]; });
      if (!met) return false;
    }
  }
  return true;
}

template std::vector<JoinedFace<2>> slit(Mesh<2>&, const std::vector<BoundarySet<2>>&);
template std::vector<JoinedFace<3>> slit(Mesh<3>&, const std::vector<BoundarySet<3>>&);
template bool is_slit(const Mesh<2>&, const BoundarySet<2>&);
template bool is_slit(const Mesh<3>&, const BoundarySet<3>&);

}  // namespace suffuse
