#include "motion/make_skeleton.hpp"

#include "solid/rigid_skeleton.hpp"

namespace suffuse {

template <int Dim>
SolidPhase<Dim> make_skeleton(const Grid<Dim>& grid, SoilMap<Dim>& soils, const TimeSpan& span,
                              int threads) {
  if (!soils.scene().moves()) {
    return {std::make_unique<RigidSkeleton<Dim>>(grid, soils, span, threads)};
  }
  auto moving = std::make_unique<MovingSkeleton<Dim>>(grid, soils, span, threads);
  MovingSkeleton<Dim>* skeleton = moving.get();
  return {std::move(moving), skeleton};
}

template SolidPhase<2> make_skeleton(const Grid<2>&, SoilMap<2>&, const TimeSpan&, int);
template SolidPhase<3> make_skeleton(const Grid<3>&, SoilMap<3>&, const TimeSpan&, int);

}  // namespace suffuse
