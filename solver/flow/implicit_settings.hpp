#pragma once

/// Settings of the parts of the implicit flow, from the scene and its plan.

#include <vector>

#include "boundary/face_conditions.hpp"
#include "flow/coefficient_blending.hpp"
#include "flow/flow_solver.hpp"
#include "flow/step_control.hpp"
#include "mixed/implicit_mixed.hpp"

namespace suffuse {

/// Whether any face of the model has a condition of this kind.
template <int Dim>
bool has_condition(const Grid<Dim>& grid, const std::vector<FaceCondition>& conditions,
                   FaceKind kind);

/// Whether the coefficients of the flow depend on pores that erosion opens, apart from gravity and
/// prescribed velocities.
bool depends_on_pores(const Scene& scene, const FlowOptions& options);

ImplicitSettings scheme_settings(const Scene& scene, const FlowOptions& options);

/// \param kinks  times of possible kinks of boundary values, s
StepSettings step_settings(const Scene& scene, const FlowOptions& options, bool follows_pores,
                           const std::vector<FaceCondition>& conditions,
                           const std::vector<double>& kinks);

BlendingSettings blending_settings(const Scene& scene, const FlowOptions& options,
                                   bool follows_pores);

}  // namespace suffuse
