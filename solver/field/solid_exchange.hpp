#pragma once

/// Exchange of fines between the solid and the liquid in its pores during the steps of transport.

#include <functional>
#include <vector>

#include "field/transport.hpp"
#include "results/pass_timer.hpp"
#include "solid/skeleton.hpp"

namespace suffuse {

template <int Dim>
class SolidExchange {
 public:
  /// Finds the present concentration and saturation of the liquid at the solid points.
  using FindLiquid = std::function<void(PointFlows& flows)>;

  /// `solid` outlives this. `find_liquid` is called if some exchange depends on the liquid.
  SolidExchange(Skeleton<Dim>& solid, FindLiquid find_liquid)
      : solid_(solid), find_liquid_(std::move(find_liquid)) {}

  /// Starts an interval with this flow at the solid points.
  void start_interval(PointFlows flows) { flows_ = std::move(flows); }
  [[nodiscard]] const Skeleton<Dim>& solid() const { return solid_; }
  /// The flow at the solid points in the interval.
  [[nodiscard]] const PointFlows& flows() const { return flows_; }
  /// The flow at the solid points with the present liquid.
  const PointFlows& find_flows() {
    if (depends_on_concentration()) find_liquid_(flows_);
    return flows_;
  }
  [[nodiscard]] bool depends_on_concentration() const {
    return solid_.soils().exchange_depends_on().concentration;
  }

  /// Times of the exchange in a step of transport. If the exchange depends on the fines in the
  /// liquid, half of it comes before the liquid moves and half after (Strang splitting, second
  /// order); otherwise all of it comes while the liquid moves.
  struct Times {
    TimeSpan before = TimeSpan::never();
    TimeSpan during = TimeSpan::never();
    TimeSpan after = TimeSpan::never();
  };
  [[nodiscard]] Times times(const TransportStep& step) const;

  /// Exchanges fines over a time. Returns the volume that goes into the liquid, m3 per solid point;
  /// empty if there is no exchange. The solid does not change in elements of `excluded` (may be
  /// empty).
  const std::vector<double>& over(const TimeSpan& time, const std::vector<char>& excluded = {});
  /// Applies a known exchange, per solid point and volume of soil, to the solid. Returns as `over`
  /// does.
  const std::vector<double>& take(const std::vector<Exchange>& change);
  /// Adds deposits, m3 per solid point, to the solid.
  void deposit(const std::vector<double>& volume) { solid_.deposit(volume); }

  [[nodiscard]] const PassTiming& timing() const { return timing_; }
  void archive(auto& archive) { archive(timing_); }

 private:
  Skeleton<Dim>& solid_;
  FindLiquid find_liquid_;
  PointFlows flows_;
  std::vector<double> volume_;  ///< last exchange, m3 per solid point
  PassTiming timing_{"erosion", 0, 0.0};
};

}  // namespace suffuse
