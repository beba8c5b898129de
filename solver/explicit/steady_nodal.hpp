#pragma once

/// Steady state of the nodal scheme: drag balances pressure and gravity, no element stores.

#include "explicit/nodal_operator.hpp"

namespace suffuse {

template <int Dim>
struct NodalSteadyState {
  std::vector<double> pressure;  ///< per element, Pa
  VectorField<Dim> velocity;     ///< per node, m/s
  double imbalance = 0.0;        ///< largest net outflow of an element over the largest face flux
};

/// Solves for the pressure by a sparse Cholesky factorization, regularized by a small storage whose
/// effect a few repeated solutions remove. It is for boundaries that prescribe fluxes only, and for
/// meshes on which element pressures have modes without a gradient. Throws NumericalError if the
/// factorization fails or the drag of fast flow does not converge.
template <int Dim>
NodalSteadyState<Dim> steady_flow(const NodalOperator<Dim>& op);

}  // namespace suffuse
