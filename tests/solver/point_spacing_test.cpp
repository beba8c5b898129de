/// Points that have been crowded are spread again.

#include "motion/point_spacing.hpp"

#include <gtest/gtest.h>

#include "box_mesh.hpp"
#include "grid/near_element.hpp"
#include "motion/solid_flux.hpp"
#include "solver/solid_model.hpp"

namespace suffuse {
namespace {

template <int Dim>
struct Box;

template <>
struct Box<2> {
  static Mesh<2> mesh() { return model::column_mesh(8, 8, 1.0, 1.0); }
  static std::vector<QuadraturePoint<2>> places() { return model::places_in_triangle(4); }
};

template <>
struct Box<3> {
  static Mesh<3> mesh() { return model::box_mesh({6, 6, 6}); }
  static std::vector<QuadraturePoint<3>> places() { return model::places_in_tetrahedron(); }
};

template <class Size>
class PointSpacing : public testing::Test {
 protected:
  static constexpr int dim = Size::value;
  using Model = model::SolidModel<dim>;

  PointSpacing()
      : m(Box<dim>::mesh(), Box<dim>::places(), model::elastic_soil(1e6, 0.3),
          [](const Vector<dim>& x) { return x[0] < 0.75; }) {
    m.support("left", Support::normal);
    m.support("bottom", Support::both);
  }
  /// Moves all points towards the left side, with their volumes.
  void crowd(double factor) {
    for (int p = 0; p < m.points.size(); ++p) {
      m.points.position[p][0] *= factor;
      m.points.element[p] = element_at(m.grid, m.points.element[p], m.points.position[p]);
    }
  }
  [[nodiscard]] double fullest() const {
    const std::vector<double> filled = smooth_volumes(m.grid, m.points, m.points.volume);
    double result = 0.0;
    for (std::size_t e = 0; e < filled.size(); ++e) {
      result = std::max(result, filled[e] / m.grid.volume[e]);
    }
    return result;
  }

  /// Spreads points in a step that has moved all nodes by this length, m.
  void space(double length) {
    const Supports<dim> supports(m.grid, m.face_support);
    const NodeVectors<dim> moved(m.mesh.node_count(), length * Vector<dim>::UnitX());
    space_points(m.grid, supports, moved, m.points);
  }

  Model m;
};

using Sizes = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(PointSpacing, Sizes);

TYPED_TEST(PointSpacing, SpreadsPointsThatShareTheRoomOfOthers) {
  auto& box = this->m;
  this->crowd(0.6);
  EXPECT_GT(this->fullest(), 1.6);
  const std::vector<double> volume = box.points.volume;
  double before = this->fullest();
  for (int step = 0; step < 30 && before > 1.3; ++step) {
    this->space(1.0);
    EXPECT_LT(this->fullest(), before) << step;
    before = this->fullest();
  }
  EXPECT_LE(this->fullest(), 1.3);
  EXPECT_EQ(box.points.volume, volume);
  for (int p = 0; p < box.points.size(); ++p) {
    const Vector<TestFixture::dim>& x = box.points.position[p];
    EXPECT_EQ(box.points.element[p], element_at(box.grid, box.points.element[p], x)) << p;
    EXPECT_GE(x.minCoeff(), -1e-12) << p;
    EXPECT_LE(x.maxCoeff(), 1.0 + 1e-12) << p;
  }
}

TYPED_TEST(PointSpacing, LeavesPointsAloneThatOverlapALittle) {
  this->crowd(0.9);
  auto& box = this->m;
  const auto before = box.points.position;
  this->space(1.0);
  EXPECT_EQ(box.points.position, before);
}

TYPED_TEST(PointSpacing, MovesPointsNoFartherThanTheSoilMoves) {
  this->crowd(0.6);
  auto& box = this->m;
  const auto before = box.points.position;
  this->space(0.0);
  EXPECT_EQ(box.points.position, before);
  this->space(1e-6);
  for (int p = 0; p < box.points.size(); ++p) {
    EXPECT_LE((box.points.position[p] - before[p]).norm(), 1.1e-5) << p;
  }
  EXPECT_NE(box.points.position, before);
}

}  // namespace
}  // namespace suffuse
