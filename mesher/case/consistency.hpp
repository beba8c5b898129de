#pragma once

/// Checks that a scene fits a mesh.

#include <vector>

#include "case/errors.hpp"
#include "case/mesh.hpp"
#include "case/scene.hpp"

namespace suffuse {

/// Every way in which the scene's names and values do not fit the mesh: soils without a region,
/// regions without a soil that are not free water, boundaries that do not exist, two conditions on
/// one face, and an initial porosity that leaves (0, 1 - n_C] somewhere in its region. Empty when
/// all is well.
template <int Dim>
std::vector<InputProblem> scene_problems(const SceneDocument& document, const Mesh<Dim>& mesh);

}  // namespace suffuse
