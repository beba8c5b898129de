#pragma once

/// Checks that a scene fits a mesh.

#include <vector>

#include "common/errors.hpp"
#include "mesh/mesh.hpp"
#include "scene/scene.hpp"

namespace suffuse {

/// Names inside a mesh that walls and wells may have, cut or not.
struct InnerNames {
  std::vector<std::string> curves;
  std::vector<std::string> points;
};

/// Every way in which the scene's names and values do not fit the mesh: soils without a region,
/// regions without a soil that are not free water, boundaries, walls and wells that do not exist,
/// two conditions on one face, heads that the explicit scheme cannot follow, probes and sections
/// outside the mesh, an initial porosity that leaves (0, 1 - n_C] somewhere in its region, numbers
/// of Gauss points that its elements cannot have, and keys that exist in two dimensions only. Empty
/// when there is none. `inner` has the names of curves and points inside the mesh that are known in
/// addition to its cuts.
template <int Dim>
std::vector<InputProblem> scene_problems(const SceneDocument& document, const Mesh<Dim>& mesh,
                                         const InnerNames& inner = {});

}  // namespace suffuse
