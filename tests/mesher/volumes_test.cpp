/// Meshes of tetrahedra: the built-in box and users' volumes, their points, and what is refused.

#include <gmsh.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <map>

#include "common/errors.hpp"
#include "geometry.hpp"
#include "gmsh_export.hpp"
#include "gmsh_session.hpp"
#include "mesh/slit.hpp"
#include "seeding.hpp"
#include "summary.hpp"
#include "temporary_folder.hpp"

namespace suffuse {
namespace volumes_test {

using test::scene_text;
using test::TemporaryFolder;

std::string box(double size, const std::string& structure = "regular") {
  return "[geometry]\nshape = \"box\"\nwidth = 0.5\ndepth = 0.25\nheight = 1.0\n[mesh]\nsize = " +
         std::to_string(size) + "\nstructure = \"" + structure + "\"\n";
}

SceneDocument scene_of(const std::string& geometry, std::vector<std::string> overrides = {},
                       const std::string& more = "", const std::string& path = "test.toml") {
  overrides.insert(overrides.begin(), "time.scheme=implicit");
  return parse_scene(scene_text(geometry, more), path, overrides);
}

Geometry<3> build(const std::string& geometry, const std::vector<std::string>& overrides = {},
                  const std::string& more = "") {
  return build_geometry_of<3>(scene_of(geometry, overrides, more));
}

std::string refusal(const std::function<void()>& attempt) {
  try {
    attempt();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "nothing refused";
}

std::map<std::string, double> volumes(const Mesh<3>& mesh) {
  std::map<std::string, double> result;
  for (int e = 0; e < mesh.element_count(); ++e) {
    EXPECT_GT(element_volume(mesh, e), 0.0);
    result[mesh.region_names[mesh.element_region[e]]] += element_volume(mesh, e);
  }
  return result;
}

std::map<std::string, double> areas(const Mesh<3>& mesh) {
  std::map<std::string, double> result;
  for (const BoundarySet<3>& set : mesh.boundaries) {
    for (const auto& face : set.faces) {
      const Vector<3> a = mesh.nodes[face[1]] - mesh.nodes[face[0]];
      const Vector<3> b = mesh.nodes[face[2]] - mesh.nodes[face[0]];
      result[set.name] +=
          0.5 * std::sqrt(a.squaredNorm() * b.squaredNorm() - std::pow(a.dot(b), 2));
    }
  }
  return result;
}

void expect_sizes(const std::map<std::string, double>& found,
                  const std::map<std::string, double>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (const auto& [name, size] : expected) EXPECT_NEAR(found.at(name), size, 1e-12) << name;
}

TEST(Box, HasSixTetrahedraPerCuboidAndSixSides) {
  const Mesh<3> mesh = build(box(0.125)).mesh;
  EXPECT_EQ(mesh.element_count(), 6 * 4 * 2 * 8);
  EXPECT_EQ(mesh.node_count(), 5 * 3 * 9);
  for (int e = 0; e < mesh.element_count(); ++e) {
    EXPECT_NEAR(element_volume(mesh, e), std::pow(0.125, 3) / 6.0, 1e-18);
  }
  EXPECT_NEAR(smallest_angle(mesh), 45.0, 1e-12);
  expect_sizes(volumes(mesh), {{"specimen", 0.125}});
  expect_sizes(areas(mesh), {{"left", 0.25},
                             {"right", 0.25},
                             {"front", 0.5},
                             {"back", 0.5},
                             {"bottom", 0.125},
                             {"top", 0.125}});
}

TEST(Box, HasTheLayersOfAColumn) {
  for (const std::string structure : {"regular", "free"}) {
    const Mesh<3> mesh =
        build(box(0.125, structure),
              {"formulation=double-point",
               "geometry.layers={inflow = 1, free_above = 2, below = 1, outflow = 2}"},
              "[soil.buffer]\nlike = \"specimen\"\n")
            .mesh;
    const double row = 0.5 * 0.25 * 0.125;
    expect_sizes(volumes(mesh), {{"inflow", row},
                                 {"free_above", 2.0 * row},
                                 {"specimen", 8.0 * row},
                                 {"buffer", row},
                                 {"outflow", 2.0 * row}});
    expect_sizes(areas(mesh), {{"left", 0.25 * 1.75},
                               {"right", 0.25 * 1.75},
                               {"front", 0.5 * 1.75},
                               {"back", 0.5 * 1.75},
                               {"inflow", 0.125},
                               {"outflow", 0.125}});
    EXPECT_GT(smallest_angle(mesh), 5.0);
  }
}

TEST(Box, NotesRowsThatDoNotDivideItAndSumsUpWhatItHas) {
  const Geometry<3> geometry = build(box(0.1));
  ASSERT_EQ(geometry.notes.size(), 1U);
  EXPECT_EQ(geometry.notes[0],
            "mesh.size 0.1 does not divide the depth 0.25: it has 3 elements of 0.0833333");
  const SceneDocument document = scene_of(box(0.125));
  const std::string summary = case_summary(Case<3>{document, build(box(0.125)).mesh, {}, {}}, {});
  EXPECT_NE(summary.find("region specimen  0.125 m3\n"), std::string::npos) << summary;
  EXPECT_NE(summary.find("boundary front   0.5 m2\n"), std::string::npos) << summary;
}

TEST(Box, RefusesWhatOnlyTwoDimensionsHave) {
  const auto refused = [](const std::vector<std::string>& overrides, const std::string& more = "") {
    return refusal([&] { build(box(0.125), overrides, more); });
  };
  EXPECT_EQ(refused({"mesh.structure=crossed"}),
            "--set mesh.structure=crossed: mesh.structure: got \"crossed\" with shape = \"box\"; "
            "expected \"regular\" or \"free\": only triangles can be crossed");
  EXPECT_EQ(
      refused({"time.scheme=explicit"}),
      "--set time.scheme=explicit: time.scheme: got \"explicit\" in three dimensions; expected "
      "\"implicit\": the explicit scheme is for meshes of triangles alone");
  EXPECT_EQ(refused({"points.solid_per_element=3"}),
            "--set points.solid_per_element=3: points.solid_per_element: got 3 Gauss points in a "
            "tetrahedron; expected 1, 4 or 14");
  EXPECT_NE(refused({}, "[[output.section]]\nfrom = [0, 0, 0]\nto = [0, 0, 1]\n")
                .find("output.section: got a section in three dimensions; expected no such entry"),
            std::string::npos);
  EXPECT_NE(
      refused({"gravity=[0.0, 0.0, -9.81]", "initial.water_level=1.0", "formulation=double-point"},
              "[soil.specimen.skeleton]\nlaw = \"elastic\"\nyoung = 1e7\npoisson = 0.3\n")
          .find("formulation: got \"double-point\" with a skeleton that moves, in three "
                "dimensions; expected \"single-point\""),
      std::string::npos);
  EXPECT_EQ(
      refused({"mesh.size=1e-4"}),
      "--set mesh.size=1e-4: mesh.size: got 0.0001; expected at least 0.00531329, which makes "
      "5 million tetrahedra here");
}

TEST(Box, NeedsADepthThatAColumnHasNot) {
  EXPECT_EQ(
      refusal([] {
        scene_of("[geometry]\nshape = \"box\"\nwidth = 1.0\nheight = 1.0\n[mesh]\nsize = 0.5\n");
      }),
      "test.toml:3: geometry.depth: got nothing; expected a number with depth > 0, in m, for "
      "shape = \"box\"");
  EXPECT_EQ(
      refusal([] { scene_of(test::unit_column, {"geometry.depth=1.0"}); }),
      "--set geometry.depth=1.0: geometry.depth: got a depth with shape = \"column\"; expected "
      "no such key: a column is two-dimensional, a box has a depth");
}

/// Scenes over files that the test writes.
class Volumes : public testing::Test {
 protected:
  Geometry<3> build_file(const std::string& name, const std::string& text,
                         const std::string& more = "",
                         const std::vector<std::string>& overrides = {}) {
    folder_.write(name, text);
    const bool meshed = name.ends_with(".msh");
    return build_geometry_of<3>(
        scene_of("[geometry]\nfile = \"" + name + "\"\n" + (meshed ? "" : "[mesh]\nsize = 0.4\n"),
                 overrides, more, folder_.file("scene.toml")));
  }
  std::string refusal_of(const std::string& name, const std::string& text) {
    const std::string message = refusal([&] { build_file(name, text); });
    return message.substr(std::min(message.find("scene.toml"), message.size()));
  }

  TemporaryFolder folder_;
};

/// Two boxes side by side with a surface between them.
const std::string two_volumes =
    "SetFactory(\"OpenCASCADE\");\n"
    "Box(1) = {0, 0, 0, 1, 1, 1};\n"
    "Box(2) = {1, 0, 0, 1, 1, 1};\n"
    "BooleanFragments{ Volume{1, 2}; Delete; }{ }\n"
    "Physical Volume(\"specimen\") = {1};\n"
    "Physical Volume(\"sand\") = {2};\n"
    "Physical Surface(\"between\") = {2};\n"
    "Physical Surface(\"west\") = {1};\n";
const std::string sand = "[soil.sand]\nlike = \"specimen\"\n";

TEST_F(Volumes, AreRegionsAndSurfacesBoundaries) {
  const Geometry<3> geometry = build_file("two.geo", two_volumes, sand);
  expect_sizes(volumes(geometry.mesh), {{"specimen", 1.0}, {"sand", 1.0}});
  expect_sizes(areas(geometry.mesh), {{"west", 1.0}});
  ASSERT_EQ(geometry.notes.size(), 1U);
  EXPECT_EQ(geometry.notes[0],
            "the surface \"between\" lies inside the mesh and no wall or well names it: it does "
            "nothing");
}

TEST_F(Volumes, AreCutAlongASurfaceThatAWallNames) {
  const Mesh<3> whole = build_file("two.geo", two_volumes, sand).mesh;
  const Mesh<3> cut =
      build_file("two.geo", two_volumes, sand + "[[wall]]\non = \"between\"\n").mesh;
  EXPECT_GT(cut.node_count(), whole.node_count());
  EXPECT_EQ(cut.element_count(), whole.element_count());
  expect_sizes(areas(cut), {{"west", 1.0}, {"between", 2.0}});
  for (const BoundarySet<3>& set : cut.boundaries)
    EXPECT_EQ(is_slit(cut, set), set.name == "between");
}

TEST_F(Volumes, AreReadInTheUnitOfTheFile) {
  const Mesh<3> mesh =
      build_file("two.geo", two_volumes, sand, {"geometry.scale=0.001", "mesh.size=4e-4"}).mesh;
  const std::map<std::string, double> found = volumes(mesh);
  EXPECT_NEAR(found.at("sand"), 1e-9, 1e-21);
}

TEST_F(Volumes, OfAMeshThatTheMesherWroteAreThoseOfTheMesh) {
  const Mesh<3> mesh = build(box(0.125, "free")).mesh;
  write_gmsh(folder_.file("written.msh"), mesh);
  const Mesh<3> read = build_file("written.msh", test::read_file(folder_.file("written.msh"))).mesh;
  ASSERT_EQ(read.node_count(), mesh.node_count());
  for (int n = 0; n < mesh.node_count(); ++n) {
    EXPECT_LT((read.nodes[n] - mesh.nodes[n]).norm(), 1e-15);  // digits of the file
  }
  EXPECT_EQ(read.elements, mesh.elements);
  expect_sizes(areas(read), areas(mesh));
}

TEST_F(Volumes, OfAStepFileNeedNames) {
  {
    const GmshSession session;
    gmsh::model::add("box");
    gmsh::model::occ::addBox(0.0, 0.0, 0.0, 1.0, 1.0, 1.0);
    gmsh::model::occ::synchronize();
    gmsh::write(folder_.file("box.step"));
  }
  const std::string message = refusal_of("box.step", test::read_file(folder_.file("box.step")));
  EXPECT_NE(message.find("with no named physical volume"), std::string::npos) << message;
  EXPECT_NE(message.find("Physical Volume(\"specimen\") = {1}; Physical Surface(\"top\") = {3};"),
            std::string::npos)
      << message;
}

/// A mesh of these elements, each `type nodes...`, all in one volume; nodes by their coordinates.
std::string msh_of(const std::vector<std::array<double, 3>>& nodes,
                   const std::vector<std::string>& elements) {
  std::string text =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 1 \"specimen\"\n"
      "$EndPhysicalNames\n$Nodes\n" +
      std::to_string(nodes.size()) + "\n";
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    text += std::to_string(n + 1);
    for (const double x : nodes[n]) text += " " + std::to_string(x);
    text += "\n";
  }
  text += "$EndNodes\n$Elements\n" + std::to_string(elements.size()) + "\n";
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const std::size_t type_end = elements[e].find(' ');
    text += std::to_string(e + 1) + " " + elements[e].substr(0, type_end) + " 2 1 1" +
            elements[e].substr(type_end) + "\n";
  }
  return text + "$EndElements\n";
}

TEST_F(Volumes, AreRefusedWhereTheyMakeNoMesh) {
  const std::string start = "scene.toml:4: geometry.file: got \"bad.msh\" with ";
  const std::vector<std::array<double, 3>> corner{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const auto more = [&](std::vector<std::array<double, 3>> nodes) {
    nodes.insert(nodes.begin(), corner.begin(), corner.end());
    return nodes;
  };
  const std::string same_place = "node 5 at (0, 0, 0)";
  EXPECT_EQ(refusal_of("bad.msh", msh_of(more({{1, 1, 0}}), {"4 1 2 3 4", "4 1 2 5 3"})),
            start +
                "element 2, flat, with its nodes at (0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0); "
                "expected tetrahedra with a volume");
  EXPECT_EQ(refusal_of("bad.msh", msh_of(more({{0.2, 0.2, 2}}), {"4 1 2 3 4", "4 1 2 3 5"}))
                .find(start + "elements 1 and 2, on the same side of the face at "),
            0U);
  EXPECT_EQ(refusal_of("bad.msh", msh_of(more({{0, 0, 0}, {-1, 0, 0}}), {"4 1 2 3 4", "4 5 6 3 4"}))
                .find(start + "nodes 1 and 5, both at (0, 0, 0); expected one node per place"),
            0U);
  // A corner of the second lies in the middle of a face, and of an edge, of the first.
  for (const double x : {0.25, 0.0}) {
    const std::string message =
        refusal_of("bad.msh", msh_of(more({{x, 0.25, 0}, {0, 0.3, -1}, {1, 0.3, -1}, {0.5, 1, -1}}),
                                     {"4 1 2 3 4", "4 5 6 7 8"}));
    EXPECT_NE(message.find("node 5 at (" + std::string(x > 0 ? "0.25" : "0") +
                           ", 0.25, 0) on the face of element 1"),
              std::string::npos)
        << message;
  }
  // The second one pierces the first, or lies within it.
  EXPECT_NE(refusal_of("bad.msh",
                       msh_of(more({{0.2, 0.2, -1}, {0.2, 0.2, 0.3}, {-3, -3, -2}, {3, -4, -2}}),
                              {"4 1 2 3 4", "4 5 6 7 8"}))
                .find("elements 1 and 2, whose faces at "),
            std::string::npos);
  EXPECT_NE(
      refusal_of("bad.msh",
                 msh_of(more({{0.1, 0.1, 0.1}, {0.2, 0.1, 0.1}, {0.1, 0.2, 0.1}, {0.1, 0.1, 0.2}}),
                        {"4 1 2 3 4", "4 5 6 7 8"}))
          .find("within element 1 of another part"),
      std::string::npos);
}

TEST_F(Volumes, OfOtherElementsAreRefused) {
  const std::string physical = "Physical Volume(\"specimen\") = {1};\n";
  const std::string cube =
      "SetFactory(\"OpenCASCADE\");\nBox(1) = {0, 0, 0, 1, 1, 1};\n" + physical;
  EXPECT_NE(
      refusal_of("second.geo", "Mesh.ElementOrder = 2;\n" + cube).find("(Tetrahedron 10) at ("),
      std::string::npos);
  const std::string mixed =
      refusal_of("mixed.geo",
                 "Point(1) = {0, 0, 0};\nPoint(2) = {1, 0, 0};\nLine(1) = {1, 2};\n"
                 "s() = Extrude {0, 1, 0} { Line{1}; Layers{2}; Recombine; };\n"
                 "Extrude {0, 0, 1} { Surface{s(1)}; Layers{2}; Recombine; }\n" +
                     physical);
  EXPECT_NE(mixed.find("(Hexahedron 8) at ("), std::string::npos) << mixed;
  EXPECT_NE(mixed.find("expected tetrahedra of four nodes (in Gmsh: Mesh.ElementOrder = 1, no "
                       "Recombine)"),
            std::string::npos)
      << mixed;
}

double factorial(int n) {
  return std::tgamma(n + 1.0);
}

/// Largest error over all monomials of a degree in the barycentric coordinates, whose mean over a
/// tetrahedron is 3! a! b! c! d! / (3 + a + b + c + d)!.
double worst_error(const std::vector<QuadraturePoint<3>>& rule, int degree) {
  double worst = 0.0;
  for (int i = 0; i <= degree; ++i) {
    for (int j = 0; i + j <= degree; ++j) {
      for (int k = 0; i + j + k <= degree; ++k) {
        const std::array<int, 4> power{i, j, k, degree - i - j - k};
        double exact = 6.0 / factorial(3 + degree);
        for (const int p : power) exact *= factorial(p);
        double mean = 0.0;
        for (const auto& point : rule) {
          double term = point.weight;
          for (int a = 0; a < 4; ++a) term *= std::pow(point.barycentric[a], power[a]);
          mean += term;
        }
        worst = std::max(worst, std::abs(mean - exact));
      }
    }
  }
  return worst;
}

TEST(TetrahedronRule, IntegratesToItsDegreeAndNotBeyond) {
  for (const auto& [count, degree] : std::map<int, int>{{1, 1}, {4, 2}, {14, 5}}) {
    const auto rule = gauss_rule<3>(count);
    ASSERT_EQ(rule.size(), static_cast<std::size_t>(count));
    for (int d = 0; d <= degree; ++d) EXPECT_LT(worst_error(rule, d), 4e-16) << count << ' ' << d;
    EXPECT_GT(worst_error(rule, degree + 1), 1e-6) << count;
    for (const auto& point : rule) {
      EXPECT_GT(point.weight, 0.0);
      for (const double share : point.barycentric) EXPECT_GT(share, 0.04);
    }
  }
  EXPECT_THROW(gauss_rule<3>(11), InputError);
}

/// Root of the mean square over elements of the error of the mean place of their points, in
/// barycentric coordinates.
double unevenness(const MaterialPoints<3>& points, int elements) {
  std::vector<std::array<double, 4>> sum(elements);
  std::vector<int> count(elements, 0);
  for (int p = 0; p < points.size(); ++p) {
    for (int a = 0; a < 4; ++a) sum[points.element[p]][a] += points.barycentric[p][a];
    ++count[points.element[p]];
  }
  double squares = 0.0;
  for (int e = 0; e < elements; ++e) {
    for (int a = 0; a < 4; ++a) squares += std::pow(sum[e][a] / count[e] - 0.25, 2);
  }
  return std::sqrt(squares / (4.0 * elements));
}

TEST(SeedingOfTetrahedra, FillsThemAtAnyPlaceInProportion) {
  for (const std::string seeding : {"random", "low-discrepancy", "gauss"}) {
    const int per_element = seeding == "gauss" ? 14 : 12;
    const SceneDocument document =
        scene_of(box(0.0625), {"formulation=double-point", "points.seeding=" + seeding,
                               "points.liquid_per_element=" + std::to_string(per_element)});
    const Mesh<3> mesh = build_geometry_of<3>(document).mesh;
    const MaterialPoints<3> points = seed_liquid_points(mesh, document.scene);
    ASSERT_EQ(points.size(), per_element * mesh.element_count());
    double volume = 0.0;
    double in_corner = 0.0;  // part in the tetrahedra half as large at their first corners
    for (int p = 0; p < points.size(); ++p) {
      double sum = 0.0;
      for (const double share : points.barycentric[p]) {
        EXPECT_GT(share, 0.0);
        sum += share;
      }
      EXPECT_NEAR(sum, 1.0, 1e-15);
      volume += points.volume[p];
      if (points.barycentric[p][0] > 0.5) in_corner += points.volume[p];
    }
    EXPECT_NEAR(volume, 0.3 * 0.125, 1e-12);
    EXPECT_NEAR(in_corner / volume, 0.125, seeding == "gauss" ? 0.1 : 0.003) << seeding;
    const double uneven = unevenness(points, mesh.element_count());
    std::cout << seeding << ": " << uneven << '\n';
    // For random points, the deviation of a coordinate is sqrt(3/80), over sqrt(12).
    const double chance = std::sqrt(3.0 / 80.0 / 12.0);
    EXPECT_NEAR(uneven, chance, seeding == "random" ? 0.002 : chance) << seeding;
    EXPECT_LT(uneven, seeding == "low-discrepancy" ? 0.026 : 2.0 * chance);  // as on triangles
  }
}

TEST(SeedingOfTetrahedra, MovesSolidPointsWithinTheirElements) {
  const Mesh<3> mesh = build(box(0.125)).mesh;
  PointSettings settings;
  settings.solid_per_element = 4;
  const MaterialPoints<3> straight = seed_solid_points(mesh, settings);
  settings.jitter = 0.3;
  const MaterialPoints<3> moved = seed_solid_points(mesh, settings);
  ASSERT_EQ(moved.size(), 4 * mesh.element_count());
  double farthest = 0.0;
  for (int p = 0; p < moved.size(); ++p) {
    for (const double share : moved.barycentric[p]) EXPECT_GE(share, 0.0);
    farthest = std::max(farthest, (moved.position(mesh, p) - straight.position(mesh, p)).norm());
  }
  EXPECT_LE(farthest, 0.3 * 0.125);  // legs of the elements
  EXPECT_GT(farthest, 0.2 * 0.125);
  EXPECT_EQ(moved.volume, straight.volume);
}

TEST(SeedingOfTetrahedra, HasFourSolidPointsUnlessTheSceneSaysOtherwise) {
  SceneDocument document = scene_of(box(0.125));
  complete_for_mesh(document, 3);
  EXPECT_EQ(document.scene.points.solid_per_element, 4);
  document = scene_of(box(0.125), {"points.solid_per_element=14"});
  complete_for_mesh(document, 3);
  EXPECT_EQ(document.scene.points.solid_per_element, 14);
}

}  // namespace volumes_test
}  // namespace suffuse
