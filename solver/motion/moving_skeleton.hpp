#pragma once

/// A skeleton that moves: points that carry stress, in equilibrium with weight, loads and pore
/// pressure at the end of each step.

#include <memory>

#include "boundary/boundary_loads.hpp"
#include "equilibrium/crossing_forces.hpp"
#include "grid/compensated_sum.hpp"
#include "motion/motion_flux.hpp"
#include "motion/repeated_failure.hpp"
#include "motion/soil_inertia.hpp"
#include "motion/solid_flux.hpp"
#include "solid/eroding_skeleton.hpp"

namespace suffuse {

/// Porosity of a point is n = 1 - V_s/V with its volume of today; that of an element 1 - V_s,e/V_e
/// with its solid volume V_s,e, which motion carries from element to element and exchange changes
/// where it happens.
template <int Dim>
class MovingSkeleton final : public ErodingSkeleton<Dim> {
 public:
  /// Moves the points of `soils`. Throws InputError as they do.
  MovingSkeleton(const Grid<Dim>& grid, SoilMap<Dim>& soils, const TimeSpan& span, int threads);

  /// Porosity changes with the volume of the soil too: what counts is what its points have left.
  [[nodiscard]] double eroded_share(int point) const override {
    return (initial_erodible_[point] - this->state_.erodible_volume[point]) / points_.volume[point];
  }
  [[nodiscard]] std::vector<double> element_porosity() const override;

  void exchange(double from, double to, const PointFlows& flows, const std::vector<char>& waiting,
                std::vector<double>& exchange) override;
  void apply(const std::vector<Exchange>& change, std::vector<double>& exchange) override;
  void deposit(const std::vector<double>& volume) override;
  void start_from(const SolidState& state) override;
  void archive(StateArchive& archive) override;

  [[nodiscard]] bool moves() const override { return true; }
  void start_motion(const MotionForcing& forcing) override;
  [[nodiscard]] std::vector<double> compressibility(double duration) const override;
  [[nodiscard]] std::vector<double> inertial_mobility(double duration) const override;
  const SolidMotion& try_motion(const MotionForcing& forcing) override;
  const SolidMotion& accept_motion() override;
  bool let_fail(double time) override;
  [[nodiscard]] bool has_inertia() const override { return inertia_.acts(); }
  [[nodiscard]] bool slides() const override { return slides_; }
  [[nodiscard]] double time_of_fall() const override;
  [[nodiscard]] double longest_step() const override { return inertia_.longest_step(); }
  [[nodiscard]] std::vector<double> load_breakpoints() const override {
    return boundary_loads_.breakpoints();
  }
  [[nodiscard]] double stiffness() const override;
  [[nodiscard]] double largest_load_change() const override {
    return boundary_loads_.largest_change();
  }
  [[nodiscard]] std::vector<double> region_gain() const override;
  [[nodiscard]] const std::vector<SoilFilling>& filling() const override { return filling_; }
  void describe(HistoryRow& row) const override;
  void describe(Snapshot& snapshot) const override;

  /// The points, sorted by element, in the order of `soils().points()`.
  [[nodiscard]] const SolidPoints<Dim>& points() const { return points_; }
  /// Number of each point at the start.
  [[nodiscard]] const std::vector<int>& id() const { return id_; }
  /// Share of the erodible fines of the start that a point has left; above 1 with deposits.
  [[nodiscard]] double fines_left(int point) const;
  /// Effective stress sigma' of a point, Pa; tension is positive.
  [[nodiscard]] Eigen::Matrix3d effective_stress(int point) const;
  /// Solid volume per element, m3.
  [[nodiscard]] const std::vector<double>& element_solid_volume() const { return solid_; }

  /// A motion by more than this share of an element's height is refused: points would pass
  /// elements unseen.
  static constexpr double max_travel = 0.5;
  /// Limit of the motion in an equilibrium that inertia is to follow, as a share of an element's
  /// height: a slide must not pass within a long step.
  static constexpr double watched_travel = 0.05;

 private:
  /// Laws and numbers of the points with the fines that they will have at the end of the step.
  [[nodiscard]] std::vector<PointSkeleton> skeletons() const;
  [[nodiscard]] PointSkeleton skeleton_of(int point, double fines_left) const;
  /// `erodible_volume`, m3, as a share of the erodible volume at the start.
  [[nodiscard]] double share_left(int point, double erodible_volume) const;
  [[nodiscard]] std::vector<double> solid_volumes() const;
  /// `smooth_volumes` of what the points have, m3.
  [[nodiscard]] std::vector<double> smooth(const std::vector<double>& of_points) const {
    return smooth_volumes(this->grid_, points_, of_points, supports_.rigid_elements());
  }
  /// Keeps what points will have lost by the end of the step.
  void expect_losses(const std::vector<double>& porosity);
  /// Volume that a point will have lost by the end of the step, m3.
  [[nodiscard]] double loss_of(int point) const { return loss_.empty() ? 0.0 : loss_[point]; }
  [[nodiscard]] NodeVectors<Dim> loads(const MotionForcing& forcing, const PointsByElement& sorted,
                                       const ElementClasses& classes) const;
  /// Solid of the points at the end of the step that is tried, kg.
  [[nodiscard]] std::vector<double> solid_masses() const;
  /// Makes the equilibrium of the step that is tried, if there is none yet.
  void prepare_step(const MotionForcing& forcing);
  /// What counts for inertia: solid, and the liquid in its pores, kg per point.
  [[nodiscard]] std::vector<double> moved_masses(const MotionForcing& forcing) const;
  /// Whether the soil is in equilibrium, and inertia is to follow when it is lost.
  [[nodiscard]] bool watches_failure() const;
  /// Mean size of the elements, m.
  [[nodiscard]] double mean_size() const;
  /// \param mass  what counts for inertia, kg per point
  [[nodiscard]] SoilExtent extent(const std::vector<double>& mass) const;
  /// Whether the step that is accepted moved the soil as fast as it falls. `before`: places of the
  /// points at its start.
  [[nodiscard]] bool has_slid(const std::vector<Vector<Dim>>& before) const;
  void take_velocities();
  /// V_e / E_oed, m3/Pa, in free water beside soil that of the softest soil; 0 elsewhere without
  /// soil that moves.
  [[nodiscard]] std::vector<double> drained_compressibility() const;
  /// Mass of soil and the liquid in its pores, per node, kg.
  [[nodiscard]] std::vector<double> node_masses() const;
  /// Throws EquilibriumLost where the step that is accepted leaves soil no pores.
  void check_pores() const;
  /// Sorts what belongs to points by their elements and hands them on to the soils.
  void sort_points();
  void show_points();
  void find_filling();
  /// Adds what the points gained, m3 per point, to their elements.
  void add_to_elements(const std::vector<double>& gain);
  /// After the points have moved and before they are sorted.
  void find_crossing_forces();
  [[nodiscard]] std::vector<double> diffusivity(const PointsByElement& sorted) const;
  void carry_solid(const std::vector<double>& smooth_before, double travel);
  /// Books the solid of points that have come into another region from `element`, per point.
  void book_regions(const std::vector<int>& element);

  SoilMap<Dim>& movable_soils_;
  bool has_free_water_;
  SolidPoints<Dim> points_;
  std::vector<Vector<Dim>> start_;  ///< per point: its place at the start, m
  std::vector<int> id_;
  std::vector<int> region_;               ///< per point: where it comes from
  std::vector<double> initial_erodible_;  ///< per point, m3
  Supports<Dim> supports_;
  BoundaryLoads<Dim> boundary_loads_;
  CrossingForces<Dim> crossing_forces_;  ///< while inertia does not act
  SoilInertia<Dim> inertia_;
  RepeatedFailure<Dim> repeated_failure_;
  bool slides_ = false;                      ///< see `slides`; of the last step
  double failure_time_ = 0.0;                ///< when equilibrium was lost last, s; 0: never
  std::vector<double> solid_;                ///< per element, m3
  std::vector<CompensatedSum> region_gain_;  ///< per region of the mesh, m3
  std::vector<double> loss_;          ///< per point, in the step that is tried, m3; empty: none
  std::vector<double> pressure_;      ///< of the pores at the last equilibrium, per element, Pa
  std::vector<SoilFilling> filling_;  ///< after the last motion
  SolidFlux<Dim> solid_flux_;
  double correction_ = 0.0;  ///< see HistoryRow::solid_correction
  long newton_iterations_ = 0;
  long step_iterations_ = 0;  ///< of the tries since the last step

  std::unique_ptr<StepEquilibrium<Dim>> step_;  ///< of the step that is tried; null between steps
  std::unique_ptr<FaceBubbles<Dim>> bubbles_;
  MotionForcing tried_;
  NodeVectors<Dim> forces_;  ///< loads of the step that is tried, N
  SolidMotion motion_;
};

}  // namespace suffuse
