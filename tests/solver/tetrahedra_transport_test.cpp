/// Fluidised fines and points of the inflow, on tetrahedra.

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <numbers>

#include "box_mesh.hpp"
#include "field/eulerian.hpp"
#include "points/face_placement.hpp"
#include "points/point_injection.hpp"
#include "solver/flow_model.hpp"

namespace suffuse {
namespace tetrahedra_transport_test {

constexpr double flux = 0.012;

/// A unit cube that liquid enters from above; the flux is uniform, so exactly without divergence.
struct Cube {
  explicit Cube(Mesh<3> mesh, double inflow_concentration = 0.0)
      : c(make(std::move(mesh), inflow_concentration)),
        grid(c.mesh),
        conditions(face_conditions(c, grid)),
        sides(grid),
        transport(grid, sides, conditions) {
    state.liquid_volume.resize(c.mesh.element_count());
    state.fines_volume.assign(c.mesh.element_count(), ElementValues<3>{});
    for (int e = 0; e < c.mesh.element_count(); ++e) {
      state.liquid_volume[e].fill(0.3 * grid.volume[e] / 4.0);
    }
    set_flux({0.0, 0.0, -flux});
  }
  Cube(const Cube&) = delete;
  Cube& operator=(const Cube&) = delete;
  ~Cube() = default;
  static Case<3> make(Mesh<3> mesh, double inflow_concentration) {
    Scene scene = model::paper_scene();
    scene.boundaries = {model::flux_on("top", flux), model::pressure_on("bottom", 0.0)};
    scene.boundaries[0].concentration = inflow_concentration;
    return model::make_case(std::move(mesh), scene);
  }
  /// Sets the volumes of a uniform flux; nothing passes the walls.
  void set_flux(const Vector<3>& q) {
    volume.clear();
    for (int f = 0; f < grid.face_count(); ++f) {
      const bool wall = conditions[f].kind == FaceKind::wall;
      volume.push_back(wall ? 0.0 : grid.face_normal[f].dot(q));
    }
  }
  [[nodiscard]] double fines() const {
    double sum = 0.0;
    for (const auto& values : state.fines_volume) sum += element_sum<3>(values);
    return sum;
  }
  /// Advances by `time` in steps of a share of the limit; returns the net volume that entered.
  double run(double time, double share = 0.9) {
    const double allowed = share * transport.steps_allowed(state, volume);
    const int steps = static_cast<int>(std::ceil(time / allowed));
    std::vector<double> part = volume;
    for (double& v : part) v *= time / steps;
    transport.start(state, part, scratch);
    for (int s = 0; s < steps; ++s) {
      transport.advance(state, {}, {}, scratch);
      note_range();
    }
    transport.fines_crossed(scratch, crossed);
    double in = 0.0;
    for (int f = 0; f < grid.face_count(); ++f) in -= grid.is_outer(f) ? crossed[f] : 0.0;
    return in;
  }
  void note_range() {
    for (std::size_t e = 0; e < state.fines_volume.size(); ++e) {
      for (int j = 0; j < 4; ++j) {
        lowest = std::min(lowest, state.fines_volume[e][j] / state.liquid_volume[e][j]);
        highest = std::max(highest, state.fines_volume[e][j] / state.liquid_volume[e][j]);
      }
    }
  }

  Case<3> c;
  Grid<3> grid;
  std::vector<FaceCondition> conditions;
  ElementSides<3> sides;
  EulerianTransport<3> transport;
  FinesState<3> state;
  std::vector<double> volume;
  TransportScratch<3> scratch;
  std::vector<double> crossed;
  double lowest = 1.0;
  double highest = 0.0;
};

Mesh<3> rough_mesh(int cells) {
  return model::box_mesh({cells, cells, cells}, Vector<3>::Ones(), model::disturbed(0.2 / cells));
}

TEST(TetrahedraTransport, KeepsAConstantConcentration) {
  Cube s(rough_mesh(4), 0.2);
  for (std::size_t e = 0; e < s.state.fines_volume.size(); ++e) {
    for (int j = 0; j < 4; ++j) s.state.fines_volume[e][j] = 0.2 * s.state.liquid_volume[e][j];
  }
  s.run(20.0);
  EXPECT_NEAR(s.lowest, 0.2, 1e-13);
  EXPECT_NEAR(s.highest, 0.2, 1e-13);
}

TEST(TetrahedraTransport, AFrontStaysWithinBoundsAndEveryGrainIsBooked) {
  Cube s(rough_mesh(5), 0.6);
  const double in = s.run(10.0, 1.0);
  EXPECT_GE(s.lowest, 0.0);
  EXPECT_LE(s.highest, 0.6 + 1e-11);
  EXPECT_NEAR(s.fines(), in, 1e-15);
  // After 10 s the front is at q t / n = 0.4 m: grains that have spread ahead of it have not
  // reached the end.
  EXPECT_NEAR(in, 0.6 * flux * 10.0, 1e-6);
}

TEST(TetrahedraTransport, BothSidesOfAFaceFindTheSameGrains) {
  Cube s(rough_mesh(4), 0.6);
  s.run(10.0);
  int inner = 0;
  for (int f = 0; f < s.grid.face_count(); ++f) {
    if (s.grid.is_outer(f)) continue;
    std::array<double, 2> out{};
    for (const int side : {0, 1}) {
      const int e = side == 0 ? s.grid.face_left[f] : s.grid.face_right[f];
      const auto& faces = s.grid.element_face[e];
      const auto k = std::find(faces.begin(), faces.end(), f) - faces.begin();
      out.at(side) = s.scratch.fines_out[e][k];
    }
    EXPECT_EQ(out[0], -out[1]);
    inner += out[0] != 0.0 ? 1 : 0;
  }
  EXPECT_GE(inner, s.grid.face_count() / 2);
}

/// One element at a time, where nothing else limits the step: any flow through its faces; 0 or 0.02
/// at each of its vertices, which no limiter would leave; pores that differ little, where every
/// face has a share of its own, or by more than in any soil.
TEST(TetrahedraTransport, StepsAsLongAsAllowedTakeNoMoreThanThereIs) {
  Cube s(model::box_mesh({2, 2, 2}));
  model::Uniform uniform(4);
  for (const double contrast : {1.2, 2.0, 10.0}) {
    for (int state = 0; state < 2000; ++state) {
      const int e = state % s.grid.mesh.element_count();
      s.state.liquid_volume.assign(s.state.liquid_volume.size(), {1.0, 1.0, 1.0, 1.0});
      s.state.fines_volume.assign(s.state.fines_volume.size(), {});
      s.volume.assign(s.grid.face_count(), 0.0);
      ElementValues<3> at_vertices;
      double sum = 0.0;
      for (double& c : at_vertices) sum += c = uniform() > 0.3 ? 0.02 : 0.0;
      for (int j = 0; j < 4; ++j) {
        const double c = FieldNodes<3>::far_vertex * sum + FieldNodes<3>::spread * at_vertices[j];
        s.state.liquid_volume[e][j] = uniform() > 0.0 ? contrast : 1.0;
        s.state.fines_volume[e][j] = s.state.liquid_volume[e][j] * c;
        s.volume[s.grid.element_face[e][j]] =
            s.grid.element_face_sign[e][j] * (uniform() > 0.0 ? 1.0 : -0.1);
      }
      const double allowed = s.transport.steps_allowed(s.state, s.volume);
      if (!std::isfinite(allowed)) continue;
      for (double& v : s.volume) v *= allowed;
      s.transport.start(s.state, s.volume, s.scratch);
      ASSERT_NO_THROW(s.transport.advance(s.state, {}, {}, s.scratch)) << contrast << ' ' << state;
    }
  }
}

TEST(TetrahedraTransport, ASmoothProfileIsSecondOrder) {
  // A bump moves down by 0.4 m; the limiter may clip its top, so the norm is L1.
  const auto bump = [](double z) {
    return z > 0.4 && z < 1.0 ? 0.3 * std::pow(std::sin((z - 0.4) / 0.6 * std::numbers::pi), 4)
                              : 0.0;
  };
  std::vector<double> errors;
  for (const int cells : {16, 32, 64}) {
    const double width = 2.0 / cells;
    Cube s(model::box_mesh({2, 2, cells}, Vector<3>(width, width, 1.0)));
    const auto for_each_node = [&](const auto& visit) {
      for (int e = 0; e < s.grid.mesh.element_count(); ++e) {
        for (int j = 0; j < 4; ++j) {
          double z = 0.0;
          for (int k = 0; k < 4; ++k) {
            z += (k == j ? FieldNodes<3>::near_vertex : FieldNodes<3>::far_vertex) *
                 s.grid.mesh.nodes[s.grid.mesh.elements[e][k]][2];
          }
          visit(e, j, z);
        }
      }
    };
    for_each_node([&](int e, int j, double z) {
      s.state.fines_volume[e][j] = s.state.liquid_volume[e][j] * bump(z);
    });
    // A step without flow limits the profile first.
    TransportScratch<3> scratch;
    s.transport.start(s.state, std::vector<double>(s.volume.size(), 0.0), scratch);
    s.transport.advance(s.state, {}, {}, scratch);
    s.run(10.0);
    double error = 0.0;
    for_each_node([&](int e, int j, double z) {
      const double found = s.state.fines_volume[e][j] / s.state.liquid_volume[e][j];
      error += s.grid.volume[e] / 4.0 * std::abs(found - bump(z + 0.4)) / (width * width);
    });
    errors.push_back(error);
  }
  std::cout << "bump: errors " << errors[0] << ' ' << errors[1] << ' ' << errors[2] << '\n';
  EXPECT_GE(std::log2(errors[1] / errors[2]), 1.7) << errors[1] << " -> " << errors[2];
  EXPECT_LE(errors[2], 1e-3);
}

/// Moments of points on a triangle, and numbers of points in its quarters.
struct Spread {
  std::array<double, 3> mean{};
  std::array<std::array<double, 3>, 3> second{};
  std::array<double, 4> quarter{};  ///< at each corner, then in the middle
};

Spread spread_of(bool random, const std::array<double, 3>& inflow, int points) {
  model::Uniform uniform(8);
  Spread spread;
  for (int p = 0; p < points; ++p) {
    std::array<double, 2> u = even_numbers<2>(p, 7);
    if (random) u = {0.5 + 0.5 * uniform(), 0.5 + 0.5 * uniform()};
    const std::array<double, 3> at = spread_on_face(inflow, u);
    EXPECT_NEAR(at[0] + at[1] + at[2], 1.0, 1e-15);
    for (int i = 0; i < 3; ++i) {
      EXPECT_GE(at[i], 0.0);
      spread.mean[i] += at[i] / points;
      for (int j = 0; j < 3; ++j) spread.second[i][j] += at[i] * at[j] / points;
    }
    const auto largest = std::max_element(at.begin(), at.end());
    spread.quarter[*largest > 0.5 ? largest - at.begin() : 3] += 1.0 / points;
  }
  return spread;
}

TEST(TetrahedraPlacement, PointsLieEvenlyOnAFace) {
  for (const bool random : {false, true}) {
    const int points = 20000;
    const Spread spread = spread_of(random, {2.0, 2.0, 2.0}, points);
    // Three standard deviations of random points; evenly spread points deviate only by a few
    // points.
    const double tolerance = random ? 3.0 * 0.25 / std::sqrt(points) : 5.0 / points;
    double worst = 0.0;
    for (int i = 0; i < 3; ++i) {
      worst = std::max(worst, std::abs(spread.mean[i] - 1.0 / 3.0));
      for (int j = 0; j < 3; ++j) {
        worst = std::max(worst, std::abs(spread.second[i][j] - (i == j ? 1.0 / 6.0 : 1.0 / 12.0)));
      }
    }
    EXPECT_LE(worst, tolerance);
    for (const double share : spread.quarter) {
      EXPECT_NEAR(share, 0.25, random ? 3.0 * 0.44 / std::sqrt(points) : 1e-3);
    }
    std::cout << (random ? "at random" : "evenly") << ": largest error of the moments " << worst
              << ", quarters " << spread.quarter[0] << ' ' << spread.quarter[1] << ' '
              << spread.quarter[2] << ' ' << spread.quarter[3] << '\n';
  }
}

TEST(TetrahedraPlacement, PointsFollowTheInflowAtTheNodes) {
  using Inflow = std::array<double, 3>;
  for (const Inflow& inflow : {Inflow{1.0, 1.0, 1.0}, Inflow{1.0, 2.0, 4.0}, Inflow{5.0, 0.0, 1.0},
                               Inflow{0.0, 0.0, 2.0}, Inflow{3.0, 0.0, 0.0}}) {
    const double sum = inflow[0] + inflow[1] + inflow[2];
    const Spread spread = spread_of(false, inflow, 20000);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(spread.mean[i], (sum + inflow[i]) / (4.0 * sum), 3e-4);
      for (int j = 0; j < 3; ++j) {
        // Mean of l_i l_j l_k over the triangle: 2 a! b! c! / 5!.
        const double expected = i == j ? (sum + 2.0 * inflow[i]) / (10.0 * sum)
                                       : (sum + inflow[i] + inflow[j]) / (20.0 * sum);
        EXPECT_NEAR(spread.second[i][j], expected, 3e-4);
      }
    }
  }
}

TEST(TetrahedraPlacement, PointsComeInOnTheFaceThatLiquidEnters) {
  const Mesh<3> mesh = model::box_mesh({2, 2, 2});
  const Grid<3> grid(mesh);
  std::vector<FaceCondition> conditions(grid.face_count());
  std::vector<double> volume(grid.face_count(), 0.0);
  for (int f = 0; f < grid.face_count(); ++f) {
    if (!grid.is_outer(f)) continue;
    conditions[f].kind = FaceKind::flux;
    volume[f] = -50.0;
  }
  for (const bool random : {false, true}) {
    const InjectionSettings settings{std::vector<double>(grid.face_count(), 1.0),
                                     std::vector<int>(grid.face_count(), 4), random, 3};
    const PointInjection<3> injection(grid, conditions, settings, {1000.0, 2700.0}, 2e9);
    InflowAccount account = injection.initial_account(0);
    std::vector<InjectedPoint<3>> points;
    injection.inject(account, volume, {}, points);
    EXPECT_GE(points.size(), 48U * 49U);
    Vector<3> mean = Vector<3>::Zero();
    for (const InjectedPoint<3>& point : points) {
      const Vector<3> x = point.place.position(mesh);
      const Vector<3>& normal = grid.face_normal[point.face];
      EXPECT_NEAR(normal.dot(x - grid.face_centre(point.face)), 0.0, 1e-15);
      for (const double share : point.place.barycentric) EXPECT_GE(share, 0.0);
      mean += x / static_cast<double>(points.size());
    }
    EXPECT_LE((mean - Vector<3>(0.5, 0.5, 0.5)).norm(), random ? 0.03 : 0.003);
  }
}

}  // namespace tetrahedra_transport_test
}  // namespace suffuse
