#include "solid/rigid_skeleton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "case/errors.hpp"
#include "grid/parallel.hpp"

namespace suffuse {
namespace {

/// Free water resists the flow so much less than the most conductive soil: next to nothing, and
/// steady flow through it is still one linear system.
constexpr double free_water_ease = 1e4;

Soil free_water(const Scene& scene) {
  Soil water;
  water.porosity = 1.0;
  water.skeleton_fraction = 0.0;
  water.conductivity = 0.0;
  for (const Soil& soil : scene.soils) {
    water.conductivity = std::max(water.conductivity, free_water_ease * soil.conductivity);
  }
  return water;
}

}  // namespace

template <int Dim>
RigidSkeleton<Dim>::RigidSkeleton(const Case<Dim>& c, const Grid<Dim>& grid, int threads)
    : mesh_(c.mesh),
      points_(c.solid_points),
      grid_(grid),
      threads_(threads),
      free_water_(std::make_shared<const Soil>(free_water(c.document.scene))) {
  for (const std::string& region : mesh_.region_names) {
    const Soil* soil = c.document.scene.find_soil(region);
    if (soil == nullptr && c.document.scene.is_free_water(region)) soil = free_water_.get();
    if (soil == nullptr) {
      throw InputError({{c.document.locate("soil"), "soil." + region, "nothing",
                         "a soil for region '" + region + "' of the mesh", ""}});
    }
    soil_of_region_.push_back(soil);
    erosion_of_region_.push_back(
        {soil->erosion.law, soil->erosion.rate, soil->erosion.start, soil->porosity_max()});
  }
  initial_porosity_.reserve(points_.size());
  for (int p = 0; p < points_.size(); ++p) {
    initial_porosity_.push_back(soil_of_point(p).initial_porosity(points_.position(mesh_, p)));
  }
  porosity_ = initial_porosity_;
  points_begin_.assign(mesh_.element_count() + 1, 0);
  for (const int e : points_.element) ++points_begin_[e + 1];
  std::partial_sum(points_begin_.begin(), points_begin_.end(), points_begin_.begin());
  find_basis();
}

template <int Dim>
void RigidSkeleton<Dim>::find_basis() {
  const auto& places = points_.barycentric;
  if (places.empty()) return;
  const int first = points_.element.front();
  const int count = points_begin_[first + 1] - points_begin_[first];
  for (int e = 0; e < mesh_.element_count() && points_lie_alike_; ++e) {
    const int begin = points_begin_[e];
    const int end = points_begin_[e + 1];
    points_lie_alike_ =
        begin == end || (end - begin == count &&
                         std::equal(places.begin() + begin, places.begin() + end, places.begin()));
  }
  const std::size_t stored = points_lie_alike_ ? count : places.size();
  basis_.resize(stored);
  for (std::size_t p = 0; p < stored; ++p) {
    for (int j = 0; j <= Dim; ++j) basis_[p][j] = FieldNodes<Dim>::basis(places[p][j]);
  }
}

template <int Dim>
template <class Visit>
void RigidSkeleton<Dim>::follow_erosion(int element, const std::vector<double>& porosity,
                                        double from, double to, const std::vector<double>& flux,
                                        const Visit& visit) const {
  const ErosionModel& model = erosion_of_element(element);
  for (int p = points_begin_[element]; p < points_begin_[element + 1]; ++p) {
    visit(p, suffuse::porosity_after(model, porosity[p], from, to, flux.empty() ? unset : flux[p]));
  }
}

template <int Dim>
std::vector<double> RigidSkeleton<Dim>::porosity_after(const std::vector<double>& porosity,
                                                       double from, double to,
                                                       const std::vector<double>& flux) const {
  std::vector<double> result(porosity.size());
  for_each_index(mesh_.element_count(), threads_, [&](int e) {
    follow_erosion(e, porosity, from, to, flux, [&](int p, double after) { result[p] = after; });
  });
  return result;
}

template <int Dim>
ElementField<Dim> RigidSkeleton<Dim>::eroded_volume(const std::vector<double>& before,
                                                    const std::vector<double>& after) const {
  ElementField<Dim> eroded(mesh_.element_count());
  for_each_index(mesh_.element_count(), threads_, [&](int e) {
    const ElementValues<Dim>* basis = basis_in(e);
    ElementValues<Dim> sum{};
    for (int p = points_begin_[e]; p < points_begin_[e + 1]; ++p, ++basis) {
      const double volume = points_.volume[p] * (after[p] - before[p]);
      for (int j = 0; j <= Dim; ++j) sum[j] += volume * (*basis)[j];
    }
    eroded[e] = sum;
  });
  return eroded;
}

template <int Dim>
void RigidSkeleton<Dim>::erode(std::vector<double>& porosity, double from, double to,
                               const std::vector<double>& flux, ElementField<Dim>& eroded) const {
  eroded.resize(mesh_.element_count());
  for_each_index(mesh_.element_count(), threads_, [&](int e) {
    const ElementValues<Dim>* basis = basis_in(e);
    ElementValues<Dim> sum{};
    follow_erosion(e, porosity, from, to, flux, [&](int p, double after) {
      const double volume = points_.volume[p] * (after - porosity[p]);
      for (int j = 0; j <= Dim; ++j) sum[j] += volume * (*basis)[j];
      porosity[p] = after;
      ++basis;
    });
    eroded[e] = sum;
  });
}

template <int Dim>
ElementField<Dim> RigidSkeleton<Dim>::initial_pore_volume() const {
  // The initial porosity is a linear function, so its values at the field nodes are exact; points
  // moved off the Gauss positions would not reproduce it.
  ElementField<Dim> result(mesh_.element_count());
  for (int e = 0; e < mesh_.element_count(); ++e) {
    for (int j = 0; j <= Dim; ++j) {
      Vector<Dim> x = Vector<Dim>::Zero();
      for (int k = 0; k <= Dim; ++k) {
        const double weight = k == j ? FieldNodes<Dim>::near_vertex : FieldNodes<Dim>::far_vertex;
        x += weight * mesh_.nodes[mesh_.elements[e][k]];
      }
      result[e][j] = grid_.volume[e] / (Dim + 1) * soil_of_element(e).initial_porosity(x);
    }
  }
  return result;
}

template <int Dim>
bool RigidSkeleton<Dim>::erodes() const {
  return std::any_of(erosion_of_region_.begin(), erosion_of_region_.end(), [](const auto& model) {
    return model.law != ErosionLaw::none && model.rate > 0.0;
  });
}

template <int Dim>
bool RigidSkeleton<Dim>::erodes_by_flux() const {
  return std::any_of(erosion_of_region_.begin(), erosion_of_region_.end(), [](const auto& model) {
    return model.law == ErosionLaw::flux && model.rate > 0.0;
  });
}

template <int Dim>
std::vector<double> RigidSkeleton<Dim>::erosion_events() const {
  std::vector<double> events;
  for (std::size_t r = 0; r < erosion_of_region_.size(); ++r) {
    const ErosionModel& model = erosion_of_region_[r];
    if (model.law == ErosionLaw::none || model.rate == 0.0) continue;
    events.push_back(model.start);
    if (model.law != ErosionLaw::constant) continue;
    double first = std::numeric_limits<double>::infinity();
    double last = 0.0;
    for (int p = 0; p < points_.size(); ++p) {
      if (mesh_.element_region[points_.element[p]] != static_cast<int>(r)) continue;
      const double gone = (model.porosity_max - initial_porosity_[p]) / model.rate;
      first = std::min(first, gone);
      last = std::max(last, gone);
    }
    for (const double gone : {first, last}) {
      if (std::isfinite(gone)) events.push_back(model.start + gone);
    }
  }
  std::sort(events.begin(), events.end());
  events.erase(std::unique(events.begin(), events.end()), events.end());
  return events;
}

template <int Dim>
TimeSpan RigidSkeleton<Dim>::erosion_span() const {
  // Porosity that is added up over many steps reaches its end earlier or later by their round-off.
  constexpr double round_off = 1e-6;
  constexpr double never = std::numeric_limits<double>::infinity();
  TimeSpan span{never, -never};
  for (int p = 0; p < points_.size(); ++p) {
    const ErosionModel& model = erosion_of_element(points_.element[p]);
    if (model.law == ErosionLaw::none || model.rate == 0.0) continue;
    span.begin = std::min(span.begin, model.start);
    const bool runs_out =
        model.law == ErosionLaw::constant &&
        soil_of_point(p).erosion.empty_elements != EmptyElements::dry;  // those wait for liquid
    const double gone = model.start + (model.porosity_max - initial_porosity_[p]) / model.rate;
    span.end = std::max(span.end, runs_out ? gone * (1.0 + round_off) : never);
  }
  return span;
}

template class RigidSkeleton<2>;

}  // namespace suffuse
