#include "equilibrium/nodal_dilatation.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace suffuse {
namespace {

/// Sides of a cell's diagonal that differ in direction by less than this are one line.
constexpr double in_line = 1e-6;

/// The other two nodes of an element.
std::array<int, 2> others(const std::array<int, 3>& nodes, int node) {
  const auto at = static_cast<int>(std::ranges::find(nodes, node) - nodes.begin());
  return {nodes[(at + 1) % 3], nodes[(at + 2) % 3]};
}

/// Whether four triangles around a node are a quadrangle that is cut along both diagonals.
bool is_crossing(const Mesh<2>& mesh, int node, const std::array<int, 4>& triangles) {
  const std::array<int, 2> first = others(mesh.elements[triangles[0]], node);
  for (const int end : first) {
    const Vector<2> to = (mesh.nodes[end] - mesh.nodes[node]).normalized();
    bool continues = false;
    for (const int triangle : triangles) {
      for (const int other : others(mesh.elements[triangle], node)) {
        const Vector<2> from = (mesh.nodes[other] - mesh.nodes[node]).normalized();
        continues = continues || (to + from).norm() < in_line;
      }
    }
    if (!continues) return false;
  }
  return true;
}

/// Per element: whether it is a quarter of a quadrangle that is cut along its diagonals.
std::vector<char> crossed_elements(const Mesh<2>& mesh) {
  std::vector<int> count(mesh.node_count(), 0);
  std::vector<std::array<int, 4>> around(mesh.node_count());
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (const int i : mesh.elements[e]) {
      if (count[i] < 4) around[i][count[i]] = e;
      ++count[i];
    }
  }
  std::vector<char> result(mesh.elements.size(), 0);
  for (int i = 0; i < mesh.node_count(); ++i) {
    if (count[i] != 4 || !is_crossing(mesh, i, around[i])) continue;
    for (const int e : around[i]) result[e] = 1;
  }
  return result;
}

std::vector<char> crossed_elements(const Mesh<3>& mesh) {
  return std::vector<char>(mesh.elements.size(), 0);
}

}  // namespace

template <int Dim>
NodalDilatation<Dim>::NodalDilatation(const Grid<Dim>& grid, std::vector<double> weight) {
  const Mesh<Dim>& mesh = grid.mesh;
  const std::vector<char> crossed = crossed_elements(mesh);
  for (std::size_t e = 0; e < weight.size(); ++e) {
    if (crossed[e] != 0) weight[e] = 0.0;
  }
  if (std::ranges::all_of(weight, [](double w) { return w == 0.0; })) return;
  weight_ = std::move(weight);
  corner_.resize(weight_.size());
  std::vector<int> of_first(mesh.node_count(), -1);  // of the region that comes first at a node
  std::vector<int> first_region(mesh.node_count(), -1);
  std::map<std::pair<int, int>, int> of_others;
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (weight_[e] == 0.0) continue;
    const int region = mesh.element_region[e];
    for (int a = 0; a <= Dim; ++a) {
      const int i = mesh.elements[e][a];
      if (first_region[i] < 0) first_region[i] = region;
      const bool is_first = first_region[i] == region;
      int& number = is_first ? of_first[i] : of_others.try_emplace({i, region}, -1).first->second;
      if (number < 0) {
        number = static_cast<int>(around_.size());
        around_.push_back(0.0);
      }
      corner_[e][a] = number;
      around_[number] += weight_[e];
    }
  }
}

template <int Dim>
std::vector<double> NodalDilatation<Dim>::over_nodes(const std::vector<double>& values) const {
  std::vector<double> of_node(around_.size(), 0.0);
  for (std::size_t e = 0; e < values.size(); ++e) {
    if (weight_[e] == 0.0) continue;
    for (const int node : corner_[e]) of_node[node] += values[e];
  }
  for (std::size_t i = 0; i < of_node.size(); ++i) of_node[i] /= around_[i];
  std::vector<double> result(values.size(), 0.0);
  for (std::size_t e = 0; e < values.size(); ++e) {
    if (weight_[e] == 0.0) continue;
    for (const int node : corner_[e]) result[e] += of_node[node] / (Dim + 1);
  }
  return result;
}

template <int Dim>
std::vector<double> NodalDilatation<Dim>::mean(const std::vector<double>& values) const {
  std::vector<double> weighted = values;
  for (std::size_t e = 0; e < values.size(); ++e) weighted[e] *= weight_[e];
  std::vector<double> result = over_nodes(weighted);
  for (std::size_t e = 0; e < values.size(); ++e) {
    if (weight_[e] == 0.0) result[e] = values[e];
  }
  return result;
}

template <int Dim>
std::vector<double> NodalDilatation<Dim>::spread(const std::vector<double>& values) const {
  std::vector<double> result = over_nodes(values);
  for (std::size_t e = 0; e < values.size(); ++e) result[e] *= weight_[e];
  return result;
}

template class NodalDilatation<2>;
template class NodalDilatation<3>;

}  // namespace suffuse
