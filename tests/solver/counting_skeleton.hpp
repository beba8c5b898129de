#pragma once

/// A solid that counts the volume that it gives to the liquid.

#include "ranks/exact_sum.hpp"
#include "solid/rigid_skeleton.hpp"

namespace suffuse {

template <int Dim>
class CountingSkeleton final : public RigidSkeleton<Dim> {
 public:
  using RigidSkeleton<Dim>::RigidSkeleton;
  void exchange(double from, double to, const PointFlows& flows, const std::vector<char>& excluded,
                std::vector<double>& exchange) override {
    RigidSkeleton<Dim>::exchange(from, to, flows, excluded, exchange);
    for (const double volume : exchange) given_.add(volume);
  }
  /// Volume that all points gave to the liquid since the start, m3.
  [[nodiscard]] double given() const { return given_.value(); }

 private:
  ExactSum given_;
};

}  // namespace suffuse
