#pragma once

/// Measures whether the nodal (explicit) scheme can follow the flow of a scene on its mesh.

#include <optional>

#include "explicit/nodal_operator.hpp"

namespace suffuse {

/// If each element has one pressure, linear velocities have so few degrees of freedom on general
/// triangles that curved flows are hindered, on regular meshes altogether ("volumetric locking").
/// Returns the relative L2 difference of the steady Darcy flux `velocity` (intrinsic, per node)
/// from that of mixed finite elements: it falls with the mesh where the scheme follows, and stays
/// near one where it locks. Nothing if the steady flow is rest, or if there is none.
template <int Dim>
std::optional<double> deviation_from_mixed_flow(const NodalOperator<Dim>& op,
                                                const FlowCoefficients<Dim>& coefficients,
                                                const VectorField<Dim>& velocity);

/// The run warns above this value: the mesh locks the flow or is far too coarse for it. Under a
/// weir in a bed ten elements deep it is 0.48 on free and 0.18 on crossed meshes.
inline constexpr double locked_deviation = 0.3;

}  // namespace suffuse
