#pragma once

/// Fields of a snapshot at elements, nodes and solid points: the part of a snapshot that both
/// formulations share.

#include <optional>

#include "field/eulerian.hpp"
#include "flow/flow_solver.hpp"
#include "results/writer.hpp"
#include "solid/skeleton.hpp"

namespace suffuse {

/// What a snapshot holds of the bounds; none if nothing flows from one head to another.
std::optional<DischargeRecord> discharge_record(const DischargeBounds& bounds);

/// `liquid`: pores and fines in them, per element and field node; `step`: number of flow steps so
/// far; `acting_concentration`: that of erosion, per element, if it is not that of `liquid`;
/// `of_elements`: further fields. On several ranks, rank 0 gets the values of the whole model.
/// Includes heads at nodes with gravity, and saturations of elements if the flow has them.
template <int Dim>
Snapshot element_snapshot(const Grid<Dim>& grid, const Skeleton<Dim>& solid,
                          const FinesState<Dim>& liquid, const FlowState<Dim>& flow,
                          const Scene& scene, long step,
                          const std::vector<double>& acting_concentration = {},
                          std::vector<Field> of_elements = {});

}  // namespace suffuse
