#pragma once

/// Which soil fills each element and each solid point, how it erodes, and when. Constant through a
/// run.

#include <limits>
#include <memory>
#include <vector>

#include "case/case_file.hpp"
#include "physics/erosion/erosion_law.hpp"

namespace suffuse {

/// s
struct TimeSpan {
  double start = -std::numeric_limits<double>::infinity();
  double end = std::numeric_limits<double>::infinity();

  static constexpr TimeSpan never() {
    return {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  }
  /// Whether any of the time from `from` to `to` lies within.
  [[nodiscard]] bool meets(double from, double to) const { return to > start && from < end; }
};

/// Free water (double-point) is there as a soil of porosity 1 without solid points.
template <int Dim>
class SoilMap {
 public:
  /// Keeps references to the mesh and the solid points of the case. Throws InputError when a region
  /// of the mesh has no soil (also checked by the mesher).
  explicit SoilMap(const Case<Dim>& c);

  [[nodiscard]] const Mesh<Dim>& mesh() const { return mesh_; }
  /// The solid points, sorted by element.
  [[nodiscard]] const MaterialPoints<Dim>& points() const { return points_; }
  /// Points of element e: from points_begin(e) to points_begin(e + 1).
  [[nodiscard]] int points_begin(int element) const { return points_begin_[element]; }

  [[nodiscard]] bool is_soil(int element) const {
    return soil_of_region_[mesh_.element_region[element]] != free_water_.get();
  }
  [[nodiscard]] const Soil& soil_of_element(int element) const {
    return *soil_of_region_[mesh_.element_region[element]];
  }
  [[nodiscard]] const ErosionModel& erosion_of_element(int element) const {
    return erosion_of_region_[mesh_.element_region[element]];
  }
  /// A flux, m/s, as far as it can erode: the round-off of still water is no drive. Still water in
  /// which the last digit eroded would not stay still, as fines are heavy.
  [[nodiscard]] double eroding_flux(int element, double flux) const {
    return flux <= still_flux_[mesh_.element_region[element]] ? 0.0 : flux;
  }
  /// n_0 of a solid point.
  [[nodiscard]] double initial_porosity(int point) const {
    return soil_of_element(points_.element[point]).initial_porosity(points_.position(mesh_, point));
  }

  /// Some soil erodes.
  [[nodiscard]] bool erodes() const;
  /// Some soil's erosion depends on the flow.
  [[nodiscard]] bool erodes_by_flux() const;
  /// Times at which erosion starts or, where the law says when, ends (at the first and the last
  /// point of a region), ascending, s.
  [[nodiscard]] std::vector<double> erosion_breakpoints() const;
  /// When porosity can change at all: from the first start on until, if only constant rates are at
  /// work, the last soil has nothing left to erode; infinite where that cannot be told.
  [[nodiscard]] TimeSpan erosion_span() const;

 private:
  const Mesh<Dim>& mesh_;
  const MaterialPoints<Dim>& points_;
  std::vector<int> points_begin_;
  std::shared_ptr<const Soil> free_water_;
  std::vector<const Soil*> soil_of_region_;
  std::vector<ErosionModel> erosion_of_region_;
  std::vector<double> still_flux_;  ///< per region, of water that stands still, m/s
};

}  // namespace suffuse
