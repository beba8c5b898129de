#pragma once

/// Solid volume in the elements of the mesh, and what crosses their faces as points move.

#include <memory>
#include <vector>

#include "linear/cholesky_factor.hpp"
#include "solid/solid_points.hpp"

namespace suffuse {

/// Smoothed solid volume per element, m3: the points' volumes go to nodes, and an element has V_e
/// times the mean of its nodes' shares. The total is that of the points. (Counting the points in an
/// element has an error of a whole point.) Solid spreads to elements next to those with points, but
/// not between rigid and moving soil: rigid elements have the volume of their own points.
/// \param rigid  per element; empty: none is rigid
template <int Dim>
std::vector<double> smooth_volumes(const Grid<Dim>& grid, const SolidPoints<Dim>& points,
                                   const std::vector<double>& solid_volume,
                                   const std::vector<char>& rigid = {});

/// Makes the flux of solid balance in connected pieces of the mesh, which solid does not leave.
/// There is no history: the factor follows from the elements of the pieces.
template <int Dim>
class SolidFlux {
 public:
  explicit SolidFlux(const Grid<Dim>& grid) : grid_(grid) {}

  /// \param has_solid  per element
  void follow(const std::vector<char>& has_solid);
  /// Piece of each element, from 0 on; -1 without solid.
  [[nodiscard]] const std::vector<int>& piece() const { return piece_; }
  [[nodiscard]] int piece_count() const { return static_cast<int>(roots_.size()); }

  /// Solid that the motion of the soil carries, m3: the volume of soil that crosses each face,
  /// times the share of solid in the element that it comes from.
  [[nodiscard]] std::vector<double> carried(const std::vector<double>& face_volume,
                                            const std::vector<double>& solid_volume) const;
  /// Adds the flux of a potential to the volumes through faces, so that each element gains `gain`,
  /// m3, to round-off. Gains of a piece must add up to zero. Returns the sum of magnitudes of this
  /// flux, over that of the volumes before.
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
  std::vector<double> conductance_;  ///< per face, m; 0 at faces without flux
  std::unique_ptr<CholeskyFactor> factor_;
};

}  // namespace suffuse
