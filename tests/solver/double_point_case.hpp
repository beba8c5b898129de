#pragma once

/// Double-point cases made in memory: the paper's column with layers, no files.

#include "solver/model_case.hpp"

namespace suffuse::model {

/// Rows of square cells from top to bottom, as the scene key `geometry.layers` has them.
inline Mesh<2> layered_mesh(int columns, const LayerSettings& layers, int specimen_rows = 0,
                            double width = 1.0) {
  if (specimen_rows == 0) specimen_rows = columns;
  const double size = width / columns;
  struct Block {
    std::string region;
    int rows;
  };
  // Blocks from bottom to top.
  const std::vector<Block> blocks{{"outflow", layers.outflow}, {"free_below", layers.free_below},
                                  {"buffer", layers.below},    {"specimen", specimen_rows},
                                  {"buffer", layers.above},    {"free_above", layers.free_above},
                                  {"inflow", layers.inflow}};
  const double bottom = -size * (layers.outflow + layers.free_below + layers.below);
  int rows = 0;
  for (const Block& block : blocks) rows += block.rows;
  Mesh<2> mesh = column_mesh(columns, rows, width, size * rows,
                             [&](const Vector<2>& x) { return Vector<2>(x[0], x[1] + bottom); });
  mesh.region_names.clear();
  int row = 0;
  for (const Block& block : blocks) {
    if (block.rows == 0) continue;
    auto known = std::find(mesh.region_names.begin(), mesh.region_names.end(), block.region);
    if (known == mesh.region_names.end()) {
      known = mesh.region_names.insert(known, block.region);
    }
    const auto region = static_cast<int>(known - mesh.region_names.begin());
    for (int k = 0; k < block.rows; ++k, ++row) {
      for (int e = 2 * columns * row; e < 2 * columns * (row + 1); ++e) {
        mesh.element_region[e] = region;
      }
    }
  }
  for (BoundarySet<2>& boundary : mesh.boundaries) {
    if (boundary.name == "top") boundary.name = "inflow";
    if (boundary.name == "bottom") boundary.name = "outflow";
  }
  return mesh;
}

/// The paper's soil, eroding by the constant law from t = 2 s, water entering at a Darcy flux of
/// `flux` from above and leaving at p = 0 below, steady from the start.
inline Scene double_point_scene(double flux, double rate) {
  Scene scene = paper_scene();
  scene.formulation = Formulation::double_point;
  scene.soils.front().erosion.law = erosion_law("constant");
  scene.soils.front().erosion.rate = rate;
  scene.soils.front().erosion.start = 2.0;
  Soil buffer = scene.soils.front();
  buffer.region = "buffer";
  buffer.erosion = {};
  scene.soils.push_back(buffer);
  scene.boundaries = {flux_on("inflow", flux), pressure_on("outflow", 0.0)};
  scene.initial_flow = InitialFlow::steady;
  return scene;
}

inline Case<2> make_double_point_case(Mesh<2> mesh, Scene scene) {
  // Soils without a region would be refused.
  std::erase_if(scene.soils, [&](const Soil& soil) {
    return std::find(mesh.region_names.begin(), mesh.region_names.end(), soil.region) ==
           mesh.region_names.end();
  });
  return make_case(std::move(mesh), std::move(scene));
}

}  // namespace suffuse::model
