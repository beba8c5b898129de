#include "field/field_transport.hpp"

#include <algorithm>
#include <limits>

#include "common/errors.hpp"
#include "common/short_number.hpp"
#include "grid/parallel.hpp"

namespace suffuse {
namespace {

/// Adds liquid to each element, distributed like its liquid.
template <int Dim>
void gain(FinesState<Dim>& state, const std::vector<double>& gained) {
  for (std::size_t e = 0; e < gained.size(); ++e)
    add_liquid<Dim>(state.liquid_volume[e], gained[e]);
}

/// Throws NumericalError, on all ranks, if an element has no liquid: what it gains is distributed
/// like its liquid.
template <int Dim>
void refuse_dry(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                const ElementField<Dim>& liquid_volume, double time) {
  together(grid.ranks(), [&] {
    const auto dry = std::ranges::find_if(
        liquid_volume, [](const auto& liquid) { return !(element_sum<Dim>(liquid) > 0.0); });
    if (dry == liquid_volume.end()) return;
    const int e = static_cast<int>(dry - liquid_volume.begin());
    const std::string key = "soil." + soils.soil_of_element(e).region + ".retention";
    throw NumericalError(element_text(grid, e) + " holds no water at t = " + short_number(time) +
                         " s; give " + key + " a residual_saturation");
  });
}

/// More steps of explicit transport in a step of the flow take too long.
constexpr StepCountLimit count_limit{1e6,
                                     "take time.transport = \"implicit\", or a shorter time.step"};

}  // namespace

template <int Dim>
FieldTransport<Dim>::FieldTransport(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                                    const std::vector<FaceCondition>& conditions,
                                    const BoundaryValues<Dim>& boundary_values,
                                    const FieldTransportSettings& settings, int threads)
    : grid_(grid),
      soils_(soils),
      settings_(settings),
      threads_(threads),
      sides_(grid),
      scheme_(grid, sides_, conditions, threads),
      implicit_(grid, sides_, soils, boundary_values, settings.implicit, threads) {
  state_.liquid_volume = initial_pore_volume(grid, soils);
  state_.fines_volume.assign(grid.mesh.element_count(), ElementValues<Dim>{});
  find_basis();
}

template <int Dim>
void FieldTransport<Dim>::find_basis() {
  const auto& places = soils_.points().barycentric;
  if (places.empty()) return;
  const int first = soils_.points().element.front();
  const int count = soils_.points_begin(first + 1) - soils_.points_begin(first);
  for (int e = 0; e < grid_.mesh.element_count() && points_lie_alike_; ++e) {
    const int begin = soils_.points_begin(e);
    const int end = soils_.points_begin(e + 1);
    points_lie_alike_ =
        begin == end || (end - begin == count &&
                         std::equal(places.begin() + begin, places.begin() + end, places.begin()));
  }
  basis_.resize(points_lie_alike_ ? static_cast<std::size_t>(count) : places.size());
  for (std::size_t p = 0; p < basis_.size(); ++p) {
    for (int j = 0; j <= Dim; ++j) basis_[p][j] = FieldNodes<Dim>::basis(places[p][j]);
  }
}

template <int Dim>
void FieldTransport<Dim>::spread(const std::vector<double>& exchange,
                                 ElementField<Dim>& field) const {
  field.resize(grid_.mesh.element_count());
  for_each_index(grid_.mesh.element_count(), threads_, [&](int e) {
    const int begin = soils_.points_begin(e);
    const ElementValues<Dim>* basis = basis_.data() + (points_lie_alike_ ? 0 : begin);
    ElementValues<Dim> sum{};
    for (int p = begin; p < soils_.points_begin(e + 1); ++p, ++basis) {
      for (int j = 0; j <= Dim; ++j) sum[j] += exchange[p] * (*basis)[j];
    }
    field[e] = sum;
  });
}

template <int Dim>
void FieldTransport<Dim>::start(const std::vector<double>& air) {
  std::vector<double> missing(air.size());
  for (std::size_t e = 0; e < air.size(); ++e) missing[e] = -air[e];
  gain(state_, missing);
}

template <int Dim>
double FieldTransport<Dim>::longest_step(const std::vector<double>& face_rate) const {
  return is_implicit(face_rate) ? std::numeric_limits<double>::infinity()
                                : longest_explicit_step(face_rate);
}

template <int Dim>
bool FieldTransport<Dim>::is_implicit(const std::vector<double>& face_rate) const {
  if (settings_.scheme != TransportScheme::by_count) {
    return settings_.scheme == TransportScheme::implicit_sweeps;
  }
  return settings_.implicit.end >
         explicit_steps_of_a_run * scheme_.steps_allowed(state_, face_rate);
}

template <int Dim>
std::vector<double> FieldTransport<Dim>::move(double start, const FlowProgress& flow,
                                              SolidExchange<Dim>& exchange) {
  if (settings_.points_move) find_basis();
  if (!flow.room_gained.empty()) refuse_dry(grid_, soils_, state_.liquid_volume, start);
  const bool implicitly =
      holds_fines(flow.end) && is_implicit(per_time(flow.volumes.liquid, flow.end - start));
  return implicitly ? move_implicitly(start, flow, exchange)
                    : move_explicitly(start, flow, exchange);
}

template <int Dim>
std::vector<double> FieldTransport<Dim>::move_explicitly(double start, const FlowProgress& flow,
                                                         SolidExchange<Dim>& exchange) {
  std::vector<double> crossed(grid_.face_count(), 0.0);
  std::vector<double> gained = flow.room_gained;
  if (!holds_fines(flow.end)) {
    gain(state_, gained);
    return crossed;
  }
  for (const TransportStep& step : start_steps(start, flow, gained)) {
    const auto times = exchange.times(step);
    receive(exchange.over(times.before));
    const std::vector<double>& eroded = exchange.over(times.during);
    {
      const PassTimer timer(timing_);
      ++timing_.calls;
      eroded_.clear();
      if (!eroded.empty()) spread(eroded, eroded_);
      scheme_.advance(state_, eroded_, gained, scratch_);
    }
    receive(exchange.over(times.after));
  }
  scheme_.fines_crossed(scratch_, crossed);
  return crossed;
}

template <int Dim>
std::vector<double> FieldTransport<Dim>::move_implicitly(double start, const FlowProgress& flow,
                                                         SolidExchange<Dim>& exchange) {
  implicit_.start(start, flow);
  while (!implicit_.finished()) {
    const std::vector<double>& given =
        exchange.take(implicit_.solve(state_, exchange.solid(), exchange.flows()));
    if (given.empty()) {
      eroded_.assign(grid_.mesh.element_count(), ElementValues<Dim>{});
    } else {
      spread(given, eroded_);
    }
    implicit_.finish(state_, eroded_);
  }
  std::vector<double> crossed(grid_.face_count(), 0.0);
  implicit_.field().fines_crossed(crossed);
  return crossed;
}

template <int Dim>
std::vector<TransportStep> FieldTransport<Dim>::start_steps(double start, const FlowProgress& flow,
                                                            std::vector<double>& gained) {
  double allowed = scheme_.steps_allowed(state_, flow.volumes.liquid);
  if (!gained.empty()) {
    // If liquid drains, the liquid at the end limits the step.
    FinesState<Dim> after = state_;
    gain(after, gained);
    allowed = std::min(allowed, scheme_.steps_allowed(after, flow.volumes.liquid));
  }
  std::vector<TransportStep> steps = equal_steps(
      start, flow.end, step_count(transport_safety * allowed, start, flow.end, count_limit));
  std::vector<double> step_volume = flow.volumes.liquid;
  if (steps.size() > 1) {
    for (double& volume : step_volume) volume *= steps.front().share;
    for (double& volume : gained) volume *= steps.front().share;
  }
  scheme_.start(state_, step_volume, scratch_);
  return steps;
}

template <int Dim>
void FieldTransport<Dim>::receive(const std::vector<double>& exchange) {
  if (exchange.empty()) return;
  const PassTimer timer(timing_);
  spread(exchange, eroded_);
  scheme_.receive(state_, eroded_, scratch_);
}

template <int Dim>
std::vector<PassTiming> FieldTransport<Dim>::passes() const {
  std::vector<PassTiming> result{timing_};
  if (implicit_.timing().calls > 0) result.push_back(implicit_.timing());
  return result;
}

template <int Dim>
std::vector<double> FieldTransport<Dim>::face_concentration(
    double time, const std::vector<double>& face_rate) const {
  if (holds_fines(time)) return scheme_.face_concentration(state_, face_rate);
  return std::vector<double>(grid_.face_count(), 0.0);
}

template class FieldTransport<2>;
template class FieldTransport<3>;

}  // namespace suffuse
