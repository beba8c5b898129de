#pragma once

/// Places on a face of an element where points are injected: spread like the flux through it.

#include <array>

namespace suffuse {

/// Fractional parts of its multiples spread evenly over [0, 1) (golden ratio - 1).
inline constexpr double golden = 0.6180339887498948482;

/// Numbers in [0, 1), one for each direction along a face, for the point `number` (0, 1, ...) of a
/// face: each falls into a wide gap between those before it. Van der Corput's sequence in base two
/// for one direction, with base three for two (Halton, Numer. Math. 2 (1960) 84), displaced
/// from face to face.
template <int Directions>
std::array<double, Directions> even_numbers(long number, int face);

/// Barycentric coordinates of a place on an edge (Dim = 2) or a triangle (3), which are spread like
/// a flux that is linear from node to node when `u` are spread evenly over [0, 1). `inflow`: the
/// flux at the nodes, >= 0 in any unit; where it is zero at all of them it counts as the same at
/// all.
template <std::size_t Nodes>
std::array<double, Nodes> spread_on_face(const std::array<double, Nodes>& inflow,
                                         const std::array<double, Nodes - 1>& u);

}  // namespace suffuse
