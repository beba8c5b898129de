#pragma once

/// Forces in the place of soil that is dug out, or under soil that is filled in, until the work is
/// done.

#include <algorithm>

#include "equilibrium/equilibrium.hpp"

namespace suffuse {

/// They balance the soil at the start and decrease linearly to zero over the time of construction:
/// the soil is unloaded or loaded as fast as the work goes on.
template <int Dim>
class ConstructionForces {
 public:
  ConstructionForces() = default;
  /// \param force     per node, N
  /// \param duration  of the work, s
  ConstructionForces(NodeVectors<Dim> force, double duration)
      : force_(std::move(force)), duration_(duration) {}

  /// Adds the forces that act at a time, s.
  void add(double time, NodeVectors<Dim>& loads) const {
    if (time >= duration_) return;
    const double left = 1.0 - time / duration_;
    for (std::size_t i = 0; i < force_.size(); ++i) loads[i] += left * force_[i];
  }

  void archive(auto& archive) { archive(force_, duration_); }

 private:
  NodeVectors<Dim> force_;
  double duration_ = 0.0;
};

}  // namespace suffuse
