#pragma once

/// Where the tangent matrix of the soil has entries.

#include <Eigen/SparseCore>
#include <array>
#include <vector>

#include "solid/supports.hpp"

namespace suffuse {

/// Components of a displacement at the nodes of an element.
template <int Dim>
inline constexpr std::size_t element_components = std::size_t(Dim) * (Dim + 1);

/// What couples unknowns: linear displacements of elements with soil, and patches.
struct SoilCouplings {
  std::vector<int> elements;
  /// Nodes of each patch that shares its dilatation; nodes and edges of each element with quadratic
  /// displacements.
  std::vector<std::vector<int>> patches;

  bool operator==(const SoilCouplings&) const = default;
  void archive(auto& archive) { archive(elements, patches); }
};

/// Per node: whether it is a corner of one of these elements.
template <int Dim>
std::vector<char> nodes_of(const Mesh<Dim>& mesh, const std::vector<int>& elements) {
  std::vector<char> used(mesh.node_count(), 0);
  for (const int e : elements) {
    for (const int i : mesh.elements[e]) used[i] = 1;
  }
  return used;
}

template <int Dim>
class StiffnessPattern {
 public:
  /// Indices among the values of the matrix, column by column; -1 in held directions.
  using ElementSlots = std::array<int, element_components<Dim> * element_components<Dim>>;

  StiffnessPattern(const Mesh<Dim>& mesh, const DisplacementUnknowns<Dim>& unknowns,
                   SoilCouplings couplings);

  [[nodiscard]] const SoilCouplings& couplings() const { return couplings_; }
  /// The matrix with zeros for all entries.
  [[nodiscard]] const Eigen::SparseMatrix<double>& zeros() const { return zeros_; }
  /// Entries of the matrix of the k-th element, with the directions of its nodes in their order.
  [[nodiscard]] const ElementSlots& of_element(std::size_t k) const { return of_element_[k]; }
  /// Entries of all pairs of unknowns of the k-th patch.
  [[nodiscard]] const std::vector<int>& of_patch(std::size_t k) const { return of_patch_[k]; }

 private:
  SoilCouplings couplings_;
  Eigen::SparseMatrix<double> zeros_;
  std::vector<ElementSlots> of_element_;
  std::vector<std::vector<int>> of_patch_;
};

}  // namespace suffuse
