#pragma once

/// A skeleton whose points erode and do not move.

#include "solid/eroding_skeleton.hpp"

namespace suffuse {

template <int Dim>
class RigidSkeleton : public ErodingSkeleton<Dim> {
 public:
  RigidSkeleton(const Grid<Dim>& grid, const SoilMap<Dim>& soils, const TimeSpan& span,
                int threads);

  [[nodiscard]] std::vector<double> element_porosity() const override;
  void archive(StateArchive& archive) override;

 private:
  std::vector<double> initial_pores_;  ///< volume per element, m3
};

}  // namespace suffuse
