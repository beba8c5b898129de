#pragma once

#include <memory>

#include "motion/moving_skeleton.hpp"

namespace suffuse {

/// The solid phase of a run.
template <int Dim>
struct SolidPhase {
  std::unique_ptr<Skeleton<Dim>> skeleton;
  MovingSkeleton<Dim>* moving = nullptr;  ///< the skeleton, if it moves; otherwise null
};

/// The skeleton that the scene asks for. One that moves also moves the points of `soils`. Exchange
/// happens within `span` only.
template <int Dim>
SolidPhase<Dim> make_skeleton(const Grid<Dim>& grid, SoilMap<Dim>& soils, const TimeSpan& span,
                              int threads);

}  // namespace suffuse
