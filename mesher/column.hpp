#pragma once

/// The built-in geometry: a rectangular column made of layers, bottom to top.

#include <string>
#include <vector>

#include "case/scene.hpp"

namespace suffuse {

/// One layer over the whole width. Neighbours share their nodes.
struct ColumnLayer {
  std::string region;
  double bottom;  ///< m
  double top;     ///< m
};

struct ColumnShape {
  double width;                     ///< m, from x = 0
  std::vector<ColumnLayer> layers;  ///< ascending, without gaps
};

/// The column that a scene asks for.
ColumnShape column_of(const Scene& scene);

/// Number of elements along a side: as near to `size` as a whole number allows.
int element_rows(double length, double size);

/// Builds and meshes the column in the current Gmsh model, with a physical surface per region and
/// physical curves "bottom", "top", "left" and "right". `regular` structure: two right triangles
/// per rectangle; `crossed`: rectangles, for `extract_mesh` to cut. Gmsh's own errors come as its
/// exceptions.
void mesh_column(const ColumnShape& column, const MeshSettings& settings);

}  // namespace suffuse
