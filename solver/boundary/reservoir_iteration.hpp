#pragma once

/// The rates at which levels of reservoirs rise in a step and what seeps at these rates depend on
/// each other: an iteration finds rates that agree.

#include <vector>

#include "linear/anderson_mixing.hpp"

namespace suffuse {

class ReservoirIteration {
 public:
  /// `tolerance`: rates that differ by less agree, m/s.
  ReservoirIteration(std::size_t reservoirs, double tolerance)
      : mixing_(static_cast<int>(reservoirs)), tolerance_(tolerance) {}

  /// Whether these rates agree with those that the flow they lead to would have, m/s. Otherwise
  /// changes them to the next ones to try.
  [[nodiscard]] bool agree(std::vector<double>& rates, const std::vector<double>& of_flow);

 private:
  AndersonMixing mixing_;
  double tolerance_;
};

}  // namespace suffuse
