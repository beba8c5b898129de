#pragma once

/// Figures of the flow and of the fines that it carries, for runs of either formulation. All
/// functions throw FileError when a table has fewer than two times.

#include "drawing/chart.hpp"
#include "results/reader.hpp"

namespace suffuse {

/// Two charts: concentration of the liquid that leaves the eroding soil, and mass of the grains
/// that left it. Outflow is counted at the boundary of the soil, so that free water behind it
/// causes no delay; where several regions erode, at the boundary of the model. Concentrations are
/// means over 1/24 of the run. Exact curves are added where a scene has them (column_fines.hpp).
std::vector<Chart> outflow_charts(const std::vector<ResultsReader>& runs);

/// Fig. 6 of the paper: number of elements without liquid points, summed over the steps.
Chart empty_elements_chart(const std::vector<ResultsReader>& runs);

/// Liquid flux into and out of the model, with the exact steady flux where there is one.
Chart flux_chart(const std::vector<ResultsReader>& runs);

}  // namespace suffuse
