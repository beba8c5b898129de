#pragma once

/// The flow solver of a scene, as formulations and transport use it. It computes pressures and
/// volumes of liquid through faces from boundary conditions and the state of the pores. The
/// implicit and the explicit scheme are derived classes; this class has what they share.

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "boundary/face_conditions.hpp"
#include "bounds/discharge_bounds.hpp"
#include "files/tables.hpp"
#include "flow/flow_step.hpp"
#include "grid/element_field.hpp"
#include "grid/face_flux.hpp"
#include "grid/field_values.hpp"
#include "mixed/flow.hpp"
#include "results/pass_timer.hpp"
#include "results/state_archive.hpp"
#include "solid/pores.hpp"

namespace suffuse {

/// The flow at one moment, for results.
template <int Dim>
struct FlowState {
  double time = 0.0;                  ///< s
  double dt = 0.0;                    ///< of the last step, or of the first before it, s
  std::vector<double> pressure;       ///< per element, Pa
  std::vector<double> node_pressure;  ///< per node, Pa
  /// Per face, Pa: the pressure in an element is the linear field of those of its faces. Empty if
  /// the flow has node pressures only.
  std::vector<double> face_pressure;
  std::vector<double> saturation;  ///< S per element; empty where every soil is saturated
  std::vector<double> porosity;    ///< n_L per element; empty as `saturation`
  /// k_r per element: conductivity over that of the saturated soil; empty as `saturation`.
  std::vector<double> relative_conductivity;
  VectorField<Dim> velocity;              ///< per node, intrinsic, m/s
  std::vector<double> face_flux;          ///< along each face's normal, m3/s
  double eos_error = 0.0;                 ///< see HistoryRow
  double pressure_overshoot = 0.0;        ///< see HistoryRow
  std::optional<DischargeBounds> bounds;  ///< with mesh.error
};

/// The last flow of an earlier run.
template <int Dim>
struct EarlierFlow {
  FlowState<Dim> state;
  ElementField<Dim> air;  ///< per side of each element, m3; empty if all soil is saturated

  /// Pressures at the centers of faces, Pa.
  [[nodiscard]] std::vector<double> face_pressure(const Grid<Dim>& grid) const;
  /// Per element, m3; empty as `air`.
  [[nodiscard]] std::vector<double> air_volume() const { return element_sums<Dim>(air); }
};

/// Choices of the run's plan for steps of the flow.
struct FlowOptions {
  double step = unset;      ///< length of a step, s
  bool step_given = false;  ///< the scene gives `step`; otherwise the scheme may change it
  bool inertia = false;     ///< implicit only: keep rho_L dv/dt
  /// Implicit only: waves of shorter periods need not be resolved, s. The error of a much shorter
  /// step counts by the displaced volume, not by the flux.
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
  [[nodiscard]] const BoundaryValues<Dim>& boundary_values() const { return boundary_values_; }
  [[nodiscard]] const FlowCoefficients<Dim>& coefficients() const { return coefficients_; }

  /// Limits of a coupling interval in addition to those of erosion and transport.
  struct CouplingLimits {
    bool one_transport_step = false;  ///< an interval holds at most one step of transport
    /// The flow uses the forecast of the pores; otherwise they may open only a little per interval.
    bool follows_pores = false;
  };
  [[nodiscard]] virtual CouplingLimits coupling_limits() const = 0;

  /// Finds the coefficients at `time`, s, from the state of the pores and the concentration of the
  /// liquid that crosses each face.
  virtual void update(double time, const PoreState& pores,
                      const std::vector<double>& face_concentration);

  /// Sets the state at the start of the run: at rest or steady, by the scene. Adds a warning if
  /// this mesh cannot resolve the flow. Call `update` before.
  virtual void start() = 0;
  /// Starts with the pressures, fluxes and air of another run on this mesh.
  virtual void start_from(const EarlierFlow<Dim>& earlier) = 0;
  /// The present flow, for another run to start from.
  [[nodiscard]] EarlierFlow<Dim> last_flow(double time) const {
    return {state(time), air_at_sides()};
  }

  /// Finds one or more steps within the interval, for a solid that does not move. They end exactly
  /// on a breakpoint or the latest end if they reach one. The flow does not change, but for what
  /// no result shows: the choice of later steps learns from the attempts, and a steady flow is
  /// solved anew with the sources that it has now. Throws NumericalError.
  virtual FlowStep<Dim> solve(const FlowInterval<Dim>& interval) = 0;
  /// Takes the steps: sets pressures and fluxes to those at their end.
  virtual FlowProgress commit(FlowStep<Dim> step) = 0;

  // Used by estimates; without effect on a scheme that does not choose its steps.
  /// Length of a step that keeps this tolerance, estimated from the last step, s.
  [[nodiscard]] virtual double step_within(double /*tolerance*/) const { return unset; }
  /// Sets the length of the next step to try, s, whatever was planned.
  virtual void plan_step(double /*dt*/) {}

  /// Longest step from `time` in which boundary values change so little that the mean flux of the
  /// step stands for the flux in it, s: by the root of the tolerance, whose square is an error.
  [[nodiscard]] double longest_of_boundaries(double time) const {
    return boundary_values_.longest_step(time, std::sqrt(scene_.time.tolerance));
  }
  /// Pressure per element, Pa.
  [[nodiscard]] virtual const std::vector<double>& pressure() const = 0;
  /// Volume of air per element, m3; empty where all soil is saturated.
  [[nodiscard]] virtual std::vector<double> air() const { return {}; }
  /// Volume of air in the share of each side of an element, m3; empty where all soil is saturated.
  [[nodiscard]] virtual ElementField<Dim> air_at_sides() const { return {}; }
  /// Makes pressures follow the masses of water, which are conserved (single-point): at once, or
  /// over the next steps. `water_mass` per element, kg; `time` in s.
  virtual void match_masses(double time, const std::vector<double>& water_mass) = 0;

  /// The flow at `time`, s, the end of the last step.
  [[nodiscard]] virtual FlowState<Dim> state(double time) const = 0;
  /// How far the discharge can be off on this mesh; none where the scheme cannot tell. Throws
  /// NumericalError.
  [[nodiscard]] virtual std::optional<DischargeBounds> discharge_bounds() const {
    return std::nullopt;
  }
  /// The fluxes through faces of `state`, m3/s.
  [[nodiscard]] virtual std::vector<double> face_flux(double time) const {
    return state(time).face_flux;
  }
  /// Calls and seconds of each pass of the scheme, for run.json.
  [[nodiscard]] virtual std::vector<PassTiming> passes() const = 0;

  /// Stores or restores everything that later steps depend on, after `start`.
  virtual void archive(StateArchive& archive);

  /// Adds a warning, once, where soil without retention is under suction; `time` in s. Not without
  /// gravity, where pressures may be negative. Throws as `refuse_dry_outflow` does. All ranks have
  /// to call it.
  void check_suction(double time);
  /// Adds a warning, which the next `take_warnings` returns.
  void warn(std::string text) { warnings_.push_back(std::move(text)); }
  /// The warnings since the last call.
  [[nodiscard]] std::vector<std::string> take_warnings() { return std::exchange(warnings_, {}); }

 protected:
  [[nodiscard]] FlowCoefficients<Dim> coefficients_of(
      double time, const PoreState& pores, const std::vector<double>& face_concentration) const;
  /// Times at which erosion starts or ends or a boundary value has a kink, ascending, s.
  [[nodiscard]] const std::vector<double>& breakpoints() const { return breakpoints_; }
  /// Breakpoints at which boundary values or loads have a kink, ascending, s.
  [[nodiscard]] const std::vector<double>& kinks() const { return kinks_; }
  /// The first breakpoint after `start`, or `latest` if that comes first, s.
  [[nodiscard]] double next_breakpoint(double start, double latest) const;
  /// Mean of the elements around each node, Pa; at a prescribed pressure, that pressure.
  [[nodiscard]] std::vector<double> node_means(const std::vector<double>& pressure) const;
  [[nodiscard]] std::vector<double> pressure_at_rest() const {
    return suffuse::pressure_at_rest(scene_, grid_);
  }
  /// Throws NumericalError: the element has no water left.
  [[noreturn]] void refuse_dry(int element, double time) const;
  /// Throws NumericalError where the grains in the liquid lock.
  void refuse_locked(double time, const std::vector<double>& concentration) const;
  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] const Grid<Dim>& grid() const { return grid_; }
  [[nodiscard]] int threads() const { return threads_; }
  [[nodiscard]] bool has_ergun() const { return has_ergun_; }
  [[nodiscard]] Vector<Dim> gravity() const;
  /// Sets the boundary values to those at the end of a step, and concentrations to their means over
  /// the step; both times in s. Levels of reservoirs have risen at these rates, m/s.
  void update_boundary_values(double start, double end,
                              const std::vector<double>& reservoir_rates = {}) {
    boundary_values_.raise_reservoirs(end, reservoir_rates);
    boundary_values_.update(end, conditions_);
    boundary_values_.update_concentrations(0.5 * (start + end), conditions_);
  }
  /// Sets the pressure of nodes on faces with a prescribed pressure, and of other nodes of open
  /// seepage faces to zero, Pa; it is not above zero at closed ones.
  /// \param face_pressure  empty if there are no seepage faces
  void prescribe_at_nodes(const std::vector<double>& face_pressure,
                          std::vector<double>& node_pressure) const;

  std::vector<FaceCondition> conditions_;  ///< per face, at the end of the last step
  FlowCoefficients<Dim> coefficients_;

 private:
  const Scene& scene_;
  const Grid<Dim>& grid_;
  BoundaryValues<Dim> boundary_values_;
  const SoilMap<Dim>& soils_;
  const Skeleton<Dim>& skeleton_;
  int threads_;
  /// Porosity that resists the flow in an element partly filled with soil, and its conductivity
  /// over that of an element full of this soil.
  struct SurfaceSoil {
    double porosity;
    double easier;
  };
  /// n_0 of the soil that an element holds now.
  [[nodiscard]] double start_porosity(int element) const;
  [[nodiscard]] SurfaceSoil surface_soil(int element, double porosity) const;

  std::vector<double> breakpoints_;
  std::vector<double> kinks_;
  std::vector<double> initial_porosity_;  ///< per element, at its centroid
  bool has_ergun_ = false;                ///< a soil has Ergun's drag
  double grain_density_ = unset;
  bool suction_warned_ = false;
  std::vector<std::string> warnings_;
};

/// The flow solver of the scheme that the scene asks for.
template <int Dim>
std::unique_ptr<FlowSolver<Dim>> make_flow(const Case<Dim>& c, const Grid<Dim>& grid,
                                           const Skeleton<Dim>& solid, const FlowOptions& options);

/// Throws InputError where the scene's scheme does not work in this dimension.
template <int Dim>
void check_scheme(const Case<Dim>& c);

}  // namespace suffuse
