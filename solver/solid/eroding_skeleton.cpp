#include "solid/eroding_skeleton.hpp"

#include <algorithm>

#include "common/errors.hpp"
#include "grid/parallel.hpp"

namespace suffuse {

template <int Dim>
ErodingSkeleton<Dim>::ErodingSkeleton(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                                      const TimeSpan& span, int threads)
    : grid_(grid), threads_(threads), soils_(soils), span_(span) {
  const MaterialPoints<Dim>& points = soils.points();
  state_.skeleton_volume.reserve(points.size());
  state_.erodible_volume.reserve(points.size());
  for (int p = 0; p < points.size(); ++p) {
    const double porosity = soils.initial_porosity(p);
    const double porosity_max = soils.soil_of_point(p).porosity_max();
    state_.skeleton_volume.push_back(points.volume[p] * (1.0 - porosity_max));
    state_.erodible_volume.push_back(points.volume[p] * (porosity_max - porosity));
  }
  if (soils.deposits()) state_.deposited_volume.assign(points.size(), 0.0);
  update_porosity();
  initial_porosity_ = porosity_;
  if (soils.exchange_depends_on().surroundings) {
    nonlocal_flux_ = std::make_unique<NonlocalFlux<Dim>>(grid, soils, threads);
  }
}

template <int Dim>
std::vector<double> ErodingSkeleton<Dim>::fines_left_at(const std::vector<double>& porosity) const {
  std::vector<double> result(porosity.size(), 0.0);
  for (int p = 0; p < soils_.points().size(); ++p) {
    const double at_start = this->erodible_at_start(p);
    if (!(at_start > 0.0)) continue;
    const double lost = soils_.points().volume[p] * (porosity[p] - porosity_[p]);
    result[p] = (state_.erodible_volume[p] - lost) / at_start;
  }
  return result;
}

template <int Dim>
void ErodingSkeleton<Dim>::find_eroding_flux(PointFlows& flows) const {
  if (!nonlocal_flux_ || !soils_.exchange_depends_on().flux) return;
  nonlocal_flux_->find(fines_left_at(porosity_), flows);
  const double middle = 0.5 * (flows.start + flows.end);
  if (flows.end <= flows.start || !exchanges_within(flows.start, middle)) return;
  // The fines of the middle of an interval give the mean over it to second order.
  nonlocal_flux_->find(fines_left_at(porosity_after(flows.start, middle, flows)), flows);
}

template <int Dim>
void ErodingSkeleton<Dim>::update_porosity() {
  porosity_.resize(state_.skeleton_volume.size());
  for (int p = 0; p < soils_.points().size(); ++p) porosity_[p] = porosity_of(p);
}

template <int Dim>
const ExchangeModel& ErodingSkeleton<Dim>::model_of(int point, ExchangeModel& changed) const {
  const ExchangeModel& model = soils_.exchange_of_point(point);
  if (porosity_max_.empty() || !model.exchanges()) return model;
  changed = model;
  changed.erosion.porosity_max = porosity_max_[point];
  // Soil compressed below porosity_min catches no more, and keeps its deposits.
  if (!model.deposition.has_room_at(porosity_[point])) changed.deposition.coefficient = 0.0;
  return changed;
}

template <int Dim>
Exchange ErodingSkeleton<Dim>::eroded_at(const ErosionModel& erosion, int point, double porosity,
                                         double from, double to, const PointFlows& flows) {
  const auto [first, last] = flows.flux_ends(point, from, to);
  return {suffuse::porosity_after(erosion, porosity, from, to, first, last) - porosity, 0.0};
}

template <int Dim>
template <class Take>
void ErodingSkeleton<Dim>::exchange_in(int element, double from, double to, const PointFlows& flows,
                                       const Take& take) const {
  ExchangeModel changed;
  for (int p = soils_.points_begin(element); p < soils_.points_begin(element + 1); ++p) {
    const ExchangeModel& model = model_of(p, changed);
    if (!model.exchanges()) continue;
    if (!model.depends_on_concentration() && !model.drive_depends_on_conductivity()) {
      take(p, eroded_at(model.erosion, p, porosity_[p], from, to, flows));
      continue;
    }
    take(p,
         exchange_over(model, place_of(p, porosity_[p]), flows.at(p, element, from, to), from, to));
  }
}

template <int Dim>
std::vector<double> ErodingSkeleton<Dim>::porosity_after(double from, double to,
                                                         const PointFlows& flows) const {
  std::vector<double> result = porosity_;
  for_each_index(grid_.mesh.element_count(), threads_, [&](int e) {
    exchange_in(e, from, to, flows,
                [&](int p, const Exchange& change) { result[p] += change.into_liquid(); });
  });
  return result;
}

template <int Dim>
void ErodingSkeleton<Dim>::exchange(double from, double to, const PointFlows& flows,
                                    const std::vector<char>& excluded,
                                    std::vector<double>& exchange) {
  exchange.assign(porosity_.size(), 0.0);
  for_each_index(grid_.mesh.element_count(), threads_, [&](int e) {
    if (!excluded.empty() && excluded[e] != 0) return;
    exchange_in(e, from, to, flows,
                [&](int p, const Exchange& change) { exchange[p] = take(p, change); });
  });
  refuse_full();
}

template <int Dim>
double ErodingSkeleton<Dim>::take(int point, const Exchange& change) {
  const double net = change.into_liquid();
  if (net == 0.0 && change.deposited == 0.0) return 0.0;
  const double volume = soils_.points().volume[point];
  double& erodible = state_.erodible_volume[point];
  const double most = porosity_max_.empty() ? soils_.exchange_of_point(point).erosion.porosity_max
                                            : porosity_max_[point];
  const bool all = porosity_[point] + net >= most;
  const double left = all ? 0.0 : std::max(0.0, erodible - volume * net);
  // Difference of the rounded states, so that rounding loses no fines.
  const double into_liquid = erodible - left;
  erodible = left;
  // Soil filled by a last digit beyond its room returns that: erosion, not a deposit.
  if (change.deposited > 0.0) state_.deposited_volume[point] += volume * change.deposited;
  porosity_[point] = porosity_of(point);
  return into_liquid;
}

template <int Dim>
Exchange ErodingSkeleton<Dim>::exchange_at(int point, double porosity, double concentration,
                                           double from, double to, const PointFlows& flows) const {
  const int e = soils_.points().element[point];
  ExchangeModel changed;
  const ExchangeModel& model = model_of(point, changed);
  if (!model.depends_on_concentration() && !model.drive_depends_on_conductivity()) {
    return eroded_at(model.erosion, point, porosity, from, to, flows);
  }
  PlaceFlow flow = flows.at(point, e, from, to);
  flow.concentration = concentration;
  flow.motion = LiquidMotion::flows_on;
  return exchange_over(model, place_of(point, porosity), flow, from, to);
}

template <int Dim>
Exchange ErodingSkeleton<Dim>::exchange_rate_at(int point, double porosity, double concentration,
                                                double time, const PointFlows& flows) const {
  const int e = soils_.points().element[point];
  PlaceFlow flow = flows.at(point, e, time, time);
  flow.concentration = concentration;
  flow.motion = LiquidMotion::flows_on;
  ExchangeModel changed;
  return exchange_rate(model_of(point, changed), place_of(point, porosity), flow, time);
}

template <int Dim>
bool ErodingSkeleton<Dim>::is_possible(int point, double porosity, double time,
                                       const PointFlows& flows) const {
  ExchangeModel changed;
  const ExchangeModel& model = model_of(point, changed);
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
void ErodingSkeleton<Dim>::apply(const std::vector<Exchange>& change,
                                 std::vector<double>& exchange) {
  exchange.assign(porosity_.size(), 0.0);
  for_each_index(static_cast<int>(change.size()), threads_,
                 [&](int p) { exchange[p] = take(p, change[p]); });
  refuse_full();
}

template <int Dim>
void ErodingSkeleton<Dim>::deposit(const std::vector<double>& volume) {
  for (std::size_t p = 0; p < volume.size(); ++p) {
    if (volume[p] == 0.0) continue;
    state_.erodible_volume[p] += volume[p];
    state_.deposited_volume[p] += volume[p];
    porosity_[p] = porosity_of(static_cast<int>(p));
  }
  refuse_full();
}

template <int Dim>
void ErodingSkeleton<Dim>::refuse_full() const {
  if (!soils_.deposits()) return;
  constexpr double full = 1e-3;
  together(grid_.ranks(), [&] {
    const auto least = std::ranges::min_element(porosity_);
    if (least == porosity_.end() || *least > full) return;
    const auto p = static_cast<int>(least - porosity_.begin());
    throw NumericalError("deposits have filled the pores of " +
                         element_text(grid_, soils_.points().element[p]) + ": give soil \"" +
                         soils_.soil_of_point(p).region + "\" a deposition.porosity_min");
  });
}

template <int Dim>
void ErodingSkeleton<Dim>::start_from(const SolidState& state) {
  state_ = state;
  if (soils_.deposits()) state_.deposited_volume.resize(state_.erodible_volume.size(), 0.0);
  update_porosity();
}

template <int Dim>
void ErodingSkeleton<Dim>::archive(StateArchive& archive) {
  archive(state_);
}

template class ErodingSkeleton<2>;
template class ErodingSkeleton<3>;

}  // namespace suffuse
