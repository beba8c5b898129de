#pragma once

/// A random sealed box of soil that starts from a random pressure, and the energy that the schemes
/// conserve or lose.

#include <algorithm>
#include <cmath>

#include "explicit/explicit_nodal.hpp"
#include "explicit/stability_limit.hpp"
#include "mixed/implicit_mixed.hpp"
#include "solver/flow_model.hpp"

namespace suffuse::model {

struct BoxSettings {
  unsigned seed = 1;
  double jitter = 0.0;  ///< of inner nodes, m; the box is 1 m x 1 m, cells of 1/6 m
  double conductivity =
      1e-2;                   ///< around it, two decades from element to element; infinite: no drag
  double bulk_modulus = 2e7;  ///< Pa
  double mass_scaling = 1.0;  ///< explicit only
  double gap = 0.9;           ///< porosities from 0.5 - gap / 2 to 0.5 + gap / 2
  DragIntegration drag = DragIntegration::explicit_drag;
  bool convects = false;  ///< explicit: pressure is convected by the scheme
};

/// Changes of energy over a run, relative to the energy at its start.
struct EnergyChange {
  double drift = 0.0;   ///< largest distance from the start
  double growth = 0.0;  ///< largest growth in one step, relative to the energy before it
  double kept = 1.0;    ///< share of the energy at the end
  bool finite = true;

  void note(double first, double before, double now) {
    finite = finite && std::isfinite(now);
    drift = std::max(drift, std::abs(now / first - 1.0));
    growth = std::max(growth, now / before - 1.0);
    kept = now / first;
  }
};

class SealedBox {
 public:
  explicit SealedBox(const BoxSettings& settings)
      : settings_(settings),
        random_(settings.seed),
        flow_(column_mesh(cells, cells, 1.0, 1.0, jittered(settings.jitter, settings.seed))) {
    FlowCoefficients<2>& c = flow_.forcing.coefficients;
    for (int e = 0; e < flow_.mesh.element_count(); ++e) {
      c.porosity[e] = 0.5 + 0.5 * settings.gap * random_();
      c.water_volume[e] = c.porosity[e] * flow_.grid.volume[e] * (0.75 + 0.25 * random_());
      c.mixture_density[e] = 1200.0 + 200.0 * random_();
      const double k = settings.conductivity * std::pow(10.0, random_());
      c.drag[e] = std::isinf(k) ? 0.0 : darcy_drag(c.porosity[e], 1000.0, k);
    }
  }

  /// Makes `steps` steps of a share of the assembled limit. Pressures are so small relative to the
  /// modulus that nonlinear parts of the equation of state are below round-off.
  EnergyChange run_explicit(double share_of_limit, int steps) {
    NodalOperator<2> op(flow_.grid, flow_.forcing.conditions, Vector<2>::Zero());
    op.update(flow_.forcing.coefficients);
    ExplicitSettings settings;
    settings.bulk_modulus = settings_.bulk_modulus;
    settings.mass_scaling = settings_.mass_scaling;
    settings.drag = settings_.drag;
    settings.pressure_moves_with_liquid = !settings_.convects;
    ExplicitNodal<2> scheme(op, settings);
    scheme.update(flow_.forcing.coefficients);
    const double dt =
        share_of_limit * assembled_limit(op, flow_.forcing.coefficients, settings_.bulk_modulus,
                                         settings_.mass_scaling, settings_.drag);
    std::vector<double> pressure(flow_.mesh.element_count());
    for (double& p : pressure) p = 1e-16 * settings_.bulk_modulus * random_();
    scheme.set_pressure(pressure);
    scheme.set_velocity(VectorField<2>(flow_.mesh.node_count(), Vector<2>::Zero()));
    scheme.step(dt);  // its velocity step is half as long

    EnergyChange change;
    double first = 0.0;
    double last = 0.0;
    for (int s = 0; s < steps; ++s) {
      const std::vector<double> p = scheme.pressure();
      const VectorField<2> v = scheme.velocity();
      scheme.step(dt);
      const double now = std::isinf(settings_.conductivity)
                             ? conserved(op, v, scheme.velocity(), p)
                             : dissipated(op, dt, scheme.velocity(), p, scheme.pressure());
      if (s == 0) first = last = now;
      change.note(first, last, now);
      last = now;
    }
    return change;
  }

  /// Makes `steps` steps of `dt`, from random pressures and, with inertia, velocities.
  EnergyChange run_implicit(TimeStepping stepping, bool inertia, double dt, int steps) {
    ImplicitMixed<2> scheme(flow_.grid, {settings_.bulk_modulus, inertia, stepping},
                            Vector<2>::Zero());
    MixedState<2> state = flow_.rest();
    for (double& p : state.face_pressure) p = 1e4 * random_();
    for (auto& v : state.velocity) v = Vector<2>(random_(), random_());
    EnergyChange change;
    const double first = mixed_energy(inertia, state);
    double last = first;
    for (int s = 0; s < steps; ++s) {
      state = scheme.step(state, dt, flow_.constant(scheme)).end;
      const double now = mixed_energy(inertia, state);
      change.note(first, last, now);
      last = now;
    }
    return change;
  }

 private:
  static constexpr int cells = 6;

  [[nodiscard]] double compression(const std::vector<double>& p,
                                   const std::vector<double>& other) const {
    double sum = 0.0;
    for (std::size_t e = 0; e < p.size(); ++e) {
      sum += 0.5 * flow_.forcing.coefficients.water_volume[e] / settings_.bulk_modulus * p[e] *
             other[e];
    }
    return sum;
  }

  /// At the time of the pressure: 1/2 sum n S m v(-1/2).v(+1/2) + 1/2 sum V_w / K p^2, which
  /// symplectic Euler conserves.
  [[nodiscard]] double conserved(const NodalOperator<2>& op, const VectorField<2>& before,
                                 const VectorField<2>& after, const std::vector<double>& p) const {
    double sum = compression(p, p);
    for (std::size_t i = 0; i < before.size(); ++i) {
      sum += 0.5 * op.node_porosity()[i] * settings_.mass_scaling * op.node_mass()[i] *
             before[i].dot(after[i]);
    }
    return sum;
  }

  /// At the time of the velocity: 1/2 sum n M v^2 + 1/2 sum V_w / K p(-1/2) p(+1/2). With
  /// M = S m - dt d / 2 (drag stepped explicitly) or S m + dt d / 2 (implicitly) the drag acts on
  /// the mean of two velocities, so a step takes n d dt (v + v')^2 / 4 from it and gives nothing.
  [[nodiscard]] double dissipated(const NodalOperator<2>& op, double dt, const VectorField<2>& v,
                                  const std::vector<double>& before,
                                  const std::vector<double>& after) const {
    double sum = compression(before, after);
    const double share = settings_.drag == DragIntegration::explicit_drag ? -0.5 : 0.5;
    for (std::size_t i = 0; i < v.size(); ++i) {
      const double mass =
          settings_.mass_scaling * op.node_mass()[i] + share * dt * op.node_drag()[i];
      sum += 0.5 * op.node_porosity()[i] * mass * v[i].squaredNorm();
    }
    return sum;
  }

  [[nodiscard]] double mixed_energy(bool inertia, const MixedState<2>& state) const {
    double sum = 0.0;
    const FlowCoefficients<2>& c = flow_.forcing.coefficients;
    for (int e = 0; e < flow_.mesh.element_count(); ++e) {
      if (inertia) {
        sum += 0.5 * flow_.grid.volume[e] * c.mixture_density[e] * c.porosity[e] *
               state.velocity[e].squaredNorm();
      }
      for (const int f : flow_.grid.element_face[e]) {
        sum += 0.5 * flow_.capacity(e, settings_.bulk_modulus) * state.face_pressure[f] *
               state.face_pressure[f];
      }
    }
    return sum;
  }

  BoxSettings settings_;
  Uniform random_;
  FlowModel flow_;
};

}  // namespace suffuse::model
