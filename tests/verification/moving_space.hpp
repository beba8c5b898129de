#pragma once

/// Slabs of tetrahedra whose soil moves, in whole runs.

#include <algorithm>
#include <cmath>
#include <limits>

#include "box_mesh.hpp"
#include "moving_soil.hpp"

namespace suffuse::model {

/// A case of tetrahedra, its plan and the model that runs it.
class SpaceRun {
 public:
  SpaceRun(Mesh<3> mesh, Scene scene, int threads = 1)
      : case_(make(std::move(mesh), std::move(scene))),
        plan_(make_plan(case_, {.threads = threads})),
        model_(case_, plan_) {}

  void run_to(double time) {
    while (model_.time() < time) {
      model_.advance(time);
      const LedgerRow row = model_.ledger();
      worst_residual_ =
          std::max({worst_residual_, std::abs(row.residual_water), std::abs(row.residual_grains)});
    }
  }
  [[nodiscard]] SinglePoint<3>& model() { return model_; }
  [[nodiscard]] HistoryRow history() const { return model_.history_row(model_.flow_state()); }
  [[nodiscard]] Snapshot snapshot() const { return model_.snapshot(model_.flow_state()); }
  [[nodiscard]] double worst_residual() const { return worst_residual_; }

 private:
  static Case<3> make(Mesh<3> mesh, Scene scene) {
    Case<3> c;
    c.mesh = std::move(mesh);
    c.document.path = "model.toml";
    c.document.scene = std::move(scene);
    complete_for_mesh(c.document, 3);
    c.solid_points = seed_solid_points(c.mesh, c.document.scene);
    return c;
  }

  Case<3> case_;
  Plan plan_;
  SinglePoint<3> model_;
  double worst_residual_ = 0.0;
};

/// The sides are smooth, so that the soil moves as in a plane.
inline Scene slab_scene() {
  Scene scene = model::paper_scene();
  scene.gravity = {0.0, 0.0, -9.81};
  scene.liquid.bulk_modulus = std::numeric_limits<double>::infinity();
  scene.time.scheme = FlowScheme::implicit_mixed;
  for (const char* side : {"left", "right", "front", "back"}) {
    scene.boundaries.push_back(fixed_on(side, Fixing::normal));
  }
  scene.boundaries.push_back(fixed_on("bottom", Fixing::both));
  return scene;
}

/// A bank of 1 m with a slope of 45 degrees, along diagonals of the cells, that loses its strength
/// with its fines.
inline SpaceRun slab_of_bank(int threads = 1, int in_metre = 4) {
  Scene scene = slab_scene();
  scene.water_level = 1.25;
  scene.time.end = 12.0;
  scene.time.failure = AtFailure::follow;
  scene.boundaries.push_back(clean_pressure_on("top", 0.0));
  Soil& soil = scene.soils[0];
  soil.conductivity = 1e-2;
  soil.skeleton = elastic_soil(2e6, 0.3);
  soil.skeleton.law = skeleton_law("mohr-coulomb");
  soil.skeleton.friction = FinesFunction({{1.0, 33.0}, {0.0, 25.0}});
  soil.skeleton.cohesion = FinesFunction({{1.0, 1.5e3}, {0.0, 0.0}});
  soil.erosion.law = erosion_law("constant");
  soil.erosion.rate = 0.01;
  const auto is_soil = [](const Vector<3>& x) {
    return x[2] < 0.25 || (x[2] < 1.0 && x[2] < x[0] - 2.0);
  };
  return {under_water(box_mesh({4 * in_metre, 1, 5 * in_metre / 4}, {4.0, 1.0 / in_metre, 1.25}),
                      is_soil),
          scene, threads};
}

}  // namespace suffuse::model
