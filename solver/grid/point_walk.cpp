#include "grid/point_walk.hpp"

#include <algorithm>

namespace suffuse {
namespace {

template <int Dim>
using Barycentric = std::array<double, Dim + 1>;

/// Velocity at a place of the element, m/s.
template <int Dim>
Vector<Dim> velocity_at(const Grid<Dim>& grid, const WalkField<Dim>& field, int element,
                        const Barycentric<Dim>& at) {
  Vector<Dim> flux = Vector<Dim>::Zero();
  for (int a = 0; a <= Dim; ++a) flux += at[a] * field.node_flux[grid.mesh.elements[element][a]];
  return flux / field.porosity[element];
}

/// Change of the barycentric coordinates per second at a velocity, 1/s.
template <int Dim>
Barycentric<Dim> rates(const Grid<Dim>& grid, int element, const Vector<Dim>& velocity) {
  Barycentric<Dim> result;
  for (int a = 0; a <= Dim; ++a) result[a] = grid.shape_gradient[element][a].dot(velocity);
  return result;
}

/// Removes the part of a velocity that points out through the faces that hold the point.
template <int Dim>
Vector<Dim> along_walls(const Grid<Dim>& grid, int element, Vector<Dim> velocity,
                        const std::array<bool, Dim + 1>& held) {
  if (std::ranges::find(held, true) == held.end()) return velocity;
  // Two faces at an acute corner push into each other: a few rounds satisfy both.
  for (int round = 0; round <= 2 * Dim; ++round) {
    for (int a = 0; a <= Dim; ++a) {
      const Vector<Dim>& inward = grid.shape_gradient[element][a];
      const double through = inward.dot(velocity);
      if (held[a] && through < 0.0) velocity -= through / inward.squaredNorm() * inward;
    }
  }
  for (int a = 0; a <= Dim; ++a) {
    const double through = grid.shape_gradient[element][a].dot(velocity);
    if (held[a] && through < -1e-12 * grid.shape_gradient[element][a].norm() * velocity.norm()) {
      return Vector<Dim>::Zero();
    }
  }
  return velocity;
}

template <int Dim>
Barycentric<Dim> moved(const Barycentric<Dim>& from, const Barycentric<Dim>& rate, double time) {
  Barycentric<Dim> to;
  for (int a = 0; a <= Dim; ++a) to[a] = from[a] + time * rate[a];
  return to;
}

/// A straight piece of the path: its duration, and the face at its end, -1 for none.
template <int Dim>
struct Piece {
  Barycentric<Dim> rate;
  double time;
  int face;
};

template <int Dim>
Piece<Dim> first_exit(const Barycentric<Dim>& from, const Barycentric<Dim>& rate, double time,
                      const std::array<bool, Dim + 1>& held) {
  Piece<Dim> piece{rate, time, -1};
  for (int a = 0; a <= Dim; ++a) {
    if (held[a] || rate[a] >= 0.0) continue;
    const double exit = std::max(0.0, from[a]) / -rate[a];
    if (exit > piece.time) continue;
    // At a vertex several faces are reached at once: take the one that is left fastest.
    if (exit < piece.time || piece.face < 0 || rate[a] < rate[piece.face]) piece.face = a;
    piece.time = exit;
  }
  return piece;
}

}  // namespace

template <int Dim>
int walk(const Grid<Dim>& grid, const WalkField<Dim>& field, PointPlace<Dim>& place,
         double duration, long id) {
  std::array<bool, Dim + 1> held{};
  double remaining = duration;
  for (int crossing = 0; crossing < max_crossings; ++crossing) {
    const int e = place.element;
    const auto rate_at = [&](const Barycentric<Dim>& at) {
      return rates<Dim>(grid, e, along_walls(grid, e, velocity_at(grid, field, e, at), held));
    };
    // Use the velocity half-way along the piece, again once its length is known.
    const auto start = rate_at(place.barycentric);
    auto piece = first_exit<Dim>(place.barycentric,
                                 rate_at(moved<Dim>(place.barycentric, start, 0.5 * remaining)),
                                 remaining, held);
    if (piece.face >= 0) {
      piece = first_exit<Dim>(place.barycentric,
                              rate_at(moved<Dim>(place.barycentric, piece.rate, 0.5 * piece.time)),
                              remaining, held);
    }
    // If an extrapolated velocity leads out at once, use that at the point itself, as two elements
    // could otherwise pass the point to each other without end.
    if (piece.face >= 0 && piece.time == 0.0) {
      piece = first_exit<Dim>(place.barycentric, start, remaining, held);
    }
    place.barycentric = moved<Dim>(place.barycentric, piece.rate, piece.time);
    if (piece.face < 0) {
      // Round-off must not leave the point slightly outside.
      for (int a = 0; a <= Dim; ++a) {
        if (place.barycentric[a] < 0.0) put_on_face(place.barycentric, a);
      }
      return -1;
    }
    put_on_face(place.barycentric, piece.face);
    remaining -= piece.time;
    const int f = grid.element_face[e][piece.face];
    if (grid.is_outer(f)) {
      if (field.open_face[f] != 0) return f;
      held[piece.face] = true;
      continue;
    }
    held = {};
    place = across(grid, place, piece.face);
  }
  refuse_endless(grid, place, id);
}

template <int Dim>
double crossing_rate(const Grid<Dim>& grid, const WalkField<Dim>& field, int element) {
  double largest = 0.0;
  for (const int i : grid.mesh.elements[element]) {
    for (int a = 0; a <= Dim; ++a) {
      largest =
          std::max(largest, std::abs(grid.shape_gradient[element][a].dot(field.node_flux[i])));
    }
  }
  return largest / field.porosity[element];
}

template int walk(const Grid<2>&, const WalkField<2>&, PointPlace<2>&, double, long);
template int walk(const Grid<3>&, const WalkField<3>&, PointPlace<3>&, double, long);
template double crossing_rate(const Grid<2>&, const WalkField<2>&, int);
template double crossing_rate(const Grid<3>&, const WalkField<3>&, int);

}  // namespace suffuse
