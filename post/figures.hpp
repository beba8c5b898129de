#pragma once

/// The figures of `suffuse-post figure`, by name.

#include <string>
#include <vector>

#include "chart.hpp"
#include "results/reader.hpp"

namespace suffuse {

/// Names of all figures, sorted.
std::vector<std::string> figure_names();

/// The charts of a figure, drawn side by side: "porosity", "masses", "solid-mass"
/// (soil_figures.hpp), "outflow", "empty-elements", "flux" (flow_figures.hpp), and "comparison":
/// porosity, masses and concentration of the outflow in one picture. Throws InputError for other
/// names.
std::vector<Chart> make_figure(const std::string& name, const std::vector<ResultsReader>& runs);

/// Draws one of these figures, or "model", the sketch of one run's model (model_sketch.hpp). Throws
/// InputError, FileError.
void draw_figure(const std::string& name, const std::vector<ResultsReader>& runs,
                 const std::string& path);

}  // namespace suffuse
