#pragma once

/// The water that stands outside a model: over each boundary with a head, up to its level.

#include <optional>
#include <vector>

#include "mesh/mesh.hpp"
#include "scene/scene.hpp"

namespace suffuse {

/// The water at one boundary.
struct OutsideWater {
  std::string boundary;
  double head = 0.0;                           ///< head of its level, m
  std::vector<std::array<Vector<2>, 4>> body;  ///< quadrilaterals between boundary and level
  std::array<Vector<2>, 2> level;              ///< the ends of its surface
};

/// At `time`, s, for every boundary under gravity whose head is above some of it; wells are within
/// the model and have none. Over edges that rise or lie the water reaches up to the level; beside
/// upright ones it is `breadth` m wide.
std::vector<OutsideWater> outside_water(const Mesh<2>& mesh, const Scene& scene, double time,
                                        double breadth);

}  // namespace suffuse
