#pragma once

/// The explicit flow of a scene, whichever way its liquid is carried: boundary conditions,
/// operator, scheme and state at the start, and what the results say of it.

#include <limits>
#include <string>
#include <vector>

#include "flow/explicit_nodal.hpp"
#include "flow/stability_limit.hpp"
#include "results/writer.hpp"
#include "solid/rigid_skeleton.hpp"

namespace suffuse {

/// Share of the way from `a` to `b`.
template <class Value>
std::vector<Value> between(const std::vector<Value>& a, const std::vector<Value>& b, double share) {
  std::vector<Value> result(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) result[i] = a[i] + share * (b[i] - a[i]);
  return result;
}

/// The flow at one moment.
template <int Dim>
struct FlowMoment {
  double time = 0.0;
  double dt = 0.0;
  std::vector<double> pressure;  ///< per element, Pa
  VectorField<Dim> velocity;     ///< per node, intrinsic, m/s
};

/// What has passed since the last meeting of flow and transport, up to some moment.
template <int Dim>
struct Passed {
  FaceVolumes volumes;
  VectorField<Dim> displacements;  ///< see ExplicitNodal
};

template <int Dim>
Passed<Dim> between(const Passed<Dim>& a, const Passed<Dim>& b, double share) {
  return {{between(a.volumes.liquid, b.volumes.liquid, share),
           between(a.volumes.density_excess, b.volumes.density_excess, share)},
          between(a.displacements, b.displacements, share)};
}

/// What the pores hold, per element, as the flow needs to know it.
struct PoreContent {
  std::vector<double> porosity;       ///< n_L
  std::vector<double> water_volume;   ///< pore volume less fluidised grains, m3
  std::vector<double> concentration;  ///< c
};

template <int Dim>
class NodalFlow {
 public:
  NodalFlow(const Case<Dim>& c, const Grid<Dim>& grid, const RigidSkeleton<Dim>& skeleton,
            int threads);
  NodalFlow(const NodalFlow&) = delete;
  NodalFlow& operator=(const NodalFlow&) = delete;

  [[nodiscard]] const std::vector<FaceCondition>& conditions() const { return conditions_; }
  [[nodiscard]] const NodalOperator<Dim>& nodal_operator() const { return operator_; }
  [[nodiscard]] ExplicitNodal<Dim>& scheme() { return scheme_; }
  [[nodiscard]] const ExplicitNodal<Dim>& scheme() const { return scheme_; }
  [[nodiscard]] const FlowCoefficients<Dim>& coefficients() const { return coefficients_; }

  /// Takes what the pores hold at `time`, and the concentration of what crosses each face.
  void update(double time, const PoreContent& content,
              const std::vector<double>& face_concentration);

  /// At rest or steady, as the scene says. Warns where this mesh cannot follow the flow.
  void start(std::vector<std::string>& warnings);

  /// Stability limit with the coefficients and speeds of this moment: element by element, and in
  /// double-point scenes, where `step` is above that, of the assembled scheme.
  [[nodiscard]] StabilityLimit current_limit(double step) const;

  [[nodiscard]] FlowMoment<Dim> moment(double time, double dt) const {
    return {time, dt, scheme_.pressure(), scheme_.velocity()};
  }
  /// Runs `steps` steps of `dt` from time `begin`. Calls observe(moment, passed) for each of
  /// `times` (ascending, within these steps) in turn: flux is constant within a step, so what has
  /// passed is linear.
  template <class Observe>
  void run(double begin, long steps, double dt, const std::vector<double>& times,
           const Observe& observe) {
    scheme_.reset_volumes();
    auto next = times.begin();
    for (long s = 0; s < steps; ++s) {
      const double step_begin = begin + static_cast<double>(s) * dt;
      const double step_end =
          s + 1 == steps ? std::numeric_limits<double>::infinity() : step_begin + dt;
      if (next == times.end() || *next > step_end) {
        scheme_.step(dt);
        continue;
      }
      const std::vector<double> pressure = scheme_.pressure();
      const Passed<Dim> before = passed();
      scheme_.step(dt);
      for (; next != times.end() && *next <= step_end; ++next) {
        const double share = (*next - step_begin) / dt;
        observe(FlowMoment<Dim>{*next, dt, between(pressure, scheme_.pressure(), share),
                                scheme_.velocity_at((share - 0.5) * dt)},
                between(before, passed(), share));
      }
    }
  }
  [[nodiscard]] Passed<Dim> passed() const { return {scheme_.volumes(), scheme_.displacements()}; }

  /// Liquid volume through each face per second, m3/s.
  [[nodiscard]] std::vector<double> face_fluxes(const VectorField<Dim>& velocity) const;
  /// Darcy flux at the centroid of each element, m/s: the Raviart-Thomas field of the face fluxes.
  [[nodiscard]] VectorField<Dim> darcy_flux(const std::vector<double>& face_flux) const;
  /// Mean of the elements around each node, Pa. Element pressures carry patterns that push no node,
  /// large on unstructured meshes; this is almost free of them. Where a pressure is prescribed,
  /// that is it.
  [[nodiscard]] std::vector<double> node_pressure(const std::vector<double>& pressure) const;

  /// Fluxes through the outer boundary, pressures and speeds.
  void describe(const FlowMoment<Dim>& moment, HistoryRow& row) const;

  /// Names each boundary that liquid entered through, once, where the scene gives it no
  /// concentration. `entered`: volume along each face's normal, m3.
  void warn_of_unstated_inflow(double time, const std::vector<double>& entered,
                               std::vector<std::string>& warnings);

 private:
  void warn_of_locking(const VectorField<Dim>& steady_velocity,
                       std::vector<std::string>& warnings) const;

  const Scene& scene_;
  const Grid<Dim>& grid_;
  const RigidSkeleton<Dim>& skeleton_;
  std::vector<FaceCondition> conditions_;
  NodalOperator<Dim> operator_;
  ExplicitNodal<Dim> scheme_;
  FlowCoefficients<Dim> coefficients_;
  std::vector<double> grain_size_;  ///< per element, of Ergun's drag; empty where no soil has it, m
  double grain_density_ = unset;
  std::vector<bool> inflow_warned_;
  /// The two limits when the assembled one was last found; it follows the other until that has
  /// moved.
  mutable double assembled_limit_ = unset;
  mutable double element_limit_ = unset;
};

}  // namespace suffuse
