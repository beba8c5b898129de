#pragma once

/// A stage of construction: soil that an earlier run has left is dug out or filled in before the
/// next run starts.

#include "flow/flow_solver.hpp"
#include "mixed/flow_soils.hpp"
#include "motion/moved_soil.hpp"

namespace suffuse {

/// The soil with which the next run starts.
template <int Dim>
struct NextStage {
  MovedSoil<Dim> soil;
  /// Elements whose soil was dug out or filled in: the room of their pores has changed.
  std::vector<int> changed;
};

/// Digs out of `earlier` the regions that have no soil any more, and what came from them; fills
/// regions that had none with the soil of `fresh`, which has its places, volumes and porosities of
/// a new run and no stress. Earlier soil in a region that is filled is dug out first. Without such
/// a region the soil is that of `earlier`. All soil keeps its stress under the laws of `scene`,
/// that of the next run.
template <int Dim>
NextStage<Dim> next_stage(const Scene& scene, const Mesh<Dim>& mesh, const MovedSoil<Dim>& fresh,
                          const MovedSoil<Dim>& earlier);

/// What is in the pores of each element.
template <int Dim>
struct PoreContent {
  ElementField<Dim>& liquid;        ///< m3, per node
  ElementField<Dim>& fines;         ///< m3, per node
  ElementField<Dim>& air;           ///< m3, per side; empty where all soil is saturated
  std::vector<double>& water_mass;  ///< kg
};

/// Fills the pores of elements whose soil was dug out or filled in with clear water, and with air
/// where they drain, at the pressures of the earlier flow.
/// \param porosity  per element, after construction
template <int Dim>
void fill_pores(const Grid<Dim>& grid, const FlowSoils<Dim>& soils, const LiquidProperties& liquid,
                const std::vector<double>& porosity, const EarlierFlow<Dim>& earlier,
                const std::vector<int>& elements, PoreContent<Dim> content);

}  // namespace suffuse
