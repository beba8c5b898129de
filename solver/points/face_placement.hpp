#pragma once

/// Places on a face where points are injected, distributed like the flux through it.

#include <array>

namespace suffuse {

/// Golden ratio - 1: the fractional parts of its multiples are spread evenly over [0, 1).
inline constexpr double golden = 0.6180339887498948482;

/// Evenly distributed numbers in [0, 1), one for each direction along a face, for the point
/// `number` (0, 1, ...) of a face: van der Corput's sequence in base two, and in base three for a
/// second direction (Halton, Numer. Math. 2 (1960) 84), shifted from face to face.
template <int Directions>
std::array<double, Directions> even_numbers(long number, long face);

/// Barycentric coordinates of a place on an edge (Dim = 2) or a triangle (3). For `u` distributed
/// evenly over [0, 1) the places are distributed like a linear flux. `inflow`: this flux at the
/// nodes, >= 0 in any unit; zero at all nodes means a constant flux.
template <std::size_t Nodes>
std::array<double, Nodes> spread_on_face(const std::array<double, Nodes>& inflow,
                                         const std::array<double, Nodes - 1>& u);

}  // namespace suffuse
