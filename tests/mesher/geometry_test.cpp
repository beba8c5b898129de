#include "geometry.hpp"

#include <gmsh.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <new>
#include <set>

#include "common/errors.hpp"
#include "gmsh_export.hpp"
#include "gmsh_session.hpp"
#include "hilbert_order.hpp"
#include "mesh/slit.hpp"
#include "summary.hpp"
#include "temporary_folder.hpp"
#include "test_paths.hpp"

namespace suffuse {
namespace geometry_test {

namespace fs = std::filesystem;
using test::scene_text;
using test::TemporaryFolder;

std::string column(double width, double height, double size, const std::string& structure) {
  return "[geometry]\nshape = \"column\"\nwidth = " + std::to_string(width) +
         "\nheight = " + std::to_string(height) + "\n[mesh]\nsize = " + std::to_string(size) +
         "\nstructure = \"" + structure + "\"\n";
}

Geometry<2> build(const std::string& geometry, const std::string& more = "",
                  const std::vector<std::string>& overrides = {}) {
  return build_geometry_of<2>(parse_scene(scene_text(geometry, more), "test.toml", overrides));
}

const std::string buffer = "[soil.buffer]\nlike = \"specimen\"\n";

Geometry<2> build_layers(const std::string& geometry, const std::string& layers,
                         const std::string& more = "") {
  return build(geometry, more, {"formulation=double-point", "geometry.layers=" + layers});
}

std::vector<double> areas_by_region(const Mesh<2>& mesh) {
  std::vector<double> areas(mesh.region_names.size(), 0.0);
  for (int e = 0; e < mesh.element_count(); ++e) {
    EXPECT_GT(element_volume(mesh, e), 0.0);
    areas[mesh.element_region[e]] += element_volume(mesh, e);
  }
  return areas;
}

const BoundarySet<2>& boundary(const Mesh<2>& mesh, const std::string& name) {
  return *std::ranges::find(mesh.boundaries, name, &BoundarySet<2>::name);
}

double longest_edge(const Mesh<2>& mesh, int e) {
  double longest = 0.0;
  for (int a = 0; a < 3; ++a) {
    longest = std::max(
        longest,
        (mesh.nodes[mesh.elements[e][a]] - mesh.nodes[mesh.elements[e][(a + 1) % 3]]).norm());
  }
  return longest;
}

TEST(Column, RegularHasTwoRightTrianglesPerSquare) {
  const Geometry<2> geometry = build(column(1.0, 0.5, 0.25, "regular"));
  const Mesh<2>& mesh = geometry.mesh;
  EXPECT_EQ(mesh.element_count(), 2 * 4 * 2);
  EXPECT_EQ(mesh.node_count(), 5 * 3);
  EXPECT_EQ(mesh.region_names, std::vector<std::string>{"specimen"});
  EXPECT_TRUE(geometry.notes.empty());
  EXPECT_NEAR(smallest_angle(mesh), 45.0, 1e-12);
  for (int e = 0; e < mesh.element_count(); ++e) {
    EXPECT_EQ(element_volume(mesh, e), 0.5 * 0.25 * 0.25);  // exact in binary
  }
}

/// Nodes that four triangles share, with their neighbours opposite each other in pairs.
int diagonal_crossings(const Mesh<2>& mesh) {
  std::map<int, std::set<int>> neighbours;
  std::map<int, int> elements;
  for (const auto& corners : mesh.elements) {
    for (int a = 0; a < 3; ++a) {
      ++elements[corners[a]];
      neighbours[corners[a]].insert({corners[(a + 1) % 3], corners[(a + 2) % 3]});
    }
  }
  int crossings = 0;
  for (const auto& [node, around] : neighbours) {
    if (elements[node] != 4 || around.size() != 4) continue;
    int opposite = 0;
    for (const int i : around) {
      for (const int j : around) {
        const Vector<2> a = (mesh.nodes[i] - mesh.nodes[node]).normalized();
        const Vector<2> b = (mesh.nodes[j] - mesh.nodes[node]).normalized();
        opposite += (a + b).norm() < 1e-9 ? 1 : 0;
      }
    }
    crossings += opposite == 4 ? 1 : 0;
  }
  return crossings;
}

TEST(Column, CrossedHasFourTrianglesPerSquare) {
  const Mesh<2> mesh = build(column(1.0, 0.5, 0.25, "crossed")).mesh;
  EXPECT_EQ(mesh.element_count(), 4 * 4 * 2);
  EXPECT_EQ(mesh.node_count(), 5 * 3 + 4 * 2);
  EXPECT_EQ(diagonal_crossings(mesh), 4 * 2);
  EXPECT_NEAR(areas_by_region(mesh)[0], 0.5, 1e-15);
  EXPECT_EQ(boundary(mesh, "top").faces.size(), 4U);
}

TEST(Column, RegularIsItsOwnImageWhenTurnedUpsideDown) {
  const Mesh<2> mesh = build(column(1.0, 1.0, 0.25, "regular")).mesh;
  const auto key = [](const Vector<2>& x) {
    return std::pair(std::lround(x[0] * 3e6), std::lround(x[1] * 3e6));
  };
  std::set<std::pair<long, long>> centroids;
  for (int e = 0; e < mesh.element_count(); ++e) centroids.insert(key(element_centroid(mesh, e)));
  for (int e = 0; e < mesh.element_count(); ++e) {
    EXPECT_TRUE(centroids.contains(key(Vector<2>(1.0, 1.0) - element_centroid(mesh, e))));
  }
}

TEST(Column, BoundariesLieWhereTheirNamesSay) {
  for (const std::string structure : {"regular", "free"}) {
    const Mesh<2> mesh = build(column(2.0, 1.0, 0.25, structure)).mesh;
    const std::map<std::string, std::pair<int, double>> places{
        {"left", {0, 0.0}}, {"right", {0, 2.0}}, {"bottom", {1, 0.0}}, {"top", {1, 1.0}}};
    ASSERT_EQ(mesh.boundaries.size(), 4U);
    for (const auto& [name, place] : places) {
      double length = 0.0;
      for (const auto& face : boundary(mesh, name).faces) {
        for (int node : face) EXPECT_NEAR(mesh.nodes[node][place.first], place.second, 1e-12);
        length += (mesh.nodes[face[1]] - mesh.nodes[face[0]]).norm();
      }
      EXPECT_NEAR(length, place.first == 0 ? 1.0 : 2.0, 1e-12) << name;
    }
  }
}

TEST(Column, FreeHasTheAreaTheSizeAndNoPattern) {
  const Mesh<2> mesh = build(column(1.0, 1.0, 0.1, "free")).mesh;
  EXPECT_NEAR(areas_by_region(mesh)[0], 1.0, 1e-12);
  double mean = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) mean += longest_edge(mesh, e);
  mean /= mesh.element_count();
  EXPECT_GT(mean, 0.08);
  EXPECT_LT(mean, 0.14);
  EXPECT_LT(std::abs(smallest_angle(mesh) - 40.0), 15.0);
}

TEST(Column, IsTheSameEveryTime) {
  const std::string scene = column(1.0, 1.0, 0.07, "free");
  const Mesh<2> first = build(scene).mesh;
  const Mesh<2> second = build(scene).mesh;
  EXPECT_EQ(first.nodes, second.nodes);
  EXPECT_EQ(first.elements, second.elements);
}

TEST(Column, SaysWhenTheSizeDoesNotDivideASide) {
  const Geometry<2> geometry = build(column(1.0, 1.0, 0.3, "regular"));
  EXPECT_EQ(geometry.mesh.element_count(), 2 * 3 * 3);
  ASSERT_EQ(geometry.notes.size(), 2U);
  EXPECT_EQ(geometry.notes[1],
            "mesh.size 0.3 does not divide the height 1: it has 3 elements of 0.333333");
}

std::string refusal(const std::function<void()>& body) {
  try {
    body();
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing refused";
}

TEST(Column, RefusesMoreTrianglesThanAnyoneMeans) {
  EXPECT_EQ(refusal([] { build(column(1.0, 1.0, 1e-4, "regular")); }),
            "test.toml:8: mesh.size: got 0.0001; expected at least 0.000632456, which makes 5 "
            "million triangles here");
}

void expect_order(const Mesh<2>& mesh) {
  const Mesh<2> ordered = in_hilbert_order(mesh);
  EXPECT_EQ(mesh.elements, ordered.elements);
  EXPECT_EQ(mesh.nodes, ordered.nodes);
}

TEST(Column, IsInTheOrderOfHilbertsCurve) {
  for (const std::string structure : {"regular", "crossed", "free"}) {
    expect_order(build(column(1.0, 2.0, 0.1, structure)).mesh);
  }
}

/// Layers of every kind, 13 rows together with the 3 of the specimen.
const std::string all_layers =
    "{inflow=2, free_above=1, above=3, below=1, free_below=2, outflow=1}";

/// Nodes minus edges plus elements: 1 for a mesh in one piece without holes.
int euler_characteristic(const Mesh<2>& mesh) {
  std::set<std::pair<int, int>> edges;
  for (const auto& corners : mesh.elements) {
    for (int a = 0; a < 3; ++a) edges.insert(std::minmax(corners[a], corners[(a + 1) % 3]));
  }
  return mesh.node_count() - static_cast<int>(edges.size()) + mesh.element_count();
}

class Layers : public testing::TestWithParam<std::string> {};

TEST_P(Layers, LieInTheirOrderInOnePiece) {
  // Rows of a third, because 0.3 does not divide the height.
  const Mesh<2> mesh = build_layers(column(1.0, 1.0, 0.3, GetParam()), all_layers, buffer).mesh;
  EXPECT_EQ(mesh.region_names, (std::vector<std::string>{"outflow", "free_below", "buffer",
                                                         "specimen", "free_above", "inflow"}));
  const auto expected_region = [](double thirds) -> std::string {
    if (thirds < -3.0) return "outflow";
    if (thirds < -1.0) return "free_below";
    if (thirds > 7.0) return "inflow";
    if (thirds > 6.0) return "free_above";
    return thirds > 0.0 && thirds < 3.0 ? "specimen" : "buffer";
  };
  for (int e = 0; e < mesh.element_count(); ++e) {
    const std::string& region = mesh.region_names[mesh.element_region[e]];
    EXPECT_EQ(region, expected_region(3.0 * element_centroid(mesh, e)[1]));
    for (const int node : mesh.elements[e]) {
      if (region != "specimen") continue;
      EXPECT_GE(mesh.nodes[node][1], 0.0);
      EXPECT_LE(mesh.nodes[node][1], 1.0);
    }
  }
  const std::vector<double> areas = areas_by_region(mesh);
  const std::array<double, 6> rows{1, 2, 4, 3, 1, 2};
  for (std::size_t r = 0; r < rows.size(); ++r) EXPECT_NEAR(areas[r], rows[r] / 3.0, 1e-12);
  EXPECT_EQ(euler_characteristic(mesh), 1);
}

TEST_P(Layers, HaveTheirBoundariesAroundAllOfThem) {
  const Mesh<2> mesh = build_layers(column(2.0, 1.0, 0.5, GetParam()), all_layers, buffer).mesh;
  const std::map<std::string, std::pair<int, double>> places{
      {"left", {0, 0.0}}, {"right", {0, 2.0}}, {"outflow", {1, -2.0}}, {"inflow", {1, 4.0}}};
  ASSERT_EQ(mesh.boundaries.size(), places.size());
  for (const auto& [name, place] : places) {
    double length = 0.0;
    for (const auto& face : boundary(mesh, name).faces) {
      for (int node : face) EXPECT_NEAR(mesh.nodes[node][place.first], place.second, 1e-12);
      length += (mesh.nodes[face[1]] - mesh.nodes[face[0]]).norm();
    }
    EXPECT_NEAR(length, place.first == 0 ? 6.0 : 2.0, 1e-12) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Structures, Layers, testing::Values("regular", "crossed", "free"),
                         [](const auto& tested) { return tested.param; });

TEST(Column, LeavesTheSpecimensNodesInTheirPlaces) {
  // Two rows of 0.35 in the specimen; three such rows are nearer to four of 0.29.
  const std::string geometry = column(1.0, 0.7, 0.29, "regular");
  const Mesh<2> alone = build(geometry).mesh;
  const Mesh<2> layered = build_layers(geometry, all_layers, buffer).mesh;
  std::set<double> rows;
  for (const Vector<2>& x : layered.nodes) rows.insert(x[1]);
  std::set<double> expected;
  for (int row = -4; row <= 8; ++row) expected.insert(0.7 * row / 2);
  EXPECT_EQ(rows, expected);  // to the last digit, so no line is there twice
  std::set<std::pair<double, double>> places;
  for (const Vector<2>& x : layered.nodes) places.emplace(x[0], x[1]);
  for (const Vector<2>& x : alone.nodes) EXPECT_TRUE(places.contains({x[0], x[1]}));
}

TEST(Column, IsCalledTopAndBottomWhereNoFreeWaterEnds) {
  const auto names = [](const std::string& layers) {
    const Mesh<2> mesh = build_layers(test::unit_column, layers, buffer).mesh;
    std::set<std::string> result;
    for (const auto& set : mesh.boundaries) result.insert(set.name);
    return result;
  };
  EXPECT_EQ(names("{above=1, free_above=1}"),
            (std::set<std::string>{"top", "bottom", "left", "right"}));
  EXPECT_EQ(names("{below=1, outflow=1}"),
            (std::set<std::string>{"top", "outflow", "left", "right"}));
}

TEST(Column, CountsItsLayersAmongTooManyTriangles) {
  // 1 / 7e-4 = 1429 rows of 1429 columns are 4.1 million triangles; 1000 rows more make 6.9.
  EXPECT_EQ(refusal([] { build_layers(column(1.0, 1.0, 7e-4, "regular"), "{inflow=1000}"); }),
            "test.toml:8: mesh.size: got 0.0007; expected at least 0.000863325, which makes 5 "
            "million triangles here");
}

TEST(Scene, SoilsAndBoundariesMustFitTheLayers) {
  const std::string top = "[[boundary]]\non = \"top\"\npressure = 1.0\n";
  EXPECT_EQ(refusal([&] { build_layers(test::unit_column, "{inflow=1}", buffer + top); }),
            "test.toml:24: soil.buffer: got \"buffer\"; expected a region of the mesh: "
            "\"specimen\" or \"inflow\"\n"
            "test.toml:27: boundary[0].on: got \"top\"; expected a boundary of the mesh: "
            "\"inflow\", \"bottom\", \"left\" or \"right\"");
  EXPECT_EQ(refusal([&] { build_layers(test::unit_column, "{above=1}"); }),
            "test.toml:19: soil.buffer: got nothing; expected a table [soil.buffer] for the mesh's "
            "region of that name; the soils are \"specimen\"");
}

TEST(Scene, EveryMisfitIsReportedAtOnceWithItsLine) {
  const std::string more =
      "[soil.clya]\nporosity = 0.3\nskeleton_fraction = 0.6\ngrain_density = 2700.0\n"
      "conductivity = 2.0e-2\n"
      "[[boundary]]\non = \"botom\"\npressure = 1.0\n[[boundary]]\non = \"top\"\npressure = 1.0\n";
  EXPECT_EQ(
      refusal([&] { build(test::unit_column, more); }),
      "test.toml:24: soil.clya: got \"clya\"; expected a region of the mesh: \"specimen\"\n"
      "test.toml:30: boundary[0].on: got \"botom\"; expected a boundary of the mesh: \"top\", "
      "\"bottom\", \"left\" or \"right\"; did you mean \"bottom\"?");
}

TEST(Scene, APorosityThatLeavesItsBoundsIsPlaced) {
  const auto with_gradient = [](const std::string& gradient) {
    return refusal([&] { build(test::unit_column, "porosity_gradient = " + gradient + "\n"); });
  };
  EXPECT_EQ(with_gradient("[0.0, 0.11]"),
            "test.toml:24: soil.specimen.porosity_gradient: got n_0 = 0.41 at (0, 1); expected 0 < "
            "n_0 <= 1 - n_C = 0.4 everywhere in the region");
  EXPECT_NE(with_gradient("[-0.3, 0.0]").find("got n_0 = 0 at (1, 0)"), std::string::npos);
  EXPECT_EQ(with_gradient("[0.0, 0.1]"), "nothing refused");
  // Deposits need n_0 above n_min.
  const auto with_deposits = [&](const std::string& least) {
    return with_gradient("[0.0, -0.1]\n[soil.specimen.deposition]\ncoefficient = 2.0\n" +
                         ("porosity_min = " + least));
  };
  EXPECT_EQ(with_deposits("0.2"),
            "test.toml:27: soil.specimen.deposition.porosity_min: got n_min = 0.2 with n_0 = 0.2 "
            "at (0, 1); expected n_min < n_0 everywhere in the region");
  EXPECT_EQ(with_deposits("0.19"), "nothing refused");
}

/// A folder with the geometry files of the test data, so that anything they wrote would show.
class UserFile : public testing::Test {
 protected:
  UserFile() {
    for (const auto& entry : fs::directory_iterator(test::data_folder() + "/geometry")) {
      fs::copy(entry.path(), folder_.path());
    }
    files_ = folder_.count();
  }

  Geometry<2> build_file(const std::string& name, const std::string& size = "0.5",
                         const std::string& more = "", const std::string& structure = "free") {
    std::string geometry = "[geometry]\nfile = \"" + name + "\"\n";
    std::vector<std::string> overrides;
    if (!name.ends_with(".msh")) {
      geometry += "[mesh]\nsize = " + size + "\n";
      overrides.push_back("mesh.structure=" + structure);
    }
    return build_geometry_of<2>(
        parse_scene(scene_text(geometry, more), folder_.file("scene.toml"), overrides));
  }

  Geometry<2> build_free_water(const std::vector<std::string>& overrides,
                               const std::string& more = "") {
    return build_geometry_of<2>(
        parse_scene(scene_text("[geometry]\nfile = \"free_water.geo\"\n[mesh]\nsize = 0.5\n", more),
                    folder_.file("scene.toml"), overrides));
  }

  /// The message of refusal without the folder's name.
  std::string refusal_of(const std::string& name) {
    std::string message = refusal([&] { build_file(name); });
    const std::string prefix = folder_.path().string() + "/";
    for (std::size_t at = message.find(prefix); at != std::string::npos;
         at = message.find(prefix)) {
      message.erase(at, prefix.size());
    }
    return message;
  }

  TemporaryFolder folder_;
  int files_;
};

TEST_F(UserFile, MayHoldFreeWater) {
  const std::string ends =
      "[[boundary]]\non = \"inflow\"\nvelocity = 0.1\n[[boundary]]\non = \"outflow\"\npressure = "
      "0.0\n";
  const Mesh<2> mesh = build_free_water({"formulation=double-point"}, ends).mesh;
  EXPECT_EQ(mesh.region_names, (std::vector<std::string>{"outflow", "specimen", "inflow"}));
  const std::vector<double> areas = areas_by_region(mesh);
  EXPECT_NEAR(areas[0], 0.5, 1e-12);
  EXPECT_NEAR(areas[1], 1.0, 1e-12);
  EXPECT_NEAR(areas[2], 0.5, 1e-12);
  for (const auto& face : boundary(mesh, "inflow").faces) {
    for (const int node : face) EXPECT_EQ(mesh.nodes[node][1], 1.5);
  }
}

TEST_F(UserFile, MayHoldSoilWhereFreeWaterWouldBe) {
  const SceneDocument document = parse_scene(
      scene_text("[geometry]\nfile = \"free_water.geo\"\n", "[soil.inflow]\nlike = \"specimen\"\n"),
      folder_.file("scene.toml"), {"formulation=double-point"});
  EXPECT_FALSE(document.scene.is_free_water("inflow"));
  EXPECT_TRUE(document.scene.is_free_water("outflow"));
  EXPECT_NO_THROW(build_geometry_of<2>(document));
}

TEST_F(UserFile, HoldsNoFreeWaterInSinglePointScenesOfRigidSoil) {
  const std::string message = refusal([&] { build_free_water({}); });
  for (const std::string key : {"soil.inflow: got nothing", "soil.outflow: got nothing"}) {
    EXPECT_NE(message.find(key), std::string::npos) << message;
  }
  EXPECT_NE(
      message.find("region of that name, or formulation = \"double-point\" or a skeleton that "
                   "moves, where it is free water without one; the soils are \"specimen\""),
      std::string::npos)
      << message;
}

std::string changed(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

/// Soils of the regions of two_regions.geo, under these names.
std::string two_soils(const std::string& sand, const std::string& gravel) {
  std::string text = scene_text("[geometry]\nfile = \"two_regions.geo\"\n[mesh]\nsize = 0.5\n",
                                "[soil." + gravel + "]\nlike = \"" + sand + "\"\n");
  return changed(text, "[soil.specimen]", "[soil." + sand + "]");
}

TEST_F(UserFile, OneMisspeltNameIsOneProblem) {
  const auto message = [&](const std::string& sand, const std::string& gravel) {
    return refusal([&] {
      build_geometry_of<2>(parse_scene(two_soils(sand, gravel), folder_.file("scene.toml")));
    });
  };
  EXPECT_EQ(message("sand", "gravel"), "nothing refused");
  EXPECT_EQ(message("Sand", "gravel"),
            folder_.file("scene.toml") +
                ":17: soil.Sand: got \"Sand\"; expected a region of the mesh: \"sand\" or "
                "\"gravel\"; did you mean \"sand\"?");
  // The suggestion is never a region that has a soil.
  const std::string third = "[soil.sands]\nlike = \"sand\"\n";
  EXPECT_EQ(refusal([&] {
              build_geometry_of<2>(
                  parse_scene(two_soils("sand", "gravel") + third, folder_.file("scene.toml")));
            }),
            folder_.file("scene.toml") +
                ":24: soil.sands: got \"sands\"; expected a region of the mesh: \"sand\" or "
                "\"gravel\"");
}

TEST_F(UserFile, WithoutPhysicalCurvesItSaysHowToNameThem) {
  const std::string ends =
      "[[boundary]]\non = \"inlet\"\npressure = 1.0\n[[boundary]]\non = "
      "\"outlet\"\npressure = 0.0\n[[wall]]\non = \"pile\"\n";
  EXPECT_EQ(refusal([&] { build_file("no_physical_curve.geo", "0.5", ends); }),
            folder_.file("scene.toml:4: geometry.file: got ") +
                "\"no_physical_curve.geo\" with no physical curve; expected a physical curve for "
                "\"inlet\", \"outlet\" and \"pile\", as in Physical Curve(\"inlet\") = {1}; the "
                "model has\n    curve 1: x 0 to 1, y 0 to 0\n    curve 2: x 1 to 1, y 0 to 1\n    "
                "curve 3: x 0 to 1, y 1 to 1\n    curve 4: x 0 to 0, y 0 to 1");
  EXPECT_EQ(build_file("no_physical_curve.geo").mesh.boundaries.size(), 0U);
}

/// The same geometry in units that are `scale` metres long.
std::string in_units(const std::string& scale) {
  return "u = " + scale +
         ";\nPoint(1) = {0, 0, 0};\nPoint(2) = {3/u, 0, 0, 0.2/u};\n"
         "Point(3) = {2/u, 1.5/u, 0};\nPoint(4) = {0, 1/u, 0};\nLine(1) = {1, 2};\n"
         "Line(2) = {2, 3};\nLine(3) = {3, 4};\nLine(4) = {4, 1};\n"
         "Curve Loop(1) = {1, 2, 3, 4};\nPlane Surface(1) = {1};\n"
         "Physical Surface(\"specimen\") = {1};\nPhysical Curve(\"left\") = {4};\n";
}

TEST_F(UserFile, InAnotherUnitGivesTheMeshInMetres) {
  for (const std::string structure : {"free", "crossed"}) {
    folder_.write("units.geo", in_units("1"));
    const std::string probe = "[[output.probe]]\nat = [2.5, 0.5]\n";
    const Mesh<2> metres = build_file("units.geo", "0.5", probe, structure).mesh;
    for (const std::string scale : {"0.125", "1024", "0.001", "1000"}) {
      folder_.write("units.geo", in_units(scale));
      const std::string text =
          scene_text("[geometry]\nfile = \"units.geo\"\nscale = " + scale +
                         "\n[mesh]\nsize = 0.5\nstructure = \"" + structure + "\"\n",
                     probe);
      const Mesh<2> mesh = build_geometry_of<2>(parse_scene(text, folder_.file("scene.toml"))).mesh;
      ASSERT_EQ(mesh.elements, metres.elements) << scale << structure;
      double worst = 0.0;
      for (int n = 0; n < mesh.node_count(); ++n) {
        worst = std::max(worst, (mesh.nodes[n] - metres.nodes[n]).norm());
      }
      // Gmsh places nodes on curves to about 1e-12, and quadrangles to a few units of the last
      // digit.
      const bool power_of_two = scale == "0.125" || scale == "1024";
      const bool exact = power_of_two && structure == "free";
      EXPECT_LE(worst, exact ? 0.0 : power_of_two ? 1e-14 : 1e-11) << scale << structure;
    }
  }
}

TEST_F(UserFile, AMeshInMillimetresIsReadInMetres) {
  const std::string text = scene_text("[geometry]\nfile = \"square.msh\"\nscale = 0.001\n");
  const Mesh<2> mesh = build_geometry_of<2>(parse_scene(text, folder_.file("scene.toml"))).mesh;
  EXPECT_EQ(mesh.nodes, (std::vector<Vector<2>>{{0, 0}, {1e-3, 1e-3}, {0, 1e-3}, {1e-3, 0}}));
}

struct Refused {
  std::string file;
  std::string message;  // its beginning
};

void PrintTo(const Refused& refused, std::ostream* stream) {
  *stream << refused.file;
}

class RefusedFile : public UserFile, public testing::WithParamInterface<Refused> {};

TEST_P(RefusedFile, SaysWhyAndDoesNothing) {
  const std::string message = refusal_of(GetParam().file);
  EXPECT_EQ(message.substr(0, GetParam().message.size()), GetParam().message) << message;
  EXPECT_EQ(folder_.count(), files_);
}

const std::string in_scene = "scene.toml:4: geometry.file: got ";
const std::string runs_a_command =
    ", which has Gmsh run a command or start a process; expected a geometry that reads regular "
    "files, runs no commands, writes nothing and does not wait";

INSTANTIATE_TEST_SUITE_P(
    All, RefusedFile,
    testing::Values(
        Refused{"system_call.geo", in_scene + "\"system_call.geo\"" + runs_a_command},
        Refused{"external_field.geo", in_scene + "\"external_field.geo\"" + runs_a_command},
        Refused{"ends_the_program.geo",
                in_scene + "\"ends_the_program.geo\", which ends Gmsh before there is a mesh"},
        Refused{"includes_a_command.geo", in_scene + "\"includes_a_command.geo\"" + runs_a_command},
        Refused{"with_options.msh", in_scene + "\"with_options.msh\"" + runs_a_command},
        Refused{
            "writes_a_file.geo",
            in_scene + "\"writes_a_file.geo\", which has Gmsh write the file \"written.txt\"; "},
        Refused{"computed_include.geo", in_scene + "\"computed_include.geo\"" + runs_a_command},
        Refused{"missing_include.geo",
                in_scene + "\"missing_include.geo\", of which Gmsh says: Unable to open file "
                           "'nowhere.step'; expected a geometry that Gmsh can mesh"},
        Refused{"not_a_mesh.msh", in_scene + "\"not_a_mesh.msh\"" + runs_a_command},
        Refused{"no_physical_surface.geo",
                in_scene +
                    "\"no_physical_surface.geo\" with no named physical surface; expected "
                    "each region as a physical surface, as in Physical Surface(\"specimen\") "
                    "= {1}; the model has\n    surface 1: x 0 to 1, y 0 to 1\n    curve 1: "
                    "x 0 to 1, y 0 to 0\n"},
        Refused{"unnamed_region.msh",
                in_scene +
                    "\"unnamed_region.msh\" with physical surface 7 without a name; expected "
                    "a name, as in Physical Surface(\"name\") = {...};"},
        Refused{"empty.geo", in_scene + "\"empty.geo\" with no named physical surface; expected "},
        Refused{"open_loop.geo",
                in_scene + "\"open_loop.geo\", of which Gmsh says: The 1D mesh seems not to be "
                           "forming a closed loop"},
        Refused{"crossing.geo",
                in_scene + "\"crossing.geo\" with curves 2 and 4 that meet at (1, 0.5); expected "
                           "curves that meet at points of both alone: split them there, or use "
                           "BooleanFragments"},
        Refused{"touching.geo", in_scene + "\"touching.geo\" with curves 1 and "},
        Refused{"second_order.geo",
                in_scene + "\"second_order.geo\" with element 1 (Triangle 6) at ("},
        Refused{"quadrilateral.msh",
                in_scene + "\"quadrilateral.msh\" with element 1 (Quadrilateral 4) at (0.5, 0.5); "
                           "expected triangles of three nodes (in Gmsh: Mesh.ElementOrder = 1, no "
                           "Recombine)"},
        Refused{"volume.geo", in_scene +
                                  "\"volume.geo\" with no named physical volume; expected each "
                                  "region as a physical volume, as in Physical "
                                  "Volume(\"specimen\") = {1}; the model has\n    volume 1: "
                                  "x 0 to 1, y 0 to 1, z 0 to 1\n    surface 1: x 0 to 1"},
        Refused{"flat.msh", in_scene + "\"flat.msh\" with element 3, flat, with its nodes at (0, "
                                       "0), (0.5, 0.5), (1, 1); expected triangles with an area"},
        Refused{"folded.msh",
                in_scene +
                    "\"folded.msh\" with elements 1 and 2, on the same side of the edge from "
                    "(1, 1) to (0, 0); expected triangles that do not overlap: the mesh is "
                    "folded or has one twice"},
        Refused{"out_of_plane.msh", in_scene + "\"out_of_plane.msh\" with node 4 at (0, 1, 0.25); "
                                               "expected a mesh in the plane z = 0"},
        Refused{"duplicate_nodes.msh",
                in_scene + "\"duplicate_nodes.msh\" with nodes 1 and 5, both at (0, 0); expected "
                           "one node per place, so that neighbours are connected"},
        Refused{"unconnected.geo",
                in_scene + "\"unconnected.geo\" with nodes 2 and 5, both at (1, 0); expected one "
                           "node per place"},
        Refused{"partly_unassigned.msh",
                in_scene +
                    "\"partly_unassigned.msh\" with surface 2 (1 triangles, one of them 2 at "
                    "(0.333333, 0.666667)) in no physical surface; expected every triangle "
                    "in one region"},
        Refused{"two_surfaces.geo", in_scene + "\"two_surfaces.geo\" with surface 1 ("},
        Refused{"empty_groups.msh",
                in_scene +
                    "\"empty_groups.msh\" with physical surface \"clay\" without triangles; "
                    "expected a region that is not empty\n" +
                    in_scene +
                    "\"empty_groups.msh\" with physical curve \"top\" without edges; expected a "
                    "boundary that is not empty\n"},
        Refused{"interior_curve.geo",
                in_scene + "\"interior_curve.geo\" with physical curve \"top\" with an edge at "
                           "(0.5, 0.5) that lies inside the mesh; expected a boundary of outer "
                           "edges only"},
        Refused{"foreign_edge.msh",
                in_scene + "\"foreign_edge.msh\" with physical curve \"top\" with an edge at (0, "
                           "1.5) that no triangle has; expected a boundary of outer edges only"},
        Refused{"two_regions.geo",
                "scene.toml:17: soil.specimen: got \"specimen\"; expected a region of the mesh: "
                "\"sand\" or \"gravel\"\nscene.toml:17: soil.sand: got nothing; expected a table "
                "[soil.sand] for the mesh's region of that name; the soils are \"specimen\"\n"}),
    [](const auto& tested) {
      std::string name = tested.param.file;
      std::ranges::replace(name, '.', '_');
      return name;
    });

/// A square of two triangles; `change` damages it.
struct DamagedMesh {
  std::string name;
  std::string replace;
  std::string by;
  std::string message;  // follows `geometry.file: got `; empty: the mesh is accepted
};

void PrintTo(const DamagedMesh& damage, std::ostream* stream) {
  *stream << damage.name;
}

const std::string mesh_22 =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 1 \"specimen\"\n1 2 \"top\"\n"
    "$EndPhysicalNames\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n"
    "$Elements\n3\n1 2 2 1 1 1 2 3\n2 2 2 1 1 1 3 4\n3 1 2 2 3 3 4\n$EndElements\n";

const std::string mesh_41 =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 1 \"specimen\"\n1 2 \"top\"\n"
    "$EndPhysicalNames\n$Entities\n0 1 1 0\n3 0 1 0 1 1 0 1 2 0\n1 0 0 0 1 1 0 1 1 0\n"
    "$EndEntities\n$Nodes\n1 4 1 4\n2 1 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n$EndNodes\n"
    "$Elements\n2 3 1 3\n2 1 2 2\n1 1 2 3\n2 1 3 4\n1 3 1 1\n3 3 4\n$EndElements\n";

class DamagedMeshFile : public UserFile, public testing::WithParamInterface<DamagedMesh> {
 protected:
  void expect(const std::string& mesh) {
    const DamagedMesh& damage = GetParam();
    folder_.write("damaged.msh", changed(mesh, damage.replace, damage.by));
    if (damage.message.empty()) {
      EXPECT_EQ(build_file("damaged.msh").mesh.element_count(), 2);
      return;
    }
    const std::string message = refusal_of("damaged.msh");
    const std::string expected = in_scene + "\"damaged.msh\"" + damage.message;
    EXPECT_EQ(message.substr(0, expected.size()), expected) << message;
    EXPECT_EQ(folder_.count(), files_ + 1);
  }
};

const std::string gmsh_says = ", of which Gmsh says: ";
const std::string gmsh_ends = ", over which Gmsh ";

class DamagedMesh22 : public DamagedMeshFile {};

TEST_P(DamagedMesh22, IsRefusedOrTaken) {
  expect(mesh_22);
}

INSTANTIATE_TEST_SUITE_P(
    All, DamagedMesh22,
    testing::Values(
        DamagedMesh{"None", "2.2", "2.2", ""}, DamagedMesh{"Windows", "8\n$End", "8\r\n$End", ""},
        DamagedMesh{"UnusedNode", "4\n1 0 0 0", "5\n9 7 7 0\n1 0 0 0", ""},
        DamagedMesh{"TagsFarApart",
                    "4 0 1 0\n$EndNodes\n$Elements\n3\n1 2 2 1 1 1 2 3\n2 2 2 1 1 1 "
                    "3 4\n3 1 2 2 3 3 4",
                    "2000000000 0 1 0\n$EndNodes\n$Elements\n3\n1 2 2 1 1 1 2 3\n2 2 2 1 1 1 3 "
                    "2000000000\n3 1 2 2 3 3 2000000000",
                    ""},
        DamagedMesh{"NotANumber", "3 1 1 0", "3 nan 1 0",
                    " with node 3 at (nan, 1, 0); expected finite coordinates, in m, below 1e+50"},
        DamagedMesh{"Infinite", "3 1 1 0", "3 1 -inf 0", " with node 3 at (1, -inf, 0); expected"},
        DamagedMesh{"FarAway", "3 1 1 0", "3 1e300 1 0",
                    " with node 3 at (1e+300, 1, 0); expected"},
        DamagedMesh{"NoNumber", "3 1 1 0", "3 x 1 0", gmsh_says + "Error loading"},
        DamagedMesh{"NoSuchNode", "1 1 1 2 3", "1 1 1 2 9", gmsh_says + "Wrong node index 9"},
        DamagedMesh{"NegativeNode", "1 1 1 2 3", "1 1 1 2 -3", gmsh_says + "Wrong node index -3"},
        DamagedMesh{"SameNodeTwice", "1 1 1 2 3", "1 1 1 2 2", " with element 1, flat"},
        DamagedMesh{"TwiceTheSame", "2 2 2 1 1 1 3 4", "2 2 2 1 1 1 2 3",
                    " with elements 1 and 2, on the same side of the edge"},
        DamagedMesh{"UnknownType", "1 2 2 1 1 1 2 3", "1 999 2 1 1 1 2 3",
                    gmsh_says + "Unknown type of element 999"},
        DamagedMesh{"ManyNodes", "$Nodes\n4", "$Nodes\n99999999999", gmsh_says},
        DamagedMesh{"ManyElements", "$Elements\n3", "$Elements\n2000000000", gmsh_says},
        DamagedMesh{"ManyTags", "1 2 2 1 1 1 2 3", "1 2 2000000000 1 1 1 2 3", gmsh_says},
        DamagedMesh{"NoNodes", "4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n", "0\n",
                    gmsh_says + "Wrong node index 1"},
        DamagedMesh{"NoNames", "2\n2 1 \"specimen\"\n1 2 \"top\"\n", "0\n",
                    " with physical surface 1 without a name"},
        DamagedMesh{"Nul", "top", std::string("t\0p", 3),
                    " with physical curve 2 with a name that is no plain text; expected a name in "
                    "UTF-8 of at most 127 bytes, without control characters"},
        DamagedMesh{"Escape", "top", "t\x1b[2J", " with physical curve 2 with a name that is no"},
        DamagedMesh{"Latin1", "top", "B\xf6schung",
                    " with physical curve 2 with a name that is no"},
        DamagedMesh{"LongName", "top", std::string(100000, 't'),
                    " with physical curve 2 with a name that is no plain text"},
        DamagedMesh{
            "HangingNode", "4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n$Elements\n3\n",
            "7\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 2 0 0\n6 2 1 0\n7 1 .5 0\n"
            "$EndNodes\n$Elements\n6\n4 2 2 1 1 2 5 7\n5 2 2 1 1 7 5 6\n6 2 2 1 1 7 6 3\n",
            " with node 7 at (1, 0.5) on the edge of element 1 from (1, 0) to (1, 1); expected "
            "neighbours that share whole edges"},
        DamagedMesh{
            "PartsThatCross", "4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n$Elements\n3\n",
            "7\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 .2 -1 0\n6 .4 -1 0\n7 .3 2 0\n"
            "$EndNodes\n$Elements\n4\n4 2 2 1 1 5 6 7\n",
            " with elements 1 and 4, whose edges from (0, 0) to (1, 0) and from (0.2, -1) to "
            "(0.3, 2) cross; expected parts that do not lie on each other"},
        DamagedMesh{"APartWithin",
                    "4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n$Elements\n3\n",
                    "7\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 .5 .1 0\n6 .7 .1 0\n7 .6 .2 0\n"
                    "$EndNodes\n$Elements\n4\n4 2 2 1 1 5 6 7\n",
                    " with node 5 at (0.5, 0.1) within element 1 of another part; expected parts "
                    "that do not lie on each other"},
        DamagedMesh{"Quadrangle",
                    "4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n$Elements\n3\n",
                    "6\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 2 0 0\n6 2 1 0\n$EndNodes\n"
                    "$Elements\n4\n4 3 2 1 1 2 5 6 3\n",
                    " with element 4 (Quadrilateral 4) at (1.5, 0.5); expected triangles"},
        DamagedMesh{"NewVersion", "2.2 0 8", "9.9 0 8",
                    gmsh_says + "Unknown MSH file version 9.9"}),
    [](const auto& tested) { return tested.param.name; });

class DamagedMesh41 : public DamagedMeshFile {};

TEST_P(DamagedMesh41, IsRefusedOrTaken) {
  expect(mesh_41);
}

INSTANTIATE_TEST_SUITE_P(
    All, DamagedMesh41,
    testing::Values(
        DamagedMesh{"None", "4.1", "4.1", ""},
        DamagedMesh{"NoSuchNode", "\n1 1 2 3\n", "\n1 1 2 9\n", gmsh_says + "Unknown node 9"},
        DamagedMesh{"ManyNodes", "$Nodes\n1 4", "$Nodes\n1 4000000000000", gmsh_ends},
        DamagedMesh{"ManyInABlock", "2 1 0 4\n", "2 1 0 4000000000000\n", gmsh_ends},
        DamagedMesh{"ManyElements", "$Elements\n2 3", "$Elements\n2 3000000000000", gmsh_ends},
        DamagedMesh{"NoSuchDimension", "2 1 0 4\n", "7 1 0 4\n", gmsh_says},
        DamagedMesh{"TwoGroups", "1 1 0 1 1 0\n$EndE", "1 1 0 2 1 5 0\n$EndE",
                    " with physical surface 5 without a name"}),
    [](const auto& tested) { return tested.param.name; });

/// The same square in Gmsh's binary form.
std::string binary_mesh() {
  std::string text = "$MeshFormat\n2.2 1 8\n";
  const auto add = [&text](const auto value) {
    text.append(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  add(1);
  text +=
      "\n$EndMeshFormat\n$PhysicalNames\n2\n2 1 \"specimen\"\n1 2 \"top\"\n$EndPhysicalNames\n"
      "$Nodes\n4\n";
  constexpr std::array<std::array<double, 2>, 4> nodes{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  for (int n = 0; n < 4; ++n) {
    add(n + 1);
    for (const double x : {nodes.at(n)[0], nodes.at(n)[1], 0.0}) add(x);
  }
  text += "\n$EndNodes\n$Elements\n3\n";
  for (const int word : {2, 2, 2, 1, 1, 1, 1, 2, 3, 2, 1, 1, 1, 3, 4}) add(word);
  for (const int word : {1, 1, 2, 3, 2, 3, 3, 4}) add(word);
  return text + "\n$EndElements\n";
}

TEST_F(UserFile, ABinaryMeshIsReadToo) {
  folder_.write("binary.msh", binary_mesh());
  EXPECT_EQ(build_file("binary.msh").mesh.element_count(), 2);
}

TEST_F(UserFile, ATruncatedOrDamagedMeshIsRefusedOrWhole) {
  for (const std::string& whole : {mesh_22, mesh_41, binary_mesh()}) {
    // The mesh is complete without the last line.
    for (std::size_t length = 15; length < whole.size() - 14; length += 41) {
      folder_.write("cut.msh", whole.substr(0, length));
      EXPECT_NE(refusal_of("cut.msh"), "nothing refused") << length;
    }
  }
  const std::string whole = binary_mesh();
  for (std::size_t at = 20; at < whole.size(); at += 29) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x55);
    folder_.write("damaged.msh", damaged);
    static_cast<void>(refusal_of("damaged.msh"));  // Gmsh 4.8 crashes over some
  }
}

TEST(GmshSession, RunsOutOfMemoryWithAComplaint) {
  const GmshSession session;
  EXPECT_EQ(gmsh_complaint([] { throw std::bad_alloc(); }), "not enough memory");
}

TEST_F(UserFile, AMissingFileIsAFileError) {
  try {
    build_file("nowhere.geo");
    FAIL();
  } catch (const FileError& error) {
    EXPECT_EQ(error.what(), folder_.file("scene.toml") + ":4: geometry.file: there is no file " +
                                folder_.file("nowhere.geo"));
  }
}

TEST_F(UserFile, MeshSizeIsTheDefaultAndTheUpperBound) {
  EXPECT_EQ(build_file("square.geo", "1.0").mesh.boundaries[0].faces.size(), 1U);
  EXPECT_EQ(build_file("square.geo", "0.5").mesh.boundaries[0].faces.size(), 2U);
  EXPECT_EQ(build_file("square.geo", "0.05").mesh.boundaries[0].faces.size(), 20U);
}

TEST_F(UserFile, CrossedCutsEveryQuadrangleAlongItsDiagonals) {
  const Mesh<2> mesh = build_file("square.geo", "0.1", "", "crossed").mesh;
  EXPECT_EQ(boundary(mesh, "top").faces.size(), 10U);
  // Every triangle belongs to one crossing.
  EXPECT_EQ(4 * diagonal_crossings(mesh), mesh.element_count());
  EXPECT_NEAR(areas_by_region(mesh)[0], 1.0, 1e-12);
  EXPECT_GT(smallest_angle(mesh), 15.0);
}

TEST_F(UserFile, SizeFieldsOfTheFileHold) {
  const std::string soils =
      "[soil.sand]\nporosity = 0.3\nskeleton_fraction = 0.6\ngrain_density = 2700.0\n"
      "conductivity = 2.0e-2\n[soil.gravel]\nporosity = 0.3\nskeleton_fraction = 0.6\n"
      "grain_density = 2700.0\nconductivity = 2.0e-2\n";
  std::string text =
      scene_text("[geometry]\nfile = \"two_regions.geo\"\n[mesh]\nsize = 0.5\n", soils);
  text.replace(text.find("[soil.specimen]"),
               text.find("[soil.sand]") - text.find("[soil.specimen]"), "");
  const Mesh<2> mesh = build_geometry_of<2>(parse_scene(text, folder_.file("scene.toml"))).mesh;
  EXPECT_EQ(mesh.region_names, (std::vector<std::string>{"sand", "gravel"}));
  const std::vector<double> areas = areas_by_region(mesh);
  EXPECT_NEAR(areas[0], 1.0, 1e-12);
  EXPECT_NEAR(areas[1], 1.0, 1e-12);
  EXPECT_EQ(boundary(mesh, "outlet").faces.size(), 10U);
  EXPECT_EQ(boundary(mesh, "inlet").faces.size(), 2U);
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (mesh.element_region[e] == 0) continue;
    EXPECT_LT(longest_edge(mesh, e), 0.2);
  }
}

const std::string pile_and_wells =
    "[[wall]]\non = \"pile\"\n[[well]]\non = \"drain\"\nhead = 0.0\n"
    "[[well]]\non = \"pump\"\nhead = -1.0\n";

double length_of(const Mesh<2>& mesh, const BoundarySet<2>& set) {
  double length = 0.0;
  for (const auto& face : set.faces) length += (mesh.nodes[face[0]] - mesh.nodes[face[1]]).norm();
  return length;
}

TEST_F(UserFile, IsCutAlongWallsAndWells) {
  for (const std::string structure : {"free", "crossed"}) {
    const Geometry<2> geometry = build_file("sheet_pile.geo", "0.25", pile_and_wells, structure);
    const Mesh<2>& mesh = geometry.mesh;
    for (const std::string name : {"pile", "drain", "pump"}) {
      EXPECT_TRUE(is_slit(mesh, boundary(mesh, name))) << name << ", " << structure;
    }
    EXPECT_FALSE(is_slit(mesh, boundary(mesh, "left")));
    EXPECT_NEAR(length_of(mesh, boundary(mesh, "pile")), 2.0, 1e-12);
    EXPECT_NEAR(length_of(mesh, boundary(mesh, "drain")), std::sqrt(2.0), 1e-12);
    EXPECT_EQ(boundary(mesh, "pump").faces.size(), 4U);
    EXPECT_NEAR(length_of(mesh, boundary(mesh, "right")), 4.0, 1e-12);
    for (const auto& face : boundary(mesh, "pile").faces) {
      EXPECT_NEAR(mesh.nodes[face[0]][0], 0.0, 1e-12);
      EXPECT_GE(mesh.nodes[face[0]][1], -1.0 - 1e-12);
    }
    const Vector<2> well(1.0, -0.5);
    double nearest = 1.0;
    for (const auto& face : boundary(mesh, "pump").faces) {
      for (const int node : face) nearest = std::min(nearest, (mesh.nodes[node] - well).norm());
    }
    EXPECT_LT(nearest, 1e-12);
    EXPECT_NEAR(areas_by_region(mesh)[0], 8.0, 1e-9);
    EXPECT_EQ(geometry.notes,
              std::vector<std::string>{"the curve \"old\" lies inside the mesh and no wall or well "
                                       "names it: it does nothing"});
  }
}

TEST_F(UserFile, WithCurvesInsideIsWhatItIsWithoutWhereNothingNamesThem) {
  const Geometry<2> geometry = build_file("sheet_pile.geo", "0.25");
  EXPECT_EQ(geometry.mesh.boundaries.size(), 2U);
  EXPECT_EQ(geometry.notes.size(), 3U);
}

/// Beyond walls where nothing set a level, steady water had any pressure, and nothing said so.
TEST_F(UserFile, EachPartThatWallsCutOffNeedsALevelForASteadyStart) {
  const auto build = [&](const std::string& more) {
    build_geometry_of<2>(
        parse_scene(scene_text("[geometry]\nfile = \"divided.geo\"\n[mesh]\nsize = 0.5\n",
                               "[[boundary]]\non = \"top_left\"\nhead = 2.0\n" + more),
                    folder_.file("scene.toml"),
                    {"gravity=[0.0, -9.81]", "initial.flow=steady", "time.scheme=implicit"}));
  };
  const std::string upper = "[[wall]]\non = \"upper\"\n";
  const std::string lower = "[[wall]]\non = \"lower\"\n";
  const std::string message = refusal([&] { build(upper + lower); });
  const std::string found =
      "initial.flow: got \"steady\" where nothing sets the level of the water in the part of the "
      "mesh around (1.";
  EXPECT_NE(message.find(found), std::string::npos) << message;
  EXPECT_NO_THROW(build(upper));
  EXPECT_NO_THROW(build(upper + lower + "conductance = 1e-9\n"));
  EXPECT_NO_THROW(build(upper + lower + "[[boundary]]\non = \"top_right\"\nrain = 1e-7\n"));
}

TEST_F(UserFile, WrongNamesOfWallsAndWellsAreRefused) {
  const auto message = [&](const std::string& more, const std::string& size = "0.25") {
    return refusal([&] { build_file("sheet_pile.geo", size, more); });
  };
  const auto expect = [&](const std::string& more, const std::string& end,
                          const std::string& size = "0.25") {
    const std::string found = message(more, size);
    EXPECT_TRUE(found.ends_with(end)) << found;
    EXPECT_EQ(std::ranges::count(found, '\n'), 0) << found;
  };
  expect("[[wall]]\non = \"pyle\"\n",
         "wall[0].on: got \"pyle\"; expected a curve inside the mesh: \"pile\", \"drain\" or "
         "\"old\"; did you mean \"pile\"?");
  expect("[[wall]]\non = \"left\"\n",
         "wall[0].on: got \"left\", an outer boundary; expected a curve inside the mesh: \"pile\", "
         "\"drain\" or \"old\"");
  expect("[[well]]\non = \"pumpe\"\nhead = 0\n",
         "well[0].on: got \"pumpe\"; expected a curve or a point inside the mesh: \"pile\", "
         "\"drain\", \"old\", \"pump\", \"recharge\" or \"corner\"; did you mean \"pump\"?");
  expect("[[wall]]\non = \"pump\"\n",
         "wall[0].on: got \"pump\", a point; expected a curve inside the mesh");
  expect("[[boundary]]\non = \"pile\"\npressure = 0\n",
         "boundary[0].on: got \"pile\", which lies inside the mesh; expected a boundary of the "
         "mesh: \"right\" or \"left\"; what lies inside is for [[wall]] and [[well]]");
  expect("[[well]]\non = \"corner\"\nhead = 0\n",
         "well[0].on: got \"corner\", a point at (2, 0) without two inner edges that no wall and "
         "no other well has; expected a point in the soil, two elements or more off walls, wells "
         "and boundaries");
  expect("[[well]]\non = \"drain\"\nhead = 0\n",
         "well[0].on: got \"drain\" with a single edge, at (1.25, -1.25), between two ends in the "
         "soil; expected a curve of at least two edges: a smaller mesh.size there",
         "5.0");
}

TEST_F(UserFile, ProbesAndSectionsLieInTheMesh) {
  const std::string message = refusal([&] {
    build_file("sheet_pile.geo", "0.25",
               "[[output.probe]]\nat = [0.5, -0.5]\n[[output.probe]]\nat = [2.0, 0.0]\n"
               "[[output.probe]]\nat = [0.5, 0.5]\n"
               "[[output.section]]\nfrom = [-3, -1]\nto = [3, -1]\n"
               "[[output.section]]\nfrom = [-3, 1]\nto = [3, 0.5]\n"
               "[[output.section]]\nfrom = [1, -1, 0.1]\nto = [1.1, -1]\n");
  });
  const std::string box = ", which lies between (-2, -2) and (2, 0)";
  EXPECT_NE(message.find("output.probe[2].at: got (0.5, 0.5); expected a point of the mesh" + box),
            std::string::npos)
      << message;
  EXPECT_NE(message.find("output.section[1]: got a line from (-3, 1) to (3, 0.5); expected a line "
                         "that meets the mesh" +
                         box),
            std::string::npos)
      << message;
  EXPECT_NE(message.find("output.section[2].from: got a third number, 0.1; expected two numbers"),
            std::string::npos)
      << message;
  EXPECT_EQ(std::ranges::count(message, '\n'), 2) << message;
}

TEST_F(UserFile, HeadsOfTheExplicitSchemeStayAboveTheirBoundary) {
  const auto with_head = [](const std::string& head, const std::string& more = "") {
    return "[[boundary]]\non = \"left\"\nhead = " + head + "\n" + more;
  };
  const auto build_with = [&](const std::string& more, const std::string& scheme) {
    return build_geometry_of<2>(
        parse_scene(scene_text("[geometry]\nfile = \"sheet_pile.geo\"\n[mesh]\nsize = 0.5\n", more),
                    folder_.file("scene.toml"),
                    {"gravity=[0,-10]", "initial.flow=steady", "time.scheme=" + scheme}));
  };
  const std::string falling = "[[0, 2], [0.5, -0.5], [1, 2]]";
  const std::string message = refusal([&] { build_with(with_head(falling), "explicit"); });
  EXPECT_TRUE(
      message.ends_with("boundary[0].head: got a head of -0.5 m with scheme = \"explicit\"; "
                        "expected a head above 0 m, "
                        "the highest face of \"left\", at all times, or scheme = \"implicit\": "
                        "what is above the water "
                        "changes there"))
      << message;
  const auto areas_with = [&](const std::string& more, const std::string& scheme) {
    return areas_by_region(build_with(more, scheme).mesh);
  };
  for (const std::vector<double>& areas :
       {areas_with(with_head(falling), "implicit"),
        areas_with(with_head(falling, "dry = \"suction\"\n"), "explicit"),
        areas_with(with_head("[[0, 2], [1, 0.5], [2, -1]]"), "explicit")}) {
    ASSERT_EQ(areas.size(), 1U);
    EXPECT_NEAR(areas[0], 8.0, 1e-12);
  }
}

TEST_F(UserFile, AThirdDirectionIsRefusedInThePlane) {
  const std::string text =
      "gravity = [0.0, 0.0, -9.81]\n" +
      scene_text("[geometry]\nfile = \"square.geo\"\n[mesh]\nsize = 0.5\n",
                 "porosity_gradient = [0.0, 0.0, 0.1]\nporosity_origin = [0.0, 0.0, 1.0]\n");
  const SceneDocument scene =
      parse_scene(text, folder_.file("scene.toml"), {"initial.water_level=1"});
  std::string message = refusal([&] { build_geometry_of<2>(scene); });
  for (const auto& [key, value] : {std::pair{"gravity", "-9.81"},
                                   {"soil.specimen.porosity_gradient", "0.1"},
                                   {"soil.specimen.porosity_origin", "1"}}) {
    EXPECT_NE(message.find(std::string(": ") + key + ": got a third number, " + value +
                           "; expected two numbers: the mesh is two-dimensional"),
              std::string::npos)
        << message;
  }
}

TEST_F(UserFile, ALoadInSpaceHasThreeNumbers) {
  const auto message = [](const std::string& traction) {
    const SceneDocument scene = parse_scene(
        scene_text("[geometry]\nshape = \"box\"\nwidth = 1.0\ndepth = 1.0\nheight = 1.0\n"
                   "[mesh]\nsize = 0.5\n",
                   "skeleton = { law = \"elastic\", young = 1e7, poisson = 0.3 }\n") +
            "[[boundary]]\non = \"top\"\ntraction = " + traction + "\n",
        "scene.toml", {"time.scheme=implicit"});
    return refusal([&] { build_geometry_of<3>(scene); });
  };
  for (const char* plane : {"[0.0, -1e3]", "[[0.0, 0.0, 0.0], [10.0, 0.0, -1e3]]"}) {
    EXPECT_NE(message(plane).find("boundary[0].traction: got two numbers, of x and y; expected "
                                  "three numbers: the mesh is three-dimensional"),
              std::string::npos)
        << message(plane);
  }
  EXPECT_EQ(message("[0.0, 0.0, -1e3]"), "nothing refused");
}

TEST_F(UserFile, APlaceInSpaceHasThreeNumbers) {
  const auto message = [](const std::string& more) {
    const SceneDocument scene = parse_scene(
        "gravity = [0.0" + more + ", -9.81]\n" +
            scene_text("[geometry]\nshape = \"box\"\nwidth = 1.0\ndepth = 1.0\nheight = 1.0\n"
                       "[mesh]\nsize = 0.5\n",
                       "porosity_gradient = [0.0, 0.01" + more + "]\n") +
            "[[output.probe]]\nat = [0.5, 0.5" + more + "]\n",
        "scene.toml", {"time.scheme=implicit", "initial.water_level=1"});
    return refusal([&] { build_geometry_of<3>(scene); });
  };
  for (const std::string key :
       {"gravity", "soil.specimen.porosity_gradient", "output.probe[0].at"}) {
    EXPECT_NE(message("").find(key + ": got two numbers, of x and y; expected three numbers: the "
                                     "mesh is three-dimensional"),
              std::string::npos)
        << message("");
  }
  EXPECT_EQ(message(", 0.0"), "nothing refused");
}

TEST_F(UserFile, OneEdgeTakesOneCondition) {
  const std::string both =
      "[[boundary]]\non = \"all\"\npressure = 0.0\n[[boundary]]\non = \"top\"\npressure = 1.0\n";
  const std::string message = refusal([&] { build_file("shared_edge.geo", "1.0", both); });
  EXPECT_NE(
      message.find("boundary[1].on: got \"top\"; expected a boundary that shares no face with "
                   "\"all\"; both have the one at (0.5, 1)"),
      std::string::npos)
      << message;
  EXPECT_EQ(build_file("shared_edge.geo", "1.0", both.substr(0, both.find("[[", 2)))
                .mesh.boundaries.size(),
            2U);
}

TEST_F(UserFile, AMeshIsUsedAsItIs) {
  const Geometry<2> geometry = build_file("square.msh");
  // In the order of `in_hilbert_order`: the upper one of its two triangles comes first.
  EXPECT_EQ(geometry.mesh.nodes, (std::vector<Vector<2>>{{0, 0}, {1, 1}, {0, 1}, {1, 0}}));
  EXPECT_EQ(geometry.mesh.elements, (std::vector<std::array<int, 3>>{{0, 1, 2}, {0, 3, 1}}));
  EXPECT_TRUE(geometry.notes.empty());
}

TEST_F(UserFile, IsInTheOrderOfHilbertsCurve) {
  expect_order(build_file("square.geo", "0.1").mesh);
  expect_order(build_file("meshes_itself.geo").mesh);
}

TEST_F(UserFile, ClockwiseTrianglesAreTurnedRound) {
  const Geometry<2> geometry = build_file("clockwise.msh");
  EXPECT_NEAR(areas_by_region(geometry.mesh)[0], 1.0, 1e-15);
  EXPECT_EQ(geometry.notes, std::vector<std::string>{"1 clockwise triangles were turned round"});
}

TEST_F(UserFile, AFileThatMeshesItselfIsLeftAlone) {
  const Geometry<2> geometry = build_file("meshes_itself.geo", "0.05");
  EXPECT_GT(longest_edge(geometry.mesh, 0), 0.08);
  EXPECT_EQ(geometry.notes,
            std::vector<std::string>{"the .geo file meshes itself, mesh.size does not apply"});
}

/// Two squares of 1000 mm side by side, as a CAD program would name them.
void write_step(const std::string& path, const std::vector<std::string>& names) {
  {
    const GmshSession session;
    gmsh::option::setString("Geometry.OCCTargetUnit", "MM");  // OCC keeps the unit of the last run
    gmsh::model::occ::addRectangle(0, 0, 0, 1000, 1000);
    gmsh::model::occ::addRectangle(1000, 0, 0, 1000, 1000);
    gmsh::model::occ::synchronize();
    gmsh::write(path);
  }
  std::string text = test::read_file(path);
  for (std::size_t i = 0; i < names.size(); ++i) {
    // 'Open CASCADE STEP translator 7.6 1.1' and so on
    const std::string end = "." + std::to_string(i + 1) + "'";
    for (std::size_t at = text.find(end); at != std::string::npos; at = text.find(end, at + 1)) {
      const std::size_t start = text.rfind('\'', at);
      if (text.compare(start + 1, 12, "Open CASCADE") != 0) continue;
      text.replace(start + 1, at + end.size() - start - 2, names[i]);
      at = start;
    }
  }
  std::ofstream(path, std::ios::binary) << text;
}

TEST_F(UserFile, StepShapesAreRegionsByTheirNamesInMetresAndConnected) {
  write_step(folder_.file("two.step"), {"specimen", "gravel"});
  const Geometry<2> geometry =
      build_file("two.step", "0.25",
                 "[soil.gravel]\nporosity = 0.3\nskeleton_fraction = 0.6\ngrain_density = 2700.0\n"
                 "conductivity = 2.0e-2\n");
  EXPECT_EQ(
      std::set<std::string>(geometry.mesh.region_names.begin(), geometry.mesh.region_names.end()),
      (std::set<std::string>{"specimen", "gravel"}));
  for (double area : areas_by_region(geometry.mesh)) EXPECT_NEAR(area, 1.0, 1e-9);
}

TEST_F(UserFile, StepWithoutNamesSaysWhatIsNeeded) {
  write_step(folder_.file("two.step"), {});
  const std::string message = refusal_of("two.step");
  EXPECT_NE(message.find("surface 2: x 1 to 2, y 0 to 1"), std::string::npos) << message;
  EXPECT_NE(message.find("Merge \"two.step\"; Physical Surface(\"specimen\") = {1};"),
            std::string::npos)
      << message;
}

TEST_F(UserFile, AGeoFileCanNameTheSurfacesOfAStepFile) {
  write_step(folder_.file("two.step"), {});
  folder_.write("names.geo",
                "SetFactory(\"OpenCASCADE\");\nGeometry.OCCTargetUnit = \"M\";\n"
                "Merge \"two.step\";\nCoherence;\nPhysical Surface(\"specimen\") = {1, 2};\n"
                "Physical Curve(\"bottom\") = Curve In BoundingBox {-1, -0.1, -1, 3, 0.1, 1};\n");
  const Mesh<2> mesh = build_file("names.geo", "0.25").mesh;
  EXPECT_NEAR(areas_by_region(mesh)[0], 2.0, 1e-9);
  EXPECT_EQ(boundary(mesh, "bottom").faces.size(), 8U);
}

TEST(GmshExport, ReopensWithItsGroupsAndColours) {
  const TemporaryFolder folder;
  Mesh<2> mesh = build(test::unit_column).mesh;
  mesh.region_names.push_back("gravel");
  for (int e = 20; e < 32; ++e) mesh.element_region[e] = 1;
  const std::string path = folder.file("a.msh");
  write_gmsh(path, mesh);
  EXPECT_EQ(folder.count(), 2);  // with a.msh.opt
  EXPECT_EQ(test::read_file(path).substr(0, 15), "$MeshFormat\n4.1");

  const GmshSession session;
  gmsh::open(path);
  std::map<std::string, std::size_t> counts;
  std::set<std::array<int, 3>> colours;
  for (int dimension : {1, 2}) {
    gmsh::vectorpair groups;
    gmsh::model::getPhysicalGroups(groups, dimension);
    for (const auto& [ignored, tag] : groups) {
      std::string name;
      gmsh::model::getPhysicalName(dimension, tag, name);
      std::vector<int> entities;
      gmsh::model::getEntitiesForPhysicalGroup(dimension, tag, entities);
      ASSERT_EQ(entities.size(), 1U);
      std::vector<int> types;
      std::vector<std::vector<std::size_t>> tags;
      std::vector<std::vector<std::size_t>> nodes;
      gmsh::model::mesh::getElements(types, tags, nodes, dimension, entities[0]);
      counts[name] = tags.at(0).size();
      if (dimension == 1) continue;
      std::array<int, 3> colour{};
      int opacity = 0;
      gmsh::model::getColor(2, entities[0], colour[0], colour[1], colour[2], opacity);
      colours.insert(colour);
    }
  }
  EXPECT_EQ(
      counts,
      (std::map<std::string, std::size_t>{
          {"specimen", 20}, {"gravel", 12}, {"top", 4}, {"bottom", 4}, {"left", 4}, {"right", 4}}));
  EXPECT_EQ(colours, (std::set<std::array<int, 3>>{{230, 159, 0}, {86, 180, 233}}));
}

TEST(GmshExport, CountsFromOneWhatTheCaseCountsFromZero) {
  const TemporaryFolder folder;
  const Mesh<2> mesh = build_layers(test::unit_column, all_layers, buffer).mesh;
  write_gmsh(folder.file("a.msh"), mesh);
  const GmshSession session;
  gmsh::open(folder.file("a.msh"));
  for (int e = 0; e < mesh.element_count(); ++e) {
    int type = 0;
    std::vector<std::size_t> nodes;
    gmsh::model::mesh::getElement(static_cast<std::size_t>(e) + 1, type, nodes);
    for (std::size_t& node : nodes) --node;
    EXPECT_EQ(nodes, std::vector<std::size_t>(mesh.elements[e].begin(), mesh.elements[e].end()));
  }
  for (int n = 0; n < mesh.node_count(); ++n) {
    std::vector<double> x;
    std::vector<double> parameters;
    gmsh::model::mesh::getNode(static_cast<std::size_t>(n) + 1, x, parameters);
    EXPECT_EQ(Vector<2>(x[0], x[1]), mesh.nodes[n]);
  }
}

TEST(GmshExport, OfLayersServesAsAGeometry) {
  const TemporaryFolder folder;
  const Mesh<2> mesh = build_layers(test::unit_column, all_layers, buffer).mesh;
  write_gmsh(folder.file("a.msh"), mesh);
  const std::string geometry = "[geometry]\nfile = \"" + folder.file("a.msh") + "\"\n";
  const Mesh<2> again = build(geometry, buffer, {"formulation=double-point"}).mesh;
  EXPECT_EQ(again.region_names, mesh.region_names);
  EXPECT_EQ(again.nodes, mesh.nodes);
  EXPECT_EQ(again.elements, mesh.elements);
  EXPECT_EQ(again.element_region, mesh.element_region);
  ASSERT_EQ(again.boundaries.size(), mesh.boundaries.size());
  for (const auto& set : mesh.boundaries) {
    EXPECT_EQ(boundary(again, set.name).faces, set.faces) << set.name;
  }
}

Case<2> case_with(Mesh<2> mesh, const std::vector<std::string>& overrides = {}) {
  return {
      parse_scene(scene_text(test::unit_column), "test.toml", overrides), std::move(mesh), {}, {}};
}

TEST(Summary, IsAlignedAndComplete) {
  EXPECT_EQ(case_summary(case_with(build(test::unit_column).mesh), {"a note"}),
            "  elements         32\n"
            "  nodes            25\n"
            "  solid points     0\n"
            "  median edge      0.25 m; mesh.size is 0.25 m\n"
            "  smallest angle   45 degrees\n"
            "  region specimen  1 m2\n"
            "  boundary top     1 m\n"
            "  boundary bottom  1 m\n"
            "  boundary left    1 m\n"
            "  boundary right   1 m\n"
            "  note: a note\n");
}

TEST(Summary, TellsOfLiquidPointsAndFreeWater) {
  Case<2> c =
      case_with(build_layers(test::unit_column, "{inflow=1}").mesh, {"formulation=double-point"});
  for (int e = 0; e < c.mesh.element_count(); ++e) {
    const int count = e == 3 ? 5 : 2;
    c.liquid_points.element.insert(c.liquid_points.element.end(), count, e);
  }
  const std::string summary = case_summary(c, {});
  EXPECT_NE(summary.find("  liquid points    83 (2 to 5 per element)\n"), std::string::npos)
      << summary;
  EXPECT_NE(summary.find("  region specimen  1 m2\n"), std::string::npos) << summary;
  EXPECT_NE(summary.find("  region inflow    0.25 m2, free water\n"), std::string::npos) << summary;
}

TEST(Summary, WarnsOfSharpAngles) {
  Mesh<2> mesh;
  mesh.nodes = {{0, 0}, {1, 0}, {1, 0.08}};
  mesh.elements = {{0, 1, 2}};
  EXPECT_NE(angle_warning(mesh).find("the smallest angle is 4.57"), std::string::npos);
  EXPECT_EQ(angle_warning(mesh).find("HXT"), std::string::npos);
  mesh.nodes[2][1] = 0.1;
  EXPECT_EQ(angle_warning(mesh), "");
  Mesh<3> flat;
  flat.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3, 0.3, 0.01}};
  flat.elements = {{0, 1, 2, 3}};
  EXPECT_NE(angle_warning(flat).find("Mesh.Algorithm3D = 10"), std::string::npos);
}

}  // namespace geometry_test
}  // namespace suffuse
