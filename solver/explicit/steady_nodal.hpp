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

/// Solves for the pressure by a sparse Cholesky factorisation, regularised by a storage so small
/// that a few repeated solves remove its trace; boundaries that prescribe fluxes alone need it, and
/// so do meshes on which element pressures have modes without a gradient. Throws NumericalError
/// when the factorisation fails.
template <int Dim>
NodalSteadyState<Dim> steady_flow(const NodalOperator<Dim>& op);

}  // namespace suffuse
