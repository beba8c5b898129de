#include "wanted_sizes.hpp"

#include <gmsh.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "case/case_file.hpp"
#include "common/errors.hpp"
#include "geometry.hpp"
#include "gmsh_session.hpp"
#include "size_field.hpp"
#include "temporary_folder.hpp"
#include "test_paths.hpp"

namespace suffuse {
namespace wanted_sizes_test {

using test::scene_text;
using test::TemporaryFolder;

template <int Dim>
using SizeAt = std::function<double(const Vector<Dim>&)>;

/// Falls from 0.2 at the left to 0.02 at the right of a model that is 1 m long.
template <int Dim>
double falling(const Vector<Dim>& x) {
  return 0.2 - 0.18 * x[0];
}

template <int Dim>
WantedSizes sizes_on(const Mesh<Dim>& mesh, const SizeAt<Dim>& size) {
  MeshSizes<Dim> sizes{mesh, {}};
  for (const Vector<Dim>& x : mesh.nodes) sizes.size.push_back(size(x));
  return {"sizes.h5", std::move(sizes)};
}

const std::string square = "[geometry]\nshape = \"column\"\nwidth = 1.0\nheight = 1.0\n";
const std::string implicit = "time.scheme=implicit";
const std::string cube = "[geometry]\nshape = \"box\"\nwidth = 1.0\ndepth = 0.4\nheight = 0.4\n";

SceneDocument scene(const std::string& geometry, const std::vector<std::string>& overrides = {},
                    const std::string& more = "") {
  return parse_scene(scene_text(geometry, more), "test.toml", overrides);
}

SceneDocument scene_of_file(const std::string& name, const std::vector<std::string>& overrides = {},
                            const std::string& more = "") {
  const std::string file = test::data_folder() + "/geometry/" + name;
  return scene("[geometry]\nfile = \"" + file + "\"\n", overrides, more);
}

/// A scene of a .geo file with this text.
SceneDocument own_scene(const TemporaryFolder& folder, const std::string& geo,
                        const std::vector<std::string>& overrides = {},
                        const std::string& more = "") {
  folder.write("own.geo", geo);
  return scene("[geometry]\nfile = \"" + folder.file("own.geo") + "\"\n", overrides, more);
}

/// Regions and boundaries, sorted.
template <int Dim>
std::vector<std::string> names_of(const Mesh<Dim>& mesh) {
  std::vector<std::string> names = mesh.region_names;
  for (const BoundarySet<Dim>& set : mesh.boundaries) names.push_back(set.name);
  std::ranges::sort(names);
  return names;
}

template <int Dim>
Geometry<Dim> build(const SceneDocument& document) {
  return build_geometry_of<Dim>(document);
}

template <int Dim>
Geometry<Dim> build(const SceneDocument& document, const WantedSizes& wanted) {
  const SceneDocument with_sizes = scene_with_sizes(document, wanted);
  return std::get<Geometry<Dim>>(build_geometry({.document = with_sizes, .wanted = &wanted}));
}

/// Lengths of edges over the size that is wanted at their middle, ascending.
template <int Dim>
std::vector<double> ratios(const Mesh<Dim>& mesh, const SizeAt<Dim>& size) {
  std::vector<double> result;
  for (const auto& corners : mesh.elements) {
    for (int a = 0; a <= Dim; ++a) {
      for (int b = a + 1; b <= Dim; ++b) {
        const Vector<Dim>& from = mesh.nodes[corners[a]];
        const Vector<Dim>& to = mesh.nodes[corners[b]];
        result.push_back((to - from).norm() / size((from + to) / 2.0));
      }
    }
  }
  std::ranges::sort(result);
  return result;
}

/// \param share  of the edges that may differ by more than a factor of 1.5
template <int Dim>
void expect_sizes(const Mesh<Dim>& mesh, const SizeAt<Dim>& size, double share, double tolerance) {
  const std::vector<double> all = ratios<Dim>(mesh, size);
  const auto count = static_cast<double>(all.size());
  const auto outside = static_cast<double>(
      std::ranges::count_if(all, [](double r) { return r < 1.0 / 1.5 || r > 1.5; }));
  EXPECT_NEAR(all[all.size() / 2], 1.0, tolerance);
  EXPECT_LT(outside / count, share);
}

/// Edges within a factor of 1.5 of what was asked: nearly all of triangles; of tetrahedra, which do
/// not fill space with equal edges, most.
constexpr double few = 0.01;
constexpr double some = 0.07;

TEST(WantedSizes, HoldInAColumn) {
  const Mesh<2> old = build<2>(scene(square, {"mesh.size=0.1"})).mesh;
  const Geometry<2> geometry = build<2>(scene(square), sizes_on<2>(old, falling<2>));
  expect_sizes<2>(geometry.mesh, falling<2>, few, 0.1);
  EXPECT_EQ(geometry.notes, std::vector<std::string>{"sizes of elements are those of sizes.h5"});
  EXPECT_EQ(names_of(geometry.mesh), names_of(old));
  const Mesh<2> again = build<2>(scene(square), sizes_on<2>(geometry.mesh, falling<2>)).mesh;
  expect_sizes<2>(again, falling<2>, few, 0.1);
  EXPECT_NEAR(again.element_count(), geometry.mesh.element_count(),
              0.05 * geometry.mesh.element_count());
}

/// Larger elements than `mesh.size` too, and none of the sizes of a mesh made afterwards.
TEST(WantedSizes, TakeThePlaceOfTheSizeOfTheScene) {
  const SceneDocument document = scene(square, {"mesh.size=0.05", "mesh.structure=free"});
  const Mesh<2> old = build<2>(document).mesh;
  const SizeAt<2> coarse = [](const Vector<2>&) { return 0.2; };
  expect_sizes<2>(build<2>(document, sizes_on<2>(old, coarse)).mesh, coarse, 0.05, 0.1);
  EXPECT_EQ(build<2>(document).mesh.nodes, old.nodes);
}

TEST(WantedSizes, HoldInAGeoFile) {
  const Mesh<2> old = build<2>(scene_of_file("square.geo", {"mesh.size=0.1"})).mesh;
  const WantedSizes wanted = sizes_on<2>(old, falling<2>);
  const Geometry<2> geometry = build<2>(scene_of_file("square.geo"), wanted);
  expect_sizes<2>(geometry.mesh, falling<2>, few, 0.1);
  EXPECT_EQ(names_of(geometry.mesh), names_of(old));
  EXPECT_EQ(geometry.notes, std::vector<std::string>{"sizes of elements are those of sizes.h5"});
}

/// Elements of a crossed mesh have the same areas, and so there are as many.
TEST(WantedSizes, HoldForAreasInACrossedMesh) {
  const SizeAt<2> fine = [](const Vector<2>& x) { return 0.2 * falling<2>(x); };
  const Mesh<2> old = build<2>(scene_of_file("square.geo", {"mesh.size=0.1"})).mesh;
  const WantedSizes wanted = sizes_on<2>(old, fine);
  const Mesh<2> free = build<2>(scene_of_file("square.geo"), wanted).mesh;
  const Mesh<2> crossed =
      build<2>(scene_of_file("square.geo", {"mesh.structure=crossed"}), wanted).mesh;
  EXPECT_NEAR(crossed.element_count(), free.element_count(), 0.2 * free.element_count());
}

TEST(WantedSizes, AreInMetresWhateverTheUnitOfTheFile) {
  const std::vector<std::string> millimetres{"geometry.scale=1e-3"};
  const SizeAt<2> in_metres = [](const Vector<2>& x) { return 1e-3 * falling<2>(1e3 * x); };
  const Mesh<2> old =
      build<2>(scene_of_file("square.geo", {"geometry.scale=1e-3", "mesh.size=1e-4"})).mesh;
  const Mesh<2> mesh =
      build<2>(scene_of_file("square.geo", millimetres), sizes_on<2>(old, in_metres)).mesh;
  expect_sizes<2>(mesh, in_metres, few, 0.1);
}

TEST(WantedSizes, TakeThePlaceOfTheSizesAtPointsOfTheFile) {
  const TemporaryFolder folder;
  const SceneDocument document = own_scene(
      folder,
      "SetFactory(\"OpenCASCADE\");\nRectangle(1) = {0, 0, 0, 1, 1};\n"
      "MeshSize{:} = 0.03;\nMesh.MeshSizeFromCurvature = 50;\nMesh.MeshSizeFactor = 0.5;\n"
      "Physical Surface(\"specimen\") = {1};\nPhysical Curve(\"top\") = {3};\n");
  const Mesh<2> old = build<2>(document).mesh;
  const Geometry<2> geometry = build<2>(document, sizes_on<2>(old, falling<2>));
  expect_sizes<2>(geometry.mesh, falling<2>, few, 0.1);
}

/// Limits and fields that the file sets hold in addition.
TEST(WantedSizes, DoNotPassTheLimitsOfTheFile) {
  const TemporaryFolder folder;
  const std::string rectangle =
      "SetFactory(\"OpenCASCADE\");\nRectangle(1) = {0, 0, 0, 1, 1};\n"
      "Physical Surface(\"specimen\") = {1};\nPhysical Curve(\"top\") = {3};\n";
  const Mesh<2> old = build<2>(own_scene(folder, rectangle, {"mesh.size=0.1"})).mesh;
  const auto expect = [&](const std::string& limits, const SizeAt<2>& size, std::string note) {
    const Geometry<2> geometry =
        build<2>(own_scene(folder, rectangle + limits), sizes_on<2>(old, falling<2>));
    expect_sizes<2>(geometry.mesh, size, 0.02, 0.1);
    EXPECT_EQ(geometry.notes.back(), note);
  };
  expect(
      "Mesh.MeshSizeMax = 0.1;\n", [](const Vector<2>& x) { return std::min(falling<2>(x), 0.1); },
      "Mesh.MeshSizeMax of the file holds: elements are finer than the sizes ask");
  expect(
      "Mesh.MeshSizeMin = 0.1;\n", [](const Vector<2>& x) { return std::max(falling<2>(x), 0.1); },
      "Mesh.MeshSizeMin of the file holds: elements are larger than the sizes ask");
  expect(
      "Field[1] = MathEval;\nField[1].F = \"0.05\";\nBackground Field = 1;\n",
      [](const Vector<2>& x) { return std::min(falling<2>(x), 0.05); },
      "the field of sizes of the file holds where it is finer than the sizes ask");
}

TEST(WantedSizes, HoldInAStepFile) {
  const TemporaryFolder folder;
  {
    const GmshSession session;
    gmsh::option::setString("Geometry.OCCTargetUnit", "MM");
    gmsh::model::occ::addRectangle(0, 0, 0, 1000, 1000);
    gmsh::model::occ::synchronize();
    gmsh::write(folder.file("named.step"));
  }
  const std::string geometry =
      "SetFactory(\"OpenCASCADE\");\nGeometry.OCCTargetUnit = \"M\";\nMerge \"named.step\";\n"
      "Physical Surface(\"specimen\") = {1};\n";
  const Mesh<2> old = build<2>(own_scene(folder, geometry, {"mesh.size=0.1"})).mesh;
  const Mesh<2> mesh = build<2>(own_scene(folder, geometry), sizes_on<2>(old, falling<2>)).mesh;
  expect_sizes<2>(mesh, falling<2>, few, 0.1);
}

TEST(WantedSizes, HoldInABox) {
  const Mesh<3> old = build<3>(scene(cube, {implicit, "mesh.size=0.1"})).mesh;
  const Geometry<3> geometry = build<3>(scene(cube, {implicit}), sizes_on<3>(old, falling<3>));
  expect_sizes<3>(geometry.mesh, falling<3>, some, 0.15);
  EXPECT_EQ(names_of(geometry.mesh), names_of(old));
}

/// Beyond the chords of the coarse mesh, sizes are those nearby.
TEST(WantedSizes, HoldWithinCurvedBoundaries) {
  const SizeAt<3> size = [](const Vector<3>& x) { return 0.15 * x.norm(); };
  const Mesh<3> old = build<3>(scene_of_file("sphere.geo", {implicit, "mesh.size=0.4"})).mesh;
  const Mesh<3> mesh =
      build<3>(scene_of_file("sphere.geo", {implicit}), sizes_on<3>(old, size)).mesh;
  expect_sizes<3>(mesh, size, some, 0.15);
  EXPECT_EQ(names_of(mesh), names_of(old));
}

/// Layers keep their heights, which follow from `mesh.size`.
TEST(WantedSizes, HoldInLayersOfADoublePointColumn) {
  const std::vector<std::string> layers{"formulation=double-point", "mesh.size=0.1",
                                        "geometry.layers={inflow=2, above=1, outflow=2}"};
  const SceneDocument document = scene(square, layers, "[soil.buffer]\nlike = \"specimen\"\n");
  const Mesh<2> old = build<2>(document).mesh;
  const Mesh<2> mesh = build<2>(document, sizes_on<2>(old, falling<2>)).mesh;
  expect_sizes<2>(mesh, falling<2>, 0.02, 0.1);
  EXPECT_EQ(names_of(mesh), names_of(old));
  EXPECT_NEAR((extent(mesh) - extent(old)).norm(), 0.0, 1e-12);
}

template <int Dim>
std::string refusal(const SceneDocument& document, const WantedSizes& wanted) {
  try {
    build<Dim>(document, wanted);
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing refused";
}

TEST(WantedSizes, RefusesScenesThatCannotHaveThem) {
  const WantedSizes wanted =
      sizes_on<2>(build<2>(scene(square, {"mesh.size=0.25"})).mesh, falling<2>);
  EXPECT_EQ(refusal<2>(scene(square, {"mesh.structure=regular"}), wanted),
            "--set mesh.structure=regular: mesh.structure: got \"regular\" with --sizes; expected "
            "\"free\", or no such key: elements of a pattern have one size");
  EXPECT_EQ(refusal<2>(scene(square, {"mesh.structure=crossed"}), wanted),
            "--set mesh.structure=crossed: mesh.structure: got \"crossed\" with --sizes; expected "
            "\"free\", or no such key: elements of a pattern have one size");
  const std::string mesh = test::data_folder() + "/geometry/square.msh";
  EXPECT_EQ(refusal<2>(scene_of_file("square.msh"), wanted),
            "test.toml:4: geometry.file: got \"" + mesh +
                "\" with --sizes; expected a .geo or "
                ".step file: a .msh file has a mesh already");
  const std::string itself = test::data_folder() + "/geometry/meshes_itself.geo";
  EXPECT_EQ(refusal<2>(scene_of_file("meshes_itself.geo"), wanted),
            "test.toml:4: geometry.file: got \"" + itself +
                "\" with --sizes, which meshes itself; "
                "expected a file without a Mesh command");
}

TEST(WantedSizes, RefusesThoseOfAnotherScene) {
  const SizeAt<2> size = [](const Vector<2>&) { return 0.25; };
  const WantedSizes wanted = sizes_on<2>(build<2>(scene(square, {"mesh.size=0.25"})).mesh, size);
  EXPECT_EQ(refusal<3>(scene(cube, {implicit}), wanted),
            "sizes.h5: got sizes of a mesh in two dimensions; expected those of a mesh of this "
            "scene, in three dimensions");
  EXPECT_EQ(refusal<3>(scene_of_file("sphere.geo", {implicit}), wanted),
            "sizes.h5: got sizes of a mesh in two dimensions; expected those of a mesh of this "
            "scene, in three dimensions");
  const std::string other_box =
      "sizes.h5: got sizes of a mesh from (0, 0) to (1, 1); expected those of a mesh of this "
      "scene, from (0, 0) to (";
  EXPECT_EQ(refusal<2>(scene(square, {"geometry.width=2"}), wanted), other_box + "2, 1)");
  EXPECT_EQ(refusal<2>(scene(square, {"geometry.width=1.00001"}), wanted),
            other_box + "1.00001, 1)");
  EXPECT_EQ(refusal<2>(scene(square, {"geometry.width=1.0000001"}), wanted), "nothing refused");
  EXPECT_EQ(refusal<2>(scene_of_file("square.geo", {"geometry.scale=2"}), wanted),
            other_box + "2, 2)");
}

TEST(WantedSizes, RefusesThoseOfOtherRegions) {
  WantedSizes wanted = sizes_on<2>(build<2>(scene(square, {"mesh.size=0.25"})).mesh, falling<2>);
  std::get<MeshSizes<2>>(wanted.sizes).mesh.region_names = {"clay"};
  EXPECT_EQ(refusal<2>(scene(square), wanted),
            "sizes.h5: got sizes of a mesh with the region \"clay\"; expected those of a mesh of "
            "this scene, with the region \"specimen\"");
}

TEST(WantedSizes, RefusesMoreElementsThanAnyoneMeans) {
  const Mesh<2> old = build<2>(scene(square, {"mesh.size=0.25"})).mesh;
  EXPECT_EQ(refusal<2>(scene(square), sizes_on<2>(old, [](const Vector<2>&) { return 1e-4; })),
            "sizes.h5: got sizes that make some 231 million elements; expected larger sizes, which "
            "make at most 5 million");
}

TEST(SizeField, IsLinearInElementsAndGoesOnOutside) {
  MeshSizes<2> sizes;
  sizes.mesh.nodes = {{0, 0}, {2, 0}, {2, 2}, {0, 2}};
  sizes.mesh.elements = {{0, 1, 2}, {0, 2, 3}};
  sizes.size = {1.0, 2.0, 4.0, 3.0};
  const SizeField<2> field(sizes);
  EXPECT_DOUBLE_EQ(field.at({2.0, 0.0}), 2.0);
  EXPECT_DOUBLE_EQ(field.at({1.0, 1.0}), 2.5);
  EXPECT_DOUBLE_EQ(field.at({1.5, 0.5}), 2.25);
  EXPECT_NEAR(field.at({1.0, -1.0}), 1.5, 0.2);  // at a place nearby, not the nearest
  EXPECT_DOUBLE_EQ(field.at({5.0, 5.0}), 4.0);
}

/// Against every element in turn.
TEST(SizeField, FindsTheElementOfEveryPlace) {
  const Mesh<2> mesh = build<2>(scene(square, {"mesh.size=0.05", "mesh.structure=free"})).mesh;
  const SizeAt<2> bent = [](const Vector<2>& x) { return 1.0 + std::sin(9.0 * x[0]) * x[1]; };
  const WantedSizes wanted = sizes_on<2>(mesh, bent);
  const auto& sizes = std::get<MeshSizes<2>>(wanted.sizes);
  const SizeField<2> field(sizes);
  for (int i = 0; i < 1000; ++i) {
    const Vector<2> x(std::fmod(0.618034 * i, 1.0), std::fmod(0.754878 * i, 1.0));
    for (int e = 0; e < mesh.element_count(); ++e) {
      const std::array<double, 3> share = barycentric(mesh, e, x);
      if (*std::ranges::min_element(share) < 0.0) continue;
      double expected = 0.0;
      for (int a = 0; a < 3; ++a) expected += share[a] * sizes.size[mesh.elements[e][a]];
      EXPECT_NEAR(field.at(x), expected, 1e-12);
    }
  }
}

/// What the summary adds where studies mesh the scene again.
const std::string mesh_again =
    "; make study and make sweep mesh again until the discharge is known to 1 %";

TEST(DefaultSize, MakesAboutTwentyThousandElementsAndIsSaid) {
  const auto expect = [](const auto& geometry, const std::string& size) {
    EXPECT_NEAR(geometry.mesh.element_count(), 20000, 2500);
    ASSERT_EQ(geometry.notes.size(), 1U);
    const std::string note = "mesh.size was not given: " + size + " m, for about 20 000 elements";
    EXPECT_TRUE(geometry.notes[0] == note || geometry.notes[0] == note + mesh_again)
        << geometry.notes[0];
  };
  expect(build<2>(scene(square)), "0.01");
  expect(build<2>(scene(square, {"mesh.structure=crossed"})), "0.014");
  expect(build<2>(scene(square, {"mesh.structure=free"})), "0.011");
  expect(build<3>(scene(cube, {implicit})), "0.036");
  expect(build<3>(scene(cube, {implicit, "mesh.structure=free"})), "0.034");
  expect(build<2>(scene_of_file("square.geo")), "0.019");
  expect(build<2>(scene_of_file("square.geo", {"mesh.structure=free"})), "0.011");
  expect(build<2>(scene_of_file("square.geo", {"geometry.scale=0.1"})), "0.0019");
  expect(build<3>(scene_of_file("cylinder.geo", {implicit})), "0.038");
  const TemporaryFolder folder;
  expect(build<3>(own_scene(folder,
                            "SetFactory(\"OpenCASCADE\");\nCylinder(1) = {0, 0, 0, 0, 0, 1, 1};\n"
                            "Physical Volume(\"specimen\") = {1};\n",
                            {implicit})),
         "0.092");
}

TEST(DefaultSize, IsWhereMeshingAgainBegins) {
  const auto is_said = [](const SceneDocument& document) {
    return build<2>(document).notes.at(0).ends_with(mesh_again);
  };
  EXPECT_TRUE(is_said(scene(square, {implicit})));
  EXPECT_TRUE(is_said(scene(square, {implicit, "mesh.structure=free"})));
  EXPECT_TRUE(is_said(scene_of_file("square.geo", {implicit, "mesh.structure=crossed"})));
  EXPECT_FALSE(is_said(scene(square)));
  EXPECT_FALSE(is_said(scene(square, {implicit, "mesh.structure=regular"})));
  EXPECT_FALSE(is_said(scene(square, {implicit, "mesh.structure=free", "mesh.error=0.1"})));
  EXPECT_FALSE(is_said(scene(square, {implicit, "initial.from=\"first.results\""})));
}

/// Sizes of a file stay as they are.
TEST(DefaultSize, IsNotThatOfAFileWithSizes) {
  const TemporaryFolder folder;
  const std::string rectangle =
      "SetFactory(\"OpenCASCADE\");\nRectangle(1) = {0, 0, 0, 1, 1};\n"
      "Physical Surface(\"specimen\") = {1};\n";
  for (const std::string sizes :
       {"MeshSize{:} = 0.2;", "Mesh.MeshSizeMax = 0.2;", "MeshSize{1} = 0.2;",
        "Transfinite Curve{:} = 6;",
        "Field[1] = MathEval;\nField[1].F = \"0.2\";\nBackground Field = 1;"}) {
    const Geometry<2> geometry = build<2>(own_scene(folder, rectangle + sizes + "\n"));
    EXPECT_LT(geometry.mesh.element_count(), 1000) << sizes;
    EXPECT_TRUE(geometry.notes.empty()) << sizes;
  }
}

}  // namespace wanted_sizes_test
}  // namespace suffuse
