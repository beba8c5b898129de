#pragma once

/// The figures that `suffuse-post figure` knows, from results.

#include <string>
#include <vector>

#include "chart.hpp"
#include "results/reader.hpp"

namespace suffuse {

/// Names that `draw_figure` knows.
std::vector<std::string> figure_names();

/// The charts of a figure, beside one another: "porosity", "masses", "solid-mass"
/// (soil_figures.hpp), "outflow", "empty-elements", "flux" (flow_figures.hpp), and "comparison":
/// porosity, masses and concentration of the outflow in one picture. Throws InputError for another
/// name.
std::vector<Chart> make_figure(const std::string& name, const std::vector<ResultsReader>& runs);

/// Draws one of those, or "model", the sketch of one run's model (model_sketch.hpp). Throws
/// InputError, FileError.
void draw_figure(const std::string& name, const std::vector<ResultsReader>& runs,
                 const std::string& path);

}  // namespace suffuse
