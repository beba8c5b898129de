#pragma once

/// The figures of `suffuse-post figure`, by name.

#include <optional>
#include <string>
#include <vector>

#include "drawing/chart.hpp"
#include "results/reader.hpp"

namespace suffuse {

/// Names of all figures, sorted. Some are no charts but pictures of one run: "model", the sketch of
/// its model (model_sketch.hpp), "head" and "saturation" (seepage_map.hpp).
std::vector<std::string> figure_names();

/// The charts of a figure, drawn side by side: "porosity", "masses", "solid-mass"
/// (soil_figures.hpp), "outflow", "empty-elements", "flux" (flow_figures.hpp), "boundaries"
/// (boundary_figures.hpp), "gradation" (gradation_figure.hpp), "fines-lost"
/// (permeameter_figure.hpp), and "comparison": porosity, masses and concentration of the outflow in
/// one picture. Throws InputError for other names.
std::vector<Chart> make_figure(const std::string& name, const std::vector<ResultsReader>& runs);

/// What only some figures have a use for.
struct FigureOptions {
  std::optional<double> time;  ///< of the snapshot of a map, s; the last without it
  std::string measured;        ///< file of the points beside the curves of "fines-lost"
};

/// Draws any figure. Throws InputError, also for an option that the figure has no use for;
/// FileError.
void draw_figure(const std::string& name, const std::vector<ResultsReader>& runs,
                 const std::string& path, const FigureOptions& options = {});

}  // namespace suffuse
