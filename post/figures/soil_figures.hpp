#pragma once

/// Figures of the eroding soil, with exact curves where there are any, for runs of either
/// formulation. All functions throw FileError when a table has fewer than two times.

#include "drawing/chart.hpp"
#include "results/reader.hpp"

namespace suffuse {

/// Fig. 4 of the paper: mean porosity of the eroding soil against time.
Chart porosity_chart(const std::vector<ResultsReader>& runs);

/// Fig. 7: solid, eroded, liquid and total mass of the eroding soil in closed accounting (in the
/// soil, plus what left, minus what entered).
Chart masses_chart(const std::vector<ResultsReader>& runs);

/// Fig. 5: solid mass of the eroding soil; the legend has the number of points per element.
Chart solid_mass_chart(const std::vector<ResultsReader>& runs);

/// Solid and eroded mass with one marker per run, for `comparison`.
Chart eroded_and_solid_chart(const std::vector<ResultsReader>& runs);

/// The end of a label: ": 12 liquid points per element, empty elements erode" for a double-point
/// scene, ": 3 points per element" for a single-point one.
std::string discretization(const Scene& scene);

}  // namespace suffuse
