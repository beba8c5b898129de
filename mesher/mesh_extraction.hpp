#pragma once

/// From the mesh of the current Gmsh model to ours.

#include <string>
#include <vector>

#include "case/errors.hpp"
#include "case/mesh.hpp"

namespace suffuse {

struct ExtractedMesh {
  /// Physical surfaces are its regions, physical curves its boundaries; nodes that no triangle uses
  /// are left out. Complete only when there are no problems.
  Mesh<2> mesh;
  /// What is wrong with it: `found` and `expected` only, the caller knows where the mesh came from.
  std::vector<InputProblem> problems;
  /// Clockwise triangles that were turned round.
  int turned = 0;
  /// False when so much is missing that holding a scene against it would only add noise.
  bool comparable = false;
};

ExtractedMesh extract_mesh();

}  // namespace suffuse
