#include "points/liquid_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "points/concentration_fit.hpp"
#include "solver/model_case.hpp"

namespace suffuse {
namespace liquid_points_test {

/// Random points in the elements; all columns of a point identify its id.
LiquidPoints<2> tagged_points(int count, int elements, bool with_flow) {
  LiquidPoints<2> points;
  std::mt19937_64 random(4);
  for (int p = 0; p < count; ++p) {
    const double tag = p;
    points.element.push_back(static_cast<int>(random() % elements));
    points.barycentric.push_back({tag, 0.0, 1.0 - tag});
    points.water_mass.push_back(tag + 0.1);
    points.fines_mass.push_back(tag + 0.2);
    points.id.push_back(p);
    if (!with_flow) continue;
    points.pressure.push_back(tag + 0.3);
    points.velocity.emplace_back(tag, -tag);
  }
  return points;
}

/// Checks that every column still identifies the id.
void expect_whole(const LiquidPoints<2>& points, bool with_flow) {
  for (int p = 0; p < points.size(); ++p) {
    const auto tag = static_cast<double>(points.id[p]);
    EXPECT_EQ(points.barycentric[p][0], tag);
    EXPECT_EQ(points.water_mass[p], tag + 0.1);
    EXPECT_EQ(points.fines_mass[p], tag + 0.2);
    if (!with_flow) continue;
    EXPECT_EQ(points.pressure[p], tag + 0.3);
    EXPECT_EQ(points.velocity[p], Vector<2>(tag, -tag));
  }
}

TEST(LiquidPoints, SortingKeepsPointsWholeAndInOrderWithinAnElement) {
  for (const bool with_flow : {false, true}) {
    LiquidPoints<2> points = tagged_points(200, 7, with_flow);
    const std::vector<int> element_of_id = points.element;
    sort_by_element(points, 8);
    EXPECT_EQ(points.size(), 200);
    EXPECT_TRUE(std::is_sorted(points.element.begin(), points.element.end()));
    for (int p = 0; p < points.size(); ++p) {
      EXPECT_EQ(points.element[p], element_of_id[points.id[p]]);
      if (p > 0 && points.element[p] == points.element[p - 1]) {
        EXPECT_LT(points.id[p - 1], points.id[p]);
      }
    }
    expect_whole(points, with_flow);
    EXPECT_EQ(points.pressure.empty(), !with_flow);

    const std::vector<int> begins = element_begins(points, 8);
    ASSERT_EQ(begins.size(), 9u);
    EXPECT_EQ(begins.front(), 0);
    EXPECT_EQ(begins.back(), 200);
    EXPECT_EQ(begins[7], 200) << "the last element has none";
    for (int e = 0; e < 8; ++e) {
      for (int p = begins[e]; p < begins[e + 1]; ++p) EXPECT_EQ(points.element[p], e);
    }
  }
}

TEST(LiquidPoints, KeepingSomeKeepsThemWhole) {
  for (const bool with_flow : {false, true}) {
    LiquidPoints<2> points = tagged_points(50, 7, with_flow);
    std::vector<unsigned char> keep(50);
    std::vector<long> expected;
    for (int p = 0; p < 50; ++p) {
      keep[p] = p % 3 == 1 ? 1 : 0;
      if (keep[p] != 0) expected.push_back(p);
    }
    keep_points(points, keep);
    EXPECT_EQ(points.id, expected);
    expect_whole(points, with_flow);
    EXPECT_EQ(points.pressure.size(), with_flow ? expected.size() : 0u);
  }
}

TEST(LiquidPoints, VolumeIsThatOfWaterAndGrains) {
  const LiquidDensities densities{1000.0, 2700.0};
  EXPECT_DOUBLE_EQ(liquid_volume(2.0, 0.0, densities, 1.0), 2e-3);
  EXPECT_DOUBLE_EQ(liquid_volume(2.0, 5.4, densities, 1.0), 4e-3);
  // Grains are incompressible.
  EXPECT_DOUBLE_EQ(liquid_volume(2.0, 5.4, densities, 2.0), 3e-3);
}

/// A case of two regions, divided at y = 0.5, with three points per element.
struct FitCase {
  FitCase() : mesh(model::column_mesh(4, 4, 1.0, 1.0, model::jittered(0.05, 1))), grid(mesh) {
    mesh.region_names = {"below", "above"};
    for (int e = 0; e < mesh.element_count(); ++e) {
      mesh.element_region[e] = element_centroid(mesh, e)[1] > 0.5 ? 1 : 0;
      for (int k = 0; k < 3; ++k) {
        std::array<double, 3> at{0.2, 0.2, 0.2};
        at[k] = 0.6;
        points.element.push_back(e);
        points.barycentric.push_back(at);
      }
    }
    volume.assign(points.size(), 1e-3);
  }
  FitCase(const FitCase&) = delete;
  FitCase& operator=(const FitCase&) = delete;
  ~FitCase() = default;

  [[nodiscard]] ElementField<2> fit(const std::vector<double>& values) const {
    return concentration_fit(grid, points, element_begins(points, mesh.element_count()), volume,
                             values);
  }

  Mesh<2> mesh;
  Grid<2> grid;
  LiquidPoints<2> points;
  std::vector<double> volume;
};

TEST(ConcentrationFit, IsExactForALinearFunctionInEachRegion) {
  const FitCase c;
  const auto exact = [&](const Vector<2>& x, int region) {
    return region == 0 ? 0.1 + 0.2 * x[0] - 0.05 * x[1] : 0.4 - 0.1 * x[0];
  };
  std::vector<double> values;
  values.reserve(c.points.size());
  for (int p = 0; p < c.points.size(); ++p) {
    values.push_back(
        exact(c.points.place(p).position(c.mesh), c.mesh.element_region[c.points.element[p]]));
  }
  const ElementField<2> fit = c.fit(values);
  for (int e = 0; e < c.mesh.element_count(); ++e) {
    const ElementValues<2> at_vertices = FieldNodes<2>::at_vertices(fit[e]);
    for (int a = 0; a < 3; ++a) {
      EXPECT_NEAR(at_vertices[a],
                  exact(c.mesh.nodes[c.mesh.elements[e][a]], c.mesh.element_region[e]), 1e-12);
    }
  }
}

TEST(ConcentrationFit, GoesByTheNeighboursWhereAnElementIsEmpty) {
  FitCase c;
  std::vector<unsigned char> keep(c.points.size(), 1);
  // Three neighbouring elements lose all their points.
  for (int p = 0; p < c.points.size(); ++p) {
    if (c.points.element[p] >= 2 && c.points.element[p] < 5) keep[p] = 0;
  }
  c.points.water_mass.assign(keep.size(), 1.0);
  c.points.fines_mass.assign(keep.size(), 0.0);
  c.points.id.assign(keep.size(), 0);
  keep_points(c.points, keep);
  std::vector<double> values;
  values.reserve(c.points.size());
  for (int p = 0; p < c.points.size(); ++p) {
    values.push_back(0.1 + 0.3 * c.points.place(p).position(c.mesh)[0]);
  }
  c.volume.resize(values.size());
  const ElementField<2> fit = c.fit(values);
  for (int e = 2; e < 5; ++e) {
    const ElementValues<2> at_vertices = FieldNodes<2>::at_vertices(fit[e]);
    for (int a = 0; a < 3; ++a) {
      EXPECT_NEAR(at_vertices[a], 0.1 + 0.3 * c.mesh.nodes[c.mesh.elements[e][a]][0], 1e-12);
    }
  }
}

TEST(ConcentrationFit, IsZeroWithoutAnyLiquid) {
  FitCase c;
  c.points = {};
  c.volume.clear();
  for (const ElementValues<2>& values : c.fit({})) {
    for (const double v : values) EXPECT_EQ(v, 0.0);
  }
}

}  // namespace liquid_points_test
}  // namespace suffuse
