#pragma once

/// Tells whether the nodal scheme can follow the flow of a scene on its mesh.

#include <optional>

#include "flow/nodal_operator.hpp"

namespace suffuse {

/// One pressure per element leaves linear velocities so few freedoms on general triangles that
/// flows that turn are held back, on regular meshes altogether ("volumetric locking"). Returns the
/// relative L2 difference of the steady Darcy flux `velocity` (intrinsic, per node) from that of
/// mixed finite elements: it falls with the mesh where the scheme follows, and stays near one where
/// it locks. Nothing when the steady flow is rest.
template <int Dim>
std::optional<double> deviation_from_mixed_flow(const NodalOperator<Dim>& op,
                                                const FlowCoefficients<Dim>& coefficients,
                                                const Vector<Dim>& gravity,
                                                const VectorField<Dim>& velocity);

/// Above this a run should not pass without a word. Crossed meshes of four cells across stay below
/// it.
inline constexpr double locked_deviation = 0.5;

}  // namespace suffuse
