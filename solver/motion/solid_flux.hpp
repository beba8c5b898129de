#pragma once

/// Solid volume in the elements of the mesh, and what crosses their faces as points move.

#include <memory>
#include <vector>

#include "equilibrium/solid_points.hpp"
#include "linear/cholesky_factor.hpp"

namespace suffuse {

/// Solid volume per element, m3, as the points' volumes have it that are carried to the nodes and
/// back: V_e times the mean of the nodes' shares. Its total is theirs. (To count the points in an
/// element errs by a whole point.) It spreads over the elements next to those with points, but not
/// between rigid soil and soil that moves: rigid elements have what their own points have.
/// \param rigid  per element; empty: none is
template <int Dim>
std::vector<double> smooth_volumes(const Grid<Dim>& grid, const SolidPoints<Dim>& points,
                                   const std::vector<double>& solid_volume,
                                   const std::vector<char>& rigid = {});

/// Makes the flux of solid balance. Solid is in connected pieces of the mesh, and leaves none. Has
/// no history: the factor follows from the elements of the pieces.
template <int Dim>
class SolidFlux {
 public:
  explicit SolidFlux(const Grid<Dim>& grid) : grid_(grid) {}

  /// \param has_solid  per element
  void follow(const std::vector<char>& has_solid);
  /// Piece of each element, from 0 on; -1 without solid.
  [[nodiscard]] const std::vector<int>& piece() const { return piece_; }
  [[nodiscard]] int piece_count() const { return static_cast<int>(roots_.size()); }

  /// What the motion of the soil carries along: of the volume of soil that crosses each face the
  /// share of solid in the element that it comes from, m3.
  [[nodiscard]] std::vector<double> carried(const std::vector<double>& face_volume,
                                            const std::vector<double>& solid_volume) const;
  /// Adds to the volumes through faces the flux of a potential, so that what enters each element is
  /// its gain, m3, to round-off. Gains of a piece must add up to zero. Returns the sum of the sizes
  /// of what was added over that of what was there.
  double balance(const std::vector<double>& gain, std::vector<double>& face_volume);

 private:
  [[nodiscard]] bool is_passable(int face) const {
    return !grid_.is_outer(face) && piece_[grid_.face_left[face]] >= 0 &&
           piece_[grid_.face_right[face]] >= 0;
  }
  void find_pieces();
  void factorise();
  [[nodiscard]] std::vector<double> excess(const std::vector<double>& gain,
                                           const std::vector<double>& face_volume) const;

  const Grid<Dim>& grid_;
  std::vector<char> has_solid_;
  std::vector<int> piece_;
  std::vector<int> roots_;           ///< first element of each piece
  std::vector<int> from_root_;       ///< elements, each after the one that it drains to
  std::vector<int> drain_;           ///< per element: face towards the root, -1 at a root
  std::vector<int> unknown_;         ///< per element; -1 at roots and outside
  std::vector<double> conductance_;  ///< per face, m; 0 where nothing passes
  std::unique_ptr<CholeskyFactor> factor_;
};

}  // namespace suffuse
