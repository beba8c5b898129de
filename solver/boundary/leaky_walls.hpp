#pragma once

/// Leaky walls: pairs of outer faces at the same place, and their conductances.

#include <vector>

#include "case/case_file.hpp"
#include "grid/grid.hpp"

namespace suffuse {

/// Leaky faces of the scene's walls with a conductance, ascending.
template <int Dim>
std::vector<LeakyFace> leaky_faces(const Case<Dim>& c, const Grid<Dim>& grid);

/// The grid of a case, with leaky faces joined as partners. `part`: that of the rank to which the
/// case belongs, without leaky walls; null: this program is alone.
template <int Dim>
Grid<Dim> grid_with_walls(const Case<Dim>& c, const RankPart* part = nullptr);

}  // namespace suffuse
