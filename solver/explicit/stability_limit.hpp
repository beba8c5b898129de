#pragma once

/// The longest stable step of the explicit nodal scheme, in soil that does not move.

#include <array>

#include "explicit/nodal_operator.hpp"
#include "grid/grid.hpp"
#include "mixed/flow.hpp"
#include "scene/scene.hpp"

namespace suffuse {

/// Largest stable step of one oscillator omega (1/s) damped by a = drag / mass (1/s), s.
double stable_step(double omega, double damping, DragIntegration drag);

/// The limit of the whole grid and the element that sets it.
struct StabilityLimit {
  double step = unset;  ///< s
  int element = -1;
};

/// The scheme is stable while 4 M - 2 dt C - dt^2 A (explicit drag) or 4 M + 2 dt C - dt^2 A
/// (implicit drag) is positive definite, where M, C and A are the matrices of mass, drag and
/// compression. Each is a sum over elements, so the smallest limit of one element is safe for the
/// grid. For one element A has the single eigenvalue omega_e^2 = (Dim + 1) (K / rho_L) sum n_i
/// |grad N_i|^2 / n_w,e. The drag of fast flow is taken at `node_speed`, m/s; empty: it is left
/// out.
template <int Dim>
StabilityLimit stability_limit(const Grid<Dim>& grid, const FlowCoefficients<Dim>& coefficients,
                               const std::vector<double>& carried_porosity, double bulk_modulus,
                               double mass_scaling, DragIntegration drag,
                               const std::vector<double>& node_speed = {});

/// Double-point columns have jumps from free water to soil, for which the bound by elements is too
/// low.
inline bool uses_assembled_limit(const Scene& scene) {
  return scene.formulation == Formulation::double_point;
}

/// Share of the assembled limit that is used; the rest allows for changes after which the limit is
/// not found again.
inline constexpr double sure_of_assembled = 1.0 - 1e-3;

/// The limit of the assembled scheme: its highest frequency by Lanczos' method plus the estimated
/// error, and the worst drag of any node. It is higher than the limit by elements where porosity
/// jumps or a few elements are small, and costs some hundred steps. `op` has taken `coefficients`.
///
/// If points carry the flow (`integration`), nodes keep only a share theta of their last change of
/// velocity, the part that the points around them return: the eigenvalue of lumped^-1 consistent
/// mass, for a mode of frequency omega. A step is then p'' - (2 - a) p' + (1 - (1 - theta) a) p = 0
/// with a = (omega dt)^2, stable for a <= 4 / (2 - theta). On linear triangles theta is at least
/// 1/4 (A. J. Wathen, IMA J. Numer. Anal. 7 (1987) 449) if points sample the mass well: omega is
/// multiplied by sqrt(7/4).
template <int Dim>
double assembled_limit(const NodalOperator<Dim>& op, const FlowCoefficients<Dim>& coefficients,
                       double bulk_modulus, double mass_scaling, DragIntegration drag,
                       const std::vector<double>& node_speed = {},
                       PressureIntegration integration = PressureIntegration::mixed);

}  // namespace suffuse
