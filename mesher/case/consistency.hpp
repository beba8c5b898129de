#pragma once

/// Checks that a scene fits a mesh.

#include <vector>

#include "case/errors.hpp"
#include "case/mesh.hpp"
#include "case/scene.hpp"

namespace suffuse {

/// Every way in which the scene's names and values do not fit the mesh: soils without a region,
/// regions without a soil that are not free water, boundaries, walls and wells that do not exist,
/// two conditions on one face, heads that the explicit scheme cannot follow, probes and sections
/// outside the mesh, and an initial porosity that leaves (0, 1 - n_C] somewhere in its region.
/// Empty when all is well. \param inner  names of curves and points inside the mesh that are not
/// cut
template <int Dim>
std::vector<InputProblem> scene_problems(const SceneDocument& document, const Mesh<Dim>& mesh,
                                         const std::vector<std::string>& inner = {});

}  // namespace suffuse
