/// Results do not depend on the number of threads, bit by bit.

#include <gtest/gtest.h>

#include "model_run.hpp"

namespace suffuse {
namespace {

TEST(Threads, OneAndTwoGiveTheSameBits) {
  const auto with_threads = [](int threads) {
    Scene scene = model::paper_scene();
    scene.soils[0].erosion = {ErosionLaw::logarithmic, 1e-2, 0.0, false};
    scene.boundaries = {model::pressure_on("top", 6000.0), model::pressure_on("bottom", 0.0)};
    scene.time.mass_scaling = 1e4;
    scene.time.end = 1.0;
    // More nodes, faces and elements than the loops need to go parallel.
    SolverOptions options;
    options.threads = threads;
    model::ModelRun run(model::make_case(model::column_mesh(100, 100, 1.0, 1.0), scene), options);
    run.run({0.1, 0.25});
    return run.model().snapshot(run.model().state(), run.model().moment(), 0);
  };
  const Snapshot one = with_threads(1);
  const Snapshot two = with_threads(2);
  for (const auto& [a, b] : {std::pair{&one.cell, &two.cell}, std::pair{&one.node, &two.node},
                             std::pair{&one.element_vertex, &two.element_vertex}}) {
    for (std::size_t k = 0; k < a->size(); ++k) EXPECT_EQ((*a)[k].values, (*b)[k].values);
  }
  EXPECT_GT(one.cell[2].values[0], 0.0) << "there are grains in the liquid";
}

}  // namespace
}  // namespace suffuse
