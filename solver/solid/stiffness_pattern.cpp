#include "solid/stiffness_pattern.hpp"

#include "linear/sparse_entries.hpp"

namespace suffuse {
namespace {

/// Unknowns of an element along the directions of its nodes; -1 where they are held.
template <int Dim>
std::array<int, element_components<Dim>> unknowns_of_element(
    const Mesh<Dim>& mesh, const DisplacementUnknowns<Dim>& unknowns, int e) {
  std::array<int, element_components<Dim>> list;
  for (int a = 0; a <= Dim; ++a) {
    const int i = mesh.elements[e][a];
    for (int k = 0; k < Dim; ++k) {
      list[a * Dim + k] = k < unknowns.count(i) ? unknowns.first(i) + k : -1;
    }
  }
  return list;
}

template <int Dim>
std::vector<int> unknowns_of_patch(const DisplacementUnknowns<Dim>& unknowns,
                                   const std::vector<int>& nodes) {
  std::vector<int> list;
  for (const int i : nodes) {
    for (int k = 0; k < unknowns.count(i); ++k) list.push_back(unknowns.first(i) + k);
  }
  return list;
}

/// Calls a function with row and column of each pair of unknowns, column by column.
void for_each_pair(const auto& unknowns, const auto& call) {
  for (const int column : unknowns) {
    for (const int row : unknowns) call(row, column);
  }
}

}  // namespace

template <int Dim>
StiffnessPattern<Dim>::StiffnessPattern(const Mesh<Dim>& mesh,
                                        const DisplacementUnknowns<Dim>& unknowns,
                                        SoilCouplings couplings)
    : couplings_(std::move(couplings)), zeros_(unknowns.count(), unknowns.count()) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](int row, int column) {
    if (row >= 0 && column >= 0) entries.emplace_back(row, column, 0.0);
  };
  for (const int e : couplings_.elements) {
    for_each_pair(unknowns_of_element(mesh, unknowns, e), add);
  }
  for (const std::vector<int>& nodes : couplings_.patches) {
    for_each_pair(unknowns_of_patch(unknowns, nodes), add);
  }
  zeros_.setFromTriplets(entries.begin(), entries.end());
  for (const int e : couplings_.elements) {
    auto slot = of_element_.emplace_back().begin();
    for_each_pair(unknowns_of_element(mesh, unknowns, e), [&](int row, int column) {
      *slot++ = row >= 0 && column >= 0 ? slot_of(zeros_, row, column) : -1;
    });
  }
  for (const std::vector<int>& nodes : couplings_.patches) {
    std::vector<int>& slots = of_patch_.emplace_back();
    for_each_pair(unknowns_of_patch(unknowns, nodes),
                  [&](int row, int column) { slots.push_back(slot_of(zeros_, row, column)); });
  }
}

template class StiffnessPattern<2>;
template class StiffnessPattern<3>;

}  // namespace suffuse
