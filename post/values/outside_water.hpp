#pragma once

/// The water that stands outside a model: over each boundary with a head, up to its level.

#include <optional>
#include <vector>

#include "mesh/mesh.hpp"
#include "scene/scene.hpp"

namespace suffuse {

/// Whether the scene gives a head outside this boundary. The column `level` is 0 where it does not.
bool has_level(const Scene& scene, const std::string& boundary);

/// The water at one boundary.
struct OutsideWater {
  std::string boundary;
  double head = 0.0;                           ///< head of its level, m
  std::vector<std::array<Vector<2>, 4>> body;  ///< quadrilaterals between boundary and level
  std::array<Vector<2>, 2> level;              ///< the ends of its surface
};

/// The water at `time`, s, at every boundary whose head is above a part of it, under gravity; wells
/// are within the model and have none. Water reaches from sloping and horizontal edges up to the
/// level; beside upright edges, where a model is cut off, none is drawn. A level is at least
/// `breadth` m wide.
std::vector<OutsideWater> outside_water(const Mesh<2>& mesh, const Scene& scene, double time,
                                        double breadth);

}  // namespace suffuse
