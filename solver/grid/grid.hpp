#pragma once

/// The mesh with its faces, volumes, gradients and neighbors. Local face k of an element is
/// opposite its vertex k.

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"
#include "ranks/local_part.hpp"
#include "ranks/own_rows.hpp"
#include "ranks/ranks.hpp"

namespace suffuse {

/// The two sides of a piece of a wall; its flux is conductance * (p_face - p_partner), m3/s.
struct LeakyFace {
  int face = -1;  ///< the smaller number
  int partner = -1;
  double conductance = 0.0;  ///< m3/(s Pa)
};

template <int Dim>
struct Grid {
  /// The grid of a program that is alone and owns all of the mesh.
  explicit Grid(const Mesh<Dim>& mesh);
  /// The grid of a rank. All ranks have to call it.
  Grid(const Mesh<Dim>& mesh, const RankPart& part);

  [[nodiscard]] const Ranks& ranks() const { return *ranks_; }
  /// Elements and faces of this rank, ascending: a sum over the model is a sum over these and then
  /// over the ranks.
  [[nodiscard]] NumberRange own_elements() const { return elements_.own(); }
  [[nodiscard]] NumberRange own_faces() const { return faces_.own(); }
  [[nodiscard]] bool owns_face(int face) const { return faces_.owns(face); }
  /// Numbers in the whole mesh of the elements, faces and nodes that are here; none if this program
  /// is alone. Ascending but for faces at the fringe.
  [[nodiscard]] const std::vector<long>& element_numbers() const { return element_number_; }
  [[nodiscard]] const std::vector<long>& face_numbers() const { return face_number_; }
  [[nodiscard]] const std::vector<long>& node_numbers() const { return node_number_; }
  /// Number of an element in the whole mesh.
  [[nodiscard]] long element_number(int element) const {
    return element_number_.empty() ? element : element_number_[static_cast<std::size_t>(element)];
  }
  /// The element with this number in the whole mesh; -1 if it is not here.
  [[nodiscard]] int element_here(long number) const;
  /// Number of a face in the whole mesh.
  [[nodiscard]] long face_number(int face) const {
    return face_number_.empty() ? face : face_number_[static_cast<std::size_t>(face)];
  }
  // The rows themselves, to fetch values from other ranks.
  [[nodiscard]] const OwnRows& element_rows() const { return elements_; }
  [[nodiscard]] const OwnRows& face_rows() const { return faces_; }
  [[nodiscard]] const OwnRows& node_rows() const { return nodes_; }

  /// Face of the grid with exactly these nodes, in any order; -1 if there is none.
  [[nodiscard]] int find_face(std::array<int, Dim> nodes) const;
  [[nodiscard]] Vector<Dim> face_centre(int face) const;
  /// Whether a face has one element only, as the sides of a wall have.
  [[nodiscard]] bool is_outer(int face) const { return face_right[face] < 0; }
  /// Whether the model ends at a face: an outer face without a partner.
  [[nodiscard]] bool is_border(int face) const {
    return is_outer(face) && face_partner[face] == no_partner;
  }
  /// Element beyond a face as seen from its left one, through a wall too; -1 at the border.
  [[nodiscard]] int beyond(int face) const {
    return face_partner[face] < 0 ? face_right[face] : face_left[face_partner[face]];
  }
  /// Likewise, as seen from either of its elements; -1 at the fringe of a rank's part too.
  [[nodiscard]] int beyond(int face, int from) const {
    return face_left[face] == from ? beyond(face) : face_left[face];
  }
  /// Joins each pair of outer faces, which are at one place, as the two sides of a passage: what
  /// leaves by one enters by the other.
  void join_faces(const std::vector<std::array<int, 2>>& pairs);
  [[nodiscard]] int face_count() const { return static_cast<int>(face_left.size()); }
  /// Normal of an element's local face `k`, times its area, pointing out of the element.
  [[nodiscard]] Vector<Dim> outward_normal(int element, int k) const {
    return element_face_sign[element][k] * face_normal[element_face[element][k]];
  }
  /// Local number of a face in an element that has it.
  [[nodiscard]] int side_of(int element, int face) const {
    const auto& faces = element_face[element];
    return static_cast<int>(std::find(faces.begin(), faces.end(), face) - faces.begin());
  }
  /// Element beyond local face `k` of an element, -1 at the outer boundary.
  [[nodiscard]] int across(int element, int k) const {
    const int f = element_face[element][k];
    return face_left[f] == element ? face_right[f] : face_left[f];
  }

  const Mesh<Dim>& mesh;

  std::vector<double> volume;  ///< per element, m3 (per meter of thickness in 2D)
  std::vector<std::array<Vector<Dim>, Dim + 1>> shape_gradient;  ///< 1/m
  std::vector<double> node_volume;  ///< share of the elements' volume per node

  std::vector<std::array<int, Dim>> face_nodes;
  std::vector<int> face_left;   ///< element the normal points out of
  std::vector<int> face_right;  ///< element the normal points into, -1 at the outer boundary
  std::vector<Vector<Dim>> face_normal;  ///< times the face's area
  static constexpr int no_partner = -1;
  static constexpr int on_other_rank = -2;
  /// The other side of a wall that lets liquid through, or one of the numbers above: beyond a face
  /// at the fringe of a rank's part, the mesh goes on.
  std::vector<int> face_partner;

  std::vector<std::array<int, Dim + 1>> element_face;
  std::vector<std::array<double, Dim + 1>> element_face_sign;  ///< +1 where the normal points out

  /// Faces of node i: node_face[node_face_begin[i] .. node_face_begin[i + 1]).
  std::vector<int> node_face_begin;
  std::vector<int> node_face;
  /// Elements of node i, in the same form.
  std::vector<int> node_element_begin;
  std::vector<int> node_element;

 private:
  /// Number of each face in the whole mesh: ranks number their own faces one after the other.
  [[nodiscard]] std::vector<long> global_faces(int first, int last) const;
  /// Makes faces at the fringe equal to those of the rank that owns them.
  void settle_fringe();

  std::shared_ptr<const Ranks> ranks_;
  // Empty if the mesh is whole.
  std::vector<long> element_number_;
  std::vector<long> face_number_;
  std::vector<long> node_number_;
  OwnRows elements_;
  OwnRows faces_;
  OwnRows nodes_;
};

/// One over the smallest height of an element, 1/m.
template <int Dim>
double steepest_shape(const Grid<Dim>& grid, int element) {
  double steepest = 0.0;
  for (const Vector<Dim>& g : grid.shape_gradient[element]) {
    steepest = std::max(steepest, g.norm());
  }
  return steepest;
}

/// Mean of the elements around each node, by volume, in this part of the mesh.
/// \param of_elements  per element
template <int Dim, class Value>
std::vector<Value> means_at_nodes(const Grid<Dim>& grid, const std::vector<Value>& of_elements,
                                  const Value& zero) {
  std::vector<Value> result(grid.mesh.node_count(), zero);
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    for (const int i : grid.mesh.elements[e]) {
      result[i] += grid.volume[e] / (Dim + 1) / grid.node_volume[i] * of_elements[e];
    }
  }
  return result;
}

/// Elements with an angle of more than 90 degrees (in three dimensions, between two sides).
template <int Dim>
int obtuse_elements(const Grid<Dim>& grid);

/// "element 5 at (0.1 0.2)", with the centroid, for messages.
template <int Dim>
std::string element_text(const Grid<Dim>& grid, int element);
/// The largest of a value that each rank has in one of its elements, and which element that is:
/// empty without one.
struct LargestInElement {
  double value;
  std::string at;
};
/// `element`: of this rank; -1: none. All ranks have to call it.
template <int Dim>
LargestInElement largest_of_all(const Grid<Dim>& grid, double value, int element);
/// "at (x y)" for error messages.
template <int Dim>
std::string node_text(const Grid<Dim>& grid, int node);

}  // namespace suffuse
