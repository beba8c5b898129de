#pragma once

/// A skeleton that stays in place: its points erode and do not move.

#include "solid/eroding_skeleton.hpp"

namespace suffuse {

template <int Dim>
class RigidSkeleton final : public ErodingSkeleton<Dim> {
 public:
  RigidSkeleton(const Grid<Dim>& grid, const SoilMap<Dim>& soils, const TimeSpan& span,
                int threads);

  [[nodiscard]] std::vector<double> element_porosity() const override;
  [[nodiscard]] const std::vector<double>& face_volume_rate() const override { return at_rest_; }

 private:
  std::vector<double> initial_pores_;  ///< volume per element, m3
  std::vector<double> at_rest_;        ///< empty: no solid crosses a face
};

}  // namespace suffuse
