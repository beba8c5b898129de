#pragma once

/// Walls that let liquid through: pairs of outer faces at the same place, and how well they
/// conduct.

#include <vector>

#include "case/case_file.hpp"
#include "grid/grid.hpp"

namespace suffuse {

/// The two sides of a piece of a wall, through which conductance * (p_face - p_partner) m3/s pass.
struct LeakyFace {
  int face = -1;  ///< the smaller number
  int partner = -1;
  double conductance = 0.0;  ///< m3/(s Pa)
};

/// Those of the scene's walls with a conductance, ascending.
template <int Dim>
std::vector<LeakyFace> leaky_faces(const Case<Dim>& c, const Grid<Dim>& grid);

/// The grid of a case, whose leaky faces are partners.
template <int Dim>
Grid<Dim> grid_with_walls(const Case<Dim>& c);

}  // namespace suffuse
