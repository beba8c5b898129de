#pragma once

/// What the results hold of a model, whichever way its liquid is carried.

#include "flow/flow_solver.hpp"
#include "formulation/balance.hpp"
#include "transport/eulerian.hpp"

namespace suffuse {

/// Volume mean of the porosity (per solid point) over regions whose law is not "none", or over all
/// soil when there are none.
template <int Dim>
double mean_porosity(const RigidSkeleton<Dim>& skeleton, const std::vector<double>& porosity);

/// Adds the solid's masses to the sums of the model and of each region.
template <int Dim>
void book_solid(const RigidSkeleton<Dim>& skeleton, const Mesh<Dim>& mesh, double grain_density,
                const std::vector<double>& porosity, std::vector<StoredSums>& sums);

/// regions.csv at one time. `stored`, `initial` and `crossed`: the model's, then one per region.
template <int Dim>
std::vector<RegionRow> region_rows(const RigidSkeleton<Dim>& skeleton, const Grid<Dim>& grid,
                                   double grain_density, double time,
                                   const std::vector<Stored>& stored,
                                   const std::vector<Stored>& initial,
                                   const std::vector<CrossedSums>& crossed);

/// Fields of elements, nodes and solid points.
template <int Dim>
Snapshot make_snapshot(const Grid<Dim>& grid, const RigidSkeleton<Dim>& skeleton,
                       const std::vector<double>& porosity, const FinesState<Dim>& liquid,
                       const FlowState<Dim>& moment, long step);

}  // namespace suffuse
