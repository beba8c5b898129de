#include "field/swept_field.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "field/field_transport.hpp"
#include "grid/field_values.hpp"
#include "solid/pores.hpp"
#include "solid/rigid_skeleton.hpp"
#include "solver/model_case.hpp"

namespace suffuse {
namespace swept_field_test {

/// A closed box of water in soil, or a column that water crosses; the flow is that of a stream
/// function, so it balances to round-off.
struct Box {
  explicit Box(const std::function<double(const Vector<2>&)>& stream)
      : c(make()),
        grid(c.mesh),
        values(c, grid),
        soils(c),
        skeleton(grid, soils, TimeSpan::never(), 1),
        sides(grid),
        field(grid, sides, soils, values, 1) {
    state.liquid_volume = initial_pore_volume(grid, soils);
    state.fines_volume = state.liquid_volume;
    for (int f = 0; f < grid.face_count(); ++f) {
      const auto& [a, b] = grid.face_nodes[f];
      const Vector<2> along = c.mesh.nodes[b] - c.mesh.nodes[a];
      const double volume = stream(c.mesh.nodes[b]) - stream(c.mesh.nodes[a]);
      const double side = along[0] * grid.face_normal[f][1] - along[1] * grid.face_normal[f][0];
      volumes.push_back(side > 0.0 ? volume : -volume);
    }
  }
  static Case<2> make() {
    Scene scene = model::paper_scene();
    scene.soils[0].erosion = {};
    return model::make_case(model::column_mesh(8, 8, 1.0, 1.0), scene);
  }
  void fill(const std::function<double(const Vector<2>&)>& concentration) {
    for (int e = 0; e < grid.mesh.element_count(); ++e) {
      for (int j = 0; j < 3; ++j) {
        const Vector<2> x = FieldNodes<2>::position(grid.mesh, e, j);
        state.fines_volume[e][j] = state.liquid_volume[e][j] * concentration(x);
      }
    }
  }
  [[nodiscard]] double fines() const {
    double sum = 0.0;
    for (const auto& at_nodes : state.fines_volume) sum += element_sum<2>(at_nodes);
    return sum;
  }
  [[nodiscard]] std::pair<double, double> range() const {
    double low = 1.0;
    double high = 0.0;
    for (std::size_t e = 0; e < state.fines_volume.size(); ++e) {
      for (int j = 0; j < 3; ++j) {
        const double at_node = state.fines_volume[e][j] / state.liquid_volume[e][j];
        low = std::min(low, at_node);
        high = std::max(high, at_node);
      }
    }
    return {low, high};
  }
  /// Makes a step with `times` the volumes.
  bool step(double times) {
    std::vector<double> crossing = volumes;
    for (double& volume : crossing) volume *= times;
    field.start(crossing, {});
    StepErrors errors;
    const PointFlows flows;
    if (!field.solve(state, {skeleton, flows, 0.0, 1.0, false}, 1.0, errors)) return false;
    field.finish(state, ElementField<2>(grid.mesh.element_count(), ElementValues<2>{}));
    return true;
  }

  Case<2> c;
  Grid<2> grid;
  BoundaryValues<2> values;
  SoilMap<2> soils;
  RigidSkeleton<2> skeleton;
  ElementSides<2> sides;
  SweptField<2> field;
  FinesState<2> state;
  std::vector<double> volumes;
};

double around(const Vector<2>& x) {
  // Exactly zero along the border.
  return 16.0 * x[0] * (1.0 - x[0]) * x[1] * (1.0 - x[1]);
}

TEST(SweepOrder, ComesAlongTheFlow) {
  Box box([](const Vector<2>& x) { return 1e-3 * (x[0] + 0.3 * x[1]); });
  box.fill([](const Vector<2>&) { return 0.1; });
  ASSERT_TRUE(box.step(1.0));
  const SweepOrder& order = box.field.order();
  EXPECT_TRUE(order.largest_circle() == 0);
  ASSERT_EQ(order.elements.size(), box.grid.mesh.elements.size());
  std::vector<int> place(order.elements.size(), -1);
  for (std::size_t i = 0; i < order.elements.size(); ++i) {
    place[order.elements[i]] = static_cast<int>(i);
  }
  for (int e = 0; e < box.grid.mesh.element_count(); ++e) {
    ASSERT_GE(place[e], 0);
    const auto outflow = box.sides.outflow(e, box.volumes);
    for (int k = 0; k < 3; ++k) {
      const int upwind = box.sides.of(e).neighbour[k];
      if (upwind < 0 || outflow[k] >= 0.0) continue;
      EXPECT_LT(place[upwind], place[e]);
    }
  }
}

/// Liquid that circulates carries its fines along, in steps of any length: nothing is lost, and the
/// concentration nowhere leaves its initial range.
TEST(SweptField, GoesAroundInACircle) {
  for (const double times : {0.01, 1.0, 10.0}) {
    Box box(around);
    box.fill([](const Vector<2>& x) { return x[1] > 0.5 ? 0.2 : 0.1; });
    const double before = box.fines();
    for (int step = 0; step < 3; ++step) ASSERT_TRUE(box.step(times)) << times;
    EXPECT_GT(box.field.order().largest_circle(), 100);
    EXPECT_NEAR(box.fines(), before, 1e-12 * before) << times;
    const auto [low, high] = box.range();
    EXPECT_GE(low, 0.1 * (1.0 - 1e-10)) << times;
    EXPECT_LE(high, 0.2 * (1.0 + 1e-10)) << times;
  }
}

TEST(SweptField, KeepsAConstantConcentration) {
  Box box(around);
  box.fill([](const Vector<2>&) { return 0.15; });
  ASSERT_TRUE(box.step(5.0));
  const auto [low, high] = box.range();
  EXPECT_NEAR(low, 0.15, 1e-12);
  EXPECT_NEAR(high, 0.15, 1e-12);
}

/// Every point gives the same volume, whatever the liquid requests.
class GivingSkeleton final : public ErodingSkeleton<2> {
 public:
  GivingSkeleton(const Grid<2>& grid, const SoilMap<2>& soils, double volume)
      : ErodingSkeleton<2>(grid, soils, TimeSpan::never(), 1), volume_(volume) {}
  [[nodiscard]] std::vector<double> element_porosity() const override { return {}; }
  void apply(const std::vector<Exchange>& /*change*/, std::vector<double>& exchange) override {
    exchange.assign(soils().points().size(), volume_);
  }

 private:
  double volume_;
};

/// The liquid receives fines at the present places of points: in an element that got a neighbour's
/// points, and in one that has lost its own.
TEST(ImplicitTransport, ReceivesWherePointsHaveMovedTo) {
  Box box(around);
  FieldTransport<2> transport(box.grid, box.soils, box.values.at(0.0), box.values,
                              {.scheme = TransportScheme::implicit_sweeps,
                               .implicit = {.end = 1.0, .step_is_given = true},
                               .points_move = true},
                              1);
  MaterialPoints<2> moved = box.soils.points();
  for (int p = 0; p < moved.size(); ++p) {
    moved.barycentric[p] = {0.7, 0.2, 0.1};
    if (moved.element[p] == 1) moved.element[p] = 0;
  }
  const auto points = static_cast<std::size_t>(moved.size());
  box.soils.move_points(moved, std::vector<int>(points, 0));
  const FinesState<2> before = transport.state();
  FlowProgress flow;
  flow.end = 1.0;
  flow.volumes.liquid.assign(box.grid.face_count(), 0.0);
  constexpr double given = 1e-6;
  GivingSkeleton solid(box.grid, box.soils, given);
  SolidExchange<2> exchange(solid, [](PointFlows&) {});
  static_cast<void>(transport.move(0.0, flow, exchange));
  ElementField<2> expected = before.liquid_volume;
  for (int p = 0; p < moved.size(); ++p) {
    for (int j = 0; j < 3; ++j) {
      expected[moved.element[p]][j] += given * FieldNodes<2>::basis(moved.barycentric[p][j]);
    }
  }
  for (int e = 0; e < box.grid.mesh.element_count(); ++e) {
    for (int j = 0; j < 3; ++j) {
      EXPECT_NEAR(transport.state().liquid_volume[e][j], expected[e][j], 1e-15);
    }
  }
}

/// The concentration at faces can be queried at any time: a query changes neither the fines that
/// cross faces nor those that stay.
TEST(FieldTransport, QuestionsChangeNothing) {
  for (const TransportScheme scheme :
       {TransportScheme::explicit_steps, TransportScheme::implicit_sweeps}) {
    Box box([](const Vector<2>& x) { return 1e-3 * x[0]; });
    box.fill([](const Vector<2>& x) { return 0.1 + 0.1 * x[1]; });
    const std::vector<FaceCondition> conditions = box.values.at(0.0);
    const auto crossed_and_left = [&](bool asks) {
      FieldTransport<2> transport(
          box.grid, box.soils, conditions, box.values,
          {.scheme = scheme, .implicit = {.end = 1.0, .step_is_given = true}}, 1);
      transport.start_from(box.state);
      const auto ask = [&] {
        if (!asks) return;
        const auto first = transport.face_concentration(0.5, box.volumes);
        EXPECT_EQ(transport.face_concentration(0.5, box.volumes), first);
      };
      FlowProgress flow;
      flow.end = 1.0;
      flow.volumes.liquid = box.volumes;
      for (double& volume : flow.volumes.liquid) volume *= 20.0;
      SolidExchange<2> exchange(box.skeleton, [](PointFlows&) {});
      ask();
      std::vector<double> crossed = transport.move(0.0, flow, exchange);
      ask();
      EXPECT_GT(largest_magnitude(crossed), 1e-6);
      return std::pair(std::move(crossed), transport.state().fines_volume);
    };
    EXPECT_EQ(crossed_and_left(true), crossed_and_left(false));
  }
}

}  // namespace swept_field_test
}  // namespace suffuse
