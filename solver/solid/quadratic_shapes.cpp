#include "solid/quadratic_shapes.hpp"

namespace suffuse {

template <int Dim>
QuadraticShapes<Dim>::QuadraticShapes(const Grid<Dim>& grid) : grid_(grid) {
  of_element_.reserve(grid.mesh.elements.size());
  for (const auto& nodes : grid.mesh.elements) {
    std::array<int, count>& list = of_element_.emplace_back();
    auto next = std::ranges::copy(nodes, list.begin()).out;
    for (int a = 0; a <= Dim; ++a) {
      for (int b = a + 1; b <= Dim; ++b) {
        const std::array<int, 2> ends{std::min(nodes[a], nodes[b]), std::max(nodes[a], nodes[b])};
        const auto [found, is_new] = number_.try_emplace(ends, size());
        if (is_new) ends_.push_back(ends);
        *next++ = found->second;
      }
    }
  }
}

template <int Dim>
int QuadraticShapes<Dim>::edge_between(int a, int b) const {
  return number_.at({std::min(a, b), std::max(a, b)});
}

template <int Dim>
auto QuadraticShapes<Dim>::gradients(int element, const std::array<double, Dim + 1>& at) const
    -> Gradients {
  const auto& linear = grid_.shape_gradient[element];
  Gradients result;
  int next = 0;
  for (int a = 0; a <= Dim; ++a) result.col(next++) = linear[a];
  for (int a = 0; a <= Dim; ++a) {
    for (int b = a + 1; b <= Dim; ++b) {
      result.col(next++) = 4.0 * (at[a] * linear[b] + at[b] * linear[a]);
    }
  }
  return result;
}

template class QuadraticShapes<2>;
template class QuadraticShapes<3>;

}  // namespace suffuse
