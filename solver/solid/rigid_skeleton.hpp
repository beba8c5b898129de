#pragma once

/// The solid phase: porosity at fixed material points, eroding. Whatever else needs the solid sees
/// it through this class, so that a moving skeleton can take its place.

#include <limits>
#include <memory>
#include <vector>

#include "case/case_file.hpp"
#include "grid/element_field.hpp"
#include "grid/grid.hpp"
#include "physics/erosion_law.hpp"

namespace suffuse {

/// s
struct TimeSpan {
  double begin = -std::numeric_limits<double>::infinity();
  double end = std::numeric_limits<double>::infinity();
};

/// Pore volume and what erosion added to it, element by element, as the liquid sees it. Free water
/// (double-point) is there as a soil of porosity 1 without solid points.
template <int Dim>
class RigidSkeleton {
 public:
  /// Throws InputError when a soil does not fit its region (also checked by the mesher).
  RigidSkeleton(const Case<Dim>& c, const Grid<Dim>& grid, int threads = 1);

  /// n_L per solid point.
  [[nodiscard]] const std::vector<double>& porosity() const { return porosity_; }
  [[nodiscard]] const std::vector<double>& initial_porosity() const { return initial_porosity_; }

  /// n_L of every point at time `to`, from `porosity` (per point) at `from`. `flux`: mean of |q| at
  /// every point over that time, m/s; may be empty unless `erodes_by_flux`.
  [[nodiscard]] std::vector<double> porosity_after(const std::vector<double>& porosity, double from,
                                                   double to,
                                                   const std::vector<double>& flux) const;

  /// Volume eroded between two states, per element and field node, m3: each point's volume times
  /// its gain, shared by the basis functions at the point. Adds up to what the points lost exactly.
  [[nodiscard]] ElementField<Dim> eroded_volume(const std::vector<double>& before,
                                                const std::vector<double>& after) const;

  /// Both in one pass and in place: `porosity` as `porosity_after` has it, `eroded` between the
  /// two.
  void erode(std::vector<double>& porosity, double from, double to, const std::vector<double>& flux,
             ElementField<Dim>& eroded) const;

  void set_porosity(std::vector<double> porosity) { porosity_ = std::move(porosity); }

  /// Pore volume per element and field node at the start, m3.
  [[nodiscard]] ElementField<Dim> initial_pore_volume() const;

  [[nodiscard]] bool erodes() const;
  /// Some soil's erosion depends on the flow.
  [[nodiscard]] bool erodes_by_flux() const;
  /// Times at which erosion starts or, at a constant rate, runs out (of the first and the last
  /// point of a region), ascending, s.
  [[nodiscard]] std::vector<double> erosion_events() const;
  /// When porosity can change at all: from the first start on until, if only constant rates are at
  /// work, the last soil has nothing left to erode; infinite where that cannot be told.
  [[nodiscard]] TimeSpan erosion_span() const;
  [[nodiscard]] bool is_soil(int element) const {
    return soil_of_region_[mesh_.element_region[element]] != free_water_.get();
  }
  [[nodiscard]] const Soil& soil_of_element(int element) const {
    return *soil_of_region_[mesh_.element_region[element]];
  }
  [[nodiscard]] const Soil& soil_of_point(int point) const {
    return soil_of_element(points_.element[point]);
  }
  [[nodiscard]] const ErosionModel& erosion_of_element(int element) const {
    return erosion_of_region_[mesh_.element_region[element]];
  }
  [[nodiscard]] const MaterialPoints<Dim>& points() const { return points_; }
  /// Points of element e: from points_begin(e) to points_begin(e + 1).
  [[nodiscard]] int points_begin(int element) const { return points_begin_[element]; }

 private:
  void find_basis();
  /// Values of the element's basis functions at its points, in their order.
  [[nodiscard]] const ElementValues<Dim>* basis_in(int element) const {
    return basis_.data() + (points_lie_alike_ ? 0 : points_begin_[element]);
  }
  /// Calls visit(point, porosity after) for the points of an element.
  template <class Visit>
  void follow_erosion(int element, const std::vector<double>& porosity, double from, double to,
                      const std::vector<double>& flux, const Visit& visit) const;

  const Mesh<Dim>& mesh_;
  const MaterialPoints<Dim>& points_;
  const Grid<Dim>& grid_;
  int threads_;
  std::vector<int> points_begin_;
  /// Of each point; only of the first element's where they lie alike in every element that has any.
  std::vector<ElementValues<Dim>> basis_;
  bool points_lie_alike_ = true;
  std::shared_ptr<const Soil> free_water_;
  std::vector<const Soil*> soil_of_region_;
  std::vector<ErosionModel> erosion_of_region_;
  std::vector<double> initial_porosity_;
  std::vector<double> porosity_;
};

}  // namespace suffuse
