#pragma once

/// Figures of what happens to the soil, each with the exact curves of the scenes' own parameters.
/// The runs may be of either formulation. All throw FileError when a table has no two times.

#include "chart.hpp"
#include "results/reader.hpp"

namespace suffuse {

/// Fig. 4 of the paper: mean porosity of the eroding soil against time.
Chart porosity_chart(const std::vector<ResultsReader>& runs);

/// Fig. 7: solid, eroded, liquid and total mass of the eroding soil in closed accounting (in the
/// soil, plus what left, less what entered).
Chart masses_chart(const std::vector<ResultsReader>& runs);

/// Fig. 5: solid mass of the eroding soil; the legend says how many points an element has.
Chart solid_mass_chart(const std::vector<ResultsReader>& runs);

/// Solid and eroded mass with one marker per run, for `comparison`.
Chart eroded_and_solid_chart(const std::vector<ResultsReader>& runs);

/// ": 12 liquid points per element, empty elements erode", or ": 3 points per element".
std::string discretization(const Scene& scene);

}  // namespace suffuse
