/// Steady flow and suffusion on tetrahedra against exact solutions.

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>

#include "box_mesh.hpp"
#include "common/errors.hpp"
#include "driver/plan.hpp"
#include "exact_fines.hpp"
#include "formulation/single_point.hpp"
#include "grid/face_flux.hpp"
#include "mixed/implicit_mixed.hpp"
#include "reference_table.hpp"
#include "solver/flow_model.hpp"

namespace suffuse {
namespace tetrahedra_test {

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
  /// Imbalance relative to the largest flux through a face.
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
      // The outflow of an element over the step is the volume released as the pressures of its
      // faces drop.
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

/// Clean water enters a column from above at 0.012 m/s; the soil erodes at a constant rate from 2 s
/// on, as in the tables of tests/data/reference.
class SuffusionColumn {
 public:
  static constexpr double flux = 0.012;
  static constexpr double rate = 1e-3;
  static constexpr double start = 2.0;
  static constexpr int cells = 16;
  static constexpr double width = 2.0 / cells;

  [[nodiscard]] static Case<3> input(double end, FlowScheme scheme) {
    Scene scene = model::paper_scene();
    scene.soils[0].erosion = {erosion_law("constant"), rate, start, false};
    scene.boundaries = {model::flux_on("top", flux), model::pressure_on("bottom", 0.0)};
    scene.initial_flow = InitialFlow::steady;
    scene.time.end = end;
    scene.time.scheme = scheme;
    return model::make_case(model::box_mesh({2, 2, cells}, {width, width, 1.0},
                                            model::disturbed(0.1 / cells, {width, width, 1.0})),
                            scene);
  }
};

/// Mean of |c - exact| over the column by the rule of the field nodes.
double mean_error(const Mesh<3>& mesh, const FinesState<3>& liquid,
                  const std::function<double(double)>& exact_at_depth) {
  double error = 0.0;
  double volume = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (int j = 0; j < 4; ++j) {
      double depth = 1.0;
      for (int k = 0; k < 4; ++k) {
        depth -= (k == j ? FieldNodes<3>::near_vertex : FieldNodes<3>::far_vertex) *
                 mesh.nodes[mesh.elements[e][k]][2];
      }
      const double c = liquid.fines_volume[e][j] / liquid.liquid_volume[e][j];
      error += element_volume(mesh, e) * std::abs(c - exact_at_depth(depth));
      volume += element_volume(mesh, e);
    }
  }
  return error / volume;
}

/// Rows of a reference table for this column at time t.
std::vector<ReferenceRow> rows_at(const std::string& table, double t) {
  std::vector<ReferenceRow> result;
  for (const auto& row : read_reference(table)) {
    if (row.text("law") == "const" && row.number("par") == SuffusionColumn::rate &&
        row.number("q") == SuffusionColumn::flux && row.number("t") == t) {
      result.push_back(row);
    }
  }
  return result;
}

TEST(TetrahedraSuffusion, PorosityMassesAndProfileOfTheColumn) {
  const std::vector<double> times{7, 12, 22, 52};
  const Case<3> c = SuffusionColumn::input(times.back(), FlowScheme::implicit_mixed);
  const Plan plan = make_plan(c, {});
  SinglePoint<3> model(c, plan);
  const UniformFines exact([](double) { return SuffusionColumn::rate; }, 0.3, 0.4,
                           SuffusionColumn::start, SuffusionColumn::flux, times.back());
  for (const double t : times) {
    while (model.time() < t) {
      model.advance(t);
      const LedgerRow row = model.ledger();
      EXPECT_LE(std::abs(row.residual_water), 1e-12);
      EXPECT_LE(std::abs(row.residual_grains), 1e-12);
    }
    ASSERT_EQ(model.time(), t);
    const double porosity = 0.3 + SuffusionColumn::rate * (t - SuffusionColumn::start);
    for (const double n : model.solid().porosity()) EXPECT_NEAR(n, porosity, 1e-12);

    const auto profile = [&](double x) { return exact.concentration(x, t); };
    const auto table = rows_at("fines-profile.csv", t);
    ASSERT_GE(table.size(), 11U);
    for (const auto& row : table) {
      EXPECT_NEAR(profile(row.number("x")), row.number("n_f") / row.number("n_L"), 2e-6);
    }
    const double error = mean_error(c.mesh, model.liquid(), profile);
    EXPECT_LE(error, 0.01 * (profile(1.0) - profile(0.0))) << t;

    const auto masses = rows_at("masses.csv", t);
    ASSERT_EQ(masses.size(), 1U);
    const double area = SuffusionColumn::width * SuffusionColumn::width;
    const LedgerRow row = model.ledger();
    EXPECT_NEAR(row.solid / area, masses[0].number("M_solid"), 1e-7);
    const double out = masses[0].number("M_eroded_out");
    EXPECT_NEAR(row.fines_out / area, out, 0.01 * out);
    EXPECT_NEAR(row.fines / area, masses[0].number("M_fluidised_in"), 0.01 * out);
    std::cout << "t = " << t << " s: error of c " << error / (profile(1.0) - profile(0.0))
              << " of its range, of the mass that left " << row.fines_out / area / out - 1.0
              << ", residuals " << row.residual_water << ' ' << row.residual_grains << '\n';
  }
}

TEST(TetrahedraSuffusion, TheExplicitSchemeIsRefused) {
  const Case<3> c = SuffusionColumn::input(1.0, FlowScheme::explicit_nodal);
  try {
    make_plan(c, {});
    FAIL() << "took it";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("the explicit scheme is for meshes of triangles"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace tetrahedra_test
}  // namespace suffuse
