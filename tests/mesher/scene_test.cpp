#include "scene/scene.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <set>
#include <sstream>

#include "common/closest_name.hpp"
#include "common/errors.hpp"
#include "scene/scene_schema.hpp"
#include "test_paths.hpp"

namespace suffuse {
namespace scene_test {

namespace fs = std::filesystem;

using Knots = std::vector<std::pair<double, double>>;

const fs::path scenes = fs::path(test::data_folder()) / "scenes";

std::string read_text(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file) << path;
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The problems of a scene, one per line; empty when it is right.
std::string problems_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    parse_scene(text, "scene.toml", overrides);
  } catch (const InputError& error) {
    return error.what() + std::string("\n");
  }
  return {};
}

/// Lines `#set KEY=VALUE` of a scene, as `--set` arguments.
std::vector<std::string> overrides_in(const std::string& text) {
  const std::string mark = "#set ";
  std::vector<std::string> overrides;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(mark)) overrides.push_back(line.substr(mark.size()));
  }
  return overrides;
}

std::vector<std::string> wrong_scenes() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(scenes / "wrong")) {
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  }
  std::ranges::sort(names);
  return names;
}

class WrongScene : public testing::TestWithParam<std::string> {};

TEST_P(WrongScene, is_refused_with_these_messages) {
  const std::string text = read_text(scenes / "wrong" / (GetParam() + ".toml"));
  const std::string expected = read_text(scenes / "wrong" / (GetParam() + ".expected"));
  ASSERT_FALSE(expected.empty());
  EXPECT_EQ(problems_of(text, overrides_in(text)), expected);
}

INSTANTIATE_TEST_SUITE_P(Scenes, WrongScene, testing::ValuesIn(wrong_scenes()),
                         [](const auto& scene) {
                           std::string name = scene.param;
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

/// The shortest valid scene.
const std::string least = R"(formulation = "single-point"
geometry = { shape = "column", width = 1, height = 2 }
mesh.size = 0.25
liquid = { density = 1000, bulk_modulus = 2e7, viscosity = 1e-3 }
time = { end = 120, scheme = "explicit" }
output.every = 1
[soil.specimen]
porosity = 0.3
skeleton_fraction = 0.6
grain_density = 2700
conductivity = 2e-2
)";

Scene scene_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return parse_scene(text, "folder/column.toml", overrides).scene;
}

TEST(Scene, reads_every_value_of_the_papers_scene) {
  const SceneDocument document = read_scene((scenes / "paper.toml").string());
  const Scene& scene = document.scene;
  EXPECT_EQ(document.text, read_text(scenes / "paper.toml"));
  EXPECT_EQ(scene.name, "constant-head-sp");
  EXPECT_EQ(scene.formulation, Formulation::single_point);
  EXPECT_EQ(scene.geometry.shape, "column");
  EXPECT_EQ(scene.geometry.file, "");
  EXPECT_EQ(scene.geometry.width, 1.0);
  EXPECT_EQ(scene.geometry.height, 1.5);
  EXPECT_EQ(scene.mesh.size, 0.25);
  EXPECT_EQ(scene.mesh.structure, MeshStructure::free);
  EXPECT_EQ(scene.points.solid_per_element, 6);
  EXPECT_EQ(scene.points.jitter, 0.125);
  EXPECT_EQ(scene.points.seed, 7);
  EXPECT_EQ(scene.liquid.density, 1000.0);
  EXPECT_EQ(scene.liquid.bulk_modulus, 2e7);
  EXPECT_EQ(scene.liquid.viscosity, 1e-3);
  EXPECT_EQ(scene.gravity, (std::array{0.0, -9.81, 0.0}));
  EXPECT_EQ(scene.initial_flow, InitialFlow::steady);
  EXPECT_TRUE(scene.flow.porosity_gradient_term);
  EXPECT_EQ(scene.time.end, 120.0);
  EXPECT_EQ(scene.time.scheme, FlowScheme::explicit_nodal);
  EXPECT_EQ(scene.time.step, 0.0851);
  EXPECT_EQ(scene.time.mass_scaling, 1e4);
  EXPECT_EQ(scene.time.drag, DragIntegration::implicit_drag);
  EXPECT_EQ(scene.output.every, 1.0);
  EXPECT_EQ(scene.output.snapshot_every, 5.0);

  ASSERT_EQ(scene.soils.size(), 1U);
  const Soil& soil = scene.soils[0];
  EXPECT_EQ(soil.region, "specimen");
  EXPECT_EQ(soil.porosity, 0.3);
  EXPECT_EQ(soil.porosity_gradient, (std::array{0.0, 0.05, 0.0}));
  EXPECT_EQ(soil.porosity_origin, (std::array{0.5, 1.0, 0.0}));
  EXPECT_EQ(soil.skeleton_fraction, 0.6);
  EXPECT_EQ(soil.grain_density, 2700.0);
  EXPECT_EQ(soil.conductivity, 2e-2);
  EXPECT_EQ(soil.erosion.law, erosion_law("logarithmic"));
  EXPECT_EQ(soil.erosion.rate, 1e-3);
  EXPECT_EQ(soil.erosion.start, 2.0);
  EXPECT_TRUE(soil.erosion.momentum_transfer);

  ASSERT_EQ(scene.boundaries.size(), 3U);
  EXPECT_EQ(scene.boundaries[0].on, "top");
  EXPECT_EQ(scene.boundaries[0].pressure, 6e3);
  EXPECT_EQ(scene.boundaries[0].concentration, 0.0);
  EXPECT_EQ(scene.boundaries[0].velocity, std::nullopt);
  EXPECT_EQ(scene.boundaries[1].velocity, -0.04);
  EXPECT_EQ(scene.boundaries[1].pressure, std::nullopt);
  EXPECT_EQ(scene.boundaries[2].darcy_flux, 0.012);
}

TEST(Scene, fills_in_defaults) {
  const Scene scene = scene_of(least);
  EXPECT_EQ(scene.time.scheme, FlowScheme::explicit_nodal);
  EXPECT_EQ(scene.name, "column");  // of the file folder/column.toml
  EXPECT_EQ(scene.mesh.structure, MeshStructure::regular);
  EXPECT_EQ(scene.points.solid_per_element, 3);
  EXPECT_EQ(scene.points.jitter, 0.0);
  EXPECT_EQ(scene.initial_flow, InitialFlow::rest);
  EXPECT_TRUE(scene.flow.porosity_gradient_term);
  EXPECT_EQ(scene.time.step, std::nullopt);
  EXPECT_EQ(scene.time.mass_scaling, 1.0);
  EXPECT_EQ(scene.time.drag, DragIntegration::explicit_drag);
  EXPECT_EQ(scene.output.snapshot_every, scene.output.every);
  EXPECT_EQ(scene.gravity, (std::array{0.0, 0.0, 0.0}));
  EXPECT_EQ(scene.soils[0].conductivity_law, conductivity_law("constant"));
  EXPECT_EQ(scene.soils[0].erosion.law, erosion_law("none"));
  EXPECT_TRUE(scene.boundaries.empty());
}

/// The shortest scene without a scheme.
std::string without_scheme() {
  const std::string scheme = ", scheme = \"explicit\"";
  std::string text = least;
  return text.erase(text.find(scheme), scheme.size());
}

TEST(Scene, is_implicit_unless_it_says_otherwise) {
  const Scene scene = scene_of(without_scheme());
  EXPECT_EQ(scene.time.scheme, FlowScheme::implicit_mixed);
  EXPECT_EQ(scene.time.step, std::nullopt);
  EXPECT_EQ(scene.time.stepping, TimeStepping::second_order);
  EXPECT_EQ(scene.time.inertia, std::nullopt);
  EXPECT_EQ(scene.time.tolerance, 1e-3);
}

TEST(Scene, reads_every_key_of_the_implicit_scheme) {
  const Scene scene = scene_of(without_scheme(), {"time.scheme=implicit", "time.stepping=monotone",
                                                  "time.inertia=false", "time.tolerance=0.1"});
  EXPECT_EQ(scene.time.scheme, FlowScheme::implicit_mixed);
  EXPECT_EQ(scene.time.stepping, TimeStepping::monotone);
  EXPECT_EQ(scene.time.inertia, std::optional(false));
  EXPECT_EQ(scene.time.tolerance, 0.1);
  EXPECT_EQ(scene_of(without_scheme(), {"time.inertia=true"}).time.inertia, std::optional(true));
  EXPECT_EQ(scene_of(without_scheme(), {"time.step=0.5"}).time.step, 0.5);
}

TEST(Scene, takes_incompressible_water_for_the_implicit_scheme_only) {
  const std::string incompressible = "liquid.bulk_modulus=inf";
  EXPECT_EQ(scene_of(without_scheme(), {incompressible}).liquid.bulk_modulus,
            std::numeric_limits<double>::infinity());
  EXPECT_NE(problems_of(least, {incompressible}), "");
  EXPECT_NE(problems_of(without_scheme(), {"liquid.bulk_modulus=-inf"}), "");
  EXPECT_NE(problems_of(without_scheme(), {"liquid.bulk_modulus=nan"}), "");
  for (const std::string other : {"liquid.viscosity", "time.end", "soil.specimen.conductivity"}) {
    EXPECT_NE(problems_of(without_scheme(), {other + "=inf"}), "") << other;
  }
}

TEST(Scene, takes_laws_that_follow_the_flux_and_the_porosity) {
  const Scene scene =
      scene_of(least, {"soil.specimen.erosion.law=flux", "soil.specimen.erosion.rate=4",
                       "soil.specimen.conductivity_law=kozeny-carman"});
  EXPECT_EQ(scene.soils[0].erosion.law, erosion_law("flux"));
  EXPECT_EQ(scene.soils[0].erosion.rate, 4.0);
  EXPECT_EQ(scene.soils[0].conductivity_law, conductivity_law("kozeny-carman"));
}

TEST(Scene, takes_a_threshold_where_a_flow_drives) {
  const std::vector<std::string> flux{"soil.specimen.erosion.law=flux",
                                      "soil.specimen.erosion.rate=4"};
  EXPECT_EQ(scene_of(least, flux).soils[0].erosion.threshold, 0.0);
  std::vector<std::string> with_threshold = flux;
  with_threshold.emplace_back("soil.specimen.erosion.threshold=5e-3");
  const Scene scene = scene_of(least, with_threshold);
  EXPECT_EQ(scene.soils[0].erosion.threshold, 5e-3);
  EXPECT_EQ(scene.soils[0].erosion_model().threshold, 5e-3);
  // A soil with `like` may have another law.
  with_threshold.emplace_back("soil.base={like=\"specimen\", erosion={law=\"first-order\"}}");
  EXPECT_EQ(scene_of(least, with_threshold).soils[1].erosion.law, erosion_law("first-order"));
}

TEST(Scene, takes_boundary_values_in_time) {
  const Scene scene = scene_of(least + R"([[boundary]]
on = "top"
pressure = [[0, 0], [5, 6000], [5.001, 0.5]]
concentration = [[-1, 0], [1e1, 0.25]]
[[boundary]]
on = "bottom"
darcy_flux = [[3, -0.012]]
[[boundary]]
on = "left"
velocity = [[0, -1], [1, 1]]
concentration = 0.1
)");
  ASSERT_EQ(scene.boundaries.size(), 3U);
  EXPECT_EQ(scene.boundaries[0].pressure->knots, (Knots{{0.0, 0.0}, {5.0, 6e3}, {5.001, 0.5}}));
  EXPECT_EQ(scene.boundaries[0].concentration->knots, (Knots{{-1.0, 0.0}, {10.0, 0.25}}));
  EXPECT_EQ(scene.boundaries[1].darcy_flux->knots, (Knots{{3.0, -0.012}}));
  EXPECT_TRUE(scene.boundaries[1].darcy_flux->is_constant());
  // Liquid leaves through the left at first, and enters later: a concentration may be given.
  EXPECT_EQ(scene.boundaries[2].velocity->knots, (Knots{{0.0, -1.0}, {1.0, 1.0}}));
}

TEST(Override, takes_a_table) {
  const Scene scene =
      scene_of(least, {"boundary[0].on=top", "boundary[0].pressure=[[0,0],[5,6000]]"});
  EXPECT_EQ(scene.boundaries[0].pressure->knots, (Knots{{0.0, 0.0}, {5.0, 6e3}}));
}

TEST(TimeFunction, is_linear_between_knots_and_constant_beyond) {
  const TimeFunction f(Knots{{1.0, 2.0}, {3.0, 6.0}, {4.0, -1.0}});
  EXPECT_EQ(f.value(-5.0), 2.0);
  EXPECT_EQ(f.value(1.0), 2.0);
  EXPECT_EQ(f.value(1.5), 3.0);
  EXPECT_EQ(f.value(3.0), 6.0);
  EXPECT_EQ(f.value(3.5), 2.5);
  EXPECT_EQ(f.value(4.0), -1.0);
  EXPECT_EQ(f.value(1e9), -1.0);
  EXPECT_FALSE(f.is_constant());
  EXPECT_EQ(f.smallest(), -1.0);
  EXPECT_EQ(f.largest(), 6.0);
  EXPECT_EQ(f.breakpoints(), (std::vector{1.0, 3.0, 4.0}));
}

TEST(TimeFunction, is_constant_from_a_number_or_a_level_table) {
  const TimeFunction number = 7.5;
  EXPECT_TRUE(number.is_constant());
  EXPECT_EQ(number.value(-1.0), 7.5);
  EXPECT_EQ(number.value(1.0), 7.5);
  EXPECT_TRUE(TimeFunction(Knots{{1.0, 7.5}, {2.0, 7.5}}).is_constant());
}

TEST(TimeFunction, follows_a_jump) {
  const TimeFunction f(Knots{{0.0, 1.0}, {5.0, 1.0}, {std::nextafter(5.0, 6.0), 9.0}});
  EXPECT_EQ(f.value(5.0), 1.0);
  EXPECT_EQ(f.value(std::nextafter(5.0, 6.0)), 9.0);
}

TEST(Scene, reads_every_value_of_the_double_point_scene) {
  const Scene scene = read_scene((scenes / "double-point.toml").string(),
                                 {"geometry.layers.free_above=3", "geometry.layers.free_below=4",
                                  "geometry.layers.below=1", "points.liquid_per_element=40",
                                  "soil.specimen.drag=ergun", "flow.integration=material-point",
                                  "soil.specimen.erosion.mass_transfer=element",
                                  "soil.specimen.erosion.empty_elements=dry",
                                  "points.seeding=random", "points.equal_volume=false"})
                          .scene;
  EXPECT_EQ(scene.formulation, Formulation::double_point);
  EXPECT_EQ(scene.geometry.layers.inflow, 2);
  EXPECT_EQ(scene.geometry.layers.free_above, 3);
  EXPECT_EQ(scene.geometry.layers.above, 2);
  EXPECT_EQ(scene.geometry.layers.below, 1);
  EXPECT_EQ(scene.geometry.layers.free_below, 4);
  EXPECT_EQ(scene.geometry.layers.outflow, 2);
  EXPECT_EQ(scene.points.solid_per_element, 1);
  EXPECT_EQ(scene.points.liquid_per_element, 40);
  EXPECT_EQ(scene.points.seeding, Seeding::random);
  EXPECT_FALSE(scene.points.equal_volume);
  EXPECT_EQ(scene.flow.integration, PressureIntegration::material_point);

  const Soil& specimen = *scene.find_soil("specimen");
  EXPECT_EQ(specimen.drag, SoilDrag::ergun);
  EXPECT_EQ(specimen.erosion.law, erosion_law("constant"));
  EXPECT_EQ(specimen.erosion.mass_transfer, MassTransfer::element);
  EXPECT_EQ(specimen.erosion.empty_elements, EmptyElements::dry);
  const Soil& like_it = *scene.find_soil("buffer");
  EXPECT_EQ(like_it.porosity, specimen.porosity);
  EXPECT_EQ(like_it.drag, SoilDrag::ergun);
  EXPECT_EQ(like_it.erosion.law, erosion_law("none"));  // its rate is inherited but not used
  EXPECT_EQ(like_it.erosion.rate, specimen.erosion.rate);

  for (const std::string water : {"inflow", "outflow", "free_above", "free_below"}) {
    EXPECT_TRUE(scene.is_free_water(water));
  }
  EXPECT_FALSE(scene.is_free_water("specimen"));
  EXPECT_FALSE(scene.is_free_water("elsewhere"));
}

TEST(Scene, fills_in_defaults_of_double_point) {
  const Scene scene = scene_of(least, {"formulation=double-point"});
  EXPECT_EQ(scene.geometry.layers.inflow, 0);
  EXPECT_EQ(scene.points.liquid_per_element, 12);
  EXPECT_EQ(scene.points.seeding, Seeding::low_discrepancy);
  EXPECT_TRUE(scene.points.equal_volume);
  EXPECT_EQ(scene.flow.integration, PressureIntegration::mixed);
  EXPECT_EQ(scene.soils[0].drag, SoilDrag::darcy);
  EXPECT_EQ(scene.soils[0].erosion.mass_transfer, MassTransfer::nodal);
  EXPECT_EQ(scene.soils[0].erosion.empty_elements, EmptyElements::wet);
}

TEST(Scene, gives_gauss_points_their_unequal_volumes) {
  const std::vector<std::string> gauss{"formulation=double-point", "points.seeding=gauss"};
  EXPECT_FALSE(scene_of(least, gauss).points.equal_volume);
  for (const std::string count : {"1", "3", "6", "12"}) {
    std::vector<std::string> overrides = gauss;
    overrides.push_back("points.liquid_per_element=" + count);
    EXPECT_EQ(problems_of(least, overrides), "") << count;
  }
}

TEST(Scene, has_no_free_water_in_a_single_point_scene) {
  EXPECT_FALSE(scene_of(least).is_free_water("inflow"));
  EXPECT_TRUE(names_free_water("inflow"));
}

TEST(Scene, makes_regions_free) {
  const std::string moves =
      R"(soil.specimen.skeleton={law = "elastic", young = 1e7, poisson = 0.3})";
  const std::string implicit = "time.scheme=implicit";
  const Scene scene =
      scene_of(least, {implicit, moves, R"(soil.pit={like = "specimen", free = true})"});
  EXPECT_TRUE(scene.is_free_water("pit"));
  EXPECT_EQ(scene.find_soil("pit"), nullptr);
  const Scene filled =
      scene_of(least, {implicit, moves, R"(soil.pit={like = "specimen", free = false})"});
  EXPECT_FALSE(filled.is_free_water("pit"));
  EXPECT_NE(filled.find_soil("pit"), nullptr);
}

TEST(Scene, takes_ergun_for_either_formulation) {
  EXPECT_EQ(scene_of(least, {"soil.specimen.drag=ergun"}).soils[0].drag, SoilDrag::ergun);
}

TEST(Scene, does_not_need_a_size_for_a_file) {
  std::string text = least;
  text.replace(text.find("geometry"), text.find("liquid") - text.find("geometry"),
               "geometry.file = \"levee.geo\"\n");
  const Scene scene = scene_of(text);
  EXPECT_EQ(scene.geometry.file, "levee.geo");
  EXPECT_TRUE(std::isnan(scene.mesh.size));
  EXPECT_EQ(scene.mesh.structure, MeshStructure::crossed);
}

TEST(Scene, inherits_keys_that_are_not_given) {
  const Scene scene = scene_of(least + R"([soil.specimen.erosion]
law = "constant"
rate = 1e-3
start = 2
[soil.fine]
like = "buffer"
conductivity = 1e-4
[soil.buffer]
like = "specimen"
porosity = 0.35
erosion.law = "none"
)");
  ASSERT_EQ(scene.soils.size(), 3U);
  const Soil* buffer = scene.find_soil("buffer");
  ASSERT_NE(buffer, nullptr);
  EXPECT_EQ(buffer->porosity, 0.35);
  EXPECT_EQ(buffer->skeleton_fraction, 0.6);
  EXPECT_EQ(buffer->conductivity, 2e-2);
  EXPECT_EQ(buffer->erosion.law, erosion_law("none"));
  EXPECT_EQ(buffer->erosion.start, 2.0);
  const Soil* fine = scene.find_soil("fine");
  ASSERT_NE(fine, nullptr);
  EXPECT_EQ(fine->porosity, 0.35);
  EXPECT_EQ(fine->conductivity, 1e-4);
  EXPECT_EQ(fine->erosion.law, erosion_law("none"));
  EXPECT_EQ(scene.find_soil("specimen")->erosion.law, erosion_law("constant"));
  EXPECT_EQ(scene.find_soil("sand"), nullptr);
}

TEST(Gradation, stands_in_for_the_skeleton) {
  const std::string gradation = "soil.specimen.gradation=[[0.1, 0], [0.5, 15], [4, 15], [8, 100]]";
  const SceneDocument given = parse_scene(least, "a.toml", {gradation});
  ASSERT_EQ(given.scene.soils[0].gradation.points().size(), 4U);
  EXPECT_EQ(given.scene.soils[0].gradation.points()[1].size, 0.5);
  EXPECT_EQ(given.scene.soils[0].gradation.points()[1].finer, 15.0);
  EXPECT_EQ(given.scene.soils[0].skeleton_fraction, 0.6);

  std::string without = least;
  const std::string line = "skeleton_fraction = 0.6\n";
  without.erase(without.find(line), line.size());
  const SceneDocument derived = parse_scene(without, "a.toml", {gradation});
  EXPECT_DOUBLE_EQ(derived.scene.soils[0].skeleton_fraction, (1.0 - 0.3) * (1.0 - 0.15));
  EXPECT_FALSE(derived.where.contains("soil.specimen.skeleton_fraction"));
  EXPECT_TRUE(scene_of(least).soils[0].gradation.empty());
}

/// A soil with `like` and its own porosity has another skeleton.
TEST(Gradation, is_inherited) {
  std::string text = least;
  const std::string line = "skeleton_fraction = 0.6\n";
  text.replace(text.find(line), line.size(),
               "gradation = [[0.1, 0], [0.5, 15], [4, 15], [8, 100]]\n");
  const Scene scene = scene_of(text +
                               "[soil.loose]\nlike = \"specimen\"\nporosity = 0.4\n"
                               "[soil.own]\nlike = \"loose\"\nskeleton_fraction = 0.5\n");
  ASSERT_EQ(scene.soils.size(), 3U);
  EXPECT_DOUBLE_EQ(scene.soils[0].skeleton_fraction, 0.7 * 0.85);
  EXPECT_DOUBLE_EQ(scene.soils[1].skeleton_fraction, 0.6 * 0.85);
  EXPECT_EQ(scene.soils[2].skeleton_fraction, 0.5);
  EXPECT_EQ(scene.soils[2].gradation.points().size(), 4U);
}

TEST(Scene, keeps_soils_in_the_order_of_the_file) {
  const Scene scene = scene_of(least + "[soil.b]\nlike = \"specimen\"\n[soil.a]\nlike = \"b\"\n");
  ASSERT_EQ(scene.soils.size(), 3U);
  EXPECT_EQ(scene.soils[0].region, "specimen");
  EXPECT_EQ(scene.soils[1].region, "b");
  EXPECT_EQ(scene.soils[2].region, "a");
}

TEST(Scene, accepts_fractions_that_add_up_to_one) {
  for (int percent = 1; percent < 100; ++percent) {
    const std::string porosity = "soil.specimen.porosity=" + std::to_string(percent) + "e-2";
    const std::string skeleton =
        "soil.specimen.skeleton_fraction=" + std::to_string(100 - percent) + "e-2";
    EXPECT_EQ(problems_of(least, {porosity, skeleton}), "") << percent;
  }
}

TEST(Override, changes_and_adds_keys) {
  const Scene scene =
      scene_of(least, {"soil.specimen.erosion.rate=5e-3", "soil.specimen.erosion.law=first-order",
                       "time.end=10", "time.end = 20", "boundary[0].on=top",
                       "boundary[0].pressure=3000", "boundary[1]={on=\"bottom\", darcy_flux=-1e-3}",
                       "gravity=[0, -9.81]", "initial.water_level=2", "name='a b'",
                       "time.drag=implicit", "soil.\"two words\".like=specimen"});
  EXPECT_EQ(scene.soils[0].erosion.law, erosion_law("first-order"));
  EXPECT_EQ(scene.soils[0].erosion.rate, 5e-3);
  EXPECT_EQ(scene.time.end, 20.0);
  ASSERT_EQ(scene.boundaries.size(), 2U);
  EXPECT_EQ(scene.boundaries[0].pressure, 3e3);
  EXPECT_EQ(scene.boundaries[1].darcy_flux, -1e-3);
  EXPECT_EQ(scene.gravity[1], -9.81);
  EXPECT_EQ(scene.name, "a b");
  EXPECT_EQ(scene.time.drag, DragIntegration::implicit_drag);
  ASSERT_NE(scene.find_soil("two words"), nullptr);
  EXPECT_EQ(scene.find_soil("two words")->erosion.rate, 5e-3);
}

TEST(Override, of_a_table_replaces_it) {
  const std::string text = least + "[[boundary]]\non = \"top\"\npressure = 1\n";
  const Scene scene = scene_of(text, {"boundary[0]={on=\"top\", darcy_flux=0.012}"});
  EXPECT_EQ(scene.boundaries[0].pressure, std::nullopt);
  EXPECT_EQ(scene.boundaries[0].darcy_flux, 0.012);
}

TEST(Override, mends_a_wrong_value_of_the_file) {
  EXPECT_NE(problems_of(least + "porosity_origin = 1\n"), "");
  EXPECT_EQ(problems_of(least + "porosity_origin = 1\n", {"soil.specimen.porosity_origin=[0, 1]"}),
            "");
}

TEST(Override, turns_a_switch_off) {
  const Scene scene =
      scene_of(least, {"soil.specimen.erosion.law=none", "flow.porosity_gradient_term=false"});
  EXPECT_FALSE(scene.flow.porosity_gradient_term);
}

TEST(Override, fills_an_empty_list) {
  const Scene scene =
      scene_of("boundary = []\n" + least, {"boundary[0].on=top", "boundary[0].velocity=0"});
  ASSERT_EQ(scene.boundaries.size(), 1U);
  EXPECT_EQ(scene.boundaries[0].velocity, 0.0);
}

TEST(SceneDocument, locates_keys) {
  const std::string text = least + "[[boundary]]\non = \"top\"\npressure = 1\n";
  const SceneDocument document =
      parse_scene(text, "scene.toml", {"time.step=0.1", "soil.clay.like=specimen"});
  EXPECT_EQ(document.locate("mesh.size"), "scene.toml:3");
  EXPECT_EQ(document.locate("soil.specimen.porosity"), "scene.toml:8");
  EXPECT_EQ(document.locate("soil.specimen.erosion.law"), "scene.toml:7");  // the table's header
  EXPECT_EQ(document.locate("boundary[0].on"), "scene.toml:13");
  EXPECT_EQ(document.locate("boundary[0].velocity"), "scene.toml:12");
  EXPECT_EQ(document.locate("boundary[0]"), "scene.toml:12");
  EXPECT_EQ(document.locate("time.step"), "--set time.step=0.1");
  EXPECT_EQ(document.locate("soil.clay"), "--set soil.clay.like=specimen");
  EXPECT_EQ(document.locate("soil.clay.porosity"), "scene.toml:8");  // inherited
  EXPECT_EQ(document.locate("gravity"), "scene.toml");
  EXPECT_EQ(document.where.count("time.mass_scaling"), 0U);
}

TEST(SceneDocument, reads_the_same_from_its_own_text) {
  const SceneDocument first = parse_scene(least, "scene.toml", {"time.step=0.1"});
  const SceneDocument second = parse_scene(first.text, first.path, first.overrides);
  EXPECT_EQ(second.scene.time.step, 0.1);
  EXPECT_EQ(second.where, first.where);
}

TEST(SceneFile, that_cannot_be_read_is_a_file_error) {
  EXPECT_THROW(read_scene("no/such/scene.toml"), FileError);
  EXPECT_THROW(read_scene(scenes.string()), FileError);
}

TEST(SceneFile, that_is_not_text_is_refused) {
  EXPECT_NE(problems_of(std::string("\x89HDF\r\n\x1a\n\0\0", 10)).find("not TOML"),
            std::string::npos);
}

/// A scene with gravity and with all keys of seepage.
const std::string seepage = R"(
formulation = "single-point"
gravity = [0.0, -9.81]
geometry = {file = "dam.geo"}
liquid = {density = 1000, bulk_modulus = inf, viscosity = 1e-3}
time = {end = 100}
initial = {flow = "steady"}
[soil.body]
porosity = 0.3
skeleton_fraction = 0.6
grain_density = 2700
conductivity = [1e-5, 2e-6]
bedding = 15
retention = {model = "van-genuchten", alpha = 2.0, n = 1.6, residual_saturation = 0.1}
[soil.filter]
like = "body"
conductivity = 1e-3
retention = {model = "gardner", alpha = 5}
[soil.rock]
like = "body"
retention.model = "none"
[[boundary]]
on = "upstream"
head = [[0, 2], [86400, 5]]
dry = "suction"
[[boundary]]
on = "landside"
seepage_face = true
[[boundary]]
on = "crest"
rain = 1e-7
[[well]]
on = "drain"
seepage_face = true
[[well]]
on = "pump"
rate = [[0, 0], [60, -1e-5]]
[[well]]
on = "recharge"
head = 1.5
concentration = 0.01
[[wall]]
on = "pile"
[[wall]]
on = "curtain"
conductance = 1e-8
[output]
every = 10
probe = [{at = [1, 2]}]
[[output.section]]
from = [0, 0]
to = [0, 3]
)";

TEST(Seepage, reads_heads_faces_and_rain) {
  const Scene scene = scene_of(seepage);
  ASSERT_EQ(scene.boundaries.size(), 6U);
  const BoundaryCondition& upstream = scene.boundaries[0];
  EXPECT_EQ(upstream.key, "boundary[0]");
  EXPECT_EQ(upstream.head, TimeFunction(Knots{{0.0, 2.0}, {86400.0, 5.0}}));
  EXPECT_EQ(upstream.dry, DryPart::suction);
  EXPECT_FALSE(upstream.seepage_face);
  EXPECT_EQ(scene.boundaries[1].dry, DryPart::seepage);
  EXPECT_TRUE(scene.boundaries[1].seepage_face);
  EXPECT_EQ(scene.boundaries[2].rain, TimeFunction(1e-7));
  EXPECT_EQ(scene.boundaries[2].key, "boundary[2]");
}

TEST(Seepage, reads_wells_behind_the_boundaries_and_walls_apart) {
  const Scene scene = scene_of(seepage);
  EXPECT_EQ(scene.boundaries[3].key, "well[0]");
  EXPECT_EQ(scene.boundaries[3].on, "drain");
  EXPECT_TRUE(scene.boundaries[3].seepage_face);
  EXPECT_EQ(scene.boundaries[4].rate, TimeFunction(Knots{{0.0, 0.0}, {60.0, -1e-5}}));
  EXPECT_EQ(scene.boundaries[5].key, "well[2]");
  EXPECT_EQ(scene.boundaries[5].head, TimeFunction(1.5));
  EXPECT_EQ(scene.boundaries[5].concentration, TimeFunction(0.01));
  ASSERT_EQ(scene.walls.size(), 2U);
  EXPECT_EQ(scene.walls[0].on, "pile");
  EXPECT_EQ(scene.walls[0].conductance, 0.0);
  EXPECT_EQ(scene.walls[1].conductance, 1e-8);
}

TEST(Seepage, reads_what_soils_do_under_suction_and_along_bedding) {
  const Scene scene = scene_of(seepage);
  const Soil& body = *scene.find_soil("body");
  EXPECT_EQ(body.retention.law, retention_law("van-genuchten"));
  EXPECT_EQ(body.retention.parameters.alpha, 2.0);
  EXPECT_EQ(body.retention.parameters.n, 1.6);
  EXPECT_EQ(body.retention.residual_saturation, 0.1);
  EXPECT_EQ(body.conductivity, 1e-5);
  EXPECT_EQ(body.conductivity_across, 2e-6);
  EXPECT_NEAR(body.anisotropy(), 0.2, 1e-15);
  EXPECT_EQ(body.bedding, 15.0);
  const Soil& filter = *scene.find_soil("filter");
  EXPECT_EQ(filter.retention.law, retention_law("gardner"));
  EXPECT_EQ(filter.retention.parameters.alpha, 5.0);
  EXPECT_EQ(filter.retention.residual_saturation, 0.1);  // like body's
  EXPECT_EQ(filter.conductivity, 1e-3);
  EXPECT_EQ(filter.anisotropy(), 1.0);
  EXPECT_EQ(scene.find_soil("rock")->retention.law, nullptr);
  EXPECT_EQ(scene_of(least).soils[0].retention.law, nullptr);
  EXPECT_EQ(scene_of(least).soils[0].anisotropy(), 1.0);
}

TEST(Seepage, reads_probes_and_sections) {
  const Scene scene = scene_of(seepage);
  ASSERT_EQ(scene.output.probes.size(), 1U);
  EXPECT_EQ(scene.output.probes[0].at, (std::array{1.0, 2.0, 0.0}));
  ASSERT_EQ(scene.output.sections.size(), 1U);
  EXPECT_EQ(scene.output.sections[0].to, (std::array{0.0, 3.0, 0.0}));
}

TEST(WaterLevel, is_that_of_the_heads_at_the_start) {
  EXPECT_EQ(scene_of(seepage).water_level, 2.0);  // not that of the well
  EXPECT_EQ(scene_of(seepage, {"initial.water_level=3"}).water_level, 3.0);
  const std::string same = "boundary[1]={on=\"landside\", head=2.0000000005}";
  EXPECT_EQ(scene_of(seepage, {same, "initial.flow=rest"}).water_level, 2.0);
  const std::string other = "boundary[1]={on=\"landside\", head=2.00000001}";
  EXPECT_EQ(scene_of(seepage, {other}).water_level, std::nullopt);
  EXPECT_NE(problems_of(seepage, {other, "initial.flow=rest"}), "");
  EXPECT_EQ(scene_of(least).water_level, std::nullopt);
  EXPECT_EQ(scene_of(seepage, {"boundary=[]", "gravity=[0,0]", "initial.flow=rest"}).water_level,
            std::nullopt);
}

TEST(Override, changes_entries_of_the_new_lists) {
  const Scene scene =
      scene_of(seepage, {"well[1].rate=-2e-5", "wall[1].conductance=0", "output.probe[0].at=[3, 4]",
                         "output.probe[1].at=[5, 6]", "soil.body.retention.n=3"});
  EXPECT_EQ(scene.boundaries[4].rate, TimeFunction(-2e-5));
  EXPECT_EQ(scene.walls[1].conductance, 0.0);
  ASSERT_EQ(scene.output.probes.size(), 2U);
  EXPECT_EQ(scene.output.probes[1].at, (std::array{5.0, 6.0, 0.0}));
  EXPECT_EQ(scene.soils[0].retention.parameters.n, 3.0);
}

/// The problems of a scene whose head is in `flood.csv`, which has this text.
std::string problems_with_table(const std::string& table) {
  try {
    parse_scene(seepage, "folder/scene.toml", {"boundary[0]={on=\"upstream\", file=\"flood.csv\"}"},
                {{"flood.csv", table}});
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(TableFile, gives_the_head) {
  const std::vector<std::string> overrides{"boundary[0]={on=\"upstream\", file=\"flood.csv\"}"};
  const std::map<std::string, std::string> files{
      {"flood.csv", "\xEF\xBB\xBFt, head\r\n0,2.5\r\n 3600 ,\t-1e0\r\n\r\n7200,3\r\n"}};
  const SceneDocument document = parse_scene(seepage, "scene.toml", overrides, files);
  EXPECT_EQ(document.scene.boundaries[0].head,
            TimeFunction(Knots{{0.0, 2.5}, {3600.0, -1.0}, {7200.0, 3.0}}));
  EXPECT_EQ(document.scene.water_level, 2.5);
  EXPECT_EQ(document.files, files);
}

TEST(TableFile, is_read_beside_the_scene) {
  const fs::path folder =
      fs::temp_directory_path() / ("suffuse-table-" + std::to_string(::getpid()));
  fs::create_directories(folder / "tables");
  std::ofstream(folder / "scene.toml") << seepage;
  std::ofstream(folder / "tables/flood.csv") << "t,head\n0,4\n";
  const SceneDocument document =
      read_scene((folder / "scene.toml").string(),
                 {"boundary[0]={on=\"upstream\", file=\"tables/flood.csv\"}"});
  EXPECT_EQ(document.scene.boundaries[0].head, TimeFunction(Knots{{0.0, 4.0}}));
  EXPECT_EQ(document.files.at("tables/flood.csv"), "t,head\n0,4\n");
  fs::remove_all(folder);
}

TEST(TableFile, that_is_wrong_is_refused_at_its_line) {
  const std::string at = "folder/flood.csv:";
  EXPECT_EQ(problems_with_table(""), at + "1: got no row; expected the header line t,head and at "
                                          "least one row");
  EXPECT_EQ(problems_with_table("t,head\n"), at + "1: got no row; expected the header line t,head "
                                                  "and at least one row");
  EXPECT_EQ(problems_with_table("0,2\n1,3\n"),
            at + "1: got \"0,2\"; expected the header line t,head");
  EXPECT_EQ(problems_with_table("t,head\n0,2\n1;3\n"),
            at + "3: got \"1;3\"; expected two numbers t,head: a time in s and a head in m, with "
                 "commas between columns in the place of semicolons, and decimal points in "
                 "numbers");
  EXPECT_EQ(problems_with_table("t;head\n0;2,5\n"),
            at + "1: got \"t;head\"; expected the header line t,head, with commas between columns "
                 "in the place of semicolons, and decimal points in numbers");
  EXPECT_EQ(problems_with_table("t\thead\n0\t2\n"),
            at + "1: got \"t\thead\"; expected the header line t,head, with commas between columns "
                 "in the place of tabs, and decimal points in numbers");
  EXPECT_EQ(problems_with_table("t,head\n0,2,5\n"),
            at + "2: got \"0,2,5\"; expected two numbers t,head: a time in s and a head in m, with "
                 "decimal points");
  EXPECT_EQ(problems_with_table("t,head\n0,nan\n"),
            at + "2: got \"0,nan\"; expected two numbers t,head: a time in s and a head in m");
  EXPECT_EQ(problems_with_table("t,head\n5,2\n\n5,3\n"),
            at + "4: got t = 5 twice (for a jump give 5 and 5.0005); expected times that ascend");
  EXPECT_EQ(problems_with_table("t,head\n5,2\n4,3\n"),
            at + "3: got t = 4 after t = 5; expected times that ascend");
  EXPECT_EQ(problems_with_table("t,head\n0,2\n0,3\n"),
            at + "3: got t = 0 twice (for a jump give 0 and 1e-4); expected times that ascend");
}

TEST(ClosestName, counts_letters_to_change) {
  EXPECT_EQ(edit_distance("porosity", "porosity"), 0U);
  EXPECT_EQ(edit_distance("Porosity", "porosity"), 0U);
  EXPECT_EQ(edit_distance("porsity", "porosity"), 1U);
  EXPECT_EQ(edit_distance("porossity", "porosity"), 1U);
  EXPECT_EQ(edit_distance("poroisty", "porosity"), 1U);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
  EXPECT_EQ(edit_distance("", "abc"), 3U);
}

TEST(ClosestName, is_at_most_a_third_of_the_letters_away) {
  EXPECT_EQ(closest_name("abcxyf", {"abcdef"}), "abcdef");
  EXPECT_EQ(closest_name("abxyzf", {"abcdef"}), "");
  EXPECT_EQ(closest_name("en", {"start", "end"}), "end");
  EXPECT_EQ(closest_name("abcdxf", {"abxdxf", "abcdef"}), "abxdxf");  // the first of equal ones
}

TEST(SceneSchema, declares_each_key_once_and_within_its_own_bounds) {
  std::set<std::string> patterns;
  for (const SceneKey& key : scene_keys()) {
    EXPECT_TRUE(patterns.insert(key.pattern).second) << key.pattern;
    EXPECT_FALSE(key.sentence.empty()) << key.pattern;
    EXPECT_EQ(key.required + key.default_value.has_value() + !key.default_note.empty(), 1)
        << key.pattern << " wants a default or to be required";
    if (key.default_value) {
      EXPECT_TRUE(key.accept(*key.default_value)) << key.pattern;
    }
  }
}

TEST(SceneReference, is_up_to_date) {
  EXPECT_EQ(read_text(fs::path(test::source_folder()) / "docs/reference/scene-reference.md"),
            scene_reference_markdown())
      << "docs/reference/scene-reference.md is stale; run in the root of the repository:\n"
         "  suffuse-mesher --scene-reference > docs/reference/scene-reference.md";
}

TEST(SceneReference, has_every_key) {
  const std::string reference = scene_reference_markdown();
  std::size_t rows = 0;
  for (std::size_t row = reference.find("\n| `"); row != std::string::npos;
       row = reference.find("\n| `", row + 1)) {
    ++rows;
  }
  EXPECT_EQ(rows, scene_keys().size());
}

TEST(SceneReference, has_an_example_that_works) {
  const std::string reference = scene_reference_markdown();
  const std::string fence = "```toml\n";
  const std::size_t begin = reference.find(fence) + fence.size();
  EXPECT_EQ(problems_of(reference.substr(begin, reference.find("```\n", begin) - begin)), "");
}

/// Adds each part to a scene with gravity that lacks it.
TEST(SceneReference, has_parts_of_scenes_that_work) {
  const std::string soil = "porosity = 0.3\nskeleton_fraction = 0.6\ngrain_density = 2700\n";
  const std::string before =
      "formulation = \"single-point\"\ngravity = [0.0, -9.81]\ngeometry = {file = \"dam.geo\"}\n"
      "liquid = {density = 1000, bulk_modulus = inf, viscosity = 1e-3}\ntime = {end = 1e6}\n"
      "output.every = 1e5\n";
  const std::string reference = scene_reference_markdown();
  const std::string fence = "```toml\n";
  int parts = 0;
  for (std::size_t begin = reference.find(fence, reference.find("## Examples of seepage"));
       begin != std::string::npos; begin = reference.find(fence, begin + 1)) {
    const std::size_t start = begin + fence.size();
    std::string part = reference.substr(start, reference.find("```\n", start) - start);
    const std::string heading = "[soil.body]\n";
    if (const std::size_t at = part.find(heading); at != std::string::npos) {
      part.insert(at + heading.size(), soil);
    } else {
      part += heading + "conductivity = 1e-5\n" + soil;
    }
    try {
      parse_scene(before + part, "scene.toml", {}, {{"flood.csv", "t,head\n0,1\n"}});
    } catch (const InputError& error) {
      ADD_FAILURE() << part << error.what();
    }
    ++parts;
  }
  EXPECT_EQ(parts, 10);
}

std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

TEST(HostileScene, deep_tables_are_refused) {
  const std::string deep =
      "scene.toml:2: got tables that lie more than 64 deep in each other; expected a scene, whose "
      "tables lie three deep\n";
  EXPECT_EQ(problems_of("# " + repeated(".", 100) + "\n" + repeated("a.", 200000) + "a = 1\n"),
            deep);
  EXPECT_EQ(problems_of("\n[" + repeated("a.", 200000) + "a]\n"), deep);
  EXPECT_EQ(problems_of("[" + repeated("a.", 40) + "a]\n" + repeated("b . ", 40) + "b = 1\n"),
            deep);
  EXPECT_EQ(problems_of("\na = " + repeated("{ b.c = ", 40)), deep);
  EXPECT_EQ(problems_of("\n" + repeated("\"a\".", 70) + "a = 1\n"), deep);
  const std::string argument = "gravity=" + repeated("{a.b=", 40);
  EXPECT_EQ(problems_of(least, {argument}).substr(0, 6 + argument.size()), "--set " + argument);
  EXPECT_NE(problems_of(least, {argument}).find("more than 64 deep"), std::string::npos);
}

TEST(HostileScene, dots_in_texts_comments_and_numbers_are_no_tables) {
  const std::string dots = repeated(".", 200);
  EXPECT_EQ(problems_of("name = \"\\\"" + dots + "\" # " + dots + "\n" + least), "");
  EXPECT_EQ(problems_of("name = '" + dots + "'\n" + least), "");
  EXPECT_EQ(problems_of("name = \"\"\"" + dots + "\n" + dots + "\"\"\"\n" + least), "");
  EXPECT_EQ(problems_of(least + "[[boundary]]\non = \"top\"\npressure = [[0.0, 1.5]" +
                        [] {
                          std::string rows;
                          for (int i = 1; i < 100; ++i)
                            rows += ", [" + std::to_string(i) + ".5, 0.25]";
                          return rows;
                        }() +
                        "]\n"),
            "");
}

TEST(HostileScene, long_chains_of_soils_are_refused) {
  std::string soils;
  for (int i = 0; i < 5000; ++i) {
    soils += "[soil.s" + std::to_string(i) + "]\nlike = \"s" + std::to_string(i + 1) + "\"\n";
  }
  EXPECT_NE(
      problems_of(least + soils).find("expected at most 100 soils of which each is like the next"),
      std::string::npos);
}

TEST(HostileScene, deep_values_and_odd_bytes_are_no_toml) {
  for (const std::string& text :
       {"name = " + repeated("[", 100000), "name = " + repeated("{a=", 100000),
        std::string("name = \"a\0b\"\n", 13), std::string("name = \"\xff\"\n"),
        std::string("\0\1\2", 3)}) {
    EXPECT_EQ(problems_of(text).substr(0, 13), "scene.toml:1:");
  }
}

}  // namespace scene_test
}  // namespace suffuse
