/// Order of the implicit mixed flow in space: a smooth solution on unstructured meshes, and seepage
/// under a dam with a cutoff wall, which has singular corners, against its exact discharge.

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <numbers>

#include "free_mesh.hpp"
#include "grid/face_flux.hpp"
#include "mixed/implicit_mixed.hpp"
#include "solver/flow_model.hpp"

namespace suffuse {
namespace implicit_convergence_test {

using model::FlowModel;

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double unit_weight = 9810.0;  // of water, N/m3

/// Steady flow with conductivity e^x and the head e^(a x) cos(b y) + x^2. The first part has no
/// source, as a^2 + a = b^2; the second has -e^x (2 + 2 x). Heads above and below and on the left,
/// fluxes on the right.
class SmoothFlow {
 public:
  explicit SmoothFlow(const Mesh<2>& mesh) : m_(mesh) {
    m_.set_conductivity([](const Vector<2>& x) { return std::exp(x[0]); });
    for (int f = 0; f < m_.grid.face_count(); ++f) {
      if (!m_.grid.is_outer(f)) continue;
      FaceCondition& c = m_.forcing.conditions[f];
      const Vector<2> x = m_.grid.face_centre(f);
      if (x[0] < 1.0 - 1e-9) {
        c.kind = FaceKind::pressure;
        c.value = pressure(x);
      } else {
        // The mean over the face, whose length is dy.
        const double dy = m_.grid.face_normal[f].norm();
        c.kind = FaceKind::flux;
        c.value = 2.0 * std::exp(1.0) +
                  a * std::exp(1.0 + a) *
                      (std::sin(b * (x[1] + 0.5 * dy)) - std::sin(b * (x[1] - 0.5 * dy))) /
                      (b * dy);
      }
    }
    for (int e = 0; e < m_.mesh.element_count(); ++e) {
      const double x = element_centroid(m_.mesh, e)[0];
      m_.forcing.source.push_back(-m_.grid.volume[e] * std::exp(x) * (2.0 + 2.0 * x));
    }
    ImplicitMixed<2> flow(m_.grid, {infinite, false, TimeStepping::second_order},
                          Vector<2>::Zero());
    step_ = flow.steady(m_.forcing);
  }
  static double pressure(const Vector<2>& x) {
    return unit_weight * (std::exp(a * x[0]) * std::cos(b * x[1]) + x[0] * x[0]);
  }
  static Vector<2> flux(const Vector<2>& x) {
    return std::exp((1.0 + a) * x[0]) * Vector<2>(-a * std::cos(b * x[1]), b * std::sin(b * x[1])) -
           std::exp(x[0]) * Vector<2>(2.0 * x[0], 0.0);
  }
  /// L2 norms of the errors, by the rule of degree two inside each element: head in m, flux in m/s.
  [[nodiscard]] std::array<double, 2> errors() const {
    std::array<double, 2> sum = {0.0, 0.0};
    for (int e = 0; e < m_.mesh.element_count(); ++e) {
      const auto& vertices = m_.mesh.elements[e];
      for (int j = 0; j < 3; ++j) {
        Vector<2> place = Vector<2>::Zero();
        double found = 0.0;
        for (int k = 0; k < 3; ++k) {
          const double coordinate = k == j ? 2.0 / 3.0 : 1.0 / 6.0;
          place += coordinate * m_.mesh.nodes[vertices[k]];
          found += (1.0 - 2.0 * coordinate) * step_.end.face_pressure[m_.grid.element_face[e][k]];
        }
        const double weight = m_.grid.volume[e] / 3.0;
        sum[0] += weight * std::pow((found - pressure(place)) / unit_weight, 2);
        sum[1] +=
            weight * (flux_at(m_.grid, step_.face_flux, e, place) - flux(place)).squaredNorm();
      }
    }
    return {std::sqrt(sum[0]), std::sqrt(sum[1])};
  }

 private:
  static constexpr double a = 1.2;
  static inline const double b = std::sqrt(a * a + a);
  FlowModel m_;
  MixedStep<2> step_;
};

void expect_orders(const std::string& meshes, const std::vector<std::array<double, 2>>& errors) {
  std::cout << meshes << ": errors of pressure";
  for (const auto& e : errors) std::cout << ' ' << e[0];
  std::cout << ", of flux";
  for (const auto& e : errors) std::cout << ' ' << e[1];
  std::cout << '\n';
  for (std::size_t i = 0; i + 1 < errors.size(); ++i) {
    EXPECT_NEAR(std::log2(errors[i][0] / errors[i + 1][0]), 2.0, 0.2) << meshes << ' ' << i;
    EXPECT_NEAR(std::log2(errors[i][1] / errors[i + 1][1]), 1.0, 0.1) << meshes << ' ' << i;
  }
}

TEST(ImplicitConvergence, PressureOfOrderTwoAndFluxOfOrderOneOnFreeMeshes) {
  std::vector<std::array<double, 2>> errors;
  for (const double size : {0.2, 0.1, 0.05, 0.025}) {
    errors.push_back(SmoothFlow(model::free_mesh(size)).errors());
  }
  expect_orders("free meshes", errors);
}

TEST(ImplicitConvergence, PressureOfOrderTwoAndFluxOfOrderOneOnDisturbedMeshes) {
  std::vector<std::array<double, 2>> errors;
  for (const int cells : {8, 16, 32, 64}) {
    errors.push_back(
        SmoothFlow(model::column_mesh(cells, cells, 1.0, 1.0, model::jittered(0.25 / cells, 9)))
            .errors());
  }
  expect_orders("disturbed meshes", errors);
}

/// Flow through a layer of depth one under a dam whose floor reaches from -b to b, with a sheet
/// pile of depth s in its middle. By symmetry one half is computed, with half the head: the
/// vertical below the pile is an equipotential.
struct Dam {
  double floor;  ///< b / T
  double pile;   ///< s / T

  /// q / (k H) with Harr's modulus (Groundwater and Seepage, 1962, ch. 5).
  [[nodiscard]] double exact() const {
    const double half_pi = 0.5 * std::numbers::pi;
    const double m =
        std::cos(half_pi * pile) * std::hypot(std::tanh(half_pi * floor), std::tan(half_pi * pile));
    return 0.5 * std::comp_ellint_1(std::sqrt(1.0 - m * m)) / std::comp_ellint_1(m);
  }

  /// The value of `exact` by the scheme. With `grading` 1 the mesh has squares of 1 / `cells`; with
  /// more, as many cells on either side of the pile's tip and of the end of the floor, graded
  /// towards these.
  [[nodiscard]] double computed(int cells, double grading) const {
    const auto cells_of = [&](double length) {
      if (grading > 1.0 && length > 0.0) return cells;
      return static_cast<int>(std::lround(cells * length));
    };
    const int below = cells_of(1.0 - pile);
    const int beside = cells_of(pile);
    const int under = cells_of(floor);
    const int beyond = grading > 1.0 ? 2 * cells : cells_of(reach);
    const int nx = under + beyond;
    const int ny = below + beside;
    const auto place = [&](const Vector<2>& unit) {
      const double i = unit[0] * nx;
      const double j = unit[1] * ny;
      const double x = i <= under ? (under > 0 ? floor * towards_both(i / under, grading) : 0.0)
                                  : floor + reach * std::pow((i - under) / beyond, grading);
      const double y = j <= below ? (1.0 - pile) * (1.0 - std::pow(1.0 - j / below, grading))
                                  : 1.0 - pile + pile * towards_both((j - below) / beside, grading);
      return Vector<2>(x, y);
    };
    FlowModel m(model::column_mesh(nx, ny, 1.0, 1.0, place));
    m.set_conductivity([](const Vector<2>&) { return 1.0; });
    for (int f = 0; f < m.grid.face_count(); ++f) {
      if (!m.grid.is_outer(f)) continue;
      const Vector<2> x = m.grid.face_centre(f);
      FaceCondition& c = m.forcing.conditions[f];
      if (x[0] < 1e-12 && x[1] < 1.0 - pile) c.kind = FaceKind::pressure;
      if (x[1] > 1.0 - 1e-12 && x[0] > floor) {
        c.kind = FaceKind::pressure;
        c.value = 0.5 * unit_weight;
      }
    }
    ImplicitMixed<2> flow(m.grid, {infinite, false, TimeStepping::second_order}, Vector<2>::Zero());
    const auto steady = flow.steady(m.forcing);
    double discharge = 0.0;
    for (int f = 0; f < m.grid.face_count(); ++f) {
      if (m.grid.is_outer(f) && m.grid.face_centre(f)[0] < 1e-12) discharge += steady.face_flux[f];
    }
    return discharge;
  }

 private:
  /// Flow in a layer of depth one decays as exp(-pi x / 2): the part left out is 1e-7 of it.
  static constexpr double reach = 10.0;

  static double towards_both(double share, double grading) {
    return share < 0.5 ? 0.5 * std::pow(2.0 * share, grading)
                       : 1.0 - 0.5 * std::pow(2.0 - 2.0 * share, grading);
  }
};

TEST(ImplicitDam, DischargeOnUniformMeshesIsOfTheOrderOfTheSingularities) {
  for (const Dam& dam : {Dam{0.5, 0.5}, Dam{0.0, 0.5}, Dam{0.5, 0.0}}) {
    std::vector<double> error;
    std::cout << "dam b = " << dam.floor << ", s = " << dam.pile << ": q/(k H) " << dam.exact()
              << ", relative errors on uniform meshes";
    for (const int cells : {8, 16, 32, 64}) {
      error.push_back(dam.computed(cells, 1.0) / dam.exact() - 1.0);
      std::cout << ' ' << error.back();
    }
    std::cout << '\n';
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(std::log2(error[i] / error[i + 1]), 1.0, 0.15);
  }
}

TEST(ImplicitDam, DischargeOnGradedMeshesIsWithinAThousandth) {
  for (const Dam& dam :
       {Dam{0.5, 0.5}, Dam{1.0, 0.25}, Dam{0.0, 0.5}, Dam{0.5, 0.0}, Dam{0.25, 0.75}}) {
    std::vector<double> error;
    std::cout << "dam b = " << dam.floor << ", s = " << dam.pile << ": q/(k H) " << dam.exact()
              << ", relative errors on graded meshes";
    for (const int cells : {16, 32, 64}) {
      error.push_back(dam.computed(cells, 2.5) / dam.exact() - 1.0);
      std::cout << ' ' << error.back();
    }
    std::cout << '\n';
    EXPECT_LE(std::abs(error[2]), 1e-3);
    for (int i = 0; i < 2; ++i) EXPECT_NEAR(std::log2(error[i] / error[i + 1]), 2.0, 0.3);
  }
}

}  // namespace implicit_convergence_test
}  // namespace suffuse
