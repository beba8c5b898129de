#pragma once

/// Common settings of double-point tests: those of the paper, and the place of the specimen.

#include <algorithm>

#include "model_run.hpp"

namespace suffuse::model {

/// The settings of the paper: the same number of points in every element, at random; fines go to
/// the points of their own element, and nothing erodes in an element without points.
inline void use_paper_mode(Scene& scene, int seed = 1) {
  scene.points.seeding = Seeding::random;
  scene.points.seed = seed;
  scene.points.equal_volume = false;
  for (Soil& soil : scene.soils) {
    soil.erosion.mass_transfer = MassTransfer::element;
    soil.erosion.empty_elements = EmptyElements::dry;
  }
}

inline int region_index(const Mesh<2>& mesh, const std::string& name) {
  const auto& names = mesh.region_names;
  return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
}

/// every, 2 every, ... up to `end`.
inline std::vector<double> times_up_to(double end, double every) {
  std::vector<double> times;
  for (int k = 1; k * every <= end * (1.0 + 1e-12); ++k) times.push_back(k * every);
  return times;
}

}  // namespace suffuse::model
