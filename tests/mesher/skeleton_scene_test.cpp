#include <gtest/gtest.h>

#include "physics/skeleton/skeleton_law.hpp"
#include "scene/scene.hpp"

namespace suffuse {
namespace skeleton_scene_test {

constexpr const char* text = R"(formulation = "single-point"
gravity = [0, -9.81]
geometry = { shape = "column", width = 1, height = 2 }
mesh.size = 0.25
liquid = { density = 1000, bulk_modulus = 2e9, viscosity = 1e-3 }
time.end = 100
output.every = 10
initial = { water_level = 2, stress = 0.5 }

[soil.specimen]
porosity = 0.3
skeleton_fraction = 0.6
grain_density = 2700
conductivity = 1e-5

[soil.specimen.skeleton]
law = "mohr-coulomb"
young = 2e7
poisson = 0.25
friction = [[1, 34], [0, 28]]
cohesion = [[0, 500], [1, 1e3]]
dilation = 4

[soil.other]
like = "specimen"
skeleton.law = "elastic"

[[boundary]]
on = "bottom"
fix = "both"

[[boundary]]
on = "left"
fix = "normal"

[[boundary]]
on = "top"
pressure = 0
traction = [[0, 0, 0], [10, 0, -1e4]]
)";

TEST(SkeletonScene, reads_laws_and_what_holds_or_loads_the_soil) {
  const Scene scene = parse_scene(text, "scene.toml").scene;
  const SkeletonModel& model = scene.soils[0].skeleton;
  EXPECT_EQ(model.law, skeleton_law("mohr-coulomb"));
  const SkeletonParameters half = model.at(0.5);
  EXPECT_EQ(half.young, 2e7);
  EXPECT_EQ(half.poisson, 0.25);
  EXPECT_NEAR(half.friction, 31.0 * 3.14159265358979 / 180.0, 1e-14);
  EXPECT_EQ(half.cohesion, 750.0);
  EXPECT_NEAR(half.dilation, 4.0 * 3.14159265358979 / 180.0, 1e-14);
  EXPECT_EQ(scene.soils[1].skeleton.law, skeleton_law("elastic"));
  EXPECT_EQ(scene.soils[1].skeleton.young, 2e7);
  EXPECT_TRUE(scene.moves());

  EXPECT_EQ(scene.boundaries[0].fix, Fixing::both);
  EXPECT_EQ(scene.boundaries[1].fix, Fixing::normal);
  EXPECT_EQ(scene.boundaries[2].fix, Fixing::none);
  EXPECT_FALSE(scene.boundaries[0].traction.has_value());
  ASSERT_TRUE(scene.boundaries[2].traction.has_value());
  EXPECT_EQ(scene.boundaries[2].traction->value(5.0), (VectorFunction::Components{0, -5e3, 0}));
  EXPECT_EQ(scene.boundaries[2].traction->value(50.0), (VectorFunction::Components{0, -1e4, 0}));
  EXPECT_EQ(scene.boundaries[2].traction->breakpoints(), (std::vector{0.0, 10.0}));
  EXPECT_EQ(scene.earth_pressure, 0.5);
}

TEST(SkeletonScene, is_rigid_and_in_equilibrium_with_gravity_by_default) {
  const Scene scene =
      parse_scene(text, "scene.toml",
                  {"soil.specimen.skeleton={law=\"rigid\"}", "soil.other={like=\"specimen\"}",
                   "boundary=[]", "initial={water_level=2}"})
          .scene;
  EXPECT_FALSE(scene.moves());
  EXPECT_EQ(scene.soils[0].skeleton.law, nullptr);
  EXPECT_FALSE(scene.earth_pressure.has_value());
  EXPECT_FALSE(
      parse_scene(text, "scene.toml", {"initial.stress=gravity"}).scene.earth_pressure.has_value());
}

TEST(SkeletonScene, a_constant_traction_may_be_a_plain_vector) {
  const Scene scene = parse_scene(text, "scene.toml", {"boundary[2].traction=[1, 2, 3]"}).scene;
  EXPECT_EQ(scene.boundaries[2].traction->value(7.0), (VectorFunction::Components{1, 2, 3}));
}

}  // namespace skeleton_scene_test
}  // namespace suffuse
