/// Steady flow and suffusion on tetrahedra against exact solutions.

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>

#include "box_mesh.hpp"
#include "flow/implicit_mixed.hpp"
#include "grid/face_flux.hpp"
#include "solver/flow_model.hpp"

namespace suffuse {
namespace {

using FlowModel3 = model::FlowModelOf<3>;

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double unit_weight = 9810.0;  // of water, N/m3

Mesh<3> rough_mesh(int cells) {
  return model::box_mesh({cells, cells, cells}, Vector<3>::Ones(), model::disturbed(0.15 / cells));
}

/// Steady flow with conductivity e^x and the head e^(a x) cos(b y) cos(c z) + x^2. The first part
/// has no source, as a^2 + a = b^2 + c^2; the second has -e^x (2 + 2 x). The flux on the right,
/// heads elsewhere.
class SmoothFlow {
 public:
  explicit SmoothFlow(const Mesh<3>& mesh) : m_(mesh) {
    m_.set_conductivity([](const Vector<3>& x) { return std::exp(x[0]); });
    for (int f = 0; f < m_.grid.face_count(); ++f) {
      if (!m_.grid.is_outer(f)) continue;
      FaceCondition& condition = m_.forcing.conditions[f];
      const Vector<3> centre = m_.grid.face_centre(f);
      condition.kind = FaceKind::pressure;
      condition.value = pressure(centre);
      if (centre[0] < 1.0 - 1e-9) continue;
      // The mean over the face, by the rule of degree two on the middles of its edges.
      condition.kind = FaceKind::flux;
      condition.value = 0.0;
      const auto& nodes = m_.grid.face_nodes[f];
      for (int i = 0; i < 3; ++i) {
        const Vector<3> middle =
            0.5 * (m_.mesh.nodes[nodes[i]] + m_.mesh.nodes[nodes[(i + 1) % 3]]);
        condition.value -= flux(middle)[0] / 3.0;
      }
    }
    for (int e = 0; e < m_.mesh.element_count(); ++e) {
      const double x = element_centroid(m_.mesh, e)[0];
      m_.forcing.source.push_back(-m_.grid.volume[e] * std::exp(x) * (2.0 + 2.0 * x));
    }
    ImplicitMixed<3> flow(m_.grid, {infinite, false, TimeStepping::second_order},
                          Vector<3>::Zero());
    step_ = flow.steady(m_.forcing);
  }
  static double pressure(const Vector<3>& x) {
    return unit_weight *
           (std::exp(a * x[0]) * std::cos(b * x[1]) * std::cos(c * x[2]) + x[0] * x[0]);
  }
  static Vector<3> flux(const Vector<3>& x) {
    const double cos_y = std::cos(b * x[1]);
    const double cos_z = std::cos(c * x[2]);
    return std::exp((1.0 + a) * x[0]) * Vector<3>(-a * cos_y * cos_z,
                                                  b * std::sin(b * x[1]) * cos_z,
                                                  c * cos_y * std::sin(c * x[2])) -
           std::exp(x[0]) * Vector<3>(2.0 * x[0], 0.0, 0.0);
  }
  /// L2 norms of the errors, by the rule of degree two inside each element: head in m, flux in m/s.
  [[nodiscard]] std::array<double, 2> errors() const {
    std::array<double, 2> sum = {0.0, 0.0};
    for (int e = 0; e < m_.mesh.element_count(); ++e) {
      const auto& vertices = m_.mesh.elements[e];
      for (int j = 0; j < 4; ++j) {
        Vector<3> place = Vector<3>::Zero();
        double found = 0.0;
        for (int k = 0; k < 4; ++k) {
          const double coordinate = k == j ? FieldNodes<3>::near_vertex : FieldNodes<3>::far_vertex;
          place += coordinate * m_.mesh.nodes[vertices[k]];
          found += (1.0 - 3.0 * coordinate) * step_.end.face_pressure[m_.grid.element_face[e][k]];
        }
        const double weight = m_.grid.volume[e] / 4.0;
        sum[0] += weight * std::pow((found - pressure(place)) / unit_weight, 2);
        sum[1] +=
            weight * (flux_at(m_.grid, step_.face_flux, e, place) - flux(place)).squaredNorm();
      }
    }
    return {std::sqrt(sum[0]), std::sqrt(sum[1])};
  }
  /// Of the largest flux through a face.
  [[nodiscard]] double imbalance() const {
    return model::imbalance(m_.grid, step_.face_flux, m_.forcing.source);
  }

 private:
  static constexpr double a = 1.2;
  static constexpr double b = 1.1;
  static inline const double c = std::sqrt(a * a + a - b * b);
  FlowModel3 m_;
  MixedStep<3> step_;
};

TEST(Tetrahedra, PressureOfOrderTwoAndFluxOfOrderOne) {
  const std::vector<int> all_cells{4, 6, 9, 13};
  std::vector<std::array<double, 2>> errors;
  for (const int cells : all_cells) {
    const SmoothFlow flow(rough_mesh(cells));
    errors.push_back(flow.errors());
    EXPECT_LE(flow.imbalance(), 1e-12);
    std::cout << cells << " cells: errors of pressure " << errors.back()[0] << ", of flux "
              << errors.back()[1] << ", imbalance " << flow.imbalance() << '\n';
  }
  for (std::size_t i = 0; i + 1 < errors.size(); ++i) {
    const double refined = std::log(static_cast<double>(all_cells[i + 1]) / all_cells[i]);
    EXPECT_NEAR(std::log(errors[i][0] / errors[i + 1][0]) / refined, 2.0, 0.2) << i;
    EXPECT_NEAR(std::log(errors[i][1] / errors[i + 1][1]) / refined, 1.0, 0.1) << i;
  }
}

TEST(Tetrahedra, UniformFlowIsExact) {
  const Vector<3> gradient(3.0, -1.0, 2.0);
  FlowModel3 m(rough_mesh(4));
  m.set_conductivity([](const Vector<3>&) { return 0.02; });
  for (int f = 0; f < m.grid.face_count(); ++f) {
    if (!m.grid.is_outer(f)) continue;
    m.forcing.conditions[f].kind = FaceKind::pressure;
    m.forcing.conditions[f].value = unit_weight * gradient.dot(m.grid.face_centre(f));
  }
  ImplicitMixed<3> flow(m.grid, {infinite, false, TimeStepping::second_order}, Vector<3>::Zero());
  const MixedStep<3> steady = flow.steady(m.forcing);
  for (int f = 0; f < m.grid.face_count(); ++f) {
    EXPECT_NEAR(steady.face_flux[f], -0.02 * gradient.dot(m.grid.face_normal[f]), 1e-13);
    EXPECT_NEAR(steady.end.face_pressure[f], unit_weight * gradient.dot(m.grid.face_centre(f)),
                1e-9);
  }
}

TEST(Tetrahedra, ElementsBalanceAtAnyContrastAndWithStorage) {
  FlowModel3 m(rough_mesh(6));
  model::Uniform uniform(5);
  m.set_conductivity([&](const Vector<3>& x) {
    return 1e-2 * std::pow(10.0, (x[2] > 0.5 ? -8.0 : 0.0) + 2.0 * uniform());
  });
  m.set("top", FaceKind::pressure, 1e5);
  m.set("bottom", FaceKind::pressure, 0.0);
  m.set("left", FaceKind::flux, 1e-9);
  for (const double modulus : {infinite, 2e9}) {
    for (const TimeStepping stepping : {TimeStepping::monotone, TimeStepping::second_order}) {
      ImplicitMixed<3> flow(m.grid, {modulus, false, stepping}, {0.0, 0.0, -9.81});
      const auto steady = flow.steady(m.forcing);
      EXPECT_LE(model::imbalance(m.grid, steady.face_flux,
                                 std::vector<double>(m.mesh.element_count(), 0.0)),
                1e-12);
      const MixedState<3> rest = m.rest();
      const double dt = 10.0;
      const auto step = flow.step(rest, dt, m.constant(flow));
      // What leaves an element over the step is what the drop of its faces' pressures sets free.
      std::vector<double> net_outflow(m.mesh.element_count(), 0.0);
      for (int e = 0; e < m.mesh.element_count(); ++e) {
        for (const int f : m.grid.element_face[e]) {
          net_outflow[e] -=
              m.capacity(e, modulus) * (step.end.face_pressure[f] - rest.face_pressure[f]);
        }
      }
      EXPECT_LE(model::imbalance(m.grid, step.face_volume, net_outflow), 1e-12) << modulus;
    }
  }
}

}  // namespace
}  // namespace suffuse
