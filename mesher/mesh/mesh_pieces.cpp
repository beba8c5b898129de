#include "mesh/mesh_pieces.hpp"

#include <numeric>

namespace suffuse {

namespace {

/// Sets of nodes that are united pair by pair.
class NodeSets {
 public:
  explicit NodeSets(int nodes) : above_(nodes) { std::iota(above_.begin(), above_.end(), 0); }

  /// The node that stands for the set of a node.
  int root(int node) {
    while (above_[node] != node) {
      above_[node] = above_[above_[node]];  // halves the way for the next search
      node = above_[node];
    }
    return node;
  }
  void unite(int a, int b) { above_[root(a)] = root(b); }

 private:
  std::vector<int> above_;  ///< a node of the same set; itself for the one that stands for it
};

}  // namespace

template <int Dim>
std::vector<int> mesh_pieces(const Mesh<Dim>& mesh, const std::vector<FacePair<Dim>>& joined) {
  NodeSets sets(mesh.node_count());
  for (const auto& element : mesh.elements) {
    for (const int node : element) sets.unite(node, element.front());
  }
  for (const auto& [one, other] : joined) sets.unite(one.front(), other.front());
  std::vector<int> pieces(mesh.nodes.size());
  for (int node = 0; node < mesh.node_count(); ++node) pieces[node] = sets.root(node);
  return pieces;
}

template std::vector<int> mesh_pieces<2>(const Mesh<2>&, const std::vector<FacePair<2>>&);
template std::vector<int> mesh_pieces<3>(const Mesh<3>&, const std::vector<FacePair<3>>&);

}  // namespace suffuse
