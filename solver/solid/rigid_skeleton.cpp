#include "solid/rigid_skeleton.hpp"

#include <algorithm>

#include "case/errors.hpp"
#include "grid/parallel.hpp"
#include "solid/pores.hpp"

namespace suffuse {

template <int Dim>
RigidSkeleton<Dim>::RigidSkeleton(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                                  const TimeSpan& span, int threads)
    : grid_(grid), soils_(soils), span_(span), threads_(threads) {
  const MaterialPoints<Dim>& points = soils.points();
  state_.skeleton_volume.reserve(points.size());
  state_.erodible_volume.reserve(points.size());
  for (int p = 0; p < points.size(); ++p) {
    const double porosity = soils.initial_porosity(p);
    const double porosity_max = soils.soil_of_element(points.element[p]).porosity_max();
    state_.skeleton_volume.push_back(points.volume[p] * (1.0 - porosity_max));
    state_.erodible_volume.push_back(points.volume[p] * (porosity_max - porosity));
  }
  if (soils.deposits()) state_.deposited_volume.assign(points.size(), 0.0);
  update_porosity();
  initial_porosity_ = porosity_;
  for (const ElementValues<Dim>& pores : initial_pore_volume(grid, soils)) {
    initial_pores_.push_back(element_sum<Dim>(pores));
  }
}

template <int Dim>
void RigidSkeleton<Dim>::update_porosity() {
  porosity_.resize(state_.skeleton_volume.size());
  for (int p = 0; p < soils_.points().size(); ++p) porosity_[p] = porosity_of(p);
}

template <int Dim>
std::vector<double> RigidSkeleton<Dim>::element_porosity() const {
  // From the gain of the points: the initial porosity is a linear function that its values at a few
  // points need not have as their mean.
  const MaterialPoints<Dim>& points = soils_.points();
  std::vector<double> result(grid_.mesh.element_count());
  for_each_index(grid_.mesh.element_count(), threads_, [&](int e) {
    double pores = initial_pores_[e];
    for (int p = soils_.points_begin(e); p < soils_.points_begin(e + 1); ++p) {
      pores += points.volume[p] * (porosity_[p] - initial_porosity_[p]);
    }
    result[e] = pores / grid_.volume[e];
  });
  return result;
}

template <int Dim>
Exchange RigidSkeleton<Dim>::eroded_at(int point, double porosity, double from, double to,
                                       const PointFlows& flows) const {
  const ErosionModel& erosion = soils_.erosion_of_element(soils_.points().element[point]);
  const auto [first, last] = flows.flux_ends(point, from, to);
  const double after = suffuse::porosity_after(erosion, porosity, from, to, first, last);
  return {after - porosity, 0.0};
}

template <int Dim>
template <class Take>
void RigidSkeleton<Dim>::exchange_in(int element, double from, double to, const PointFlows& flows,
                                     const Take& take) const {
  const ExchangeModel& model = soils_.exchange_of_element(element);
  if (!model.exchanges()) return;
  const int begin = soils_.points_begin(element);
  const int end = soils_.points_begin(element + 1);
  if (!model.depends_on_concentration() && !model.drive_depends_on_conductivity()) {
    for (int p = begin; p < end; ++p) take(p, eroded_at(p, porosity_[p], from, to, flows));
    return;
  }
  for (int p = begin; p < end; ++p) {
    const SoilPlace place{initial_porosity_[p], porosity_[p]};
    take(p, exchange_over(model, place, flows.at(p, element, from, to), from, to));
  }
}

template <int Dim>
std::vector<double> RigidSkeleton<Dim>::porosity_after(double from, double to,
                                                       const PointFlows& flows) const {
  std::vector<double> result = porosity_;
  for_each_index(grid_.mesh.element_count(), threads_, [&](int e) {
    exchange_in(e, from, to, flows,
                [&](int p, const Exchange& change) { result[p] += change.into_liquid(); });
  });
  return result;
}

template <int Dim>
void RigidSkeleton<Dim>::exchange(double from, double to, const PointFlows& flows,
                                  const std::vector<char>& waiting, std::vector<double>& exchange) {
  exchange.assign(porosity_.size(), 0.0);
  for_each_index(grid_.mesh.element_count(), threads_, [&](int e) {
    if (!waiting.empty() && waiting[e] != 0) return;
    exchange_in(e, from, to, flows,
                [&](int p, const Exchange& change) { exchange[p] = take(p, change); });
  });
  refuse_full();
}

template <int Dim>
double RigidSkeleton<Dim>::take(int point, const Exchange& change) {
  const double net = change.into_liquid();
  if (net == 0.0 && change.deposited == 0.0) return 0.0;
  const double volume = soils_.points().volume[point];
  double& erodible = state_.erodible_volume[point];
  const double most = soils_.erosion_of_element(soils_.points().element[point]).porosity_max;
  const bool all = porosity_[point] + net >= most;
  const double left = all ? 0.0 : std::max(0.0, erodible - volume * net);
  // What the rounded state lost, so that none is lost on the way to the liquid.
  const double into_liquid = erodible - left;
  erodible = left;
  if (change.deposited != 0.0) state_.deposited_volume[point] += volume * change.deposited;
  porosity_[point] = porosity_of(point);
  return into_liquid;
}

template <int Dim>
Exchange RigidSkeleton<Dim>::exchange_at(int point, double porosity, double concentration,
                                         double from, double to, const PointFlows& flows) const {
  const int e = soils_.points().element[point];
  const ExchangeModel& model = soils_.exchange_of_element(e);
  if (!model.depends_on_concentration() && !model.drive_depends_on_conductivity()) {
    return eroded_at(point, porosity, from, to, flows);
  }
  PlaceFlow flow = flows.at(point, e, from, to);
  flow.concentration = concentration;
  flow.motion = LiquidMotion::flows_on;
  return exchange_over(model, {initial_porosity_[point], porosity}, flow, from, to);
}

template <int Dim>
Exchange RigidSkeleton<Dim>::exchange_rate_at(int point, double porosity, double concentration,
                                              double time, const PointFlows& flows) const {
  const int e = soils_.points().element[point];
  PlaceFlow flow = flows.at(point, e, time, time);
  flow.concentration = concentration;
  flow.motion = LiquidMotion::flows_on;
  return exchange_rate(soils_.exchange_of_element(e), {initial_porosity_[point], porosity}, flow,
                       time);
}

template <int Dim>
bool RigidSkeleton<Dim>::is_possible(int point, double porosity, double time,
                                     const PointFlows& flows) const {
  const ExchangeModel& model = soils_.exchange_of_element(soils_.points().element[point]);
  double most = porosity_[point];
  if (erodes(model.erosion)) {
    const double flux = flows.flux_ends(point, time, time).first;
    most = std::max(most, model.erosion.porosity_max - model.erosion.residual.at(flux));
  }
  const double least = model.deposition.has_room_limit()
                           ? std::min(porosity_[point], model.deposition.porosity_min)
                           : 0.0;
  return porosity <= most && porosity >= least;
}

template <int Dim>
void RigidSkeleton<Dim>::apply(const std::vector<Exchange>& change, std::vector<double>& exchange) {
  exchange.assign(porosity_.size(), 0.0);
  for_each_index(static_cast<int>(change.size()), threads_,
                 [&](int p) { exchange[p] = take(p, change[p]); });
  refuse_full();
}

template <int Dim>
void RigidSkeleton<Dim>::deposit(const std::vector<double>& volume) {
  for (std::size_t p = 0; p < volume.size(); ++p) {
    if (volume[p] == 0.0) continue;
    state_.erodible_volume[p] += volume[p];
    state_.deposited_volume[p] += volume[p];
    porosity_[p] = porosity_of(static_cast<int>(p));
  }
  refuse_full();
}

template <int Dim>
void RigidSkeleton<Dim>::refuse_full() const {
  if (!soils_.deposits()) return;
  constexpr double full = 1e-3;
  const auto least = std::ranges::min_element(porosity_);
  if (least == porosity_.end() || *least > full) return;
  const int e = soils_.points().element[least - porosity_.begin()];
  throw NumericalError("deposits have filled the pores of " + element_text(grid_, e) +
                       ": give soil \"" + soils_.soil_of_element(e).region +
                       "\" a deposition.porosity_min");
}

template <int Dim>
void RigidSkeleton<Dim>::start_from(const SolidState& state) {
  state_ = state;
  if (soils_.deposits()) state_.deposited_volume.resize(state_.erodible_volume.size(), 0.0);
  update_porosity();
}

template <int Dim>
void RigidSkeleton<Dim>::archive(StateArchive& archive) {
  archive(state_);
  if (archive.restores()) update_porosity();
}

template <int Dim>
std::unique_ptr<Skeleton<Dim>> make_skeleton(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                                             const TimeSpan& span, int threads) {
  return std::make_unique<RigidSkeleton<Dim>>(grid, soils, span, threads);
}

template class RigidSkeleton<2>;
template std::unique_ptr<Skeleton<2>> make_skeleton(const Grid<2>&, const SoilMap<2>&,
                                                    const TimeSpan&, int);
template class RigidSkeleton<3>;
template std::unique_ptr<Skeleton<3>> make_skeleton(const Grid<3>&, const SoilMap<3>&,
                                                    const TimeSpan&, int);

}  // namespace suffuse
