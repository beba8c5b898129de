#pragma once

/// A sketch of a run's model: mesh, points, regions and boundary conditions, as in Figs. 2 and 3 of
/// the paper.

#include <string>
#include <vector>

#include "results/reader.hpp"

namespace suffuse {

/// Outer faces in one colour: a boundary, or all impervious ones together.
template <int Dim>
struct SketchedBoundary {
  std::string label;  ///< "inflow: velocity 0.12 m/s, c = 0" or "left, right: impervious"
  std::vector<std::array<int, Dim>> faces;
};

/// The named boundaries in the order of the mesh. Impervious ones come last, joined where the soil
/// is held and loaded alike; outer faces without a name are "unnamed". Walls are not joined.
std::vector<SketchedBoundary<2>> sketched_boundaries(const ResultsReader& run);
template <int Dim>
std::vector<SketchedBoundary<Dim>> sketched_boundaries(const Mesh<Dim>& mesh, const Scene& scene);

/// The legend's text for a region: "specimen: soil, erodes (constant law)", "inflow: free water",
/// "free_above: air".
template <int Dim>
std::string region_label(const Mesh<Dim>& mesh, const Scene& scene, int number);

/// Draws the mesh in black, the points of the first snapshot (solid red, liquid blue), regions
/// tinted, boundaries as thick lines. Of a model in space it draws the surface: boundaries with a
/// condition in their colours, the others in the colours of the regions. Throws FileError.
void draw_model_sketch(const ResultsReader& run, const std::string& path);

}  // namespace suffuse
