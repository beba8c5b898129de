#pragma once

/// The liquid flow of a scene, whatever the scheme: an interface that the formulations step, with
/// boundary conditions, coefficients, state and the columns of the results that describe it.

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "flow/face_conditions.hpp"
#include "flow/flow.hpp"
#include "flow/flow_values.hpp"
#include "grid/face_flux.hpp"
#include "results/pass_timer.hpp"
#include "results/state_archive.hpp"
#include "results/tables.hpp"
#include "solid/pores.hpp"

namespace suffuse {

/// The flow at one moment.
template <int Dim>
struct FlowState {
  double time = 0.0;
  double dt = 0.0;
  std::vector<double> pressure;       ///< per element, Pa
  std::vector<double> node_pressure;  ///< Pa
  VectorField<Dim> velocity;          ///< per node, intrinsic, m/s
  std::vector<double> face_flux;      ///< along each face's normal, m3/s
  double eos_error = 0.0;             ///< see HistoryRow
  double pressure_overshoot = 0.0;    ///< see HistoryRow
};

/// An interval that the flow crosses by itself, until erosion and transport must follow.
template <int Dim>
struct FlowInterval {
  double start = 0.0;    ///< s
  double latest = 0.0;   ///< next output, or the end: the interval ends there at the latest, s
  double longest = 0.0;  ///< that erosion and transport can follow, s
  const PoreForecast<Dim>& pores;  ///< as erosion will make them
};

/// What the flow made of an interval.
struct FlowProgress {
  long steps = 0;
  double dt = 0.0;      ///< of the last step, s
  double end = 0.0;     ///< s; before the interval's latest end where the flow chose so
  FaceVolumes volumes;  ///< that crossed the faces
};

/// How a plan wants the flow stepped.
struct FlowOptions {
  double step = unset;      ///< s
  bool step_given = false;  ///< by the scene; else the scheme may change it
  bool inertia = false;     ///< implicit only
  /// Implicit only: errors of steps much shorter than this count by the volume that they misplace,
  /// not by the flux, s. Waves whose periods are shorter need not be followed.
  double unnoticed = 0.0;
  bool reuse_steady = true;  ///< implicit only: a steady flow is not solved again
  int threads = 1;
};

template <int Dim>
class FlowSolver {
 public:
  FlowSolver(const Case<Dim>& c, const Grid<Dim>& grid, const Skeleton<Dim>& solid,
             int threads = 1);
  virtual ~FlowSolver() = default;
  FlowSolver(const FlowSolver&) = delete;
  FlowSolver& operator=(const FlowSolver&) = delete;

  [[nodiscard]] const std::vector<FaceCondition>& conditions() const { return conditions_; }
  [[nodiscard]] const FlowCoefficients<Dim>& coefficients() const { return coefficients_; }

  /// How far the flow may go by itself before erosion and transport follow.
  struct CouplingLimits {
    bool one_transport_step = false;  ///< no more than one of them
    bool follows_pores = false;       ///< it forecasts them; else they may grow by little only
  };
  [[nodiscard]] virtual CouplingLimits coupling_limits() const = 0;

  /// Takes what the pores hold at `time`, and the concentration of what crosses each face.
  virtual void update(double time, const PoreState& pores,
                      const std::vector<double>& face_concentration);

  /// At rest or steady, as the scene says. Warns where this mesh cannot follow the flow.
  virtual void start() = 0;

  /// Takes one step or many, within the interval; ends on its latest end or on a breakpoint exactly
  /// where it reaches one. Throws NumericalError.
  virtual FlowProgress advance(const FlowInterval<Dim>& interval) = 0;

  /// Pressure per element, Pa.
  [[nodiscard]] virtual const std::vector<double>& pressure() const = 0;
  /// The masses of water are what is conserved (single-point): pressures follow from them, at once
  /// or with the next step. `water_mass` per element, kg.
  virtual void match_masses(double time, const std::vector<double>& water_mass) = 0;

  /// The flow as it stands.
  [[nodiscard]] virtual FlowState<Dim> state(double time) const = 0;
  /// Its fluxes through faces alone, m3/s.
  [[nodiscard]] virtual std::vector<double> face_flux(double time) const {
    return state(time).face_flux;
  }
  /// What this scheme did: passes with calls and seconds, for run.json.
  [[nodiscard]] virtual std::vector<PassTiming> passes() const = 0;

  /// Everything that steps to come depend on, once started.
  virtual void archive(StateArchive& archive);

  /// Fluxes through the outer boundary, pressures and speeds.
  void describe(const FlowState<Dim>& state, HistoryRow& row) const;

  /// Names each boundary that liquid entered through, once, where the scene gives it no
  /// concentration. `entered`: volume along each face's normal, m3.
  void warn_of_unstated_inflow(double time, const std::vector<double>& entered);
  /// Things to say once, newly found.
  [[nodiscard]] std::vector<std::string> take_warnings() { return std::exchange(warnings_, {}); }

 protected:
  [[nodiscard]] FlowCoefficients<Dim> coefficients_of(
      double time, const PoreState& pores, const std::vector<double>& face_concentration) const;
  /// Times at which erosion starts or ends or a boundary value has a kink, ascending, s.
  [[nodiscard]] const std::vector<double>& breakpoints() const { return breakpoints_; }
  /// The first breakpoint after `start`, or `latest` where that comes first.
  [[nodiscard]] double next_breakpoint(double start, double latest) const;
  /// Mean of the elements around each node, Pa; where a pressure is prescribed, that is it.
  [[nodiscard]] std::vector<double> node_means(const std::vector<double>& pressure) const;
  /// A warning for the next `take_warnings`.
  void warn(std::string text) { warnings_.push_back(std::move(text)); }
  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] const Grid<Dim>& grid() const { return grid_; }
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
  const SoilMap<Dim>& soils_;
  int threads_;
  std::vector<double> breakpoints_;
  std::vector<double> initial_porosity_;  ///< per element, at its centroid
  std::vector<double> grain_size_;  ///< per element, of Ergun's drag; empty where no soil has it, m
  double grain_density_ = unset;
  std::vector<bool> inflow_warned_;
  std::vector<std::string> warnings_;
};

/// The scheme that the scene asks for.
template <int Dim>
std::unique_ptr<FlowSolver<Dim>> make_flow(const Case<Dim>& c, const Grid<Dim>& grid,
                                           const Skeleton<Dim>& solid, const FlowOptions& options);

/// Throws InputError where the scene's scheme does not work in this dimension.
template <int Dim>
void check_scheme(const Case<Dim>& c);

}  // namespace suffuse
