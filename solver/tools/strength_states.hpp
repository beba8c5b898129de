#pragma once

/// The states of a run for which the factor of safety is found.

#include "boundary/soil_state.hpp"
#include "case/case_file.hpp"
#include "results/reader.hpp"

namespace suffuse {

/// The state at t = 0, before any motion. The soil may be unable to carry its loads; it is
/// therefore made rigid, or elastic if free water or an earlier run requires soil that moves.
/// \param grid, soils  of the case
template <int Dim>
SoilState<Dim> start_state(const Case<Dim>& c, const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                           int threads);

/// The state of a snapshot of a run. Throws InputError if soil has moved in a run before it and the
/// snapshot is not the last one: snapshots do not say where such soil comes from.
/// \param of_run       the case of the run
/// \param grid, soils  of the case whose factor is found, which has the same solid points
template <int Dim>
SoilState<Dim> run_state(const ResultsReader& results, const Case<Dim>& of_run, std::size_t index,
                         const Grid<Dim>& grid, const SoilMap<Dim>& soils, int threads);

}  // namespace suffuse
