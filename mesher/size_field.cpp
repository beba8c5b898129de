#include "size_field.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace suffuse {

template <int Dim>
SizeField<Dim>::SizeField(MeshSizes<Dim> sizes) : sizes_(std::move(sizes)) {
  order_.resize(sizes_.mesh.elements.size());
  std::iota(order_.begin(), order_.end(), 0);
  add_box(0, static_cast<int>(order_.size()));
}

template <int Dim>
int SizeField<Dim>::add_box(int begin, int end) {
  constexpr int few = 4;
  const Mesh<Dim>& mesh = sizes_.mesh;
  Box box{mesh.nodes[mesh.elements[order_[begin]][0]], {}, begin, end};
  box.high = box.low;
  for (int i = begin; i < end; ++i) {
    for (const int node : mesh.elements[order_[i]]) {
      box.low = box.low.cwiseMin(mesh.nodes[node]);
      box.high = box.high.cwiseMax(mesh.nodes[node]);
    }
  }
  const int index = static_cast<int>(boxes_.size());
  boxes_.push_back(box);
  if (end - begin <= few) return index;
  int axis = 0;
  (box.high - box.low).maxCoeff(&axis);
  const int middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](int a, int b) {
                     return element_centroid(mesh, a)[axis] < element_centroid(mesh, b)[axis];
                   });
  add_box(begin, middle);
  const int second = add_box(middle, end);
  boxes_[index].branch = second;
  return index;
}

template <int Dim>
double SizeField<Dim>::at(const Vector<Dim>& x) const {
  Nearest nearest{std::numeric_limits<double>::infinity(), 0.0};
  search(0, x, nearest);
  return nearest.size;
}

template <int Dim>
void SizeField<Dim>::search(int index, const Vector<Dim>& x, Nearest& nearest) const {
  const auto distance = [&](int other) {
    const Box& box = boxes_[other];
    return (x - x.cwiseMax(box.low).cwiseMin(box.high)).squaredNorm();
  };
  if (distance(index) >= nearest.distance) return;
  const Box& box = boxes_[index];
  if (box.branch == 0) {
    for (int i = box.begin; i < box.end; ++i) try_element(order_[i], x, nearest);
    return;
  }
  int first = index + 1;
  int second = box.branch;
  if (distance(second) < distance(first)) std::swap(first, second);
  search(first, x, nearest);
  search(second, x, nearest);
}

/// Takes the place of the element whose barycentric coordinates are those of x, without negative
/// ones: x itself where the element has it.
template <int Dim>
void SizeField<Dim>::try_element(int element, const Vector<Dim>& x, Nearest& nearest) const {
  std::array<double, Dim + 1> share = barycentric(sizes_.mesh, element, x);
  double sum = 0.0;
  for (double& s : share) sum += s = std::max(s, 0.0);
  Vector<Dim> place = Vector<Dim>::Zero();
  double size = 0.0;
  for (int a = 0; a <= Dim; ++a) {
    const int node = sizes_.mesh.elements[element][a];
    place += share[a] / sum * sizes_.mesh.nodes[node];
    size += share[a] / sum * sizes_.size[node];
  }
  const double distance = (place - x).squaredNorm();
  if (distance < nearest.distance) nearest = {distance, size};
}

template class SizeField<2>;
template class SizeField<3>;

}  // namespace suffuse
