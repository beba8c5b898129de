#pragma once

/// The rates at which levels of reservoirs rise in a step and what seeps at these rates depend on
/// each other: an iteration finds rates that agree.

#include <vector>

#include "linear/anderson_mixing.hpp"

namespace suffuse {

class ReservoirIteration {
 public:
  /// Solutions of a step until a shorter one is tried.
  static constexpr int max_tries = 20;

  /// \param rates  their number, that of reservoirs times stages
  /// \param scale  of heads over the length of the step, m/s
  ReservoirIteration(std::size_t rates, double scale)
      : mixing_(static_cast<int>(rates)), scale_(scale) {}

  /// Whether these rates agree with those that the flow they lead to would have, m/s. Otherwise
  /// changes them to the next ones to try.
  [[nodiscard]] bool agree(std::vector<double>& rates, const std::vector<double>& of_flow);
  /// Whether the step is short enough. It is too long if its mean rate and the rate of its first
  /// stage lead to levels that differ much.
  [[nodiscard]] bool follow(const std::vector<double>& rates, std::size_t stages) const;

 private:
  AndersonMixing mixing_;
  double scale_;
};

}  // namespace suffuse
