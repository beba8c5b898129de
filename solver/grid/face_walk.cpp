#include "grid/face_walk.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace suffuse {
namespace {

/// Circles up to this share of an element count as a point.
constexpr double small_circle = 0.01;

/// log(1 + x) / x, 1 at 0.
double log_quotient(double x) {
  return x != 0.0 ? std::log1p(x) / x : 1.0;
}

/// (exp(x) - 1) / x, 1 at 0.
double exp_quotient(double x) {
  return x != 0.0 ? std::expm1(x) / x : 1.0;
}

/// Porosity of an element, linear in time from a share of the interval on, and the clock tau =
/// integral of ds/n.
struct PorosityInTime {
  double now;
  double growth_rate;

  [[nodiscard]] double clock(double shares) const {
    return shares / now * log_quotient(growth_rate * shares / now);
  }
  [[nodiscard]] double shares(double clock) const {
    return now * clock * exp_quotient(growth_rate * clock);
  }
};

/// Motion of a point in one element, as a function of the element's clock.
template <int Dim>
struct ElementFlow {
  std::array<double, Dim + 1> out;  ///< V_k / (Dim |e|)
  double sum = 0.0;

  ElementFlow(const Grid<Dim>& grid, const std::vector<double>& face_volume, int e) {
    for (int k = 0; k <= Dim; ++k) {
      out[k] = grid.element_face_sign[e][k] * face_volume[grid.element_face[e][k]] /
               (Dim * grid.volume[e]);
      sum += out[k];
    }
  }

  /// Clock at which the face opposite vertex k is reached; infinity: never.
  [[nodiscard]] double exit(int k, double coordinate) const {
    constexpr double never = std::numeric_limits<double>::infinity();
    if (!(out[k] > 0.0)) return never;
    const double straight = std::max(0.0, coordinate) / out[k];
    // A tiny flux may be too small to divide by.
    if (!std::isfinite(straight)) return never;
    const double bent = sum * straight;
    return bent < 1.0 ? straight * log_quotient(-bent) : never;
  }

  /// Length of the path from a place, m: exact if it is straight, otherwise by Gauss' rule with
  /// three places.
  [[nodiscard]] double path_length(const Mesh<Dim>& mesh, int e,
                                   const std::array<double, Dim + 1>& from, double clock) const {
    constexpr double offset = 0.38729833462074168852;  // sqrt(3/5) / 2
    const auto speed = [&](double share) {
      const std::array<double, Dim + 1> at = moved(from, share * clock);
      Vector<Dim> v = Vector<Dim>::Zero();
      for (int k = 0; k <= Dim; ++k) v += (sum * at[k] - out[k]) * mesh.nodes[mesh.elements[e][k]];
      return v.norm();
    };
    return clock / 18.0 *
           (5.0 * speed(0.5 - offset) + 8.0 * speed(0.5) + 5.0 * speed(0.5 + offset));
  }

  [[nodiscard]] std::array<double, Dim + 1> moved(const std::array<double, Dim + 1>& from,
                                                  double clock) const {
    const double weight = clock * exp_quotient(sum * clock);
    std::array<double, Dim + 1> to;
    for (int k = 0; k <= Dim; ++k) to[k] = from[k] + (sum * from[k] - out[k]) * weight;
    return to;
  }
};

/// Detects walks around a node or, in three dimensions, an edge: if the flow rotates around it,
/// smaller circles are crossed faster, without limit.
template <int Dim>
class Circling {
 public:
  explicit Circling(const Grid<Dim>& grid) : grid_(grid) { common_.fill(none); }

  /// Call when `place` has reached the face opposite its local vertex `vertex`.
  void crossed(const PointPlace<Dim>& place, int vertex) {
    const auto& nodes = grid_.mesh.elements[place.element];
    bool any = false;
    for (int& node : common_) {
      const auto found = std::find(nodes.begin(), nodes.end(), node);
      if (found == nodes.end() || found - nodes.begin() == vertex) node = none;
      any = any || node != none;
    }
    if (!any) {
      std::remove_copy(nodes.begin(), nodes.end(), common_.begin(), nodes[vertex]);
      crossings_ = 0;
    }
    ++crossings_;
  }
  [[nodiscard]] bool in_a_small_circle(const PointPlace<Dim>& place) const {
    const auto& nodes = grid_.mesh.elements[place.element];
    double share = 0.0;
    for (int k = 0; k <= Dim; ++k) {
      const bool is_common = std::find(common_.begin(), common_.end(), nodes[k]) != common_.end();
      if (is_common) share += place.barycentric[k];
    }
    return crossings_ > max_crossings / 2 && share > 1.0 - small_circle;
  }

 private:
  static constexpr int none = -1;
  const Grid<Dim>& grid_;
  std::array<int, Dim> common_;  ///< common to all faces crossed recently, in any order
  int crossings_ = 0;            ///< of faces with these nodes
};

}  // namespace

template <int Dim>
int walk_along_faces(const Grid<Dim>& grid, const FaceWalkField<Dim>& field, PointPlace<Dim>& place,
                     double from, double to, long id, std::vector<FacePassage<Dim>>& passages) {
  double now = from;
  Circling<Dim> circling(grid);
  for (int crossing = 0; crossing <= max_crossings; ++crossing) {
    const int e = place.element;
    const double change = field.porosity_end[e] - field.porosity_start[e];
    const PorosityInTime porosity{field.porosity_start[e] + now * change, change};
    // The circle is too small to follow: the point stays, and only the porosity changes.
    const bool stays = crossing == max_crossings && circling.in_a_small_circle(place);
    if (crossing == max_crossings && !stays) break;

    const ElementFlow<Dim> flow(grid, field.face_volume, e);
    double clock = porosity.clock(to - now);
    int exit = -1;
    for (int k = 0; k <= Dim && !stays; ++k) {
      const double reached = flow.exit(k, place.barycentric[k]);
      if (reached >= clock) continue;
      clock = reached;
      exit = k;
    }
    const double shares = exit < 0 ? to - now : porosity.shares(clock);
    const auto start = place.barycentric;
    if (!stays) place.barycentric = flow.moved(start, clock);
    // Round-off must not leave the point slightly outside.
    if (exit >= 0) put_on_face(place.barycentric, exit);
    for (int k = 0; k <= Dim; ++k) {
      if (place.barycentric[k] < 0.0) put_on_face(place.barycentric, k);
    }
    const double exchanged = field.exchanged == nullptr ? change : (*field.exchanged)[e];
    if ((exchanged != 0.0 || field.all_passages) && shares > 0.0) {
      const double growth = field.exchanged == nullptr
                                ? (porosity.now + shares * change) / porosity.now
                                : std::exp(exchanged * clock);
      FacePassage<Dim> passage{e, start, growth};
      if (field.all_passages && !stays) {
        passage.path = flow.path_length(grid.mesh, e, start, clock);
        passage.clock = clock;
      }
      for (int k = 0; k <= Dim; ++k) {
        passage.barycentric[k] = 0.5 * (start[k] + place.barycentric[k]);
      }
      passages.push_back(passage);
    }
    if (exit < 0) return -1;
    const int f = grid.element_face[e][exit];
    if (grid.is_outer(f)) return f;
    now = std::min(to, now + shares);
    circling.crossed(place, exit);
    place = across(grid, place, exit);
  }
  refuse_endless(grid, place, id);
}

template <int Dim>
double crossings(const Grid<Dim>& grid, const FaceWalkField<Dim>& field, int element) {
  const ElementFlow<Dim> flow(grid, field.face_volume, element);
  double most = 0.0;
  for (const double out : flow.out) most = std::max(most, std::abs(out));
  return most / std::min(field.porosity_start[element], field.porosity_end[element]);
}

template int walk_along_faces(const Grid<2>&, const FaceWalkField<2>&, PointPlace<2>&, double,
                              double, long, std::vector<FacePassage<2>>&);
template int walk_along_faces(const Grid<3>&, const FaceWalkField<3>&, PointPlace<3>&, double,
                              double, long, std::vector<FacePassage<3>>&);
template double crossings(const Grid<2>&, const FaceWalkField<2>&, int);
template double crossings(const Grid<3>&, const FaceWalkField<3>&, int);

}  // namespace suffuse
