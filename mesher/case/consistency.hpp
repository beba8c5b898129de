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

/// Finds every way in which the names and values of a scene do not fit the mesh:
/// - soils without a region; regions without a soil that are not free water;
/// - boundaries, walls and wells that do not exist; two conditions on one face;
/// - steady flow under gravity in a part of the mesh where nothing sets the level of the water;
/// - heads that the explicit scheme cannot follow;
/// - probes and sections outside the mesh;
/// - an initial porosity that leaves (0, 1 - n_C] somewhere in its region;
/// - numbers of Gauss points that do not exist for these elements;
/// - keys that exist in two dimensions only.
/// The result is empty when the scene fits. `inner`: names of curves and points inside the mesh, in
/// addition to those of its cuts.
template <int Dim>
std::vector<InputProblem> scene_problems(const SceneDocument& document, const Mesh<Dim>& mesh,
                                         const InnerNames& inner = {});

}  // namespace suffuse
