#include "figures/render.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "common/errors.hpp"
#include "drawing/color_map.hpp"
#include "drawing/model_view.hpp"
#include "figures/categories.hpp"
#include "post/picture_pixels.hpp"
#include "post/synthetic_results.hpp"
#include "values/fields.hpp"

namespace suffuse {
namespace render_test {

using testing::expect_color;
using testing::Pixels;
using testing::ScratchFolder;

class Render : public ::testing::Test {
 protected:
  Render() {
    unsetenv("DISPLAY");
    testing::double_point::write_results(scratch / "run.results");
    testing::write_synthetic_results(scratch / "single.results");
  }
  [[nodiscard]] ResultsReader run() const { return ResultsReader(scratch / "run.results"); }
  [[nodiscard]] ResultsReader single() const { return ResultsReader(scratch / "single.results"); }
  [[nodiscard]] RenderRequest request(const std::string& field) const {
    RenderRequest r;
    r.field = field;
    r.output = scratch / "picture.png";
    return r;
  }
  [[nodiscard]] Pixels drawn(const ResultsReader& results, const RenderRequest& r) const {
    EXPECT_EQ(render(results, r), std::vector<std::string>{r.output});
    return Pixels(r.output);
  }
  /// Where a position of the double-point column lies in the picture: 800 pixels for its 3 m.
  static Eigen::Vector2d place(double x, double y) {
    return {axes_left + x * 800.0 / 3.0, axes_bottom + (y + 1.0) * 800.0 / 3.0};
  }
  void expect_refusal(const ResultsReader& results, const RenderRequest& r,
                      const std::string& message) const {
    try {
      render(results, r);
      ADD_FAILURE() << "not refused: " << message;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()), message);
    }
    EXPECT_FALSE(std::filesystem::exists(r.output));
  }

  const ScratchFolder scratch;
};

TEST(ColorMap, GetsBrighterWithoutATurn) {
  for (int k = 0; k < 200; ++k) {
    EXPECT_LT(luminance(viridis(k / 200.0)), luminance(viridis((k + 1) / 200.0))) << k;
  }
  // Ends of Viridis, within the accuracy of the fit.
  expect_color({68, 1, 84}, viridis(0.0), "low end");
  expect_color({253, 231, 37}, viridis(1.0), "high end");
  EXPECT_EQ(viridis(-1.0), viridis(0.0));
  EXPECT_EQ(viridis(2.0), viridis(1.0));
}

// concentration is y / 100 in the middle of an element: -5/6 .. 11/6 of a hundredth.
TEST_F(Render, ElementsHaveTheColoursOfTheirValues) {
  auto r = request("concentration");
  r.range = {{-0.01, 0.02}};
  const Pixels pixels = drawn(run(), r);
  const Case<2> c = testing::double_point::column();
  for (int e = 0; e < c.mesh.element_count(); ++e) {
    const auto middle = element_centroid(c.mesh, e);
    expect_color(pixels.at(place(middle[0], middle[1])), viridis((middle[1] + 1.0) / 3.0),
                 "element " + std::to_string(e));
  }
}

TEST_F(Render, AutomaticRangeReachesFromTheLeastToTheGreatestValue) {
  const Pixels pixels = drawn(run(), request("concentration"));
  const Case<2> c = testing::double_point::column();
  const auto lowest = element_centroid(c.mesh, 0);
  const auto highest = element_centroid(c.mesh, 23);
  expect_color(pixels.at(place(lowest[0], lowest[1])), viridis(0.0), "lowest");
  expect_color(pixels.at(place(highest[0], highest[1])), viridis(1.0), "highest");
}

// The soil's own linear field is y / 100: smooth within an element.
TEST_F(Render, VertexFieldsAreSmooth) {
  auto r = request("concentration");
  r.on = "node";
  r.range = {{0.0, 0.01}};
  const Pixels pixels = drawn(run(), r);
  for (const double y : {0.05, 0.2, 0.45, 0.6, 0.85}) {
    expect_color(pixels.at(place(0.8, y)), viridis(y), "y = " + std::to_string(y));
  }
}

TEST_F(Render, LiquidPointsFillTheirElements) {
  auto r = request("pressure");
  r.on = "liquid";
  r.range = {{0.0, 71.0}};
  const Pixels pixels = drawn(run(), r);
  const Case<2> c = testing::double_point::column();
  for (const int p : {0, 31, 50}) {
    const auto x = c.liquid_points.position(c.mesh, p);
    expect_color(pixels.at(place(x[0], x[1])), viridis(p / 71.0), "point " + std::to_string(p));
  }
  // Element 8 has no points and is white.
  const auto dry = c.liquid_points.position(c.mesh, 24);
  expect_color(pixels.at(place(dry[0], dry[1])), {1.0, 1.0, 1.0}, "where there is no point");
}

TEST_F(Render, VectorsShowTheirMagnitude) {
  const ResultsReader results = run();
  const FieldPlace place = find_field(results, 0, "liquid_velocity", "liquid", "test");
  const ScalarField field = read_scalar(results, 0, place);
  EXPECT_NEAR(field.values.front(), 5e-3, 1e-17);
  EXPECT_EQ(field_title(place), "Liquid velocity");
  EXPECT_EQ(field_title({"fines_left", "solid", true}), "Change of fines left since the start");
  EXPECT_EQ(field_label(place, field), "magnitude of liquid velocity v_L (m/s)");
}

TEST_F(Render, StatesHaveNamesInsteadOfABar) {
  const ResultsReader results = run();
  const auto kinds = categories(results, {"saturation_state", "cell"});
  ASSERT_EQ(kinds.size(), 4U);
  EXPECT_EQ(kinds[0].name, "dry soil");
  EXPECT_EQ(kinds[2].name, "free liquid");
  const Pixels pixels = drawn(results, request("saturation_state"));
  const Case<2> c = testing::double_point::column();
  const std::vector<std::pair<int, int>> elements{{0, 2}, {4, 1}, {8, 0}, {22, 2}, {23, 3}};
  for (const auto& [element, kind] : elements) {
    const auto x = element_centroid(c.mesh, element);
    expect_color(pixels.at(place(x[0], x[1])), kinds[kind].color,
                 "element " + std::to_string(element));
  }
  for (int a = 0; a < 4; ++a) {  // in grey, too
    for (int b = 0; b < a; ++b) {
      EXPECT_GT(std::abs(luminance(kinds[a].color) - luminance(kinds[b].color)), 0.1);
    }
  }
}

TEST_F(Render, AllFramesShareOneRange) {
  auto r = request("porosity");
  r.on = "solid";
  r.all = true;
  const auto written = render(single(), r);
  ASSERT_EQ(written,
            (std::vector<std::string>{scratch / "picture_0000.png", scratch / "picture_0001.png",
                                      scratch / "picture_0002.png"}));
  // 0.1 p + t at point p: from 0 at the first point of the first frame to 40.7.
  const Case<2> c = testing::unit_square_case();
  const auto first = c.solid_points.position(c.mesh, 0);
  const Eigen::Vector2d at{axes_left + 800.0 * first[0], axes_bottom + 800.0 * first[1]};
  const std::vector<double> times{0.0, 10.0, 40.0};
  for (std::size_t i = 0; i < written.size(); ++i) {
    expect_color(Pixels(written[i]).at(at), viridis(times[i] / 40.7), written[i]);
  }
}

TEST_F(Render, OneValueEverywhereHasOneColourAndItsNumber) {
  auto r = request("porosity");
  r.range = {{0.0, 1.0}};
  const std::size_t with_bar = drawn(run(), r).color_count();
  r = request("erosion_rate");
  EXPECT_LT(drawn(run(), r).color_count() + 150, with_bar);
  r.output = scratch / "picture.svg";
  render(run(), r);
  EXPECT_NE(testing::file_text(r.output).find(">0.001<"), std::string::npos);
}

TEST_F(Render, LinesAndArrowsAreSaidInTheLegend) {
  auto r = request("porosity");
  r.on = "node";
  r.contours = r.vectors = r.streamlines = true;
  r.output = scratch / "picture.svg";
  render(single(), r);
  const std::string svg = testing::file_text(r.output);
  // The flux of element e is (e / 4, -1) m/s, which has sources.
  for (const auto* text : {">line of equal porosity n_L (-)<", ">flux q, 2 m/s<", ">streamline; ",
                           " m3/s per m between two; unsteady flow: ", " % of the flux missed<"}) {
    EXPECT_NE(svg.find(text), std::string::npos) << text;
  }
  r.output = scratch / "picture.pdf";
  render(single(), r);
  EXPECT_GT(std::filesystem::file_size(r.output), 5000U);
}

TEST_F(Render, APartOfTheModelFillsThePictureWithItsOwnColours) {
  auto r = request("porosity");
  r.on = "node";
  r.view = {{Vector<2>(0.0, 0.5), Vector<2>(0.5, 1.0)}};
  const Pixels pixels = drawn(single(), r);
  // 0.3 + 0.01 x + 0.02 y + 0.04 (1 + x) in all elements that reach into the part.
  const auto porosity = [](double x, double y) { return testing::linear_porosity(x, y, 40.0); };
  const double low = porosity(0.0, 0.5);
  const double high = porosity(0.5, 1.0);
  for (const auto& [x, y] : {std::pair{0.1, 0.7}, std::pair{0.4, 0.55}, std::pair{0.3, 0.95}}) {
    const Eigen::Vector2d at{axes_left + 1600.0 * x, axes_bottom + 1600.0 * (y - 0.5)};
    expect_color(pixels.at(at), viridis((porosity(x, y) - low) / (high - low)), "in view");
  }
  const Eigen::Vector2d beside{axes_left + 1600.0 * 0.51, axes_bottom + 400.0};
  expect_color(pixels.at(beside), {1.0, 1.0, 1.0}, "out of view");
}

/// The unit square with a field x at its nodes.
FieldPicture linear_picture(const Mesh<2>& mesh) {
  FieldPicture picture;
  picture.title = "x";
  picture.label = "x (m)";
  picture.where = "node";
  for (const auto& x : mesh.nodes) picture.values.push_back(x[0]);
  picture.scale.range = {0.0, 1.0};
  return picture;
}

TEST_F(Render, ContoursLieOnRoundValuesAndStreamlinesBetweenTubes) {
  const Mesh<2> mesh = testing::unit_square_case().mesh;
  FieldPicture picture = linear_picture(mesh);
  picture.contours = true;
  for (const auto& x : mesh.nodes) picture.streamfunction.push_back(2.0 * x[1]);
  picture.tube = 0.4;
  const std::string path = scratch / "lines.png";
  draw_field_picture(picture_model(mesh, {}), picture, path);
  const Pixels pixels(path);
  const double bottom = axes_bottom + 60.0;
  const auto at = [&](double x, double y) {
    return pixels.at(Eigen::Vector2d{axes_left + 800.0 * x, bottom + 800.0 * y});
  };
  const auto dark = [](const std::array<int, 3>& c) { return c[0] + c[1] + c[2] < 150; };
  for (const double x : {0.2, 0.4, 0.8}) {
    bool found = false;
    for (const double off : {-1.0, 0.0, 1.0}) found = found || dark(at(x + off / 800.0, 0.25));
    EXPECT_TRUE(found) << x;
  }
  // psi = 0.2, 0.6, ... 1.8, red on yellow.
  for (const double y : {0.1, 0.3, 0.9}) {
    int least = 255;  // of green
    for (const double off : {-1.0, 0.0, 1.0}) least = std::min(least, at(0.93, y + off / 800.0)[1]);
    EXPECT_LT(least, 100) << y;
  }
  expect_color(at(0.93, 0.2), viridis(0.93), "between two");
}

TEST_F(Render, TheBarIsAsLongAsTheMapAndLiesBelowALowOne) {
  Mesh<2> mesh = testing::unit_square_case().mesh;
  const std::string path = scratch / "bar.png";
  draw_field_picture(picture_model(mesh, {}), linear_picture(mesh), path);
  const Pixels upright(path);
  for (const double share : {0.02, 0.5, 0.98}) {
    const Eigen::Vector2d at{axes_left + 800.0 + 55.0, axes_bottom + 800.0 * share};
    expect_color(upright.at(at), viridis(share), "upright");
  }
  for (Vector<2>& x : mesh.nodes) x[1] *= 0.1;
  draw_field_picture(picture_model(mesh, {}), linear_picture(mesh), path);
  const Pixels lying(path);
  EXPECT_LT(lying.height(), 400);
  for (const double share : {0.02, 0.3, 0.98}) {
    expect_color(lying.at(Eigen::Vector2d{axes_left + 1000.0 * share, 87.0}), viridis(share),
                 "lying");
  }
}

TEST_F(Render, WallsAndWellsAreDrawnAndNamed) {
  const Mesh<2> mesh = testing::unit_square_case().mesh;
  PictureModel model = picture_model(mesh, {});
  const auto& nodes = mesh.elements[0];
  model.structures.walls = {{nodes[0], nodes[1]}};
  model.structures.wells = {{nodes[1], nodes[2]}};
  const std::string path = scratch / "wall.png";
  draw_field_picture(model, linear_picture(mesh), path);
  const Pixels pixels(path);
  const auto at = [&](int i, int j) {
    const Vector<2> x = 0.5 * (mesh.nodes[i] + mesh.nodes[j]);
    return pixels.at(Eigen::Vector2d{axes_left + 800.0 * x[0], axes_bottom + 60.0 + 800.0 * x[1]});
  };
  expect_color(at(nodes[0], nodes[1]), {0.0, 0.0, 0.0}, "wall");
  expect_color(at(nodes[1], nodes[2]), {0.8, 0.0, 0.0}, "well");
  draw_field_picture(model, linear_picture(mesh), scratch / "wall.svg");
  const std::string svg = testing::file_text(scratch / "wall.svg");
  for (const auto* text : {">wall<", ">well or drain<"}) {
    EXPECT_NE(svg.find(text), std::string::npos) << text;
  }
}

TEST_F(Render, AFieldThatDidNotChangeSaysSo) {
  auto r = request("erosion_rate");
  r.change = true;
  r.output = scratch / "same.svg";
  render(run(), r);
  EXPECT_NE(testing::file_text(r.output).find(">Erosion rate has not changed since the start, "),
            std::string::npos);
}

TEST(ColorMap, RegionsDifferInGreyToo) {
  for (std::size_t r = 0; r + 1 < 8; ++r) {
    EXPECT_GT(luminance(region_color(r + 1, 8)), luminance(region_color(r, 8)) + 0.02) << r;
  }
}

TEST_F(Render, ArrowsPointAlongTheFlux) {
  const Mesh<2> mesh = testing::unit_square_case().mesh;
  FieldPicture picture = linear_picture(mesh);
  for (int e = 0; e < mesh.element_count(); ++e) {
    picture.arrows.insert(picture.arrows.end(), {0.0, 3e-5});
  }
  const std::string path = scratch / "arrows.png";
  draw_field_picture(picture_model(mesh, {}), picture, path);
  const Pixels pixels(path);
  // The first place of the grid is 21 pixels from both sides; the arrow is 38 long, upwards.
  const Eigen::Vector2d middle{axes_left + 21.0, axes_bottom + 30.0 + 21.0};
  const auto brightness = [&](double x, double y) {
    const auto color = pixels.at(Eigen::Vector2d(middle + Eigen::Vector2d(x, y)));
    return color[0] + color[1] + color[2];
  };
  EXPECT_LT(brightness(-0.5, 0.0), 400) << "shaft";
  EXPECT_LT(brightness(1.5, 11.0), 200) << "head";
  EXPECT_GT(brightness(1.5, -11.0), 400) << "white beside the shaft";
}

// Porosity grows by 0.04 (1 + x) from the first snapshot to the last.
TEST_F(Render, AChangeIsThatSinceTheStart) {
  auto r = request("porosity");
  r.on = "node";
  r.change = true;
  const Pixels pixels = drawn(single(), r);
  for (const double x : {0.1, 0.45, 0.8}) {
    const Eigen::Vector2d at{axes_left + 800.0 * x, axes_bottom + 800.0 * 0.65};
    expect_color(pixels.at(at), viridis(x), "x = " + std::to_string(x));
  }
}

TEST_F(Render, InfiniteValuesAreAsTheLargestAndHaveNoContours) {
  const Mesh<2> mesh = testing::unit_square_case().mesh;
  FieldPicture picture = linear_picture(mesh);
  picture.where = "cell";
  picture.values.assign(mesh.elements.size(), 0.5);
  picture.values[7] = HUGE_VAL;
  picture.contours = true;
  const std::string path = scratch / "infinite.png";
  draw_field_picture(picture_model(mesh, {}), picture, path);
  const Vector<2> x = element_centroid(mesh, 7);
  const Eigen::Vector2d at{axes_left + 800.0 * x[0], axes_bottom + 30.0 + 800.0 * x[1]};
  expect_color(Pixels(path).at(at), viridis(1.0), "infinite");
}

/// Means of elements would lie a third of an element aside at the border.
TEST_F(Render, ContoursOfAFieldThatNodesHaveTooReachTheBorderWhereItSays) {
  const Mesh<2> mesh = testing::unit_square_case().mesh;
  FieldPicture picture = linear_picture(mesh);
  picture.line_values = picture.values;
  picture.where = "cell";
  picture.values.clear();
  for (int e = 0; e < mesh.element_count(); ++e) {
    picture.values.push_back(element_centroid(mesh, e)[0]);
  }
  picture.contours = true;
  const std::string path = scratch / "border.png";
  draw_field_picture(picture_model(mesh, {}), picture, path);
  const Pixels pixels(path);
  for (const double y : {0.03, 0.25, 0.97}) {
    int darkest = 765;
    for (const double off : {-1.0, 0.0, 1.0}) {
      const auto c =
          pixels.at(Eigen::Vector2d{axes_left + 800.0 * 0.4 + off, axes_bottom + 30.0 + 800.0 * y});
      darkest = std::min(darkest, c[0] + c[1] + c[2]);
    }
    EXPECT_LT(darkest, 150) << y;
  }
}

TEST_F(Render, AFieldOfElementsHasContoursOfItsMeans) {
  const Mesh<2> mesh = testing::unit_square_case().mesh;
  FieldPicture picture;
  picture.where = "cell";
  for (int e = 0; e < mesh.element_count(); ++e) picture.values.push_back(e);
  const auto at_nodes = nodal_values(mesh, picture);
  // The first node is in elements 0 and 1, the middle one in 0, 1, 3, 4, 6 and 7.
  EXPECT_NEAR(at_nodes[0], 0.5, 1e-14);
  EXPECT_NEAR(at_nodes[4], 3.5, 1e-14);
}

TEST_F(Render, AnUnknownFieldListsWhatThereIsAndWhere) {
  expect_refusal(
      run(), request("concentratoin"),
      "suffuse-post render: --field: got \"concentratoin\"; expected one of the fields on cell: "
      "\"concentration\", \"conductivity\", \"porosity\", \"region\", \"saturation\" or "
      "\"saturation_state\"; on "
      "node: "
      "\"concentration\" or \"liquid_velocity\"; on solid: \"erosion_rate\"; on liquid: "
      "\"concentration\", \"liquid_velocity\" or \"pressure\"; did you mean concentration?");
}

TEST_F(Render, OtherRefusals) {
  auto r = request("porosity");
  r.on = "liquid";
  expect_refusal(single(), r,
                 "suffuse-post render: --on: got \"liquid\"; expected \"cell\", \"node\" or "
                 "\"solid\"");
  r.on.clear();
  r.time = std::nan("");
  expect_refusal(
      run(), r,
      "suffuse-post render: --time: got nan; expected a time from 0 to 40 s, the first and "
      "last snapshot");
  r.time.reset();
  r.output = scratch / "picture.bmp";
  expect_refusal(run(), r,
                 "suffuse-post render: -o: got \"" + r.output +
                     "\"; expected a name that ends in .png, .svg or .pdf");
  EXPECT_EQ(parse_range("-1:2.5"), (std::array<double, 2>{-1.0, 2.5}));
  EXPECT_EQ(parse_range("-1,2.5"), (std::array<double, 2>{-1.0, 2.5}));
  for (const std::string text : {"1", "1,1", "2,1", "1,x", "nan,1", "1,2,3", ",", "2:1", "1:2:3"}) {
    EXPECT_THROW(parse_range(text), InputError) << text;
  }
  EXPECT_EQ(parse_view("-1,0:2,3")[1], Vector<2>(2.0, 3.0));
  for (const std::string text : {"0,0:1", "1,0:0,1", "0,1:1,1", "x"}) {
    EXPECT_THROW(parse_view(text), InputError) << text;
  }
}

TEST_F(Render, RefusesLinesColoursAndPartsThatCannotBe) {
  auto r = request("saturation_state");
  r.contours = true;
  expect_refusal(run(), r,
                 "suffuse-post render: --contours: got a field of kinds, \"saturation_state\"; "
                 "expected a field of numbers");
  r = request("pressure");
  r.on = "liquid";
  r.contours = true;
  expect_refusal(run(), r,
                 "suffuse-post render: --contours: got a field of points, \"pressure\" on liquid; "
                 "expected a field on cell or node");
  r = request("region");
  r.change = true;
  expect_refusal(
      run(), r,
      "suffuse-post render: --change: got a field of kinds, \"region\"; expected a field "
      "of numbers");
  r = request("concentration");
  r.logarithmic = true;
  r.range = {{-1.0, 1.0}};
  expect_refusal(run(), r,
                 "suffuse-post render: --range: got -1 with --log; expected a range above zero");
  r = request("porosity");
  r.view = {{Vector<2>(5.0, 5.0), Vector<2>(6.0, 6.0)}};
  expect_refusal(run(), r,
                 "suffuse-post render: --view: got a part with nothing of the model in it; "
                 "expected x0,y0:x1,y1 in metres, with some");
  r = request("porosity");
  r.time = 1e9;
  expect_refusal(
      run(), r,
      "suffuse-post render: --time: got 1e+09; expected a time from 0 to 40 s, the first "
      "and last snapshot");
  // Snapshots are at 0, 10 and 40 s: the last one stands for times up to half an interval after it.
  r.time = 54.0;
  EXPECT_EQ(render(run(), r).size(), 1U);
  r.time = 56.0;
  EXPECT_THROW(render(run(), r), InputError);
}

}  // namespace render_test
}  // namespace suffuse
