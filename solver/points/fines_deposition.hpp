#pragma once

/// Fines that liquid points leave in the soil they pass. Along a path of length s the fines of a
/// point per mass of its water go with exp(-lambda_d s), exactly, whatever the flow; where room is
/// limited, with what room there is on the mean of the step.

#include <vector>

#include "grid/face_walk.hpp"
#include "points/fines_uptake.hpp"
#include "points/liquid_points.hpp"
#include "points/point_blocks.hpp"
#include "solid/skeleton.hpp"

namespace suffuse {

template <int Dim>
class FinesDeposition {
 public:
  /// Keeps references to the grid and the solid.
  FinesDeposition(const Grid<Dim>& grid, const Skeleton<Dim>& solid, double grain_density);

  /// Some soil catches fines.
  [[nodiscard]] bool active() const { return active_; }
  /// Finds the room in each element, for a step of `duration` seconds.
  void start(double duration);
  /// lambda_d times the length of a passage, with the room at the start of the step.
  [[nodiscard]] double exponent(const FacePassage<Dim>& passage) const;

  /// Takes fines from points that moved. `fines_before`: kg per point, as they were before the
  /// step; the masses of `uptakes`, kg, have been added since, and become net ones here.
  void leave_along_paths(const std::vector<double>& fines_before,
                         std::vector<FinesUptake<Dim>>& uptakes, LiquidPoints<Dim>& points);
  /// Takes fines from points whose paths are not known: they lie where their element's liquid has
  /// moved by `passed` (m: volume per area since the start of the step) in pores of `porosity`.
  void leave_in_elements(const std::vector<Vector<Dim>>& passed,
                         const std::vector<double>& porosity, PointBlocks<Dim>& points);

  /// What the step left, per solid point, m3; empty: nothing.
  [[nodiscard]] const std::vector<double>& deposited() const { return deposited_; }
  /// Fines that the step left, by the region of the soil, kg.
  [[nodiscard]] const std::vector<double>& by_region() const { return by_region_; }
  /// Fines that the step left, by the region whose liquid lost them, kg.
  [[nodiscard]] const std::vector<double>& lost_by_region() const { return lost_by_region_; }

 private:
  /// lambda_d times the room, 1/m; zero where fines are not caught.
  [[nodiscard]] double catching(int element, double flux) const;
  /// Share of `demand` (m3 per element, with the room at the start) that is caught as room goes.
  [[nodiscard]] std::vector<double> room_shares(const std::vector<double>& demand) const;
  /// Hands the volumes, m3 per element, to the solid points there, as they have room.
  void hand_out(const std::vector<double>& caught);

  const Grid<Dim>& grid_;
  const Skeleton<Dim>& solid_;
  double grain_density_;
  bool active_;
  double duration_ = 0.0;
  std::vector<double> room_;      ///< per element: of its solid points on the mean
  std::vector<double> capacity_;  ///< per element: volume that fits in, m3; may be infinite
  std::vector<double> deposited_;
  std::vector<double> by_region_;
  std::vector<double> lost_by_region_;
};

}  // namespace suffuse
