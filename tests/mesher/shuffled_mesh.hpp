#pragma once

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

#include "mesh/faces.hpp"

namespace suffuse::test {

/// The same mesh with its nodes and elements numbered at random.
template <int Dim>
Mesh<Dim> shuffled(const Mesh<Dim>& mesh) {
  std::mt19937_64 random(3);
  std::vector<int> number(mesh.nodes.size());
  std::iota(number.begin(), number.end(), 0);
  std::shuffle(number.begin(), number.end(), random);
  std::vector<int> elements(mesh.elements.size());
  std::iota(elements.begin(), elements.end(), 0);
  std::shuffle(elements.begin(), elements.end(), random);
  Mesh<Dim> result = mesh;
  for (std::size_t n = 0; n < number.size(); ++n) result.nodes[number[n]] = mesh.nodes[n];
  for (std::size_t e = 0; e < elements.size(); ++e) {
    result.elements[e] = mesh.elements[elements[e]];
    result.element_region[e] = mesh.element_region[elements[e]];
    for (int& node : result.elements[e]) node = number[node];
  }
  for (auto& set : result.boundaries) {
    for (auto& face : set.faces) {
      for (int& node : face) node = number[node];
      face = face_key<Dim>(face);
    }
  }
  return result;
}

}  // namespace suffuse::test
