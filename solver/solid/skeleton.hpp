#pragma once

/// The solid phase as an interface for the rest of the solver: soil at material points, of which a
/// part can erode into the liquid. The skeleton that stays in place is `RigidSkeleton`, the one
/// that moves is `MovingSkeleton` (deformation/).

#include <limits>
#include <memory>
#include <stdexcept>
#include <vector>

#include "common/errors.hpp"
#include "grid/grid.hpp"
#include "results/state_archive.hpp"
#include "results/writer.hpp"
#include "solid/point_flows.hpp"

namespace suffuse {

/// What the solid points hold, m3. Porosity follows from this and the volume that a point stands
/// for.
struct SolidState {
  std::vector<double> skeleton_volume;   ///< per point: coarse grains, which never erode
  std::vector<double> erodible_volume;   ///< per point: fines that can erode, deposits among them
  std::vector<double> deposited_volume;  ///< per point: deposited since the start

  [[nodiscard]] double solid_volume(int point) const {
    return skeleton_volume[point] + erodible_volume[point];
  }
  void archive(auto& archive) { archive(skeleton_volume, erodible_volume, deposited_volume); }
};

/// The soil cannot carry what loads it any longer, or is about to fail. Thrown before a step
/// changes anything: the model is as it was in the last equilibrium.
class EquilibriumLost : public NumericalError {
 public:
  using NumericalError::NumericalError;
};

/// What drives the motion of the skeleton in a step.
struct MotionForcing {
  double end = 0.0;                 ///< time at the end of the step, s
  double duration = 0.0;            ///< of the step, s
  std::vector<double> pressure;     ///< of the pores at the end, per element, Pa
  std::vector<double> liquid_mass;  ///< water and fines in the pores, per volume of soil and
                                    ///< element, kg/m3
  /// n_L of each solid point at the end, with what it will have exchanged with the liquid, if it
  /// were not deformed; empty: as now.
  std::vector<double> porosity = {};
  /// Pressures fall by this times the growth of the soil, per element, Pa; empty: they are given.
  std::vector<double> stiffness = {};
};

/// How the skeleton moves in a step.
struct SolidMotion {
  /// Whether an equilibrium was found; otherwise the step must be shorter.
  bool converged = true;
  /// Where none was found: the node at which forces are out of balance most; -1: not known.
  int worst_node = -1;
  /// Volume of soil with its pores that crosses each face along its normal, m3 (S_f). What leaves
  /// an element is what its soil grows by, V_e (J - 1), and what the bubbles of its faces carry
  /// (docs/theory.md). 0 between elements without soil.
  std::vector<double> face_volume;
  /// Volume of the solid itself that crosses each face, m3 (s_f), and what each element gains by
  /// it, m3. Empty until the motion is accepted.
  std::vector<double> solid_face_volume;
  std::vector<double> solid_gain;
  int iterations = 0;   ///< of Newton's method, in the last try
  double travel = 0.0;  ///< largest displacement over the height of an element there
  /// Correction that makes s_f balance, over what the motion carries; of accepted motions.
  double solid_correction = 0.0;
};

/// How far soil fills an element at its surface.
struct SoilFilling {
  void archive(auto& archive) { archive(share, porosity); }

  double share = 1.0;     ///< of the element; 0: free water
  double porosity = 0.0;  ///< n_L of the soil there; not used where the share is 0 or 1
};

template <int Dim>
class Skeleton {
 public:
  Skeleton() = default;
  virtual ~Skeleton() = default;
  Skeleton(const Skeleton&) = delete;
  Skeleton& operator=(const Skeleton&) = delete;

  [[nodiscard]] virtual const SoilMap<Dim>& soils() const = 0;
  [[nodiscard]] virtual const SolidState& state() const = 0;
  /// n_L per solid point.
  [[nodiscard]] virtual const std::vector<double>& porosity() const = 0;
  /// n_L per solid point at the start.
  [[nodiscard]] virtual const std::vector<double>& initial_porosity() const = 0;
  /// Volume that a point has given to the liquid since the start, per volume of its soil today;
  /// what was deposited there counts as given back.
  [[nodiscard]] virtual double eroded_share(int point) const = 0;
  /// Mean n_L per element.
  [[nodiscard]] virtual std::vector<double> element_porosity() const = 0;

  /// Whether fines can be exchanged with the liquid between two times.
  [[nodiscard]] virtual bool exchanges_within(double from, double to) const = 0;
  /// n_L per solid point at time `to`, from now (`from`), without changing the state.
  [[nodiscard]] virtual std::vector<double> porosity_after(double from, double to,
                                                           const PointFlows& flows) const = 0;
  /// Exchanges fines with the liquid from `from` to `to`. `exchange` becomes the volume per solid
  /// point that went into the liquid, m3 (negative: that came from it). Elements of `waiting` (per
  /// element, may be empty) stay as they are.
  virtual void exchange(double from, double to, const PointFlows& flows,
                        const std::vector<char>& waiting, std::vector<double>& exchange) = 0;
  /// What a solid point exchanges from now (`from`) to `to` with liquid of concentration
  /// `concentration`, which flows on, if its porosity is `porosity` at `from`.
  [[nodiscard]] virtual Exchange exchange_at(int point, double porosity, double concentration,
                                             double from, double to,
                                             const PointFlows& flows) const = 0;
  /// How fast it does at a time, per volume of soil and second.
  [[nodiscard]] virtual Exchange exchange_rate_at(int point, double porosity, double concentration,
                                                  double time, const PointFlows& flows) const = 0;
  /// Whether a point can have such a porosity at a time: no more has eroded than can, nor is more
  /// filled.
  [[nodiscard]] virtual bool is_possible(int point, double porosity, double time,
                                         const PointFlows& flows) const = 0;
  /// The state after such an exchange at each point; `exchange` as above.
  virtual void apply(const std::vector<Exchange>& change, std::vector<double>& exchange) = 0;
  /// Takes what the liquid has left, m3 per solid point; empty: nothing.
  virtual void deposit(const std::vector<double>& volume) = 0;

  /// Starts with what the points of another run hold, in the same places.
  virtual void start_from(const SolidState& state) = 0;

  virtual void archive(StateArchive& archive) = 0;

  // Only moving skeletons use this.

  [[nodiscard]] virtual bool moves() const { return false; }
  /// Times at which what loads the solid has a kink, s.
  [[nodiscard]] virtual std::vector<double> load_breakpoints() const { return {}; }
  /// Finds the stress at the start. `forcing`: without a duration. Where there is no equilibrium,
  /// the solid has inertia from the start, or NumericalError is thrown.
  virtual void start_motion(const MotionForcing& /*forcing*/) {}
  /// Volume by which each element's soil would shrink in a step of `duration`, s, per Pa of pore
  /// pressure less, m3/Pa: about how strongly pressure and motion depend on each other. V_e / E_oed
  /// as if it could not move sideways; inertia makes it less.
  [[nodiscard]] virtual std::vector<double> compressibility(double /*duration*/) const {
    return {};
  }
  /// How easily a gradient of the pore pressure moves soil that has inertia, dt/rho per element,
  /// m3 s/kg; 0 where its stiffness, or no pressure, decides on its motion in a step of `duration`,
  /// s. Empty without inertia.
  [[nodiscard]] virtual std::vector<double> inertial_mobility(double /*duration*/) const {
    return {};
  }
  /// Largest modulus of soil that cannot move sideways, Pa.
  [[nodiscard]] virtual double stiffness() const { return 0.0; }
  /// Largest change of tractions in the run, from those at the start, Pa.
  [[nodiscard]] virtual double largest_load_change() const { return 0.0; }
  /// The equilibrium at the end of a step, from its start, without changing the state. To ask again
  /// with other pressures starts from the last answer.
  virtual const SolidMotion& try_motion(const MotionForcing& /*forcing*/) {
    throw std::logic_error("a rigid skeleton does not move");
  }
  /// Takes the last motion that was tried: points move, and solid with them.
  virtual const SolidMotion& accept_motion() {
    throw std::logic_error("a rigid skeleton does not move");
  }
  /// Equilibrium is lost at this time, s: from now on the solid has inertia, until it is at rest
  /// again. Returns false where that is no way out: it has inertia already, or the run is to stop.
  virtual bool let_fail(double /*time*/) { return false; }
  [[nodiscard]] virtual bool has_inertia() const { return false; }
  /// Whether soil in equilibrium moved so fast in the last step that it would have fallen.
  [[nodiscard]] virtual bool slides() const { return false; }
  /// Time in which soil falls through an element of mean size, s; 0 without gravity.
  [[nodiscard]] virtual double time_of_fall() const { return 0.0; }
  /// Longest step from now on, s.
  [[nodiscard]] virtual double longest_step() const {
    return std::numeric_limits<double>::infinity();
  }
  /// Solid that points have carried into each region of the mesh since the start, minus what they
  /// have carried out of it, m3. Empty while the solid stays in place.
  [[nodiscard]] virtual std::vector<double> region_gain() const { return {}; }
  /// Per element; empty while soil fills all elements that it filled at the start.
  [[nodiscard]] virtual const std::vector<SoilFilling>& filling() const {
    static const std::vector<SoilFilling> all;
    return all;
  }
  /// Adds what is known of the motion to a row and to a snapshot, whose fields of solid points are
  /// in the order of `soils().points()`.
  virtual void describe(HistoryRow& /*row*/) const {}
  virtual void describe(Snapshot& /*snapshot*/) const {}
};

/// The skeleton that the scene asks for, which moves the points of `soils` if it moves. Exchange
/// happens within `span` alone. (motion/make_skeleton.cpp)
template <int Dim>
std::unique_ptr<Skeleton<Dim>> make_skeleton(const Grid<Dim>& grid, SoilMap<Dim>& soils,
                                             const TimeSpan& span, int threads);

}  // namespace suffuse
