#include "case/plausibility.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "temporary_folder.hpp"

namespace suffuse {
namespace plausibility_test {

using Warnings = std::vector<std::string>;

/// Squares of two triangles in rows from y = 0 up; boundaries bottom and top.
Mesh<2> grid(
    int columns, int rows, double width, double height,
    const std::function<std::string(int row)>& region = [](int) { return "specimen"; }) {
  Mesh<2> mesh;
  const auto node = [&](int i, int j) { return j * (columns + 1) + i; };
  mesh.boundaries = {{"bottom", {}}, {"top", {}}};
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) {
      mesh.nodes.emplace_back(width * i / columns, height * j / rows);
    }
  }
  for (int j = 0; j < rows; ++j) {
    if (mesh.region_names.empty() || mesh.region_names.back() != region(j)) {
      mesh.region_names.push_back(region(j));
    }
    for (int i = 0; i < columns; ++i) {
      mesh.elements.push_back({node(i, j), node(i + 1, j), node(i + 1, j + 1)});
      mesh.elements.push_back({node(i, j), node(i + 1, j + 1), node(i, j + 1)});
      mesh.element_region.resize(mesh.elements.size(),
                                 static_cast<int>(mesh.region_names.size()) - 1);
    }
  }
  for (int i = 0; i < columns; ++i) {
    mesh.boundaries[0].faces.push_back({node(i, 0), node(i + 1, 0)});
    mesh.boundaries[1].faces.push_back({node(i + 1, rows), node(i, rows)});
  }
  return mesh;
}

const std::string on_top = "[[boundary]]\non = \"top\"\npressure = 1e3\n";
const std::string on_bottom = "[[boundary]]\non = \"bottom\"\npressure = 0.0\n";
const std::string column = "[geometry]\nshape = \"column\"\nwidth = 1.0\nheight = 1.0\n";
const std::string size = "[mesh]\nsize = 0.25\n";

SceneDocument scene(const std::vector<std::string>& overrides = {},
                    const std::string& geometry = column + size,
                    const std::string& more = on_top + on_bottom) {
  return parse_scene(test::scene_text(geometry, more), "test.toml", overrides);
}

/// Warnings about keys, on a mesh that has nothing unusual.
Warnings of_keys(const std::vector<std::string>& overrides) {
  return plausibility_warnings(scene(overrides), grid(4, 4, 1.0, 1.0));
}

TEST(Plausibility, UsualNumbersRaiseNothing) {
  EXPECT_EQ(of_keys({}), Warnings{});
  EXPECT_EQ(of_keys({"liquid.density=500", "soil.specimen.grain_density=1500",
                     "soil.specimen.conductivity=1"}),
            Warnings{});
  EXPECT_EQ(of_keys({"liquid.density=2000", "gravity=[0, -9.81]", "initial.water_level=1"}),
            Warnings{});
  EXPECT_EQ(of_keys({"gravity=[9.81, 0]", "initial.water_level=1"}), Warnings{});
}

TEST(Plausibility, UnusualNumbersAreNamedWithTheirPlace) {
  EXPECT_EQ(of_keys({"liquid.density=1.0"}),
            Warnings{"--set liquid.density=1.0: liquid.density: 1 kg/m3; 500 to 2000 are usual, "
                     "water has 1000"});
  EXPECT_EQ(of_keys({"liquid.density=2001"}).size(), 1U);
  EXPECT_EQ(of_keys({"soil.specimen.grain_density=2.65"}),
            Warnings{"--set soil.specimen.grain_density=2.65: soil.specimen.grain_density: 2.65 "
                     "kg/m3; 1500 and more are usual, quartz has 2650"});
  const std::string k =
      "soil.specimen.conductivity: 1.5 m/s; at most 1 is usual, coarse gravel has "
      "some 0.1";
  EXPECT_EQ(of_keys({"soil.specimen.conductivity=1.5"}),
            Warnings{"--set soil.specimen.conductivity=1.5: " + k});
  EXPECT_EQ(of_keys({"time.scheme=implicit", "soil.specimen.conductivity=[0.1, 1.5]"}),
            Warnings{"--set soil.specimen.conductivity=[0.1, 1.5]: " + k});
  EXPECT_EQ(of_keys({"gravity=[0, 9.81]", "initial.water_level=1"}),
            Warnings{"--set gravity=[0, 9.81]: gravity: [0.0, 9.81] points upwards, along +y; "
                     "[0.0, -9.81] is usual"});
}

/// Soil that yields shares its dilatation on such triangles.
TEST(Plausibility, SoilThatYieldsMayHaveAnyTriangles) {
  EXPECT_EQ(of_keys({"time.scheme=implicit", "soil.specimen.skeleton.law=von-mises",
                     "soil.specimen.skeleton.young=1e7", "soil.specimen.skeleton.poisson=0.3",
                     "soil.specimen.skeleton.cohesion=1e4", "mesh.structure=free"}),
            Warnings{});
}

TEST(Plausibility, AColumnIsOneMillimetreToTenKilometresLong) {
  const auto warnings = [](double width, double height) {
    return plausibility_warnings(scene(), grid(4, 4, width, height));
  };
  EXPECT_EQ(warnings(1.0, 1e4), Warnings{});
  EXPECT_EQ(warnings(1.0, 11000.0), Warnings{"test.toml:6: geometry.height: the model is 1 x 11000 "
                                             "m; 1 mm to 1 km are usual"});
  EXPECT_EQ(warnings(11000.0, 1.0).front().substr(0, 28), "test.toml:5: geometry.width:");
  EXPECT_EQ(warnings(1e-4, 1e-3), Warnings{});
  EXPECT_EQ(warnings(1e-4, 0.9e-3).size(), 1U);
}

TEST(Plausibility, AFileOfThousandsMayBeInMillimetres) {
  const auto warnings = [](const std::string& file, double length,
                           const std::vector<std::string>& overrides = {}) {
    return plausibility_warnings(scene(overrides, "[geometry]\nfile = \"" + file + "\"\n"),
                                 grid(4, 4, length, 1.0));
  };
  EXPECT_EQ(warnings("dam.geo", 1000.0), Warnings{});
  EXPECT_EQ(
      warnings("dam.geo", 3000.0),
      Warnings{"test.toml:4: geometry.file: the model is 3000 x 1 m; 1 mm to 1 km are usual. "
               "Where the file is in millimetres, give geometry.scale = 0.001; where it is in "
               "metres, geometry.scale = 1"});
  EXPECT_EQ(warnings("dam.geo", 3000.0, {"geometry.scale=1"}), Warnings{});
  EXPECT_EQ(
      warnings("dam.geo", 11000.0, {"geometry.scale=1"}),
      Warnings{"test.toml:4: geometry.file: the model is 11000 x 1 m; 1 mm to 1 km are usual: "
               "geometry.scale is the length of a unit of the file, in m"});
  EXPECT_EQ(warnings("dam.step", 3000.0), Warnings{});
  EXPECT_EQ(
      warnings("dam.step", 11000.0),
      Warnings{"test.toml:4: geometry.file: the model is 11000 x 1 m; 1 mm to 1 km are usual: "
               "is the unit that the STEP file states the right one?"});
}

TEST(Plausibility, KeysWithoutEffectAreNamed) {
  const auto expect = [](const std::string& key, const std::string& value, const std::string& why,
                         const std::vector<std::string>& with) {
    std::vector<std::string> all{key + "=" + value};
    EXPECT_EQ(of_keys(all),
              Warnings{"--set " + all.front() + ": " + key + ": it has no effect here, as " + why});
    all.insert(all.end(), with.begin(), with.end());
    EXPECT_EQ(of_keys(all), Warnings{}) << key;
  };
  expect("points.seed", "3", "no points are placed by chance: points.jitter is 0",
         {"points.jitter=0.1"});
  expect("soil.specimen.porosity_origin", "[0, 1]", "porosity_gradient is 0",
         {"soil.specimen.porosity_gradient=[0, 0.1]"});
  expect("mesh.max_elements", "500", "without mesh.error the mesh is made once",
         {"mesh.error=0.01", "mesh.structure=\"free\"", "time.scheme=implicit"});
  expect("time.failure", "\"follow\"", "no soil moves",
         {"soil.specimen.skeleton={law=\"elastic\", young=1e7, poisson=0.3}",
          "boundary[1].fix=\"both\"", "time.scheme=implicit"});
}

TEST(Plausibility, ADiscIsForAnError) {
  EXPECT_EQ(of_keys({"output.probe=[{at=[0.5, 0.5], disc=0.1}]"}),
            Warnings{"--set output.probe=[{at=[0.5, 0.5], disc=0.1}]: output.probe[0].disc: it has "
                     "no effect here, as means over it are found with mesh.error only"});
}

TEST(Plausibility, ALevelAtASteadyStartIsNamed) {
  const Warnings found =
      of_keys({"gravity=[0, -9.81]", "initial.water_level=1", "initial.flow=\"steady\""});
  EXPECT_EQ(found, Warnings{"--set initial.water_level=1: initial.water_level: it has no effect "
                            "here, as with initial.flow = \"steady\" the boundaries decide the "
                            "start"});
}

// Elements across a region.

Warnings of_mesh(const Mesh<2>& mesh, const std::string& more = on_top + on_bottom,
                 const std::vector<std::string>& overrides = {}) {
  return plausibility_warnings(scene(overrides, column + size, more), mesh);
}

std::string too_few(const std::string& region) {
  return "test.toml:8: mesh.size: 0.25 m leaves fewer than 4 elements across the region \"" +
         region + "\", from where water enters it to where it leaves; 4 or more are usual";
}

TEST(Resolution, CountsElementsFromWhereWaterEntersToWhereItLeaves) {
  EXPECT_EQ(of_mesh(grid(1, 4, 1.0, 1.0)), Warnings{});
  for (const int rows : {1, 2, 3}) {
    EXPECT_EQ(of_mesh(grid(8, rows, 1.0, 1.0)), Warnings{too_few("specimen")}) << rows;
  }
  // An impervious base is a plane of symmetry, held or not.
  const std::string held = "[[boundary]]\non = \"bottom\"\nfix = \"normal\"\n";
  EXPECT_EQ(of_mesh(grid(8, 2, 1.0, 1.0), on_top + held,
                    {"soil.specimen.skeleton={law=\"elastic\",young=1e7,poisson=0.3}",
                     "time.scheme=implicit"}),
            Warnings{});
  EXPECT_EQ(of_mesh(grid(8, 2, 1.0, 1.0), on_top), Warnings{});
  EXPECT_EQ(of_mesh(grid(8, 1, 1.0, 1.0), on_top), Warnings{too_few("specimen")});
  EXPECT_EQ(of_mesh(grid(8, 1, 1.0, 1.0), ""), Warnings{});
}

TEST(Resolution, OfAThinLayerIsToldByItsName) {
  const std::string clay = "[soil.clay]\nlike = \"specimen\"\n";
  const auto layer = [](int row) {
    return row == 4 || row == 5 ? "clay" : row < 4 ? "specimen" : "gravel";
  };
  const std::string gravel = "[soil.gravel]\nlike = \"specimen\"\n";
  EXPECT_EQ(of_mesh(grid(8, 10, 1.0, 1.0, layer), clay + gravel + on_top + on_bottom),
            Warnings{too_few("clay")});
  EXPECT_EQ(plausibility_warnings(
                scene({}, "[geometry]\nfile = \"a.msh\"\n", clay + gravel + on_top + on_bottom),
                grid(8, 10, 1.0, 1.0, layer)),
            Warnings{"test.toml:3: geometry: the mesh has fewer than 4 elements across the region "
                     "\"clay\", from where water enters it to where it leaves; 4 or more are "
                     "usual"});
}

TEST(Resolution, OfFreeWaterAndOfTheRowsOfAColumnIsTheScenesOwn) {
  const auto layer = [](int row) { return row > 5 ? "inflow" : row > 4 ? "buffer" : "specimen"; };
  const std::string buffer = "[soil.buffer]\nlike = \"specimen\"\n";
  EXPECT_EQ(of_mesh(grid(8, 7, 1.0, 1.0, layer), buffer + on_top + on_bottom,
                    {"formulation=double-point"}),
            Warnings{});
}

// Suction.

/// Warnings about suction in a column from z = 0 to 4 m.
Warnings suction(const std::string& more, const std::vector<std::string>& overrides = {}) {
  std::vector<std::string> all{"gravity=[0, -10]", "time.scheme=implicit"};
  all.insert(all.end(), overrides.begin(), overrides.end());
  return suction_warnings(scene(all, column + size, more), grid(4, 8, 1.0, 4.0));
}

std::string because(const std::string& height, const std::string& place, const std::string& cause) {
  return "test.toml:19: soil.specimen.retention: none, and a suction of " + height +
         " m of water at " + place + ": " + cause +
         ". Without a retention law the soil stays full of water there; real soil drains, and "
         "conducts less. Up to 0.5 m are usual";
}

TEST(SuctionWarning, OfTheWaterLevelAtTheStart) {
  EXPECT_EQ(suction("", {"initial.water_level=3.5"}), Warnings{});
  EXPECT_EQ(suction("", {"initial.water_level=3"}),
            Warnings{because("1", "(0.25, 4)", "the water level at the start is 3 m")});
  EXPECT_EQ(suction("[[boundary]]\non = \"top\"\nseepage_face = true\n",
                    {"initial.water_level=3", "initial.flow=steady"}),
            Warnings{});
  EXPECT_EQ(suction("", {"initial.water_level=3", "gravity=[0, 0]"}), Warnings{});
  EXPECT_EQ(suction("[soil.specimen.retention]\nmodel = \"gardner\"\nalpha = 2.0\n",
                    {"initial.water_level=3"}),
            Warnings{});
}

TEST(SuctionWarning, NamesFreeWaterAboveTheLevelToo) {
  const auto layer = [](int row) { return row > 5 ? "free_above" : "specimen"; };
  const Warnings found =
      suction_warnings(scene({"gravity=[0, -10]", "time.scheme=implicit", "initial.water_level=1",
                              "soil.specimen.skeleton={law=\"elastic\", young=1e7, poisson=0.3}"},
                             column + size, ""),
                       grid(4, 8, 1.0, 4.0, layer));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NE(found.front().find("stays full of water there, as do regions without soil, whose "
                               "water loads it; real soil drains"),
            std::string::npos)
      << found.front();
}

TEST(SuctionWarning, OfHeadsThatNoneExceeds) {
  const std::vector<std::string> steady{"initial.flow=steady"};
  const std::string low = "[[boundary]]\non = \"bottom\"\nhead = [[0, 1], [1, 3]]\n";
  EXPECT_EQ(suction(low, steady),
            Warnings{because("1", "(0.25, 4)", "no boundary prescribes a head above 3 m")});
  EXPECT_EQ(suction(low + "[[boundary]]\non = \"top\"\nhead = 3.6\n", steady), Warnings{});
  // 40 kPa at the base are a head of 4 m.
  EXPECT_EQ(suction("[[boundary]]\non = \"bottom\"\npressure = 4e4\n", steady), Warnings{});
  EXPECT_EQ(suction("[[boundary]]\non = \"bottom\"\npressure = 3e4\n", steady).size(), 1U);
  // Injected liquid raises heads.
  EXPECT_EQ(suction(low + "[[boundary]]\non = \"top\"\ndarcy_flux = 1e-9\n", steady), Warnings{});
  EXPECT_EQ(suction(low + "[[boundary]]\non = \"top\"\ndarcy_flux = -1e-9\n", steady).size(), 1U);
}

TEST(SuctionWarning, OfWhatABoundaryPrescribes) {
  const std::string high = "[[boundary]]\non = \"bottom\"\nhead = 9.0\n";
  const std::vector<std::string> steady{"initial.flow=steady"};
  EXPECT_EQ(suction(high + "[[boundary]]\non = \"top\"\npressure = -2e4\n", steady),
            Warnings{because("2", "(0.25, 4)", "boundary[1] prescribes -20000 Pa")});
  EXPECT_EQ(suction(high + "[[boundary]]\non = \"top\"\npressure = -5e3\n", steady), Warnings{});
  EXPECT_EQ(suction(high + "[[boundary]]\non = \"top\"\nhead = [[0, 4], [1, 2]]\n", steady),
            Warnings{});
  EXPECT_EQ(
      suction(high + "[[boundary]]\non = \"top\"\nhead = [[0, 4], [1, 2]]\n"
                     "dry = \"suction\"\n",
              steady),
      Warnings{because("2", "(0.25, 4)", "boundary[1] prescribes the suction of a head of 2 m")});
}

}  // namespace plausibility_test
}  // namespace suffuse
