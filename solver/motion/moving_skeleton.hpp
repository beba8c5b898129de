#pragma once

/// A skeleton that moves: points that carry stress, in equilibrium with weight, loads, pore
/// pressure and, if it acts, inertia at the end of each step. It knows no flow, and does not decide
/// when soil fails (coupling/failure).

#include <optional>
#include <utility>

#include "boundary/boundary_loads.hpp"
#include "equilibrium/construction_forces.hpp"
#include "motion/motion_step.hpp"
#include "motion/moved_soil.hpp"
#include "motion/soil_inertia.hpp"
#include "motion/solid_flux.hpp"
#include "motion/start_stress.hpp"
#include "solid/eroding_skeleton.hpp"
#include "solid/region_gains.hpp"

namespace suffuse {

/// Porosity of a point is n = 1 - V_s/V with its present volume; that of an element is 1 -
/// V_s,e/V_e with its solid volume V_s,e, which motion carries between elements and exchange
/// changes at points.
template <int Dim>
class MovingSkeleton final : public ErodingSkeleton<Dim> {
 public:
  /// Moves the points of `soils`. Throws InputError.
  MovingSkeleton(const Grid<Dim>& grid, SoilMap<Dim>& soils, const TimeSpan& span, int threads);

  /// Fines lost, over the present volume: porosity changes with the volume of the soil too.
  [[nodiscard]] double eroded_share(int point) const override {
    return (initial_erodible_[point] - this->state_.erodible_volume[point]) / points_.volume[point];
  }
  [[nodiscard]] std::vector<double> element_porosity() const override;

  void exchange(double from, double to, const PointFlows& flows, const std::vector<char>& excluded,
                std::vector<double>& exchange) override;
  void apply(const std::vector<Exchange>& change, std::vector<double>& exchange) override;
  void deposit(const std::vector<double>& volume) override;
  void start_from(const SolidState& state) override;
  /// Takes the soil of another run. Places and plastic strains count from here.
  void start_from(MovedSoil<Dim> earlier);
  /// The present soil, for another run.
  [[nodiscard]] MovedSoil<Dim> moved() const;
  void archive(StateArchive& archive) override;

  [[nodiscard]] bool moves() const override { return true; }
  /// Finds the stress at the start under these pore pressures, Pa, and masses of liquid, kg per m3
  /// of soil; both per element.
  StartStress start_motion(const std::vector<double>& pressure,
                           const std::vector<double>& liquid_mass);

  /// Balances soil that was dug out or filled in, under pressures and masses as of `start_motion`,
  /// by construction forces.
  void start_construction(const std::vector<double>& pressure,
                          const std::vector<double>& liquid_mass);

  /// A step to be tried. It continues `last`, an earlier attempt from the same state, if that has
  /// the same equilibrium for given pressures.
  [[nodiscard]] MotionStep<Dim> start_step(MotionForcing forcing,
                                           std::optional<MotionStep<Dim>> last = {}) const;
  /// Finds the motion of the step under these pore pressures at its end, per element, Pa, starting
  /// from its last solution. With `stiffness`, per element, Pa, pressures fall by this times the
  /// relative growth of the soil.
  const SolidMotion& solve(MotionStep<Dim>& step, const std::vector<double>& pressure,
                           std::vector<double> stiffness = {}) const;
  /// Whether soil that rests stays where it is under these pore pressures; the motion of the step
  /// is none then.
  bool stays(MotionStep<Dim>& step, const std::vector<double>& pressure) const;
  /// Sets the velocities of points to those of the step, which has inertia; call before `commit`.
  SoilKinetics take_velocities(const MotionStep<Dim>& step);
  /// Moves points, and solid with them, as the step has found. Returns the motion, and its kinetics
  /// if the soil has no inertia now.
  std::pair<SolidMotion, SoilKinetics> commit(MotionStep<Dim> step);

  /// Starts the inertia of the soil, which is at rest.
  void start_inertia() {
    inertia_.begin(points_.size());
    held_share_ = 0.0;
  }
  /// Ends the inertia of the soil. From the end of the step on it rests: it stays where it is until
  /// the forces out of balance have changed by this share of the loads.
  void end_inertia(double held_share) {
    inertia_ = {};
    held_share_ = held_share;
  }
  [[nodiscard]] bool has_inertia() const override { return inertia_.acts(); }
  /// Whether the soil has come to rest after it had inertia, and has not moved since.
  [[nodiscard]] bool rests() const { return held_share_ > 0.0; }

  /// Volume by which each element's soil shrinks in a step of `duration`, s, per Pa of lower pore
  /// pressure, m3/Pa: V_e / E_oed, as without sideways motion; less with inertia.
  [[nodiscard]] std::vector<double> compressibility(double duration) const;
  /// Mobility of soil with inertia under a gradient of the pore pressure, dt/rho per element, m3
  /// s/kg; 0 where stiffness or no pressure governs its motion in a step of `duration`, s. Empty
  /// without inertia.
  [[nodiscard]] std::vector<double> inertial_mobility(double duration) const;
  /// Longest step at the present velocities, s.
  [[nodiscard]] double longest_step() const { return inertia_.longest_step(); }
  /// Time in which soil falls through an element of mean size, s; 0 without gravity.
  [[nodiscard]] double time_of_fall() const { return time_of_fall_; }
  /// Largest modulus of soil that cannot move sideways, Pa.
  [[nodiscard]] double stiffness() const;
  /// Largest change of tractions in the run, from those at the start, Pa.
  [[nodiscard]] double largest_load_change() const { return boundary_loads_.largest_change(); }
  [[nodiscard]] std::vector<double> load_breakpoints() const override;
  [[nodiscard]] std::vector<double> region_gain() const override { return region_gain_.values(); }
  [[nodiscard]] const std::vector<SoilFilling>& filling() const override { return filling_; }
  void describe(HistoryRow& row) const override;
  void describe(Snapshot& snapshot) const override;

  /// The points, sorted by element, in the order of `soils().points()`.
  [[nodiscard]] const SolidPoints<Dim>& points() const { return points_; }
  [[nodiscard]] const std::vector<int>& id() const { return id_; }  ///< numbers at the start
  /// Share of a point's initial erodible fines that it still has; above 1 with deposits.
  [[nodiscard]] double fines_left(int point) const;
  /// Effective stress sigma' of a point, Pa; tension is positive.
  [[nodiscard]] Eigen::Matrix3d effective_stress(int point) const;

 private:
  /// Laws and parameters of the points with the fines left after this loss.
  [[nodiscard]] std::vector<PointSkeleton> skeletons(const std::vector<double>& loss) const;
  [[nodiscard]] PointSkeleton skeleton_of(int point, double fines_left) const;
  /// `erodible_volume`, m3, as a share of the erodible volume at the start.
  [[nodiscard]] double share_left(int point, double erodible_volume) const;
  /// `smooth_volumes` of the points' values, m3.
  [[nodiscard]] std::vector<double> smooth(const std::vector<double>& of_points) const {
    return smooth_volumes(this->grid_, points_, of_points, supports_.rigid_elements());
  }
  [[nodiscard]] SoilLoads<Dim> loads(const MotionForcing& forcing,
                                     const std::vector<double>& solid_mass,
                                     const std::vector<double>& pressure,
                                     const PointsByElement& sorted,
                                     const ElementClasses& classes) const;
  /// Mass of the points' solid after this loss, kg.
  [[nodiscard]] std::vector<double> solid_masses(const std::vector<double>& loss) const;
  /// Sets pressures and loads of a step before its solution, without crossing forces.
  void load(MotionStep<Dim>& step, const std::vector<double>& pressure) const;
  /// Makes the equilibrium of a step, with inertia if the soil has it.
  void prepare(MotionStep<Dim>& step) const;
  /// Mass that has inertia: solid after the loss of the step, and the liquid in its pores, kg per
  /// point.
  [[nodiscard]] std::vector<double> moved_masses(const MotionStep<Dim>& step) const;
  /// Kinetics of a step in equilibrium. `before`: places of the points at its start.
  [[nodiscard]] SoilKinetics kinetics(const MotionStep<Dim>& step,
                                      const std::vector<Vector<Dim>>& before) const;
  [[nodiscard]] std::vector<double> drained_compressibility() const;
  /// What another run can go on with, in the order of MovedSoil::lasting.
  static auto lasting(auto& s) {
    return std::tie(s.state_, s.points_, s.region_, s.initial_porosity_, s.initial_erodible_,
                    s.solid_, s.pressure_, s.crossing_forces_, s.held_share_);
  }
  /// Sorts the data of points by element, and passes the points on to the soils.
  void sort_points(double time);
  void show_points();
  void find_filling();
  /// Adds the gains of the points, m3 per point, times a factor to their elements.
  void add_to_elements(const std::vector<double>& volume, double factor = 1.0);
  /// Call after the points have moved and before they are sorted.
  void find_crossing_forces(const MotionStep<Dim>& step);
  void carry_solid(const std::vector<double>& smooth_before, SolidMotion& motion);

  SoilMap<Dim>& movable_soils_;
  bool has_free_water_;
  SolidPoints<Dim> points_;
  std::vector<Vector<Dim>> start_;  ///< per point: its place at the start, m
  std::vector<int> id_;
  std::vector<int> region_;               ///< per point: region that it comes from
  std::vector<double> initial_erodible_;  ///< per point, m3
  Supports<Dim> supports_;
  BoundaryLoads<Dim> boundary_loads_;
  CrossingForces<Dim> crossing_forces_;  ///< without inertia
  ConstructionForces<Dim> construction_;
  std::shared_ptr<KeptStiffness<Dim>> kept_ = std::make_shared<KeptStiffness<Dim>>();
  SoilInertia<Dim> inertia_;
  double held_share_ = 0.0;  ///< of the loads, while the soil rests after its inertia; 0: it moves
  std::vector<double> solid_;  ///< per element, m3
  RegionGains region_gain_;
  std::vector<double> pressure_;      ///< of the pores at the last equilibrium, per element, Pa
  double time_of_fall_;               ///< see `time_of_fall`
  std::vector<SoilFilling> filling_;  ///< where the points are now
  SolidFlux<Dim> solid_flux_;
  double correction_ = 0.0;  ///< see HistoryRow::solid_correction
  long newton_iterations_ = 0;
};

}  // namespace suffuse
