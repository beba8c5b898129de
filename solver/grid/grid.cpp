#include "grid/grid.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <string>

#include "mesh/place_text.hpp"

namespace suffuse {
namespace {

/// Rows of a node -> entity table in compressed form, from the nodes of each entity.
template <class Entities>
void invert(const Entities& nodes_of, int node_count, std::vector<int>& begin,
            std::vector<int>& list) {
  begin.assign(node_count + 1, 0);
  for (const auto& nodes : nodes_of) {
    for (const int i : nodes) ++begin[i + 1];
  }
  for (int i = 0; i < node_count; ++i) begin[i + 1] += begin[i];
  list.resize(begin.back());
  std::vector<int> next(begin.begin(), begin.end() - 1);
  for (int entity = 0; entity < static_cast<int>(nodes_of.size()); ++entity) {
    for (const int i : nodes_of[entity]) list[next[i]++] = entity;
  }
}

/// Faces with one known element, in a list for each smallest node. A face leaves its list with its
/// second element, so lists stay short.
template <int Dim>
class OpenFaces {
 public:
  explicit OpenFaces(int node_count) : first_(node_count, -1) {}

  /// Removes and returns the face with these nodes (ascending); -1 if there is none.
  int take(const std::array<int, Dim>& nodes, const std::vector<std::array<int, Dim>>& face_nodes) {
    for (int* link = &first_[nodes[0]]; *link >= 0; link = &next_[*link]) {
      const int face = *link;
      if (face_nodes[face] != nodes) continue;
      *link = next_[face];
      return face;
    }
    return -1;
  }
  /// Adds the next face.
  void put(int smallest_node) {
    next_.push_back(first_[smallest_node]);
    first_[smallest_node] = static_cast<int>(next_.size()) - 1;
  }

 private:
  std::vector<int> first_;  ///< per node
  std::vector<int> next_;   ///< per face
};

}  // namespace

template <int Dim>
Grid<Dim>::Grid(const Mesh<Dim>& mesh_in)
    : mesh(mesh_in),
      ranks_(std::make_shared<Ranks>()),
      elements_(mesh_in.element_count()),
      nodes_(mesh_in.node_count()) {
  const int elements = mesh.element_count();
  volume.resize(elements);
  shape_gradient.resize(elements);
  element_face.resize(elements);
  element_face_sign.resize(elements);
  node_volume.assign(mesh.node_count(), 0.0);
  OpenFaces<Dim> open(mesh.node_count());
  for (int e = 0; e < elements; ++e) {
    const auto& vertices = mesh.elements[e];
    Eigen::Matrix<double, Dim, Dim> edges;
    for (int d = 0; d < Dim; ++d) {
      edges.col(d) = mesh.nodes[vertices[d + 1]] - mesh.nodes[vertices[0]];
    }
    volume[e] = element_volume(mesh, e);
    const Eigen::Matrix<double, Dim, Dim> inverse = edges.inverse();
    shape_gradient[e][0].setZero();
    for (int d = 0; d < Dim; ++d) {
      shape_gradient[e][d + 1] = inverse.row(d).transpose();
      shape_gradient[e][0] -= shape_gradient[e][d + 1];
    }
    for (const int i : vertices) node_volume[i] += volume[e] / (Dim + 1);

    for (int k = 0; k <= Dim; ++k) {
      std::array<int, Dim> nodes;
      std::remove_copy(vertices.begin(), vertices.end(), nodes.begin(), vertices[k]);
      std::sort(nodes.begin(), nodes.end());
      int f = open.take(nodes, face_nodes);
      const bool is_new = f < 0;
      if (is_new) {
        f = face_count();
        open.put(nodes[0]);
        face_nodes.push_back(nodes);
        face_left.push_back(e);
        face_right.push_back(-1);
        face_normal.push_back(-Dim * volume[e] * shape_gradient[e][k]);
      } else {
        face_right[f] = e;
      }
      element_face[e][k] = f;
      element_face_sign[e][k] = is_new ? 1.0 : -1.0;
    }
  }
  faces_ = OwnRows(face_count());
  face_partner.assign(face_left.size(), no_partner);
  invert(face_nodes, mesh.node_count(), node_face_begin, node_face);
  invert(mesh.elements, mesh.node_count(), node_element_begin, node_element);
}

template <int Dim>
Grid<Dim>::Grid(const Mesh<Dim>& mesh_in, const RankPart& part) : Grid(mesh_in) {
  const PartNumbers& numbers = part.numbers;
  ranks_ = part.ranks;
  element_number_ = numbers.element;
  node_number_ = numbers.node;
  elements_ = ranks_->rows(numbers.element, numbers.first_element, numbers.last_element);
  nodes_ = ranks_->rows(numbers.node, numbers.first_node, numbers.last_node);
  // Faces are numbered as elements come to them, so own elements find own faces one by one.
  const auto place = [&](int element) {
    return static_cast<int>(std::ranges::lower_bound(face_left, element) - face_left.begin());
  };
  const int first = place(numbers.first_element);
  const int last = place(numbers.last_element);
  face_number_ = global_faces(first, last);
  faces_ = ranks_->rows(face_number_, first, last);
  settle_fringe();
  nodes_.exchange(node_volume);
}

template <int Dim>
std::vector<long> Grid<Dim>::global_faces(int first, int last) const {
  constexpr long unknown = -1;
  const long offset = ranks_->before(last - first);
  std::vector<std::array<long, Dim + 1>> of_element(element_face.size());
  for (auto& numbers : of_element) numbers.fill(unknown);
  for (const int e : elements_.own()) {
    for (int k = 0; k <= Dim; ++k) {
      const int f = element_face[e][k];
      if (f >= first && f < last) of_element[e][k] = offset + f - first;
    }
  }
  // Elements of a lower rank have found the other faces of own elements. Once these are known here,
  // all faces of all elements are known to those who own them.
  std::vector<long> result(face_count(), unknown);
  for (int round = 0; round < 2; ++round) {
    elements_.exchange(of_element);
    for (std::size_t e = 0; e < of_element.size(); ++e) {
      for (int k = 0; k <= Dim; ++k) {
        if (of_element[e][k] != unknown) result[element_face[e][k]] = of_element[e][k];
      }
    }
    for (const int e : elements_.own()) {
      for (int k = 0; k <= Dim; ++k) of_element[e][k] = result[element_face[e][k]];
    }
  }
  return result;
}

template <int Dim>
int Grid<Dim>::element_here(long number) const {
  if (element_number_.empty()) return static_cast<int>(number);
  const auto place = std::ranges::lower_bound(element_number_, number);
  const bool is_here = place != element_number_.end() && *place == number;
  return is_here ? static_cast<int>(place - element_number_.begin()) : -1;
}

template <int Dim>
void Grid<Dim>::settle_fringe() {
  std::vector<char> ends(face_count());
  for (int f = 0; f < face_count(); ++f) ends[f] = is_outer(f) ? 1 : 0;
  faces_.exchange(ends);
  for (int f = 0; f < face_count(); ++f) {
    if (is_outer(f) && ends[f] == 0) face_partner[f] = on_other_rank;
  }
  // The element that gives a face its normal may not be here.
  faces_.exchange(face_normal);
  elements_.exchange(element_face_sign);
}

template <int Dim>
void Grid<Dim>::join_faces(const std::vector<std::array<int, 2>>& pairs) {
  for (const auto& [face, partner] : pairs) {
    face_partner[face] = partner;
    face_partner[partner] = face;
  }
}

template <int Dim>
int Grid<Dim>::find_face(std::array<int, Dim> nodes) const {
  std::sort(nodes.begin(), nodes.end());
  for (int k = node_face_begin[nodes[0]]; k < node_face_begin[nodes[0] + 1]; ++k) {
    if (face_nodes[node_face[k]] == nodes) return node_face[k];
  }
  return -1;
}

template <int Dim>
Vector<Dim> Grid<Dim>::face_centre(int face) const {
  Vector<Dim> sum = Vector<Dim>::Zero();
  for (const int i : face_nodes[face]) sum += mesh.nodes[i];
  return sum / Dim;
}

namespace {

/// Angles whose negative cosine exceeds this are obtuse.
constexpr double obtuse_cosine = 1e-9;

template <int Dim>
bool is_obtuse(const Grid<Dim>& grid, int e) {
  double widest = 0.0;
  for (int a = 0; a <= Dim; ++a) {
    for (int b = 0; b < a; ++b) {
      const auto& g = grid.shape_gradient[e];
      widest = std::max(widest, g[a].dot(g[b]) / (g[a].norm() * g[b].norm()));
    }
  }
  return widest > obtuse_cosine;
}

}  // namespace

template <int Dim>
int obtuse_elements(const Grid<Dim>& grid) {
  int count = 0;
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    if (is_obtuse(grid, e)) ++count;
  }
  return count;
}

template <int Dim>
std::string element_text(const Grid<Dim>& grid, int element) {
  return "element " + std::to_string(grid.element_number(element)) + " at " +
         place_text<Dim>(element_centroid(grid.mesh, element));
}

template <int Dim>
std::string node_text(const Grid<Dim>& grid, int node) {
  return "at " + place_text<Dim>(grid.mesh.nodes[node]);
}

template struct Grid<2>;
template struct Grid<3>;
template int obtuse_elements(const Grid<2>&);
template int obtuse_elements(const Grid<3>&);
template <int Dim>
LargestInElement largest_of_all(const Grid<Dim>& grid, double value, int element) {
  const double largest = largest_of_all(grid.ranks(), value);
  const bool is_here = element >= 0 && value == largest;
  return {largest, grid.ranks().first_text(is_here ? element_text(grid, element) : "")};
}

template LargestInElement largest_of_all(const Grid<2>&, double, int);
template LargestInElement largest_of_all(const Grid<3>&, double, int);
template std::string element_text(const Grid<2>&, int);
template std::string element_text(const Grid<3>&, int);
template std::string node_text(const Grid<2>&, int);
template std::string node_text(const Grid<3>&, int);

}  // namespace suffuse
