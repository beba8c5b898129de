#pragma once

/// The figures of `suffuse-post figure`, by name.

#include <string>
#include <vector>

#include "drawing/chart.hpp"
#include "figures/figure_options.hpp"
#include "results/reader.hpp"

namespace suffuse {

/// Names of all figures, sorted. Some figures are pictures of one run instead of charts: "model",
/// the sketch of its model (model_sketch.hpp), "head" and "saturation" (seepage_map.hpp), "flownet"
/// (flow_net.hpp). "slip" is a picture of a file (slip_figure.hpp).
std::vector<std::string> figure_names();

/// Whether a figure shows a file instead of runs. Throws InputError for other names.
bool is_of_file(const std::string& name);
/// Draws such a figure. Throws InputError for options, which it has none of; FileError.
void draw_figure_of_file(const std::string& name, const std::string& file, const std::string& path,
                         const FigureOptions& options = {});

/// The charts of a figure, drawn side by side: "porosity", "masses", "solid-mass"
/// (soil_figures.hpp), "outflow", "empty-elements", "flux" (flow_figures.hpp), "boundaries"
/// (boundary_figures.hpp), "gradation" (gradation_figure.hpp), "fines-lost"
/// (permeameter_figure.hpp), "curves" (table_curves.hpp), "profile" (profile.hpp), and
/// "comparison": porosity, masses and concentration of the outflow in one picture. Throws
/// InputError for other names, and for an option that the figure does not use; FileError.
std::vector<Chart> make_figure(const std::string& name, const std::vector<ResultsReader>& runs,
                               const FigureOptions& options = {});

/// Draws any figure. Throws as `make_figure`.
void draw_figure(const std::string& name, const std::vector<ResultsReader>& runs,
                 const std::string& path, const FigureOptions& options = {});

}  // namespace suffuse
