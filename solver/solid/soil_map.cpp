#include "solid/soil_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "common/errors.hpp"

namespace suffuse {
namespace {

/// Conductivity of free water over that of the most conductive soil. Its resistance is negligible,
/// and steady flow through it is still one linear system.
constexpr double free_water_ratio = 1e4;

/// Gradients below `still_gradient` are round-off. So are fluxes below `still_share` of that at a
/// gradient of one in the most conductive soil, which a tight neighbor passes on.
constexpr double still_gradient = 1e-12;
constexpr double still_share = 1e-15;

/// Next to soil that drains, air replaces water under suction, over a height of this share of an
/// element. Water then runs through it as through gravel.
constexpr double fringe = 0.25;
constexpr double free_air_ratio = 100.0;

/// The largest conductivity of all soils in their best direction, m/s.
double largest_conductivity(const Scene& scene) {
  double largest = 0.0;
  for (const Soil& soil : scene.soils) {
    largest = std::max(largest, soil.conductivity * std::max(1.0, soil.anisotropy()));
  }
  return largest;
}

Soil free_water(const Scene& scene, double element_size) {
  Soil water;
  water.porosity = 1.0;
  water.skeleton_fraction = 0.0;
  const bool has_air = std::ranges::any_of(scene.soils, &Soil::drains);
  water.conductivity = (has_air ? free_air_ratio : free_water_ratio) * largest_conductivity(scene);
  if (has_air) {
    water.retention = {.law = retention_law("van-genuchten"),
                       .parameters = {.alpha = 1.0 / (fringe * element_size), .n = 3.0}};
  }
  return water;
}

}  // namespace

template <int Dim>
Vector<Dim> across_bedding(const Soil& soil) {
  const double angle = soil.bedding * std::numbers::pi / 180.0;
  Vector<Dim> direction = Vector<Dim>::Zero();
  direction[0] = -std::sin(angle);
  direction[Dim - 1] = std::cos(angle);
  return direction;
}

template <int Dim>
SoilMap<Dim>::SoilMap(const Case<Dim>& c)
    : scene_(c.document.scene),
      mesh_(c.mesh),
      points_(&c.solid_points),
      free_water_(std::make_shared<const Soil>(free_water(c.document.scene, mean_size(c.mesh)))) {
  const double most_conductive = largest_conductivity(scene_);
  for (const std::string& region : mesh_.region_names) {
    const Soil* soil = c.document.scene.find_soil(region);
    if (soil == nullptr && c.document.scene.is_free_water(region)) soil = free_water_.get();
    if (soil == nullptr) {
      throw InputError(InputProblem{c.document.locate("soil"), "soil." + region, "nothing",
                                    "a soil for region '" + region + "' of the mesh"});
    }
    soil_of_region_.push_back(soil);
    exchange_of_region_.push_back(soil->exchange_model(c.document.scene.liquid));
    const double across = soil->conductivity * std::min(soil->anisotropy(), 1.0);
    still_flux_.push_back(still_gradient * across + still_share * most_conductive);
  }
  find_dependence();
  draw_fields();
  find_points_begin();
}

template <int Dim>
void SoilMap<Dim>::draw_fields() {
  for (std::size_t region = 0; region < soil_of_region_.size(); ++region) {
    const Soil& soil = *soil_of_region_[region];
    if (!soil.field.varies()) continue;
    if (!conductivity_factor_) conductivity_factor_.emplace(mesh_.element_count(), 1.0);
    const LognormalField field(soil.field, soil.bedding);
    for (int e = 0; e < mesh_.element_count(); ++e) {
      if (mesh_.element_region[e] != static_cast<int>(region)) continue;
      (*conductivity_factor_)[e] = field.at(element_centroid(mesh_, e));
    }
  }
}

template <int Dim>
void SoilMap<Dim>::find_points_begin() {
  points_begin_.assign(mesh_.element_count() + 1, 0);
  for (const int e : points_->element) ++points_begin_[e + 1];
  std::partial_sum(points_begin_.begin(), points_begin_.end(), points_begin_.begin());
}

template <int Dim>
void SoilMap<Dim>::move_points(MaterialPoints<Dim> points, std::vector<int> region) {
  moved_ = std::make_unique<const MaterialPoints<Dim>>(std::move(points));
  moved_region_ = std::move(region);
  points_ = moved_.get();
  find_points_begin();
  find_element_region();
}

template <int Dim>
void SoilMap<Dim>::find_element_region() {
  element_region_ = mesh_.element_region;
  std::vector<int> points(mesh_.region_names.size());
  for (int e = 0; e < mesh_.element_count(); ++e) {
    if (points_begin(e) == points_begin(e + 1)) continue;
    std::ranges::fill(points, 0);
    for (int p = points_begin(e); p < points_begin(e + 1); ++p) ++points[moved_region_[p]];
    element_region_[e] = static_cast<int>(std::ranges::max_element(points) - points.begin());
  }
}

template <int Dim>
void SoilMap<Dim>::find_dependence() {
  for (ExchangeModel& model : exchange_of_region_) {
    // A soil may have inherited the length, and not the law.
    if (!depends_on_flux(model.erosion)) model.erosion.length = 0.0;
    const bool threshold = model.erosion.threshold > 0.0;
    dependence_.flux |= model.depends_on_flux();
    dependence_.flux_change |=
        depends_on_flux(model.erosion) && (threshold || model.drive_depends_on_conductivity());
    dependence_.resistance |= model.drive_depends_on_conductivity();
    dependence_.surroundings |= model.erosion.length > 0.0;
    dependence_.concentration |= model.depends_on_concentration();
  }
}

template <int Dim>
bool SoilMap<Dim>::erodes() const {
  return std::ranges::any_of(exchange_of_region_, [](const ExchangeModel& model) {
    return suffuse::erodes(model.erosion);
  });
}

template <int Dim>
bool SoilMap<Dim>::deposits() const {
  return std::ranges::any_of(
      exchange_of_region_, [](const ExchangeModel& model) { return model.deposition.deposits(); });
}

template <int Dim>
std::vector<double> SoilMap<Dim>::erosion_breakpoints(const Ranks& ranks) const {
  std::vector<double> times;
  for (std::size_t r = 0; r < exchange_of_region_.size(); ++r) {
    double lowest = 1.0;
    double highest = 0.0;
    for (int p = 0; p < points_->size(); ++p) {
      if (region_of_point(p) != static_cast<int>(r)) continue;
      lowest = std::min(lowest, initial_porosity(p));
      highest = std::max(highest, initial_porosity(p));
    }
    lowest = smallest_of_all(ranks, lowest);
    highest = largest_of_all(ranks, highest);
    if (lowest > highest) continue;  // no points
    for (const double porosity : {lowest, highest}) {
      const std::vector<double> own = breakpoints(exchange_of_region_[r].erosion, porosity);
      times.insert(times.end(), own.begin(), own.end());
    }
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

template <int Dim>
TimeSpan SoilMap<Dim>::exchange_span(bool fines_enter) const {
  constexpr double round_off = 1e-6;  // of a porosity summed over many steps
  constexpr double never = std::numeric_limits<double>::infinity();
  TimeSpan span{never, -never};
  for (int p = 0; p < points_->size(); ++p) {
    const ErosionModel& model = exchange_of_point(p).erosion;
    if (!suffuse::erodes(model)) continue;
    span.start = std::min(span.start, model.start);
    // Fines also last longer in compressed soil, as a rate is per present volume.
    const bool waits = soil_of_point(p).erosion.empty_elements == EmptyElements::dry ||
                       soil_of_point(p).skeleton.moves();
    const double gone = exhaustion_time(model, initial_porosity(p)) * (1.0 + round_off);
    span.end = std::max(span.end, waits ? never : gone);
  }
  if (deposits() && fines_enter) span.start = -never;
  if ((deposits() || !scene().initial_from.empty()) && (fines_enter || erodes())) span.end = never;
  return span;
}

template Vector<2> across_bedding(const Soil&);
template class SoilMap<2>;
template Vector<3> across_bedding(const Soil&);
template class SoilMap<3>;

}  // namespace suffuse
