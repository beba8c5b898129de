#include "mesh_checks.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "mesh/faces.hpp"
#include "mesh_problems.hpp"

namespace suffuse {

namespace {

/// Smallest volume of an element, relative to its longest edge to the power of the dimension; a
/// triangle then has an angle of about 1e-10 degrees.
constexpr double smallest_volume = 1e-12;
/// Relative to the diagonal of the mesh.
constexpr double same_place = 1e-9;

/// Objects with bounding boxes, which can be searched by a box.
template <int Dim>
class Bins {
 public:
  struct Box {
    Vector<Dim> low;
    Vector<Dim> high;
  };

  /// \param all  contains everything that will be added
  Bins(const Box& all, std::size_t count) : low_(all.low) {
    const double per_axis = std::ceil(std::pow(2.0 * static_cast<double>(count) + 1.0, 1.0 / Dim));
    size_ = std::max((all.high - all.low).maxCoeff() / per_axis, 1e-300);
  }
  void add(const Box& box, int thing) {
    visit(box, [&](const Cell& cell) { things_[cell].push_back(thing); });
  }
  /// The objects that share a bin with the box, in ascending order.
  [[nodiscard]] std::vector<int> near(const Box& box) const {
    std::vector<int> result;
    visit(box, [&](const Cell& cell) {
      const auto found = things_.find(cell);
      if (found == things_.end()) return;
      result.insert(result.end(), found->second.begin(), found->second.end());
    });
    std::ranges::sort(result);
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  }

 private:
  using Cell = std::array<std::int64_t, Dim>;

  template <class Use>
  void visit(const Box& box, const Use& use) const {
    Cell first;
    Cell last;
    for (int d = 0; d < Dim; ++d) {
      first[d] = std::llround(std::floor((box.low[d] - low_[d]) / size_));
      last[d] = std::llround(std::floor((box.high[d] - low_[d]) / size_));
    }
    for (Cell cell = first;;) {
      use(cell);
      int d = 0;
      while (d < Dim && cell[d] == last[d]) {
        cell[d] = first[d];
        ++d;
      }
      if (d == Dim) return;
      ++cell[d];
    }
  }

  Vector<Dim> low_;
  double size_ = 0.0;
  std::map<Cell, std::vector<int>> things_;
};

template <int Dim>
class MeshChecks {
 public:
  using Face = std::array<int, Dim>;
  using Box = typename Bins<Dim>::Box;

  MeshChecks(Mesh<Dim>& mesh, const MeshTags& tags, std::vector<InputProblem>& problems)
      : mesh_(mesh), x_(mesh.nodes), tags_(tags), problems_(problems) {
    Box all{x_.front(), x_.front()};
    for (const Vector<Dim>& x : x_) grow(all, x);
    all_ = all;
    tolerance_ = same_place * (all.high - all.low).norm();
  }

  int run() {
    check_duplicate_nodes();
    const int turned = orient_and_check_volumes();
    list_sides();
    check_overlaps();
    list_outer_sides();
    check_hanging_nodes();
    check_parts();
    return turned;
  }

 private:
  using Words = MeshWords<Dim>;

  struct Side {
    Face key;     ///< nodes in ascending order
    bool is_odd;  ///< whether the outward order of the nodes is an odd permutation of `key`
    int element;
    int corner;  ///< opposite
  };

  static void grow(Box& box, const Vector<Dim>& x) {
    box.low = box.low.cwiseMin(x);
    box.high = box.high.cwiseMax(x);
  }
  [[nodiscard]] Box box_of(const Face& face) const {
    Box box{x_[face[0]], x_[face[0]]};
    for (const int node : face) grow(box, x_[node]);
    box.low.array() -= tolerance_;
    box.high.array() += tolerance_;
    return box;
  }
  [[nodiscard]] std::string node_at(int node) const {
    return "node " + std::to_string(tags_.nodes[node]) + " at " + place_text<Dim>(x_[node]);
  }
  [[nodiscard]] std::string element(int e) const { return std::to_string(tags_.elements[e]); }
  [[nodiscard]] std::string elements(int e, int other) const {
    return "elements " + element(e) + " and " + element(other);
  }
  /// `from A to B` of an edge, `at A, B and C` of a face.
  [[nodiscard]] std::string places(const Face& face) const {
    if constexpr (Dim == 2) {
      return "from " + place_text<Dim>(x_[face[0]]) + " to " + place_text<Dim>(x_[face[1]]);
    } else {
      return "at " + place_text<Dim>(x_[face[0]]) + ", " + place_text<Dim>(x_[face[1]]) + " and " +
             place_text<Dim>(x_[face[2]]);
    }
  }
  [[nodiscard]] Face nodes_of(const Side& side) const {
    return face_opposite<Dim>(mesh_.elements[side.element], side.corner);
  }

  void check_duplicate_nodes() {
    ProblemKind kind(problems_,
                     "one node per place, so that neighbours are connected (in Gmsh: Coherence; or "
                     "BooleanFragments, or Coherence Mesh)");
    if (!(tolerance_ > 0.0)) return;
    Bins<Dim> bins(all_, x_.size());
    const Vector<Dim> margin = Vector<Dim>::Constant(tolerance_);
    for (int n = 0; n < mesh_.node_count(); ++n) {
      for (const int other : bins.near({x_[n] - margin, x_[n] + margin})) {
        if ((x_[other] - x_[n]).norm() > tolerance_) continue;
        kind.add("nodes " + std::to_string(tags_.nodes[other]) + " and " +
                 std::to_string(tags_.nodes[n]) + ", both at " + place_text<Dim>(x_[n]));
      }
      bins.add({x_[n], x_[n]}, n);
    }
  }

  int orient_and_check_volumes() {
    ProblemKind kind(
        problems_, std::string(Words::elements) + (Dim == 2 ? " with an area" : " with a volume"));
    int turned = 0;
    is_flat_.assign(mesh_.elements.size(), false);
    for (int e = 0; e < mesh_.element_count(); ++e) {
      auto& corners = mesh_.elements[e];
      double longest = 0.0;
      for (int a = 0; a <= Dim; ++a) {
        for (int b = 0; b < a; ++b) {
          longest = std::max(longest, (x_[corners[a]] - x_[corners[b]]).norm());
        }
      }
      const double volume = element_volume(mesh_, e);
      if (!(std::abs(volume) > smallest_volume * std::pow(longest, Dim))) {
        kind.add("element " + element(e) + ", flat, with its nodes at " + corners_of(e));
        is_flat_[e] = true;
      } else if (volume < 0.0) {
        std::swap(corners[1], corners[2]);
        ++turned;
      }
    }
    return turned;
  }

  [[nodiscard]] std::string corners_of(int e) const {
    std::string text;
    for (const int node : mesh_.elements[e]) {
      text += (text.empty() ? "" : ", ") + place_text<Dim>(x_[node]);
    }
    return text;
  }

  void list_sides() {
    sides_.reserve(mesh_.elements.size() * (Dim + 1));
    for (int e = 0; e < mesh_.element_count(); ++e) {
      for (int corner = 0; corner <= Dim; ++corner) {
        const Face face = face_opposite<Dim>(mesh_.elements[e], corner);
        int swaps = Dim * corner;  // swaps from outward to ascending order
        for (int a = 0; a < Dim; ++a) {
          for (int b = 0; b < a; ++b) swaps += face[b] > face[a] ? 1 : 0;
        }
        sides_.push_back({face_key<Dim>(face), swaps % 2 != 0, e, corner});
      }
    }
    std::ranges::stable_sort(sides_, {}, &Side::key);
  }

  /// All elements are positively oriented, so neighbours have opposite orientations of their common
  /// side. Two elements with equal orientations lie on the same side of it and overlap.
  void check_overlaps() {
    ProblemKind kind(problems_, std::string(Words::elements) +
                                    " that do not overlap: the mesh is folded or has one twice");
    std::map<int, std::pair<const Side*, const Side*>> overlaps;  // by the second element
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      if (is_flat_[sides_[i].element]) continue;
      for (std::size_t j = i + 1; j < sides_.size() && sides_[j].key == sides_[i].key; ++j) {
        if (sides_[j].is_odd != sides_[i].is_odd || is_flat_[sides_[j].element]) continue;
        overlaps.emplace(sides_[j].element, std::pair(&sides_[i], &sides_[j]));
      }
    }
    for (const auto& [ignored, pair] : overlaps) {
      kind.add(elements(pair.first->element, pair.second->element) + ", on the same side of the " +
               Words::side + " " + places(nodes_of(*pair.second)));
    }
  }

  void list_outer_sides() {
    for (std::size_t i = 0; i < sides_.size();) {
      std::size_t next = i + 1;
      while (next < sides_.size() && sides_[next].key == sides_[i].key) ++next;
      if (next == i + 1) outer_.push_back(sides_[i]);
      i = next;
    }
  }

  /// Finds nodes within a neighbour's side. They connect nothing: an apparent single body would be
  /// two, with an impervious joint.
  void check_hanging_nodes() {
    ProblemKind kind(problems_, std::string("neighbours that share whole ") + Words::sides +
                                    " (in Gmsh: Coherence, or BooleanFragments)");
    std::set<int> nodes;
    for (const Side& side : outer_) nodes.insert(side.key.begin(), side.key.end());
    Bins<Dim> bins(all_, nodes.size());
    for (const int n : nodes) bins.add({x_[n], x_[n]}, n);
    for (const Side& side : outer_) {
      if (is_flat_[side.element]) continue;
      for (const int n : bins.near(box_of(side.key))) {
        if (std::ranges::count(side.key, n) > 0 || !lies_on(x_[n], side.key)) continue;
        kind.add(node_at(n) + " on the " + Words::side + " of element " + element(side.element) +
                 " " + places(side.key));
      }
    }
  }

  [[nodiscard]] Vector<Dim> unit_normal(const Face& face) const {
    const Vector<Dim> along = x_[face[1]] - x_[face[0]];
    if constexpr (Dim == 2) {
      return Vector<2>(-along[1], along[0]).normalized();
    } else {
      return along.cross(x_[face[2]] - x_[face[0]]).normalized();
    }
  }

  /// Distance of a place in the plane of a face from its border; negative: outside.
  [[nodiscard]] double inside(const Vector<Dim>& x, const Face& face) const {
    if constexpr (Dim == 2) {
      const Vector<2> along = x_[face[1]] - x_[face[0]];
      const double from_start = (x - x_[face[0]]).dot(along.normalized());
      return std::min(from_start, along.norm() - from_start);
    } else {
      const Vector<3> normal = unit_normal(face);
      double least = std::numeric_limits<double>::infinity();
      for (int a = 0; a < 3; ++a) {
        const Vector<3>& start = x_[face[a]];
        const Vector<3> along = (x_[face[(a + 1) % 3]] - start).normalized();
        least = std::min(least, normal.cross(along).dot(x - start));
      }
      return least;
    }
  }

  /// Whether a place lies on a face, away from its corners (those would be duplicate nodes).
  [[nodiscard]] bool lies_on(const Vector<Dim>& x, const Face& face) const {
    if (std::abs(unit_normal(face).dot(x - x_[face[0]])) > tolerance_) return false;
    for (const int node : face) {
      if ((x_[node] - x).norm() <= tolerance_) return false;
    }
    return inside(x, face) > (Dim == 2 ? tolerance_ : -tolerance_);
  }

  /// Finds parts that overlap although they share no side: their outer sides cross, or one lies
  /// within an element of the other.
  void check_parts() {
    ProblemKind kind(
        problems_, "parts that do not lie on each other (in Gmsh: Coherence, or BooleanFragments)");
    check_crossings(kind);
    const std::vector<int> part = parts();
    std::map<int, int> corner_of_part;
    for (const Side& side : outer_) corner_of_part.emplace(part[side.element], side.key[0]);
    if (corner_of_part.size() < 2) return;
    Bins<Dim> bins(all_, corner_of_part.size());
    std::map<int, int> part_of_corner;
    for (const auto& [own, node] : corner_of_part) {
      part_of_corner.emplace(node, own);
      bins.add({x_[node], x_[node]}, node);
    }
    for (int e = 0; e < mesh_.element_count(); ++e) {
      if (is_flat_[e]) continue;
      Box box{x_[mesh_.elements[e][0]], x_[mesh_.elements[e][0]]};
      for (const int node : mesh_.elements[e]) grow(box, x_[node]);
      for (const int node : bins.near(box)) {
        if (part[e] == part_of_corner.at(node) || !lies_within(x_[node], e)) continue;
        kind.add(node_at(node) + " within element " + element(e) + " of another part");
      }
    }
  }

  void check_crossings(ProblemKind& kind) {
    Bins<Dim> bins(all_, outer_.size());
    for (std::size_t i = 0; i < outer_.size(); ++i) {
      if (!is_flat_[outer_[i].element]) bins.add(box_of(outer_[i].key), static_cast<int>(i));
    }
    for (std::size_t i = 0; i < outer_.size(); ++i) {
      const Side& side = outer_[i];
      if (is_flat_[side.element]) continue;
      for (const int j : bins.near(box_of(side.key))) {
        const Side& other = outer_[j];
        if (j <= static_cast<int>(i) || !cross(side.key, other.key)) continue;
        kind.add(elements(side.element, other.element) + ", whose " + Words::sides + " " +
                 places(side.key) + " and " + places(other.key) + " cross");
      }
    }
  }

  /// Whether two faces cross by more than round-off.
  [[nodiscard]] bool cross(const Face& face, const Face& other) const {
    if constexpr (Dim == 2) {
      return separates_ends(face, other) && separates_ends(other, face);
    } else {
      return an_edge_passes(face, other) || an_edge_passes(other, face);
    }
  }

  /// Whether the ends of an edge are on different sides of a line.
  [[nodiscard]] bool separates_ends(const Face& line, const Face& edge) const {
    const Vector<Dim> normal = unit_normal(line);
    const auto aside = [&](int node) { return normal.dot(x_[node] - x_[line[0]]); };
    const auto [low, high] = std::minmax({aside(edge[0]), aside(edge[1])});
    return low < -tolerance_ && high > tolerance_;
  }

  /// Whether an edge of one face passes through the other.
  [[nodiscard]] bool an_edge_passes(const Face& face, const Face& through) const {
    const Vector<Dim> normal = unit_normal(through);
    for (int a = 0; a < Dim; ++a) {
      const Vector<Dim>& from = x_[face[a]];
      const Vector<Dim>& to = x_[face[(a + 1) % Dim]];
      const double start = normal.dot(from - x_[through[0]]);
      const double end = normal.dot(to - x_[through[0]]);
      if (std::min(start, end) > -tolerance_ || std::max(start, end) < tolerance_) continue;
      const Vector<Dim> met = from + start / (start - end) * (to - from);
      if (inside(met, through) > tolerance_) return true;
    }
    return false;
  }

  /// Per element, the number of its part of the mesh. Elements with a common side are in one part.
  [[nodiscard]] std::vector<int> parts() const {
    std::vector<int> part(mesh_.elements.size());
    std::iota(part.begin(), part.end(), 0);
    const auto root = [&](int e) {
      while (part[e] != e) e = part[e] = part[part[e]];
      return e;
    };
    for (std::size_t i = 1; i < sides_.size(); ++i) {
      if (sides_[i].key == sides_[i - 1].key) {
        part[root(sides_[i].element)] = root(sides_[i - 1].element);
      }
    }
    for (int e = 0; e < mesh_.element_count(); ++e) part[e] = root(e);
    return part;
  }

  /// Whether a place lies within an element, farther from its sides than the tolerance.
  [[nodiscard]] bool lies_within(const Vector<Dim>& x, int e) const {
    const auto& corners = mesh_.elements[e];
    for (int a = 0; a <= Dim; ++a) {
      const Face face = face_opposite<Dim>(corners, a);
      const Vector<Dim> normal = unit_normal(face);
      const double inwards = normal.dot(x_[corners[a]] - x_[face[0]]) > 0.0 ? 1.0 : -1.0;
      if (!(inwards * normal.dot(x - x_[face[0]]) > tolerance_)) return false;
    }
    return true;
  }

  Mesh<Dim>& mesh_;
  const std::vector<Vector<Dim>>& x_;
  const MeshTags& tags_;
  std::vector<InputProblem>& problems_;
  Box all_;
  double tolerance_ = 0.0;
  std::vector<bool> is_flat_;  ///< per element
  std::vector<Side> sides_;    ///< by their keys
  std::vector<Side> outer_;    ///< sides that belong to one element alone
};

}  // namespace

template <int Dim>
int check_mesh(Mesh<Dim>& mesh, const MeshTags& tags, std::vector<InputProblem>& problems) {
  return MeshChecks<Dim>(mesh, tags, problems).run();
}

template int check_mesh(Mesh<2>&, const MeshTags&, std::vector<InputProblem>&);
template int check_mesh(Mesh<3>&, const MeshTags&, std::vector<InputProblem>&);

}  // namespace suffuse
