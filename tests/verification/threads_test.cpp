/// Results do not depend on the number of threads, bit by bit.

#include <gtest/gtest.h>

#include "box_mesh.hpp"
#include "model_run.hpp"

namespace suffuse {
namespace threads_test {

/// A column with more nodes, faces and elements than the loops need to be parallel.
Scene large_scene() {
  Scene scene = model::paper_scene();
  scene.soils[0].erosion = {erosion_law("logarithmic"), 1e-2, 0.0, false};
  scene.boundaries = {model::pressure_on("top", 6000.0), model::pressure_on("bottom", 0.0)};
  return scene;
}

Snapshot snapshot_of(const Scene& scene, const std::vector<double>& times, int threads) {
  SolverOptions options;
  options.threads = threads;
  model::ModelRun run(model::make_case(model::column_mesh(100, 100, 1.0, 1.0), scene), options);
  run.run(times);
  return run.model().snapshot(run.model().flow_state());
}

void expect_same_bits(const Snapshot& one, const Snapshot& two) {
  for (const auto& [a, b] :
       {std::pair{&one.cell, &two.cell}, std::pair{&one.node, &two.node},
        std::pair{&one.solid, &two.solid}, std::pair{&one.element_vertex, &two.element_vertex}}) {
    for (std::size_t k = 0; k < a->size(); ++k) EXPECT_EQ((*a)[k].values, (*b)[k].values);
  }
  EXPECT_GT(one.cell[2].values[0], 0.0) << "there are grains in the liquid";
}

TEST(Threads, OneAndTwoGiveTheSameBits) {
  Scene scene = large_scene();
  scene.time.mass_scaling = 1e4;
  scene.time.end = 1.0;
  expect_same_bits(snapshot_of(scene, {0.1, 0.25}, 1), snapshot_of(scene, {0.1, 0.25}, 2));
}

TEST(Threads, ImplicitFlowToo) {
  // Flow and erosion depend on each other: every step is solved, and times within steps are
  // evaluated.
  Scene scene = large_scene();
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.time.step = 0.5;
  scene.time.end = 2.0;
  scene.soils[0].erosion = {erosion_law("flux"), 2.0, 0.0, false};
  scene.soils[0].conductivity_law = conductivity_law("kozeny-carman");
  expect_same_bits(snapshot_of(scene, {0.3, 0.8, 1.2}, 1), snapshot_of(scene, {0.3, 0.8, 1.2}, 2));
}

/// A box of enough tetrahedra for shared loops; water flows through it from above.
Case<3> box_case(Formulation formulation) {
  Scene scene = large_scene();
  scene.formulation = formulation;
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.time.step = 0.5;
  scene.time.end = 1.0;
  scene.points.solid_per_element = 1;
  scene.points.liquid_per_element = 2;
  scene.soils[0].erosion = {erosion_law("flux"), 2.0, 0.0, false};
  scene.soils[0].conductivity_law = conductivity_law("kozeny-carman");
  Case<3> c = model::make_case(
      model::box_mesh({10, 10, 10}, Vector<3>::Ones(), model::disturbed(0.01)), scene);
  if (formulation == Formulation::double_point) {
    c.liquid_points = seed_liquid_points(c.mesh, scene);
  }
  return c;
}

Snapshot snapshot_of(const Case<3>& c, int threads) {
  SolverOptions options;
  options.threads = threads;
  const auto model = make_model(c, make_plan(c, options));
  while (model->time() < c.document.scene.time.end) model->advance(c.document.scene.time.end);
  return model->snapshot(model->flow_state());
}

class InSpace : public testing::TestWithParam<Formulation> {};

TEST_P(InSpace, OneAndTwoGiveTheSameBits) {
  const Case<3> c = box_case(GetParam());
  const Snapshot one = snapshot_of(c, 1);
  const Snapshot two = snapshot_of(c, 2);
  expect_same_bits(one, two);
  EXPECT_EQ(one.liquid_positions, two.liquid_positions);
  ASSERT_EQ(one.liquid.size(), two.liquid.size());
  for (std::size_t k = 0; k < one.liquid.size(); ++k) {
    EXPECT_EQ(one.liquid[k].values, two.liquid[k].values);
  }
}

INSTANTIATE_TEST_SUITE_P(Threads, InSpace,
                         testing::Values(Formulation::single_point, Formulation::double_point),
                         [](const auto& tested) {
                           return tested.param == Formulation::single_point ? "SinglePoint"
                                                                            : "DoublePoint";
                         });

}  // namespace threads_test
}  // namespace suffuse
