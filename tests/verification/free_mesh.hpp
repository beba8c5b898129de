#pragma once

#include "geometry.hpp"
#include "solver/model_case.hpp"

namespace suffuse::model {

/// A rectangle, the unit square without its sides, in Gmsh's unstructured triangles.
inline Mesh<2> free_mesh(double size, double width = 1.0, double height = 1.0) {
  SceneDocument document;
  document.path = "model.toml";
  document.scene = paper_scene();
  document.scene.geometry.shape = "column";
  document.scene.geometry.width = width;
  document.scene.geometry.height = height;
  document.scene.mesh = {size, MeshStructure::free};
  return build_geometry_of<2>(document).mesh;
}

}  // namespace suffuse::model
