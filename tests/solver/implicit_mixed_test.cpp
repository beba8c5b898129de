/// Properties of the implicit mixed flow on any mesh and with any contrast: volumes, bounds,
/// energy, rest.

#include "mixed/implicit_mixed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "common/errors.hpp"
#include "flow_model.hpp"

namespace suffuse {
namespace implicit_mixed_test {

constexpr double infinite = std::numeric_limits<double>::infinity();

using model::FlowModel;
using model::imbalance;
using model::Uniform;

std::vector<double> stored(const FlowModel& m, double modulus, const MixedState<2>& a,
                           const MixedState<2>& b) {
  std::vector<double> result(m.mesh.element_count(), 0.0);
  for (int e = 0; e < m.mesh.element_count(); ++e) {
    for (const int f : m.grid.element_face[e]) {
      result[e] += m.capacity(e, modulus) * (b.face_pressure[f] - a.face_pressure[f]);
    }
  }
  return result;
}

struct Contrast {
  const char* name;
  double (*conductivity)(const Vector<2>&);
};

double thin_layer(const Vector<2>& x) {
  return x[1] > 0.5 && x[1] < 0.55 ? 1e-8 : 1.0;
}
double checkerboard(const Vector<2>& x) {
  return (static_cast<int>(5 * x[0]) + static_cast<int>(5 * x[1])) % 2 == 0 ? 1e-4 : 1e4;
}
double scattered(const Vector<2>& x) {
  const double share = std::sin(1e4 * x[0] + 3e4 * x[1]);
  return std::pow(10.0, 4.0 * share);
}

class ImplicitMixedContrast : public ::testing::TestWithParam<Contrast> {};

TEST_P(ImplicitMixedContrast, VolumesBalanceInEveryElement) {
  double worst_steady = 0.0;
  double worst_step = 0.0;
  double worst_volume = 0.0;
  for (const double amount : {0.0, 0.012}) {
    FlowModel m(model::column_mesh(20, 20, 1.0, 1.0, model::jittered(amount, 3)));
    m.set_conductivity(GetParam().conductivity);
    m.set("top", FaceKind::pressure, 6000.0);
    m.set("bottom", FaceKind::pressure, 0.0);
    m.set("left", FaceKind::flux, 1e-7);
    m.set("right", FaceKind::velocity, -2e-7);
    m.forcing.source.assign(m.mesh.element_count(), 0.0);
    Uniform uniform(7);
    for (double& s : m.forcing.source) s = 1e-9 * uniform();

    ImplicitMixed<2> still(m.grid, {infinite, false, TimeStepping::monotone}, {0.0, -9.81});
    const auto steady = still.steady(m.forcing);
    EXPECT_TRUE(steady.face_volume.empty());
    worst_steady = std::max(worst_steady, imbalance(m.grid, steady.face_flux, m.forcing.source));

    for (const auto stepping : {TimeStepping::monotone, TimeStepping::second_order}) {
      for (const bool inertia : {false, true}) {
        const double modulus = 2e7;
        ImplicitMixed<2> flow(m.grid, {modulus, inertia, stepping}, {0.0, -9.81});
        MixedState<2> state = m.rest(3000.0);
        for (const double dt : {1e-4, 1e-3, 1e-1, 10.0}) {
          const auto step = flow.step(state, dt, m.constant(flow));
          std::vector<double> expected = stored(m, modulus, state, step.end);
          for (int e = 0; e < m.mesh.element_count(); ++e) {
            expected[e] = dt * m.forcing.source[e] - expected[e];
          }
          worst_volume = std::max(worst_volume, imbalance(m.grid, step.face_volume, expected));
          for (int f = 0; f < m.grid.face_count(); ++f) {
            const FaceCondition& c = m.forcing.conditions[f];
            if (c.kind == FaceKind::pressure) {
              EXPECT_EQ(step.end.face_pressure[f], c.value);
            }
            const double area = m.grid.face_normal[f].norm();
            if (c.kind == FaceKind::flux) {
              EXPECT_EQ(step.face_flux[f], -1e-7 * area);
            }
            if (c.kind == FaceKind::velocity) {
              EXPECT_DOUBLE_EQ(step.face_flux[f], 0.3 * 2e-7 * area);
            }
          }
          state = step.end;
        }
        // Repeats the last step without storage, so that the exact net outflow is known.
        ImplicitMixed<2> stiff(m.grid, {infinite, inertia, stepping}, {0.0, -9.81});
        const auto step = stiff.step(state, 0.1, m.constant(stiff));
        worst_step = std::max(worst_step, imbalance(m.grid, step.face_flux, m.forcing.source));
      }
    }
  }
  std::cout << GetParam().name << ": largest imbalance over largest flux, steady " << worst_steady
            << ", step of water that stores nothing " << worst_step
            << ", volumes with storage from the pressures " << worst_volume << '\n';
  EXPECT_LE(worst_steady, 1e-12);
  EXPECT_LE(worst_step, 1e-12);
  EXPECT_LE(worst_volume, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Contrasts, ImplicitMixedContrast,
                         ::testing::Values(Contrast{"thin_layer", thin_layer},
                                           Contrast{"checkerboard", checkerboard},
                                           Contrast{"scattered", scattered}),
                         [](const auto& param_info) { return param_info.param.name; });

/// Overshoot of face pressures over [0, 6000] Pa, as a share of it, in steps from 1e-6 s to 1e3 s.
double overshoot(FlowModel& m, const ImplicitSettings& settings) {
  m.set("top", FaceKind::pressure, 6000.0);
  m.set("bottom", FaceKind::pressure, 0.0);
  ImplicitMixed<2> flow(m.grid, settings, Vector<2>::Zero());
  double worst = 0.0;
  for (double dt = 1e-6; dt < 2e3; dt *= 10.0) {
    MixedState<2> state = m.rest();
    for (int i = 0; i < 5; ++i) {
      state = flow.step(state, dt, m.constant(flow)).end;
      for (const double p : state.face_pressure) {
        worst = std::max({worst, -p / 6000.0, p / 6000.0 - 1.0});
      }
    }
  }
  return worst;
}

TEST(ImplicitMixed, MonotoneStepsKeepPressuresWithinThoseAtTheBoundary) {
  FlowModel layer(model::column_mesh(10, 20));
  layer.set_conductivity(thin_layer);
  FlowModel water(model::column_mesh(10, 20));
  for (int e = 0; e < water.mesh.element_count(); ++e) {
    if (element_centroid(water.mesh, e)[1] < 0.7) continue;
    FlowCoefficients<2>& c = water.forcing.coefficients;
    c.porosity[e] = 1.0;
    c.water_volume[e] = water.grid.volume[e];
    c.drag[e] = darcy_drag(1.0, 1000.0, 0.02 * 1e4);
  }
  for (const bool inertia : {false, true}) {
    for (const double modulus : {2e7, 2e9, infinite}) {
      const std::string of =
          std::string(inertia ? "inertia" : "no inertia") + ", K = " + std::to_string(modulus);
      // With inertia, pressure is a wave that exceeds these bounds.
      for (const auto stepping : {TimeStepping::monotone, TimeStepping::second_order}) {
        const bool monotone = stepping == TimeStepping::monotone;
        const double in_layer = overshoot(layer, {modulus, inertia, stepping});
        const double in_water = overshoot(water, {modulus, inertia, stepping});
        std::cout << of << (monotone ? ", monotone" : ", second order") << ": overshoot "
                  << in_layer << " with a thin layer, " << in_water << " with free water\n";
        if (monotone && !inertia) {
          EXPECT_LE(in_layer, 1e-10) << of;
          EXPECT_LE(in_water, 1e-10) << of;
        }
      }
    }
  }
}

/// Kinetic energy and energy of the compressed water, J. The momentum per flux is rho v, so
/// pressure and drag change |e| rho n |v|^2 / 2.
double energy(const FlowModel& m, double modulus, bool inertia, const MixedState<2>& state) {
  double sum = 0.0;
  const FlowCoefficients<2>& c = m.forcing.coefficients;
  for (int e = 0; e < m.mesh.element_count(); ++e) {
    if (inertia) {
      sum += 0.5 * m.grid.volume[e] * c.mixture_density[e] * c.porosity[e] *
             state.velocity[e].squaredNorm();
    }
    for (const int f : m.grid.element_face[e]) {
      if (std::isfinite(modulus)) {
        sum += 0.5 * m.capacity(e, modulus) * state.face_pressure[f] * state.face_pressure[f];
      }
    }
  }
  return sum;
}

TEST(ImplicitMixed, EnergyDoesNotGrow) {
  double largest_growth = -1.0;
  double min_kept = 1.0;
  for (const unsigned seed : {1U, 2U, 3U}) {
    FlowModel m(model::column_mesh(8, 8, 1.0, 1.0, model::jittered(0.03, seed)));
    Uniform uniform(seed);
    for (int e = 0; e < m.mesh.element_count(); ++e) {
      FlowCoefficients<2>& c = m.forcing.coefficients;
      c.porosity[e] = 0.5 + 0.4 * uniform();
      c.water_volume[e] = c.porosity[e] * m.grid.volume[e];
      c.mixture_density[e] = 1200.0 + 200.0 * uniform();
      c.drag[e] = darcy_drag(c.porosity[e], 1000.0, std::pow(10.0, 2.0 * uniform()));
    }
    m.set("top", FaceKind::pressure, 0.0);
    for (const auto stepping : {TimeStepping::monotone, TimeStepping::second_order}) {
      for (const bool inertia : {false, true}) {
        for (const double modulus : {2e7, infinite}) {
          if (!inertia && modulus == infinite) continue;  // there is no such state
          ImplicitMixed<2> flow(m.grid, {modulus, inertia, stepping}, Vector<2>::Zero());
          for (const double dt : {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1.0}) {
            MixedState<2> state = m.rest();
            for (int f = 0; f < m.grid.face_count(); ++f) {
              if (m.forcing.conditions[f].kind != FaceKind::pressure) {
                state.face_pressure[f] = 1e4 * uniform();
              }
            }
            for (auto& v : state.velocity) v = Vector<2>(uniform(), uniform());
            double last = energy(m, modulus, inertia, state);
            for (int i = 0; i < 6; ++i) {
              state = flow.step(state, dt, m.constant(flow)).end;
              const double now = energy(m, modulus, inertia, state);
              largest_growth = std::max(largest_growth, now / last - 1.0);
              min_kept = std::min(min_kept, now / last);
              EXPECT_LE(now, last * (1.0 + 1e-12));
              last = now;
            }
          }
        }
      }
    }
  }
  std::cout << "energy: largest relative growth in a step " << largest_growth << ", least kept "
            << min_kept << '\n';
}

TEST(ImplicitMixed, QuadraticDragIsFulfilledInEveryElementHoweverItVaries) {
  // Drag is up to a million times Darcy's and varies over four decades between elements; one layer
  // has no quadratic drag.
  double worst = 0.0;
  double worst_imbalance = 0.0;
  long max_solves = 0;
  for (const double scale : {1e5, 1e8, 1e11}) {
    for (const bool pressures : {true, false}) {
      FlowModel m(model::column_mesh(12, 12, 1.0, 1.0, model::jittered(0.02, 6)));
      Uniform uniform(8);
      m.set_conductivity([&](const Vector<2>&) { return std::pow(10.0, 2.0 * uniform()); });
      FlowCoefficients<2>& c = m.forcing.coefficients;
      for (int e = 0; e < m.mesh.element_count(); ++e) {
        const bool without = element_centroid(m.mesh, e)[1] > 0.8;
        c.quadratic_drag.push_back(without ? 0.0 : scale * std::pow(10.0, 2.0 * uniform()));
      }
      m.set("top", FaceKind::pressure, 6000.0);
      m.set("left", pressures ? FaceKind::pressure : FaceKind::flux, pressures ? 0.0 : 1e-2);
      ImplicitMixed<2> flow(m.grid, {2e7, true, TimeStepping::second_order}, {0.0, -9.81});
      const auto steady = flow.steady(m.forcing);
      max_solves = std::max(max_solves, flow.counts().solves);
      worst_imbalance = std::max(
          worst_imbalance,
          imbalance(m.grid, steady.face_flux, std::vector<double>(m.mesh.element_count(), 0.0)));
      for (int e = 0; e < m.mesh.element_count(); ++e) {
        const Vector<2> flux = c.porosity[e] * steady.end.velocity[e];
        const Vector<2> drag =
            (c.drag[e] / c.porosity[e] + c.quadratic_drag[e] * flux.norm()) * flux;
        Vector<2> push(0.0, -9.81 * c.mixture_density[e]);
        for (int k = 0; k < 3; ++k) {
          push += 2.0 * steady.end.face_pressure[m.grid.element_face[e][k]] *
                  m.grid.shape_gradient[e][k];
        }
        worst = std::max(worst, (drag - push).norm() / 9810.0);
      }
    }
  }
  std::cout << "quadratic drag: drag minus push " << worst << " of the weight of water, imbalance "
            << worst_imbalance << ", at most " << max_solves << " solves\n";
  EXPECT_LE(worst, 1e-10);
  EXPECT_LE(worst_imbalance, 1e-12);
}

TEST(ImplicitMixed, WaterAtRestStaysAtRest) {
  for (const double modulus : {2e7, infinite}) {
    for (const bool open : {true, false}) {
      FlowModel m(model::column_mesh(10, 10, 1.0, 1.0, model::jittered(0.03, 5)));
      m.set_conductivity([](const Vector<2>& x) { return x[1] > 0.5 ? 1e-4 : 1.0; });
      Uniform uniform(1);
      for (int e = 0; e < m.mesh.element_count(); ++e) {
        m.forcing.coefficients.porosity[e] = 0.5 + 0.4 * uniform();
      }
      if (open) m.set("top", FaceKind::pressure, 0.0);
      MixedState<2> state = m.rest();
      for (int f = 0; f < m.grid.face_count(); ++f) {
        state.face_pressure[f] = 9810.0 * (1.0 - m.grid.face_centre(f)[1]);
      }
      const MixedState<2> begin = state;
      double worst_flux = 0.0;
      double worst_pressure = 0.0;
      const auto compare = [&](const MixedStep<2>& step) {
        const double level = open || modulus < infinite ? 0.0 : begin.face_pressure[0];
        const double shift = level - (level != 0.0 ? step.end.face_pressure[0] : 0.0);
        for (int f = 0; f < m.grid.face_count(); ++f) {
          worst_flux =
              std::max(worst_flux, std::abs(step.face_flux[f]) / m.grid.face_normal[f].norm());
          worst_pressure = std::max(
              worst_pressure, std::abs(step.end.face_pressure[f] + shift - begin.face_pressure[f]));
        }
      };
      for (const auto stepping : {TimeStepping::monotone, TimeStepping::second_order}) {
        ImplicitMixed<2> flow(m.grid, {modulus, true, stepping}, {0.0, -9.81});
        for (const double dt : {1e-4, 1.0, 100.0}) {
          const auto step = flow.step(state, dt, m.constant(flow));
          compare(step);
          state = step.end;
        }
        if (open) compare(flow.steady(m.forcing));
      }
      // Compared with the flux that gravity would drive in the most conductive soil, 1 m/s.
      EXPECT_LE(worst_flux, 1e-12);
      EXPECT_LE(worst_pressure, 1e-12 * 9810.0);
      std::cout << (open ? "open" : "sealed") << ", K = " << modulus << ": flux at rest "
                << worst_flux << " m/s, pressure off by " << worst_pressure << " Pa\n";
    }
  }
}

/// The saturated flow is that of a flow without retention, even after soil has drained.
TEST(ImplicitMixed, SaturatedFlowForgetsHowSoilDrains) {
  FlowModel m(model::column_mesh(4, 8));
  m.set("top", FaceKind::pressure, -2e3);
  m.set("bottom", FaceKind::pressure, -1e3);
  FlowSoils<2> soils;
  soils.retention.assign(m.mesh.elements.size(), model::gardner(2.0));
  soils.head_per_pressure = 1.0 / (1000.0 * conductivity_gravity);
  const ImplicitSettings settings{infinite, false, TimeStepping::monotone};
  ImplicitMixed<2> drains(m.grid, settings, {0.0, -9.81}, soils);
  MixedState<2> start = m.rest(-1.5e3);
  start.air = drains.air_at(start.face_pressure, m.forcing.coefficients.porosity);
  drains.step(start, 1.0, m.constant(drains));
  ImplicitMixed<2> full(m.grid, settings, {0.0, -9.81});
  const auto found = drains.saturated_steady(m.forcing);
  const auto expected = full.steady(m.forcing);
  for (int f = 0; f < m.grid.face_count(); ++f) {
    EXPECT_NEAR(found.face_flux[f], expected.face_flux[f], 1e-15) << f;
    EXPECT_NEAR(found.end.face_pressure[f], expected.end.face_pressure[f], 1e-9) << f;
  }
  EXPECT_TRUE(drains.has_retention());
}

/// A saturated element of soil and free space loses some water to the moving soil: its pressure
/// falls until air fills the space, for any length of the step.
TEST(ImplicitMixed, AirComesIntoMixedElementsInStepsOfAnyLength) {
  for (const double dt : {1e2, 1.0, 1e-2, 1e-4, 1e-6, 1e-8}) {
    FlowModel m(model::column_mesh(4, 8));
    m.set("top", FaceKind::pressure, 2e3);
    FlowSoils<2> soils;
    soils.retention.assign(m.mesh.elements.size(), model::van_genuchten(2.0, 2.5, 0.0));
    soils.free_space = model::van_genuchten(30.0, 3.0, 0.0);
    soils.soil_share.assign(m.mesh.elements.size(), 0.7);
    soils.head_per_pressure = 1.0 / (1000.0 * conductivity_gravity);
    const ImplicitSettings settings{infinite, false, TimeStepping::monotone};
    ImplicitMixed<2> flow(m.grid, settings, {0.0, -9.81}, soils);
    MixedState<2> start = m.rest(2e3);
    start.air = flow.air_at(start.face_pressure, m.forcing.coefficients.porosity);
    double taken = 0.0;
    for (std::size_t e = 0; e < start.air.size(); e += 7) {
      for (double& side : start.air[e]) {
        side = 1e-3 * m.forcing.coefficients.porosity[e] * m.grid.volume[e];
        taken += side;
      }
    }
    const MixedStep<2> step = flow.step(start, dt, m.constant(flow));
    double left = 0.0;
    for (const auto& air : step.end.air) left += element_sum<2>(air);
    double out = 0.0;
    for (int f = 0; f < m.grid.face_count(); ++f) {
      if (m.grid.is_outer(f)) out += step.face_volume[f];
    }
    EXPECT_NEAR(left - taken, out, 1e-12 * taken) << dt;
  }
}

TEST(ImplicitMixed, SealedBoxStoresWhatIsPutIn) {
  // Nothing prescribes a pressure: the mean pressure follows from the volume alone, for any
  // stiffness of the water and any flow inside.
  for (const double modulus : {2e7, 2e9, 2e14}) {
    FlowModel m(model::column_mesh(8, 8, 1.0, 1.0, model::jittered(0.03, 5)));
    m.set_conductivity(checkerboard);
    m.set("left", FaceKind::flux, 1e-3);
    m.forcing.source.assign(m.mesh.element_count(), 0.0);
    m.forcing.source[17] = 2e-4;
    for (const auto stepping : {TimeStepping::monotone, TimeStepping::second_order}) {
      ImplicitMixed<2> flow(m.grid, {modulus, true, stepping}, Vector<2>::Zero());
      MixedState<2> state = m.rest();
      double time = 0.0;
      for (const double dt : {1e-5, 1e-3, 1.0}) {
        const auto step = flow.step(state, dt, m.constant(flow));
        EXPECT_LE(imbalance(m.grid, step.face_volume,
                            [&] {
                              auto v = stored(m, modulus, state, step.end);
                              for (double& s : v) s = -s;
                              v[17] += dt * 2e-4;
                              return v;
                            }()),
                  1e-12);
        state = step.end;
        time += dt;
        double volume = 0.0;
        for (const double s : stored(m, modulus, m.rest(), state)) volume += s;
        EXPECT_NEAR(volume / (time * (1e-3 + 2e-4)), 1.0, 1e-11) << "K = " << modulus;
      }
    }
  }
}

TEST(ImplicitMixed, WithoutPressureBoundaryFluxesMustCancel) {
  FlowModel m(model::column_mesh(6, 6, 1.0, 1.0, model::jittered(0.03, 5)));
  m.set("left", FaceKind::flux, 1e-3);
  m.set("right", FaceKind::flux, -1.5e-3);
  m.forcing.source.assign(m.mesh.element_count(), 0.5e-3 / m.mesh.element_count());
  ImplicitMixed<2> stiff(m.grid, {infinite, true, TimeStepping::second_order}, Vector<2>::Zero());
  ImplicitMixed<2> soft(m.grid, {2e7, true, TimeStepping::second_order}, Vector<2>::Zero());
  const std::vector<const FlowForcing<2>*> both = {&m.forcing, &m.forcing};
  for (const auto& step :
       {stiff.steady(m.forcing), soft.steady(m.forcing), stiff.step(m.rest(), 0.1, both)}) {
    EXPECT_LE(imbalance(m.grid, step.face_flux, m.forcing.source), 1e-12);
    EXPECT_EQ(step.end.face_pressure[m.grid.element_face[0][0]], 0.0);
  }

  m.set("left", FaceKind::flux, 1.1e-3);
  EXPECT_THROW(soft.steady(m.forcing), NumericalError);
  EXPECT_THROW(stiff.step(m.rest(), 0.1, both), NumericalError);
  EXPECT_NO_THROW(soft.step(m.rest(), 0.1, both));
  try {
    stiff.steady(m.forcing);
    FAIL() << "no error";
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("0.0001 m3/s, of 0.0031 m3/s"), std::string::npos)
        << error.what();
  }
}

}  // namespace implicit_mixed_test
}  // namespace suffuse
