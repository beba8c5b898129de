#pragma once

/// Flow by mixed finite elements and implicit steps of any length. Unknowns are the pressures at
/// face centres (Crouzeix and Raviart); each element has one mean Darcy flux, which is eliminated;
/// the fluxes through faces are those of Raviart and Thomas (Marini, SIAM J. Numer. Anal. 22 (1985)
/// 493). With the porosity n, intrinsic velocity v, q = n v and momentum divided by n:
///
///   rho_L dv/dt = -grad p + rho_L g - (drag / n) q - b |q| q
///   (water_volume / volume / K) dp/dt + div q = source

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include "case/scene.hpp"
#include "flow/face_conditions.hpp"
#include "flow/flow.hpp"
#include "flow/flux_correction.hpp"
#include "flow/mixed_matrix.hpp"
#include "grid/grid.hpp"
#include "linear/lagged_preconditioner.hpp"

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

  void archive(auto& archive) { archive(face_pressure, velocity); }
};

/// What drives the flow at one moment.
template <int Dim>
struct FlowForcing {
  FlowCoefficients<Dim> coefficients;
  std::vector<FaceCondition> conditions;  ///< per face
  /// Per element: liquid that leaves it beyond what it stores, m3/s. Empty where there is none.
  std::vector<double> source;
};

template <int Dim>
struct MixedStep {
  MixedState<Dim> end;
  std::vector<double> face_volume;  ///< over the step, along each face's normal, m3
  std::vector<double> face_flux;    ///< at the end, likewise, m3/s
  /// The same without what faces with a prescribed pressure store of it in their share of an
  /// element: that jumps where the pressure has a kink in time, this does not.
  std::vector<double> flux_through;
};

/// `second_order` is Alexander's two-stage diagonally implicit method (SIAM J. Numer. Anal. 14
/// (1977) 1006), L-stable; `monotone` is backward Euler, which with scalar mobility and no obtuse
/// angles keeps pressures within those it starts from and those at the boundary.
template <int Dim>
class ImplicitMixed {
 public:
  ImplicitMixed(const Grid<Dim>& grid, ImplicitSettings settings, Vector<Dim> gravity);
  ImplicitMixed(const ImplicitMixed&) = delete;
  ImplicitMixed& operator=(const ImplicitMixed&) = delete;

  /// Shares of the step at which `step` asks for the forcing, ascending; the last is one.
  [[nodiscard]] std::vector<double> stages() const;

  /// One step of `dt` seconds; forcing[i] at stages()[i]. Faces keep their kind of condition from
  /// call to call (else everything is set up anew). At faces with a prescribed pressure the end
  /// state holds that. Water stores (water_volume / K) dp/dt with the volume of each stage. Where
  /// water does not compress and no pressure is prescribed the first face of the piece has p = 0,
  /// and prescribed inflow and sources must cancel. Throws NumericalError when they do not, when an
  /// element has no resistance, or when Newton's method for the quadratic drag does not converge.
  MixedStep<Dim> step(const MixedState<Dim>& start, double dt,
                      const std::vector<const FlowForcing<Dim>*>& forcing);

  /// Steady state, without inertia and storage: face_flux as rates; face_volume stays empty.
  MixedStep<Dim> steady(const FlowForcing<Dim>& forcing);

  /// Of all calls so far.
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
    std::vector<double> storage;     ///< per face of the element, m3/(s Pa)
    std::vector<double> net_source;  ///< outflow asked for, m3/s
    std::vector<double> surplus;     ///< of inflow and sources of each sealed piece, m3/s
    MomentumLaw<Dim> law;
    FacePressure pressure;
    Field flux;  ///< per element, m/s
    Field push;  ///< drive minus pressure gradient, Pa/m
    // Of the linear system.
    Field face_push;                ///< what an element drives without the unknown rises, m/s
    std::vector<double> round_off;  ///< of it, m/s
    std::vector<double> known_rise;
    Eigen::VectorXd load;
    Eigen::VectorXd guess;
    Eigen::VectorXd tolerance;
    // Of the fluxes through faces.
    std::vector<double> conductance;
    std::vector<double> net_outflow;
  };

  void set_up(const std::vector<FaceCondition>& conditions);
  Stage solve_stage(const MixedState<Dim>& base, double duration, const FlowForcing<Dim>& forcing,
                    const Field& flux_guess);
  /// Linear resistance, drive and storage of each element. Throws NumericalError.
  void find_resistance(const MixedState<Dim>& base, double duration,
                       const FlowForcing<Dim>& forcing);
  /// What no pressure boundary can take up must cancel where no water is stored either.
  void balance_sealed_pieces(const FlowForcing<Dim>& forcing);
  void guess_pressure(const MixedState<Dim>& base, double duration,
                      const FlowForcing<Dim>& forcing);
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
  void find_face_flux(const FlowForcing<Dim>& forcing, Stage& stage);
  /// Solves for the pressures with the law of the moment. At prescribed pressures `rise` is known.
  void solve_pressure(const FlowForcing<Dim>& forcing);
  void find_load(const FlowForcing<Dim>& forcing);

  /// Inward flux prescribed at a face, m3/s.
  [[nodiscard]] double prescribed_inflow(const FlowForcing<Dim>& forcing, int face) const;
  [[nodiscard]] Vector<Dim> pressure_gradient(int e, const std::vector<double>& reference,
                                              const std::vector<double>& rise) const;
  /// Flux per pressure, m3/(s Pa), of the element's largest face.
  [[nodiscard]] double conductance_of(int e) const;

  const Grid<Dim>& grid_;
  ImplicitSettings settings_;
  Vector<Dim> gravity_;

  std::vector<FaceKind> kinds_;  ///< everything below is set up for these
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
