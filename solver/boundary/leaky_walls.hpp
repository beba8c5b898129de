#pragma once

/// Leaky walls: pairs of outer faces at the same place, and their conductances.

#include <vector>

#include "case/case_file.hpp"
#include "grid/grid.hpp"

namespace suffuse {

/// The two sides of a piece of a wall; its flux is conductance * (p_face - p_partner), m3/s.
struct LeakyFace {
  int face = -1;  ///< the smaller number
  int partner = -1;
  double conductance = 0.0;  ///< m3/(s Pa)
};

/// Leaky faces of the scene's walls with a conductance, ascending.
template <int Dim>
std::vector<LeakyFace> leaky_faces(const Case<Dim>& c, const Grid<Dim>& grid);

/// The grid of a case, with leaky faces joined as partners. `part`: that of the rank to which the
/// case belongs, without leaky walls; null: this program is alone.
template <int Dim>
Grid<Dim> grid_with_walls(const Case<Dim>& c, const RankPart* part = nullptr);

}  // namespace suffuse
