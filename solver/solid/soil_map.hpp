#pragma once

/// The soil of each element and each solid point, with its laws of exchange. Constant in a run,
/// except for points that move.

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "case/case_file.hpp"
#include "grid/grid.hpp"
#include "physics/exchange.hpp"

namespace suffuse {

/// A span of time, s.
struct TimeSpan {
  double start = -std::numeric_limits<double>::infinity();
  double end = std::numeric_limits<double>::infinity();

  static constexpr TimeSpan never() {
    return {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  }
  /// Whether the time from `from` to `to` overlaps this span.
  [[nodiscard]] bool meets(double from, double to) const { return to > start && from < end; }
};

/// Unit vector across the bedding of a soil, whose layers rise by `bedding` degrees from the
/// x-axis.
template <int Dim>
Vector<Dim> across_bedding(const Soil& soil);

/// Free water is a soil of porosity 1 without solid points. An element that points have entered has
/// their soil.
template <int Dim>
class SoilMap {
 public:
  /// Keeps references to the scene, the mesh and the solid points of the case. Throws InputError
  /// when a region of the mesh has no soil (also checked by the mesher).
  explicit SoilMap(const Case<Dim>& c);
  SoilMap(const SoilMap&) = delete;
  SoilMap& operator=(const SoilMap&) = delete;

  [[nodiscard]] const Scene& scene() const { return scene_; }

  [[nodiscard]] const Mesh<Dim>& mesh() const { return mesh_; }
  /// The solid points, sorted by element: those of the case, or where they have moved.
  [[nodiscard]] const MaterialPoints<Dim>& points() const { return *points_; }
  /// Points of element e: from points_begin(e) to points_begin(e + 1).
  [[nodiscard]] int points_begin(int element) const { return points_begin_[element]; }
  /// Points of a range of elements.
  [[nodiscard]] NumberRange points_of(const NumberRange& elements) const {
    return {points_begin_[*elements.begin()], points_begin_[*elements.end()]};
  }

  /// The region that most points of an element come from; its own region without points.
  [[nodiscard]] int region_of_element(int element) const {
    return element_region_.empty() ? mesh_.element_region[element] : element_region_[element];
  }
  [[nodiscard]] bool is_soil(int element) const {
    return soil_of_region_[region_of_element(element)] != free_water_.get();
  }
  /// Per region of the mesh: whether it has a soil, at the start.
  [[nodiscard]] std::vector<char> has_soil() const {
    std::vector<char> result;
    result.reserve(soil_of_region_.size());
    for (const Soil* soil : soil_of_region_) result.push_back(soil != free_water_.get() ? 1 : 0);
    return result;
  }
  /// Space without soil: water, and air if some soil drains.
  [[nodiscard]] const Soil& free_space() const { return *free_water_; }
  [[nodiscard]] const Soil& soil_of_element(int element) const {
    return *soil_of_region_[region_of_element(element)];
  }
  [[nodiscard]] const ErosionModel& erosion_of_element(int element) const {
    return exchange_of_region_[region_of_element(element)].erosion;
  }
  [[nodiscard]] const ExchangeModel& exchange_of_element(int element) const {
    return exchange_of_region_[region_of_element(element)];
  }
  /// A point keeps the soil of the region that it comes from (index into the mesh's
  /// `region_names`).
  [[nodiscard]] int region_of_point(int point) const {
    return moved_region_.empty() ? mesh_.element_region[points_->element[point]]
                                 : moved_region_[point];
  }
  [[nodiscard]] const Soil& soil_of_region(int region) const { return *soil_of_region_[region]; }
  [[nodiscard]] const Soil& soil_of_point(int point) const {
    return soil_of_region(region_of_point(point));
  }
  [[nodiscard]] const ExchangeModel& exchange_of_point(int point) const {
    return exchange_of_region_[region_of_point(point)];
  }
  /// Replaces the points of the case by points that have moved.
  /// \param points  sorted by element; at their present places
  /// \param region  per point: the one it comes from
  void move_points(MaterialPoints<Dim> points, std::vector<int> region);

  /// |q| up to which water counts as still, m/s: round-off.
  [[nodiscard]] double still_flux(int element) const {
    return still_flux_[region_of_element(element)];
  }
  /// Gradient along a flux over |q|/k, k being that along bedding; 1 for no flux.
  [[nodiscard]] double resistance_along(int element, const Vector<Dim>& flux) const {
    return soil_of_element(element).resistance_along(flux);
  }
  /// k of an element over that of its soil, whose conductivity may be a random field.
  [[nodiscard]] double conductivity_factor(int element) const {
    return conductivity_factor_ ? (*conductivity_factor_)[element] : 1.0;
  }
  /// n_0 of a solid point that has not moved.
  [[nodiscard]] double initial_porosity(int point) const {
    return soil_of_point(point).initial_porosity(points_->position(mesh_, point));
  }

  /// Whether some soil erodes.
  [[nodiscard]] bool erodes() const;
  /// Whether the momentum of eroded grains acts on the liquid in some soil.
  [[nodiscard]] bool transfers_momentum() const {
    return std::ranges::any_of(scene_.soils,
                               [](const Soil& soil) { return soil.erosion.momentum_transfer; });
  }
  /// Whether some soil catches fines.
  [[nodiscard]] bool deposits() const;
  /// What the exchange of some soil with the liquid depends on.
  struct Dependence {
    bool flux = false;           ///< |q|
    bool flux_change = false;    ///< how |q| changes within a step, as it may cross a threshold
    bool resistance = false;     ///< the gradient that drives the flow
    bool concentration = false;  ///< the fines in the liquid
    bool surroundings = false;   ///< the flux around a place, by an `erosion.length`
  };
  [[nodiscard]] const Dependence& exchange_depends_on() const { return dependence_; }
  /// Times at which erosion starts or, if the law tells, ends (at the first and the last point of a
  /// region), ascending, s.
  [[nodiscard]] std::vector<double> erosion_breakpoints(const Ranks& ranks) const;
  /// Time in which porosity can change: from the first start until nothing is left to erode, if
  /// only constant rates act; infinite if that is unknown, as where an earlier run leaves other
  /// fines. Fines that enter (`fines_enter`) can be caught from the start on.
  [[nodiscard]] TimeSpan exchange_span(bool fines_enter) const;

 private:
  void find_dependence();
  void draw_fields();
  void find_points_begin();
  void find_element_region();

  const Scene& scene_;
  const Mesh<Dim>& mesh_;
  const MaterialPoints<Dim>* points_;                 ///< of the case, or `moved_`
  std::unique_ptr<const MaterialPoints<Dim>> moved_;  ///< null if points do not move
  std::vector<int> moved_region_;                     ///< per point; empty if they do not move
  std::vector<int> points_begin_;
  std::vector<int> element_region_;  ///< per element; empty if they do not move
  std::shared_ptr<const Soil> free_water_;
  std::vector<const Soil*> soil_of_region_;
  std::vector<ExchangeModel> exchange_of_region_;
  Dependence dependence_;
  std::vector<double> still_flux_;                          ///< per region: |q| of still water, m/s
  std::optional<std::vector<double>> conductivity_factor_;  ///< per element; nothing: 1
};

}  // namespace suffuse
