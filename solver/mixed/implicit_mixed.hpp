#pragma once

/// Flow by mixed finite elements and implicit steps of any length. Unknowns are the pressures at
/// face centres (Crouzeix and Raviart); each element has one mean Darcy flux, which is eliminated;
/// the fluxes through faces are those of Raviart and Thomas (Marini, SIAM J. Numer. Anal. 22 (1985)
/// 493). With the porosity n, intrinsic velocity v, q = n v and momentum divided by n:
///
///   rho_L dv/dt = -grad p + rho_L g - (drag / n) q - b |q| q
///   (water_volume / volume / K) dp/dt + dn(S - 1)/dt + div q = source
///
/// Air, n (1 - S) per volume, gives way to liquid where a soil has a retention law; k_r / k is then
/// part of the mobility. Storage is lumped at the faces, with S at their pressures (Younes, Ackerer
/// and Lehmann, Int. J. Numer. Methods Eng. 66 (2006) 1069).

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "boundary/face_conditions.hpp"
#include "boundary/leaky_walls.hpp"
#include "common/errors.hpp"
#include "grid/grid.hpp"
#include "linear/lagged_preconditioner.hpp"
#include "linear/newton_system.hpp"
#include "mixed/flow.hpp"
#include "mixed/flow_soils.hpp"
#include "mixed/flux_correction.hpp"
#include "mixed/mixed_matrix.hpp"
#include "results/state_archive.hpp"
#include "scene/scene.hpp"

namespace suffuse {

struct ImplicitSettings {
  double bulk_modulus = std::numeric_limits<double>::infinity();  ///< K, Pa; may be infinite
  bool inertia = false;                                           ///< keep rho_L dv/dt
  TimeStepping stepping = TimeStepping::second_order;
  int threads = 1;
};

template <int Dim>
struct MixedState {
  std::vector<double> face_pressure;  ///< at face centres, Pa
  std::vector<Vector<Dim>> velocity;  ///< mean of each element, intrinsic, m/s
  /// Volume of air in the share of each side of an element, m3; empty where all soil is saturated.
  ElementField<Dim> air = {};

  void archive(auto& archive) { archive(face_pressure, velocity, air); }
};

/// What drives the flow at one moment.
template <int Dim>
struct FlowForcing {
  FlowCoefficients<Dim> coefficients;
  std::vector<FaceCondition> conditions;  ///< per face
  /// Per element: liquid that leaves it beyond what it stores, m3/s. Empty where there is none.
  std::vector<double> source;
  /// Additional storage per element, with its mean pressure, m3/Pa. Empty where there is none.
  std::vector<double> mean_storage = {};
  /// Additional mobility per element from the soil's inertia, m3 s/kg: it acts on the difference of
  /// the pressure gradient from that with `expected_rise`, per face, Pa, over the start of the
  /// step. Empty where there is none; not with quadratic drag.
  std::vector<double> mean_mobility = {};
  std::vector<double> expected_rise = {};
};

/// The nonlinear iteration of a step did not converge: a shorter one may.
class NotConverged : public NumericalError {
 public:
  using NumericalError::NumericalError;
};

template <int Dim>
struct MixedStep {
  MixedState<Dim> end;
  std::vector<double> face_volume;  ///< over the step, along each face's normal, m3
  std::vector<double> face_flux;    ///< at the end, likewise, m3/s
  /// `face_flux` without what faces with a prescribed pressure store in their share of an element:
  /// that jumps where the pressure has a kink in time, this does not.
  std::vector<double> flux_through;
};

/// `second_order` is Alexander's two-stage diagonally implicit method (SIAM J. Numer. Anal. 14
/// (1977) 1006), L-stable; `monotone` is backward Euler, which with scalar mobility and no obtuse
/// angles keeps pressures within those it starts from and those at the boundary.
template <int Dim>
class ImplicitMixed {
 public:
  ImplicitMixed(const Grid<Dim>& grid, ImplicitSettings settings, Vector<Dim> gravity,
                FlowSoils<Dim> soils = {}, std::vector<LeakyFace> walls = {});
  ImplicitMixed(const ImplicitMixed&) = delete;
  ImplicitMixed& operator=(const ImplicitMixed&) = delete;

  /// Shares of the step at which `step` asks for the forcing, ascending; the last is one.
  [[nodiscard]] std::vector<double> stages() const;

  /// One step of `dt` seconds; forcing[i] at stages()[i]. Faces keep their kind of condition from
  /// call to call (otherwise all is set up anew). At faces with a prescribed pressure the end
  /// state holds that. Water stores (water_volume / K) dp/dt with the volume of each stage. Where
  /// water does not compress and no pressure is prescribed the first face of the piece has p = 0,
  /// and prescribed inflow and sources must cancel. Throws NumericalError when they do not, when an
  /// element has no resistance, or when Newton's method for the quadratic drag does not converge;
  /// NotConverged when the iteration of retention and seepage faces does not. Where that of second
  /// order does not, under retention, the step is one of backward Euler.
  MixedStep<Dim> step(const MixedState<Dim>& start, double dt,
                      const std::vector<const FlowForcing<Dim>*>& forcing);

  [[nodiscard]] const FlowSoils<Dim>& soils() const { return soils_; }
  /// The soils have moved.
  void follow(FlowSoils<Dim> soils) { soils_ = std::move(soils); }
  /// Steady state, without inertia and storage: face_flux as rates; face_volume stays empty.
  MixedStep<Dim> steady(const FlowForcing<Dim>& forcing);
  /// Steady state with every soil saturated at any pressure: a flow as large as it can be.
  MixedStep<Dim> saturated_steady(const FlowForcing<Dim>& forcing);

  /// Air in the elements at these pressures, m3. `porosity` per element.
  [[nodiscard]] ElementField<Dim> air_at(const std::vector<double>& face_pressure,
                                         const std::vector<double>& porosity) const;
  /// k_r of each element at these pressures, per face, Pa; empty where all soil is saturated.
  [[nodiscard]] std::vector<double> relative_conductivity(
      const std::vector<double>& face_pressure) const;
  [[nodiscard]] bool has_retention() const { return !ignore_retention_ && !soils_.saturated(); }
  /// Whether steps iterate over retention or seepage faces.
  [[nodiscard]] bool is_nonlinear() const { return has_retention() || !switching_.empty(); }
  /// Number of times that the system of the last step was solved.
  [[nodiscard]] int iterations() const { return iterations_; }

  /// Counts of linear solutions in all calls so far.
  [[nodiscard]] SolveCounts counts() const;

  /// What makes the next step start where this one would. `conditions` tell the kinds of faces.
  void archive(StateArchive& archive, const std::vector<FaceCondition>& conditions);

 private:
  /// An implicit stage: from `base` over `duration` seconds (infinite: steady).
  struct Stage {
    MixedState<Dim> state;
    std::vector<double> rise;  ///< of the pressure over the base, per face, Pa
    std::vector<double> face_flux;
    std::vector<double> flux_through;
  };
  /// Pressures at face centres as a sum, base + offset + rise, so that small changes of large
  /// pressures have all their digits; offset = reference - base.
  struct FacePressure {
    std::vector<double> reference;
    std::vector<double> offset;
    std::vector<double> rise;

    /// Makes the reference what the pressure is, as nearly as it can hold it.
    void move_reference(const std::vector<double>& base);
  };
  using Field = std::vector<Vector<Dim>>;
  /// What one stage works with; kept, so that stages allocate only what they return.
  struct Work {
    std::vector<double> resistance;  ///< linear, per flux, kg/(m3 s)
    Field drive;                     ///< without pressure, Pa/m
    /// Condition of each face in this stage: that of the forcing, or for seepage faces a pressure
    /// or a flux, as they are.
    const std::vector<FaceCondition>* conditions = nullptr;
    std::vector<FaceCondition> resolved;
    std::vector<double> storage;       ///< per face of the element, m3/(s Pa)
    std::vector<double> mean_storage;  ///< per element, m3/(s Pa); may be empty
    std::vector<double> beside;        ///< mean_mobility of the forcing, per element; may be empty
    Field expected_gradient;           ///< of the pressure, where there is one, Pa/m
    std::vector<double> net_source;    ///< outflow asked for, m3/s
    std::vector<double> surplus;       ///< of inflow and sources of each sealed piece, m3/s
    std::vector<LeakyFace> walls;      ///< conductance as the stage has it
    MomentumLaw<Dim> law;
    FacePressure pressure;
    Field flux;  ///< per element, m/s
    Field push;  ///< drive minus pressure gradient, Pa/m
    // Air that gives way to liquid; empty where all soil is saturated.
    ElementField<Dim> side_storage;   ///< slope of the rate with pressure, m3/(s Pa)
    ElementField<Dim> gain;           ///< dk_r/dp at a side over k_r of the element, 1/Pa
    Eigen::VectorXd step;             ///< of Newton's method, per unknown, Pa
    ElementField<Dim> displaced;      ///< rate at the pressures of the reference, m3/s
    std::vector<int> level_elements;  ///< whose first face holds the level of a sealed piece
    // Linear system.
    Field face_push;                ///< what an element drives without the unknown rises, m/s
    std::vector<double> round_off;  ///< of it, m/s
    std::vector<double> known_rise;
    Eigen::VectorXd load;
    Eigen::VectorXd guess;
    Eigen::VectorXd tolerance;
    // Fluxes through faces.
    std::vector<double> conductance;
    std::vector<double> net_outflow;
  };

  void set_up(const std::vector<FaceCondition>& conditions);
  /// A step of backward Euler, and one of Alexander's method.
  MixedStep<Dim> one_stage(const MixedState<Dim>& start, double dt,
                           const FlowForcing<Dim>& forcing);
  MixedStep<Dim> two_stages(const MixedState<Dim>& start, double dt, const FlowForcing<Dim>& early,
                            const FlowForcing<Dim>& late);
  [[nodiscard]] Field flux_of(const Field& velocity,
                              const FlowCoefficients<Dim>& coefficients) const;
  Stage solve_stage(const MixedState<Dim>& base, double duration, const FlowForcing<Dim>& forcing,
                    const Field& flux_guess);
  /// Linear resistance, drive and storage of each element. Throws NumericalError.
  void find_resistance(const MixedState<Dim>& base, double duration,
                       const FlowForcing<Dim>& forcing);
  /// Mobility of an element with this Darcy's, m3 s/kg, and the drive that belongs to it.
  void set_mobility(int e, double of_darcy);
  /// What no pressure boundary can take up must cancel where no water is stored either.
  void balance_sealed_pieces(const FlowForcing<Dim>& forcing);
  void guess_pressure(const MixedState<Dim>& base, double duration);
  void solve_linear(const MixedState<Dim>& base, const FlowForcing<Dim>& forcing);
  /// Newton's method on flux and pressure together.
  void solve_quadratic(const MixedState<Dim>& base, const FlowForcing<Dim>& forcing,
                       const Field& flux_guess);
  void linearise_about(const Field& flux, const std::vector<double>& quadratic_drag);
  /// Flux and push of each element at the pressures found.
  void find_flux(Field& flux, Field& push) const;
  /// How an iteration of Newton's method changes the flux of the elements.
  struct FluxChange {
    double largest = 0.0;       ///< m/s
    double largest_flux = 0.0;  ///< m/s
    bool is_round_off = false;  ///< in every element
  };
  [[nodiscard]] FluxChange flux_change(const Field& new_flux, const Field& new_push) const;
  /// Shortens the step to the new flux and push until it does not raise the error of momentum.
  /// Returns the share of the step that is left; where no share helps, the step stays whole and the
  /// share is below 1e-3.
  double damp(Field& new_flux, Field& new_push, const std::vector<double>& quadratic_drag) const;
  /// Size of the momentum that is missing at a flux and its push.
  [[nodiscard]] double momentum_error(const Field& flux, const Field& push,
                                      const std::vector<double>& quadratic_drag) const;
  /// The water that a sealed piece stores takes up what enters it.
  void level_sealed_pieces(const MixedState<Dim>& base, std::vector<double>& rise) const;
  /// Whether an element stores liquid as its pressure rises.
  [[nodiscard]] bool stores(int e) const {
    return work_.storage[e] > 0.0 || (!work_.mean_storage.empty() && work_.mean_storage[e] > 0.0);
  }
  /// What an element stores with its mean pressure, m3/s, as it rises by these.
  [[nodiscard]] double stored_in_mean(int e, const auto& rise_of_face) const {
    if (work_.mean_storage.empty()) return 0.0;
    double sum = 0.0;
    for (const int f : grid_.element_face[e]) sum += rise_of_face(f);
    return work_.mean_storage[e] * sum / (Dim + 1);
  }
  /// What the share of a side stores in a stage in which its pressure rises by this, m3/s.
  [[nodiscard]] double stored(int e, int k, double rise) const;
  /// Flux out of the element through the side, m3/s.
  [[nodiscard]] double flux_out(int e, int k, double rise) const;
  void find_face_flux(const MixedState<Dim>& base, double duration, const FlowForcing<Dim>& forcing,
                      Stage& stage);

  // Walls that let liquid through: wall_flow.cpp.

  /// Conductances of the walls of this stage.
  void find_wall_conductance();
  /// What flows between the two sides of a wall at the pressures of the reference.
  void add_walls_to_load();
  /// Largest round-off of what flows through a wall at these pressures, m3/s.
  [[nodiscard]] double wall_round_off() const;
  /// Flux into a wall, m3/s, which is also what leaves the elements on its two sides.
  [[nodiscard]] double wall_flux(const LeakyFace& wall, double out_of_left,
                                 double out_of_partner) const;

  // Retention and seepage faces: nonlinear_flow.cpp.

  /// Iterates over pressures, conductivities and the set of seepage faces that let water out.
  void solve_nonlinear(const MixedState<Dim>& base, double duration,
                       const FlowForcing<Dim>& forcing);
  /// Conditions of the stage, with seepage faces as the last stage left them.
  void resolve_conditions(const FlowForcing<Dim>& forcing);
  void resolve(const FaceCondition& condition, int face);
  /// Mobility, what air gives way, and their slopes at the pressures of the reference.
  void linearise_retention(const MixedState<Dim>& base, double duration,
                           const FlowForcing<Dim>& forcing);
  /// Rate at which liquid takes the place of air in the share of a side, m3/s.
  [[nodiscard]] double displacement_rate(const MixedState<Dim>& base, double duration,
                                         const FlowForcing<Dim>& forcing, int e, int k,
                                         double pressure) const;
  /// Conductivities, contents, fluxes and what is missing of the balance at the pressures reached.
  void evaluate(const MixedState<Dim>& base, double duration, const FlowForcing<Dim>& forcing);
  /// Round-off of what gravity drives and of the contents of the elements, m3/s.
  [[nodiscard]] double balance_round_off(double duration, const FlowForcing<Dim>& forcing) const;
  /// Whether what is missing at each face is round-off of the terms that it is a sum of:
  /// conductances of the elements beside it times their pressures.
  [[nodiscard]] bool is_round_off_left(const FlowCoefficients<Dim>& c) const;
  /// Finds the step of Newton's method. Throws NotConverged.
  void solve_newton();
  /// Takes this share of it.
  void take_step(double share);
  /// Through a side of an element, m3/s.
  [[nodiscard]] double largest_flux() const;
  /// A pressure that would pass the one at which its soil's content changes fastest stops there:
  /// from there Newton's method meets a content that is convex or concave, and finds its way; from
  /// saturated or dry soil, whose content hardly changes, it would go any distance. Suction grows
  /// by a factor at most.
  void limit_change();
  /// The flux correction and its pieces are those of the faces that are held now.
  void follow_held_faces();
  /// Whether storage holds the level of the pressure in a sealed piece.
  [[nodiscard]] bool is_level_held(int piece) const;
  /// Where nothing holds the level of the pressure, its highest seepage face opens. Returns whether
  /// any did.
  bool hold_levels(const FlowForcing<Dim>& forcing);
  /// Pressures below this are zero to a seepage face: 1e-9 of the largest pressure, Pa.
  [[nodiscard]] double pressure_accuracy() const;
  /// Largest magnitude at the faces of an element.
  [[nodiscard]] double largest_at_faces(int e, const std::vector<double>& face_values) const {
    double largest = 0.0;
    for (const int f : grid_.element_face[e]) largest = std::max(largest, std::abs(face_values[f]));
    return largest;
  }
  /// Opens and closes seepage faces. Returns whether any changed.
  bool switch_faces(const FlowForcing<Dim>& forcing, double flux_tolerance,
                    double pressure_tolerance);
  /// Stores the air that the fluxes leave in each element, to the last digit.
  void settle_air(const MixedState<Dim>& base, double duration, const FlowForcing<Dim>& forcing,
                  Stage& stage) const;
  /// What flows through a side of a saturated element under gravity alone, m3/s.
  [[nodiscard]] double gravity_flux(int e, const FlowCoefficients<Dim>& c) const;
  /// The steady state of a nonlinear flow, by steps of growing length.
  Stage nonlinear_steady(const FlowForcing<Dim>& forcing);
  /// The steady state with every soil saturated.
  Stage saturated_stage(const FlowForcing<Dim>& forcing);
  /// Solves for the pressures with the law of the moment. At prescribed pressures `rise` is known.
  void solve_pressure(const FlowForcing<Dim>& forcing);
  void find_load(const FlowForcing<Dim>& forcing);

  /// Inward flux prescribed at a face, m3/s.
  [[nodiscard]] double prescribed_inflow(const FlowForcing<Dim>& forcing, int face) const;
  [[nodiscard]] const FaceCondition& condition(int face) const { return (*work_.conditions)[face]; }
  /// Whether the pressure at a face is prescribed in this stage.
  [[nodiscard]] bool is_held(int face) const { return held_[face] != 0; }
  void set_up_correction();
  [[nodiscard]] Vector<Dim> pressure_gradient(int e, const std::vector<double>& reference,
                                              const std::vector<double>& rise) const;
  /// Flux per pressure, m3/(s Pa), of the element's largest face.
  [[nodiscard]] double conductance_of(int e) const;

  const Grid<Dim>& grid_;
  ImplicitSettings settings_;
  Vector<Dim> gravity_;

  FlowSoils<Dim> soils_;
  std::vector<LeakyFace> walls_;
  bool ignore_retention_ = false;

  std::vector<FaceKind> kinds_;  ///< everything below is set up for these
  std::vector<int> switching_;   ///< faces whose kind may change
  std::vector<char> open_;       ///< per face: a seepage face that lets water out
  std::vector<char> held_;       ///< per face: its pressure is prescribed in this stage
  std::vector<char> corrected_;  ///< per face: held in the flux correction as it stands
  int iterations_ = 0;
  std::optional<NewtonSystem> newton_;
  MixedMatrix<Dim> matrix_;
  std::vector<double> face_area_;
  std::optional<LaggedPreconditioner> solver_;
  std::optional<FluxCorrection<Dim>> correction_;
  SolveCounts earlier_counts_;  ///< of solvers given up

  // Where iterations start; they change no result beyond round-off.
  std::vector<double> rise_rate_;  ///< of the last stage, per face, Pa/s
  double flux_scale_ = 0.0;        ///< largest flux through a face then, m3/s
  MixedState<Dim> last_steady_;
  Field last_steady_flux_;

  Work work_;
};

}  // namespace suffuse
