#pragma once

/// Figs. 2 and 3 of the paper: what a model consists of and what is prescribed on it.

#include <string>
#include <vector>

#include "results/reader.hpp"

namespace suffuse {

/// One boundary, or several on which the same holds, and the edges of it.
struct SketchedBoundary {
  std::string label;  ///< "inflow: velocity 0.12 m/s, c = 0" or "left, right: impervious"
  std::vector<std::array<int, 2>> edges;
};

/// The named boundaries in the order of the mesh; outer edges that nobody named are "unnamed".
/// Impervious ones come last and share a row.
std::vector<SketchedBoundary> sketched_boundaries(const ResultsReader& run);

/// "specimen: soil, erodes (constant law)", "inflow: free water"
std::string region_label(const Scene& scene, const std::string& region);

/// The mesh in black, solid points red, liquid points blue where there are any, regions tinted,
/// boundaries as thick lines; points as in the first snapshot. Throws FileError.
void draw_model_sketch(const ResultsReader& run, const std::string& path);

}  // namespace suffuse
