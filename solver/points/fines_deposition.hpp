#pragma once

/// Deposition of fines from liquid points. Along a path of length s the fines of a point per mass
/// of its water decay as exp(-lambda_d s), exactly and for any flow; a limited room is the mean
/// over the step.

#include <vector>

#include "grid/face_walk.hpp"
#include "points/fines_uptake.hpp"
#include "points/liquid_points.hpp"
#include "points/point_blocks.hpp"
#include "points/shared_points.hpp"
#include "solid/skeleton.hpp"

namespace suffuse {

template <int Dim>
class FinesDeposition {
 public:
  /// Keeps references to grid, solid and shared points. All ranks have to call all functions but
  /// `exponent`.
  FinesDeposition(const Grid<Dim>& grid, const Skeleton<Dim>& solid,
                  const SharedPoints<Dim>& shared, double grain_density);

  /// Whether fines are deposited in some soil.
  [[nodiscard]] bool active() const { return active_; }
  /// Finds the room in each element, for a step of `duration` seconds.
  void start(double duration);
  /// lambda_d times the length of a passage and the room at the start of the step.
  [[nodiscard]] double exponent(const FacePassage<Dim>& passage) const;

  /// Removes deposits from points that moved. `fines_before`: kg per point before the step. The
  /// masses of `uptakes`, kg, are in the points already; they become net of deposits.
  void leave_along_paths(const std::vector<double>& fines_before,
                         std::vector<FinesUptake<Dim>>& uptakes, LiquidPoints<Dim>& points);
  /// Removes deposits from points with unknown paths. `passed`: volume of liquid per area that has
  /// moved in each element since the start of the step, m; `porosity`: per element.
  void leave_in_elements(const std::vector<Vector<Dim>>& passed,
                         const std::vector<double>& porosity, PointBlocks<Dim>& points);

  /// Deposits of the step per solid point, m3; empty: none.
  [[nodiscard]] const std::vector<double>& deposited() const { return deposited_; }
  /// Deposits of the step by the region of the soil, kg, of this rank.
  [[nodiscard]] const std::vector<ExactSum>& by_region() const { return by_region_; }
  /// Deposits of the step by the region whose liquid lost them, kg, of this rank.
  [[nodiscard]] const std::vector<ExactSum>& lost_by_region() const { return lost_by_region_; }

 private:
  /// lambda_d times the room, 1/m; zero without deposition.
  [[nodiscard]] double catching(int element, double flux) const;
  /// Share of `demand` (m3 per element, for the room at the start) that the decreasing room allows.
  [[nodiscard]] std::vector<double> room_shares(const std::vector<double>& demand) const;
  /// Distributes the volumes, m3 per element, to the solid points in proportion to their room.
  void hand_out(const std::vector<double>& caught);

  const Grid<Dim>& grid_;
  const Skeleton<Dim>& solid_;
  const SharedPoints<Dim>& shared_;
  double grain_density_;
  bool active_;
  double duration_ = 0.0;
  std::vector<double> room_;      ///< per element: mean of its solid points
  std::vector<double> capacity_;  ///< per element: volume that fits in, m3; may be infinite
  std::vector<double> deposited_;
  std::vector<ExactSum> by_region_;
  std::vector<ExactSum> lost_by_region_;
};

}  // namespace suffuse
