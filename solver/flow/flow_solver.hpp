#pragma once

/// The flow of a scene, whichever scheme steps it and whichever way its liquid is carried: boundary
/// conditions, coefficients and state, and what the results say of it.

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "flow/face_conditions.hpp"
#include "flow/flow.hpp"
#include "grid/face_flux.hpp"
#include "results/state_archive.hpp"
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
struct FlowState {
  double time = 0.0;
  double dt = 0.0;
  std::vector<double> pressure;       ///< per element, Pa
  std::vector<double> node_pressure;  ///< Pa
  VectorField<Dim> velocity;          ///< per node, intrinsic, m/s
  std::vector<double> face_flux;      ///< along each face's normal, m3/s
  FluxInTime flux_in_time;            ///< since the interval began: what erosion goes by
  double eos_error = 0.0;             ///< see HistoryRow
  double pressure_overshoot = 0.0;    ///< see HistoryRow
};

/// What has passed since the last meeting of flow and transport, up to some moment.
template <int Dim>
struct Passed {
  FaceVolumes volumes;
  /// Flux of each node added up over the time, m. Empty where liquid follows the face volumes.
  VectorField<Dim> node_shift;
};

template <int Dim>
Passed<Dim> between(const Passed<Dim>& a, const Passed<Dim>& b, double share) {
  return {{between(a.volumes.liquid, b.volumes.liquid, share),
           between(a.volumes.density_excess, b.volumes.density_excess, share)},
          between(a.node_shift, b.node_shift, share)};
}

/// What the pores hold, per element, as the flow needs to know it.
struct PoreState {
  std::vector<double> porosity;       ///< n_L
  std::vector<double> water_volume;   ///< pore volume less fluidised grains, m3
  std::vector<double> concentration;  ///< c
  std::vector<double> flux;           ///< |q|, m/s; may be empty where no soil erodes by it
};

/// An interval of the flow, from one meeting with erosion and transport to the next, and those who
/// have a say in it.
template <int Dim>
struct FlowInterval {
  double begin = 0.0;
  double target = 0.0;  ///< the interval ends there at the latest, s
  bool end_on_target = false;
  /// Steps of a length that erosion and transport let pass before they must follow.
  std::function<long(double dt)> steps_allowed;
  /// Longest interval, s, that erosion and transport may follow in a few steps of their own.
  std::function<double()> longest;
  /// The pores at a time within the interval, as erosion will have made them.
  std::function<PoreState(double time)> pores_at;
  /// Times at which somebody looks, ascending, given the time that the interval ends at.
  std::function<std::vector<double>(double reached)> times_until;
  std::function<void(FlowState<Dim> moment, const Passed<Dim>& passed)> see;
};

/// What an interval of the flow came to.
template <int Dim>
struct FlowProgress {
  long steps = 0;
  double dt = 0.0;        ///< of one step, s
  double duration = 0.0;  ///< of all, s
  Passed<Dim> passed;
};

/// How a plan wants the flow stepped.
struct FlowOptions {
  double step = unset;      ///< s
  bool step_given = false;  ///< by the scene; else the scheme may change it
  bool inertia = false;     ///< implicit only
  /// Implicit only: errors of steps much shorter than this count by the volume that they misplace,
  /// not by the flux, s. Waves whose periods are shorter need not be followed.
  double unnoticed = 0.0;
  bool freeze = true;  ///< implicit only: a steady flow is not solved again
  int threads = 1;
};

template <int Dim>
class FlowSolver {
 public:
  FlowSolver(const Case<Dim>& c, const Grid<Dim>& grid, const RigidSkeleton<Dim>& skeleton,
             int threads = 1);
  virtual ~FlowSolver() = default;
  FlowSolver(const FlowSolver&) = delete;
  FlowSolver& operator=(const FlowSolver&) = delete;

  [[nodiscard]] const std::vector<FaceCondition>& conditions() const { return conditions_; }
  [[nodiscard]] const FlowCoefficients<Dim>& coefficients() const { return coefficients_; }

  /// Takes what the pores hold at `time`, and the concentration of what crosses each face.
  virtual void update(double time, const PoreState& content,
                      const std::vector<double>& face_concentration);

  /// At rest or steady, as the scene says. Warns where this mesh cannot follow the flow.
  virtual void start() = 0;

  /// Runs from a meeting to the next. Throws NumericalError.
  virtual FlowProgress<Dim> run(const FlowInterval<Dim>& interval) = 0;

  /// Pressure per element, Pa.
  [[nodiscard]] virtual const std::vector<double>& pressure() const = 0;
  /// The masses of water are what is conserved (single-point): pressures follow from them, at once
  /// or with the next step. `water_mass` per element, kg.
  virtual void follow_masses(double time, const std::vector<double>& water_mass) = 0;

  /// The flow as it stands.
  [[nodiscard]] virtual FlowState<Dim> moment(double time) const = 0;
  /// Its fluxes through faces alone, m3/s.
  [[nodiscard]] virtual std::vector<double> face_flux(double time) const {
    return moment(time).face_flux;
  }
  /// What this scheme did: passes with calls and seconds, for run.json.
  [[nodiscard]] virtual std::vector<PassTiming> passes() const = 0;

  /// Everything that steps to come depend on, once started.
  virtual void archive(StateArchive& archive);

  /// Fluxes through the outer boundary, pressures and speeds.
  void describe(const FlowState<Dim>& moment, HistoryRow& row) const;

  /// Names each boundary that liquid entered through, once, where the scene gives it no
  /// concentration. `entered`: volume along each face's normal, m3.
  void warn_of_unstated_inflow(double time, const std::vector<double>& entered);
  /// Things to say once, newly found.
  [[nodiscard]] std::vector<std::string> take_warnings() { return std::exchange(warnings_, {}); }

 protected:
  [[nodiscard]] FlowCoefficients<Dim> coefficients_of(
      double time, const PoreState& content, const std::vector<double>& face_concentration) const;
  /// Mean of the elements around each node, Pa; where a pressure is prescribed, that is it.
  [[nodiscard]] std::vector<double> node_means(const std::vector<double>& pressure) const;
  /// A warning for the next `take_warnings`.
  void warn(std::string text) { warnings_.push_back(std::move(text)); }
  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] const Grid<Dim>& grid() const { return grid_; }
  [[nodiscard]] const RigidSkeleton<Dim>& skeleton() const { return skeleton_; }
  [[nodiscard]] int threads() const { return threads_; }
  [[nodiscard]] bool has_ergun() const { return !grain_size_.empty(); }
  [[nodiscard]] Vector<Dim> gravity() const;
  [[nodiscard]] const BoundaryValues<Dim>& boundary_values() const { return boundary_values_; }
  /// Takes the boundary values of this moment, with the concentrations of what entered `since`.
  void take_boundary_values(double since, double now) {
    boundary_values_.update(now, conditions_);
    boundary_values_.update_concentrations(0.5 * (since + now), conditions_);
  }
  /// Where a pressure is prescribed, that is the node's.
  void prescribe_at_nodes(std::vector<double>& node_pressure) const;

  std::vector<FaceCondition> conditions_;  ///< with the values of this moment
  FlowCoefficients<Dim> coefficients_;

 private:
  const Scene& scene_;
  const Grid<Dim>& grid_;
  BoundaryValues<Dim> boundary_values_;
  const RigidSkeleton<Dim>& skeleton_;
  int threads_;
  std::vector<double> initial_porosity_;  ///< per element, at its centroid
  std::vector<double> grain_size_;  ///< per element, of Ergun's drag; empty where no soil has it, m
  double grain_density_ = unset;
  std::vector<bool> inflow_warned_;
  std::vector<std::string> warnings_;
};

/// The scheme that the scene asks for.
template <int Dim>
std::unique_ptr<FlowSolver<Dim>> make_flow(const Case<Dim>& c, const Grid<Dim>& grid,
                                           const RigidSkeleton<Dim>& skeleton,
                                           const FlowOptions& options);

}  // namespace suffuse
