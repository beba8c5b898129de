#include "field/eulerian.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "solver/model_case.hpp"

namespace suffuse {
namespace eulerian_test {

constexpr double height_flux = 0.012;

struct Column {
  Column(Mesh<2> mesh, double inflow_concentration)
      : c(make(std::move(mesh), inflow_concentration)),
        grid(c.mesh),
        conditions(face_conditions(c, grid)),
        sides(grid),
        transport(grid, sides, conditions) {
    state.liquid_volume.resize(c.mesh.element_count());
    state.fines_volume.assign(c.mesh.element_count(), ElementValues<2>{});
    nothing_eroded.assign(c.mesh.element_count(), ElementValues<2>{});
    for (int e = 0; e < c.mesh.element_count(); ++e) {
      state.liquid_volume[e].fill(0.3 * grid.volume[e] / 3.0);
    }
    // Uniform downward flux: exactly divergence-free.
    for (int f = 0; f < grid.face_count(); ++f) {
      const double flux = grid.face_normal[f].dot(Vector<2>(0.0, -height_flux));
      const bool wall = conditions[f].kind == FaceKind::wall;
      volume.push_back(wall ? 0.0 : flux);
    }
  }
  static Case<2> make(Mesh<2> mesh, double inflow_concentration) {
    Scene scene = model::paper_scene();
    scene.boundaries = {model::flux_on("top", height_flux), model::pressure_on("bottom", 0.0)};
    scene.boundaries[0].concentration = inflow_concentration;
    return model::make_case(std::move(mesh), scene);
  }
  [[nodiscard]] double fines() const {
    double sum = 0.0;
    for (const auto& values : state.fines_volume) sum += element_sum<2>(values);
    return sum;
  }
  /// Advances by `time` in steps of the limit; returns the net volume of grains that came in.
  double run(double time) {
    double in = 0.0;
    const double allowed = 0.9 * transport.steps_allowed(state, volume);
    const int steps = static_cast<int>(std::ceil(time / allowed));
    std::vector<double> part = volume;
    for (double& v : part) v *= time / steps;
    TransportScratch<2> scratch;
    transport.start(state, part, scratch);
    for (int s = 0; s < steps; ++s) {
      transport.advance(state, nothing_eroded, {}, scratch);
      for (std::size_t e = 0; e < state.fines_volume.size(); ++e) {
        for (int j = 0; j < 3; ++j) {
          const double c_node = state.fines_volume[e][j] / state.liquid_volume[e][j];
          lowest = std::min(lowest, c_node);
          highest = std::max(highest, c_node);
        }
      }
    }
    std::vector<double> crossed;
    transport.fines_crossed(scratch, crossed);
    for (int f = 0; f < grid.face_count(); ++f) {
      if (grid.is_outer(f)) in -= crossed[f];
    }
    return in;
  }

  Case<2> c;
  Grid<2> grid;
  std::vector<FaceCondition> conditions;
  ElementSides<2> sides;
  EulerianTransport<2> transport;
  FinesState<2> state;
  ElementField<2> nothing_eroded;
  std::vector<double> volume;
  double lowest = 1.0;
  double highest = 0.0;
};

Mesh<2> distorted() {
  return model::column_mesh(6, 8, 1.0, 1.0, model::jittered(0.04, 9));
}

TEST(EulerianTransport, KeepsAConstantConcentration) {
  Column s(distorted(), 0.2);
  for (std::size_t e = 0; e < s.state.fines_volume.size(); ++e) {
    for (int j = 0; j < 3; ++j) s.state.fines_volume[e][j] = 0.2 * s.state.liquid_volume[e][j];
  }
  s.run(20.0);
  EXPECT_NEAR(s.lowest, 0.2, 1e-13);
  EXPECT_NEAR(s.highest, 0.2, 1e-13);
}

TEST(EulerianTransport, AFrontStaysWithinBoundsAndEveryGrainIsBooked) {
  Column s(distorted(), 0.6);
  const double in = s.run(10.0);
  EXPECT_GE(s.lowest, 0.0);
  EXPECT_LE(s.highest, 0.6 + 1e-11);
  EXPECT_NEAR(s.fines(), in, 1e-15);
  // After 10 s the front stands at q t / n = 0.4 m.
  EXPECT_NEAR(in, 0.6 * height_flux * 10.0, 1e-8);
}

TEST(EulerianTransport, ASmoothProfileIsSecondOrder) {
  // A bump moves down by 0.4 m; the limiter may clip its top, so the norm is L1.
  const auto bump = [](double y) {
    return y > 0.4 && y < 1.0 ? 0.3 * std::pow(std::sin((y - 0.4) / 0.6 * std::numbers::pi), 4)
                              : 0.0;
  };
  std::vector<double> errors;
  for (const int cells : {16, 32, 64}) {
    Column s(model::column_mesh(2, cells), 0.0);
    const auto node_height = [&](int e, int j) {
      double y = 0.0;
      for (int k = 0; k < 3; ++k) {
        y += (k == j ? 2.0 / 3.0 : 1.0 / 6.0) * s.c.mesh.nodes[s.c.mesh.elements[e][k]][1];
      }
      return y;
    };
    for (int e = 0; e < s.c.mesh.element_count(); ++e) {
      for (int j = 0; j < 3; ++j) {
        s.state.fines_volume[e][j] = s.state.liquid_volume[e][j] * bump(node_height(e, j));
      }
    }
    // A step without flow limits the profile first.
    TransportScratch<2> scratch;
    s.transport.start(s.state, std::vector<double>(s.volume.size(), 0.0), scratch);
    s.transport.advance(s.state, {}, {}, scratch);
    s.run(10.0);
    double error = 0.0;
    for (int e = 0; e < s.c.mesh.element_count(); ++e) {
      for (int j = 0; j < 3; ++j) {
        const double c = s.state.fines_volume[e][j] / s.state.liquid_volume[e][j];
        error += s.grid.volume[e] / 3.0 * std::abs(c - bump(node_height(e, j) + 0.4));
      }
    }
    errors.push_back(error);
  }
  EXPECT_GE(std::log2(errors[1] / errors[2]), 1.7) << errors[1] << " -> " << errors[2];
  EXPECT_LE(errors[2], 1e-3);
}

TEST(Transport, CountsStepsUpToALimit) {
  const auto count = [](double allowed) {
    return step_count(allowed, 0.0, 5.0, {1e3, "the flow has run away"});
  };
  EXPECT_EQ(count(2.0), 1.0);
  EXPECT_EQ(count(0.1), 10.0);
  EXPECT_EQ(count(1e-3), 990.0);
  for (const double allowed : {9e-4, 0.0, -0.1, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(static_cast<void>(count(allowed)), NumericalError) << allowed;
  }
}

TEST(EulerianTransport, AStepBeyondTheLimitIsWhatTheLimitIsFor) {
  Column s(distorted(), 0.0);
  EXPECT_NEAR(
      s.transport.steps_allowed(s.state, s.volume) * 0.5,
      [&] {
        std::vector<double> twice = s.volume;
        for (double& v : twice) v *= 2.0;
        return s.transport.steps_allowed(s.state, twice);
      }(),
      1e-12);
  EXPECT_EQ(s.transport.steps_allowed(s.state, std::vector<double>(s.volume.size(), 0.0)),
            std::numeric_limits<double>::infinity());
}

}  // namespace eulerian_test
}  // namespace suffuse
