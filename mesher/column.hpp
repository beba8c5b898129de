#pragma once

/// The built-in geometry: a rectangular column of layers, bottom to top. All rows of elements have
/// the height of those of the specimen.

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace suffuse {

/// One layer over the whole width, in rows counted from the bottom of the specimen. Neighbours
/// share their nodes.
struct ColumnLayer {
  std::string region;
  int bottom;
  int top;
};

struct ColumnShape {
  double width;                     ///< m, from x = 0
  double height;                    ///< height of the specimen, m, from y = 0
  int rows;                         ///< rows of elements in the specimen
  std::vector<ColumnLayer> layers;  ///< ascending, without gaps
  std::string lower_boundary;       ///< name of the bottom edge
  std::string upper_boundary;       ///< name of the top edge

  /// Height y of the line under a row; exactly `height` at the top of the specimen.
  [[nodiscard]] double level(int row) const { return height * row / rows; }
};

/// The column of a scene, bottom to top: outflow, free_below, buffer, specimen, buffer, free_above,
/// inflow, without the layers that have no rows. Its ends are called "outflow" and "inflow" if it
/// has such layers, otherwise "bottom" and "top".
ColumnShape column_of(const Scene& scene);

/// Number of elements along a side: as near to `size` as a whole number allows.
int element_rows(double length, double size);

/// Builds and meshes the column in the current Gmsh model, with a physical surface per region and
/// physical curves for both ends, "left" and "right". `regular` structure: two right triangles per
/// rectangle; `crossed`: rectangles, for `extract_mesh` to cut. Throws the exceptions of Gmsh for
/// its own errors.
void mesh_column(const ColumnShape& column, const MeshSettings& settings);

}  // namespace suffuse
