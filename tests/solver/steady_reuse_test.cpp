/// Reuse of a steady flow alone: changes that end it, and changes that do not.

#include "flow/steady_reuse.hpp"

#include <gtest/gtest.h>

#include "results/state_archive.hpp"
#include "solver/flow_model.hpp"

namespace suffuse {
namespace steady_reuse_test {

using model::FlowModel;

struct SteadyReuseTest : testing::Test {
  FlowModel m{model::column_mesh(3, 3)};
  SteadyReuseSettings settings{true, 1e-3, false, false};
  FlowCoefficients<2> changed = m.forcing.coefficients;

  /// Whether a flow that was kept for the model's coefficients is still kept for the changed ones.
  [[nodiscard]] bool goes_on() const {
    SteadyReuse<2> reuse(m.grid, settings);
    reuse.start(m.forcing.coefficients);
    reuse.check(changed);
    return reuse.active();
  }
};

TEST_F(SteadyReuseTest, StartsAndStops) {
  SteadyReuse<2> reuse(m.grid, settings);
  EXPECT_FALSE(reuse.active());
  reuse.check(changed);
  EXPECT_FALSE(reuse.active());
  reuse.start(changed);
  EXPECT_TRUE(reuse.active());
  reuse.stop();
  EXPECT_FALSE(reuse.active());
}

TEST_F(SteadyReuseTest, GoesOnWhileNothingChangesAndEndsWithAConductivity) {
  EXPECT_TRUE(goes_on());
  changed.drag[7] *= 1.0 + 1e-13;
  EXPECT_TRUE(goes_on());
  changed.drag[7] *= 1.0 + 1e-11;
  EXPECT_FALSE(goes_on());
}

TEST_F(SteadyReuseTest, WhatTheFlowDoesNotFeelDoesNotEndIt) {
  // Resistance is drag over porosity; water and its fines have no resistance.
  changed.drag[7] *= 1.25;
  changed.porosity[7] *= 1.25;
  changed.water_volume[7] *= 0.5;
  changed.mixture_density[7] *= 1.5;
  EXPECT_TRUE(goes_on());
}

TEST_F(SteadyReuseTest, DensitiesEndItUnderGravity) {
  changed.mixture_density[7] *= 1.0 + 1e-11;
  EXPECT_TRUE(goes_on());
  settings.has_gravity = true;
  EXPECT_FALSE(goes_on());
}

TEST_F(SteadyReuseTest, PorosityEndsItWhereAVelocityIsPrescribed) {
  changed.drag[7] *= 1.25;
  changed.porosity[7] *= 1.25;
  settings.prescribes_velocity = true;
  EXPECT_FALSE(goes_on());
}

TEST_F(SteadyReuseTest, QuadraticDragEndsIt) {
  m.forcing.coefficients.quadratic_drag.assign(m.mesh.elements.size(), 1e5);
  changed = m.forcing.coefficients;
  EXPECT_TRUE(goes_on());
  changed.quadratic_drag[7] *= 1.0 + 1e-11;
  EXPECT_FALSE(goes_on());
}

TEST_F(SteadyReuseTest, SteadyIsAFiftiethOfTheTolerance) {
  const SteadyReuse<2> reuse(m.grid, settings);
  const std::vector<double> a{1.0, 2.0, 3.0};
  EXPECT_TRUE(reuse.is_close(a, {1.0, 2.0 - 1.9e-5 * 10.0, 3.0}, 10.0));
  EXPECT_FALSE(reuse.is_close(a, {1.0, 2.0 - 2.1e-5 * 10.0, 3.0}, 10.0));
}

TEST_F(SteadyReuseTest, SourcesOfAllElementsTogetherAskForAnUpdate) {
  const FlowModel hundred(model::column_mesh(10, 5));
  const SteadyReuse<2> reuse(hundred.grid, settings);
  const std::vector<double> before(100, 0.0);
  EXPECT_FALSE(reuse.needs_update(before, std::vector<double>(100, 0.9e-7), 1.0));
  EXPECT_TRUE(reuse.needs_update(before, std::vector<double>(100, 1.1e-7), 1.0));
  EXPECT_TRUE(reuse.needs_update(before, std::vector<double>(100, -1.1e-7), 1.0));
}

TEST_F(SteadyReuseTest, BoundaryValuesRestWhereTheirLineIsLevel) {
  Scene scene = model::paper_scene();
  scene.boundaries = {model::pressure_on("top", 6e3), model::pressure_on("bottom", 0.0)};
  const Case<2> constant = model::make_case(m.mesh, scene);
  const BoundaryValues<2> level(constant, m.grid);
  EXPECT_TRUE(boundary_values_rest(m.grid, level, level.at(5.0), 5.0, 120.0));

  scene.boundaries[0].pressure = TimeFunction({{0.0, 0.0}, {20.0, 6e3}, {40.0, 6e3}, {50.0, 0.0}});
  const Case<2> varying = model::make_case(m.mesh, scene);
  const BoundaryValues<2> values(varying, m.grid);
  for (const auto& [time, rests] : {std::pair{5.0, false},
                                    {20.0, true},
                                    {30.0, true},
                                    {40.0, false},
                                    {45.0, false},
                                    {50.0, true},
                                    {110.0, true}}) {
    EXPECT_EQ(boundary_values_rest(m.grid, values, values.at(time), time, 120.0), rests) << time;
  }
}

TEST_F(SteadyReuseTest, GoesOnAsArchived) {
  SteadyReuse<2> reuse(m.grid, settings);
  reuse.start(m.forcing.coefficients);
  StateArchive stored;
  reuse.archive(stored);
  StateArchive restored(stored.finish());
  SteadyReuse<2> other(m.grid, settings);
  other.archive(restored);
  restored.finish();
  EXPECT_TRUE(other.active());
  other.check(m.forcing.coefficients);
  EXPECT_TRUE(other.active());
  changed.drag[0] *= 2.0;
  other.check(changed);
  EXPECT_FALSE(other.active());
}

}  // namespace steady_reuse_test
}  // namespace suffuse
