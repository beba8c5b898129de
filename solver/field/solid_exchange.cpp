#include "field/solid_exchange.hpp"

namespace suffuse {

template <int Dim>
auto SolidExchange<Dim>::times(const TransportStep& step) const -> Times {
  if (!depends_on_concentration()) return {.during = {step.start, step.end}};
  const double middle = 0.5 * (step.start + step.end);
  return {.before = {step.start, middle}, .after = {middle, step.end}};
}

template <int Dim>
const std::vector<double>& SolidExchange<Dim>::over(const TimeSpan& time,
                                                    const std::vector<char>& excluded) {
  volume_.clear();
  if (time.start >= time.end || !solid_.exchanges_within(time.start, time.end)) return volume_;
  const PassTimer timer(timing_);
  ++timing_.calls;
  solid_.exchange(time.start, time.end, find_flows(), excluded, volume_);
  return volume_;
}

template <int Dim>
const std::vector<double>& SolidExchange<Dim>::take(const std::vector<Exchange>& change) {
  const PassTimer timer(timing_);
  ++timing_.calls;
  solid_.apply(change, volume_);
  return volume_;
}

template class SolidExchange<2>;
template class SolidExchange<3>;

}  // namespace suffuse
