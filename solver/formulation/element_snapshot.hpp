#pragma once

/// The fields of a snapshot that do not depend on how liquid is carried: those of elements, nodes
/// and solid points.

#include "flow/flow_solver.hpp"
#include "results/writer.hpp"
#include "solid/skeleton.hpp"
#include "transport/eulerian.hpp"

namespace suffuse {

/// `liquid`: pores and fines in them, per element and field node; `step`: number of flow steps so
/// far.
template <int Dim>
Snapshot element_snapshot(const Grid<Dim>& grid, const Skeleton<Dim>& solid,
                          const FinesState<Dim>& liquid, const FlowState<Dim>& flow, long step);

}  // namespace suffuse
