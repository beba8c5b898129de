#pragma once

/// Flow by mixed finite elements and implicit steps of any length. Unknowns are the pressures at
/// face centers (Crouzeix and Raviart); each element has one mean Darcy flux, which is eliminated;
/// the fluxes through faces are those of Raviart and Thomas (Marini, SIAM J. Numer. Anal. 22 (1985)
/// 493). With the porosity n, intrinsic velocity v, q = n v and momentum divided by n:
///
///   rho_L dv/dt = -grad p + rho_L g - (drag / n) q - b |q| q
///   (water_volume / volume / K) dp/dt + dn(S - 1)/dt + div q = source
///
/// Where a soil has a retention law, liquid displaces air, n (1 - S) per volume, and k_r / k is
/// part of the mobility. Storage is lumped at the faces, with S at their pressures (Younes, Ackerer
/// and Lehmann, Int. J. Numer. Methods Eng. 66 (2006) 1069).

#include <memory>
#include <vector>

#include "linear/lagged_preconditioner.hpp"
#include "mixed/mixed_model.hpp"
#include "results/state_archive.hpp"

namespace suffuse {

template <int Dim>
struct StageEnd;

/// `second_order` is Alexander's two-stage diagonally implicit method (SIAM J. Numer. Anal. 14
/// (1977) 1006), L-stable. `monotone` is backward Euler: with scalar mobility and no obtuse angles
/// it keeps pressures within the range of the initial and boundary pressures.
template <int Dim>
class ImplicitMixed {
 public:
  ImplicitMixed(const Grid<Dim>& grid, ImplicitSettings settings, Vector<Dim> gravity,
                FlowSoils<Dim> soils = {}, std::vector<LeakyFace> walls = {});
  ~ImplicitMixed();
  ImplicitMixed(const ImplicitMixed&) = delete;
  ImplicitMixed& operator=(const ImplicitMixed&) = delete;

  /// Shares of the step at which `step` needs the forcing, ascending; the last is one.
  [[nodiscard]] std::vector<double> stages() const;

  /// One step of `dt` seconds; forcing[i] at stages()[i]. The kind of a face's condition should not
  /// change between calls; if it does, all is set up anew. The end state has the prescribed
  /// pressures. Water stores (water_volume / K) dp/dt with the volume of each stage. If water does
  /// not compress and no pressure is prescribed, the first face of the piece has p = 0, and
  /// prescribed inflow and sources must cancel. Throws NumericalError when they do not, when an
  /// element has no resistance, or when Newton's method for the quadratic drag does not converge;
  /// NotConverged when the iteration of retention and seepage faces does not. A step of second
  /// order that does not converge under retention is replaced by backward Euler.
  MixedStep<Dim> step(const MixedState<Dim>& start, double dt,
                      const std::vector<const FlowForcing<Dim>*>& forcing);

  [[nodiscard]] const FlowSoils<Dim>& soils() const { return model_.soils; }
  [[nodiscard]] const std::vector<LeakyFace>& walls() const { return model_.walls; }
  /// Takes the soils after they have moved.
  void follow(FlowSoils<Dim> soils) { model_.soils = std::move(soils); }
  /// Steady state, without inertia and storage: face_flux as rates; face_volume stays empty.
  MixedStep<Dim> steady(const FlowForcing<Dim>& forcing);
  /// Steady state with every soil saturated at any pressure: the largest possible flow.
  MixedStep<Dim> saturated_steady(const FlowForcing<Dim>& forcing);

  /// Air in the elements at these pressures, m3. `porosity` per element.
  [[nodiscard]] ElementField<Dim> air_at(const std::vector<double>& face_pressure,
                                         const std::vector<double>& porosity) const;
  /// k_r of each element, mean of its faces, at pressures in Pa; empty if all soil is saturated.
  [[nodiscard]] std::vector<double> relative_conductivity(
      const std::vector<double>& face_pressure) const;
  [[nodiscard]] bool has_retention() const { return model_.has_retention(); }
  /// Whether steps iterate over retention or seepage faces.
  [[nodiscard]] bool is_nonlinear() const;
  /// Number of times that the system of the last step was solved.
  [[nodiscard]] int iterations() const { return iterations_; }

  /// Counts of linear solutions in all calls so far.
  [[nodiscard]] SolveCounts counts() const;

  /// State that the next step depends on. `conditions` tell the kinds of faces.
  void archive(StateArchive& archive, const std::vector<FaceCondition>& conditions);

 private:
  struct Parts;

  void set_up(const std::vector<FaceCondition>& conditions);
  /// A stage from `base` over `duration` seconds, which are infinite for a steady state.
  /// \param flux_guess  per element; read where drag is quadratic
  StageEnd<Dim> solve_stage(const MixedState<Dim>& base, double duration,
                            const FlowForcing<Dim>& forcing, const VectorField<Dim>& flux_guess,
                            bool saturated = false);
  /// A step of backward Euler.
  MixedStep<Dim> one_stage(const MixedState<Dim>& start, double dt,
                           const FlowForcing<Dim>& forcing);
  MixedStep<Dim> two_stages(const MixedState<Dim>& start, double dt, const FlowForcing<Dim>& early,
                            const FlowForcing<Dim>& late);
  /// The steady state where soil has a retention law, by steps of growing length.
  StageEnd<Dim> draining_steady(const FlowForcing<Dim>& forcing);

  MixedModel<Dim> model_;
  std::unique_ptr<Parts> parts_;  ///< solves stages; made anew when kinds of faces change
  SolveCounts earlier_counts_;    ///< of earlier `parts_`
  int iterations_ = 0;            ///< of the last stage
  // Initial guess of steady states.
  MixedState<Dim> last_steady_;
  VectorField<Dim> last_steady_flux_;
};

}  // namespace suffuse
