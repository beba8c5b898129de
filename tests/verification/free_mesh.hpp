#pragma once

#include "geometry.hpp"
#include "solver/model_case.hpp"

namespace suffuse::model {

/// The unit square in Gmsh's unstructured triangles.
inline Mesh<2> free_mesh(double size) {
  SceneDocument document;
  document.path = "model.toml";
  document.scene = paper_scene();
  document.scene.geometry.shape = "column";
  document.scene.geometry.width = 1.0;
  document.scene.geometry.height = 1.0;
  document.scene.mesh = {size, MeshStructure::free};
  return build_geometry_of<2>(document).mesh;
}

}  // namespace suffuse::model
