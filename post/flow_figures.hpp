#pragma once

/// Figures of the flow and of what it carries. The runs may be of either formulation. All throw
/// FileError when a table has no two times.

#include "chart.hpp"
#include "results/reader.hpp"

namespace suffuse {

/// Concentration of the liquid that leaves the eroding soil, and the grains that left it. Taken at
/// the soil's own boundary, so that buffers below it delay nothing; at the model's where several
/// regions erode. Concentrations are means over a 24th of the run. With the exact curves where
/// a scene has them (see column_fines.hpp).
std::vector<Chart> outflow_charts(const std::vector<ResultsReader>& runs);

/// Fig. 6 of the paper: elements found without liquid points, added up over the steps.
Chart empty_elements_chart(const std::vector<ResultsReader>& runs);

/// Liquid that enters and leaves the model, with the steady flux where it is known.
Chart flux_chart(const std::vector<ResultsReader>& runs);

}  // namespace suffuse
