#pragma once

/// Pressures and fluxes of the mixed elements at one time, and what transport and results derive
/// from them.

#include <vector>

#include "grid/grid.hpp"
#include "mixed/flow.hpp"
#include "mixed/implicit_mixed.hpp"

namespace suffuse {

/// The flow at one moment.
template <int Dim>
struct MixedFlow {
  MixedState<Dim> state;
  std::vector<double> face_flux;     ///< along each face's normal, m3/s
  std::vector<double> flux_through;  ///< see MixedStep: errors and scales are based on it

  void archive(auto& archive) { archive(state, on_faces(face_flux), on_faces(flux_through)); }
};

/// The flow at the end of a step.
template <int Dim>
MixedFlow<Dim> end_of(MixedStep<Dim> step) {
  return {std::move(step.end), std::move(step.face_flux), std::move(step.flux_through)};
}

/// Water at rest: `pressure` per face, Pa, or the prescribed one where there is one.
template <int Dim>
MixedFlow<Dim> flow_at_rest(const Grid<Dim>& grid, const std::vector<FaceCondition>& conditions,
                            const std::vector<double>& pressure) {
  MixedFlow<Dim> flow;
  flow.state.face_pressure = pressure;
  flow.state.velocity.assign(grid.mesh.element_count(), Vector<Dim>::Zero());
  flow.face_flux.assign(grid.face_count(), 0.0);
  flow.flux_through = flow.face_flux;
  for (int f = 0; f < grid.face_count(); ++f) {
    if (conditions[f].kind == FaceKind::pressure) {
      flow.state.face_pressure[f] = conditions[f].value;
    }
  }
  return flow;
}

/// Mean of the pressures at the faces of each element, Pa.
template <int Dim>
std::vector<double> element_pressure(const Grid<Dim>& grid,
                                     const std::vector<double>& face_pressure, int threads);

/// What crossed the faces in a step that started with the pressures `start_face` and, per element,
/// `start_element`, Pa; `bulk_modulus` in Pa, may be infinite. Liquid that crosses a face has the
/// density at the pressure of the element it comes from, mean over the step; liquid from outside,
/// that at the pressure of the face.
template <int Dim>
FaceVolumes face_volumes(const Grid<Dim>& grid, const std::vector<double>& start_face,
                         const std::vector<double>& start_element, const MixedStep<Dim>& step,
                         double bulk_modulus, int threads);

/// Pressure and velocity at the nodes.
template <int Dim>
struct NodalFields {
  std::vector<double> pressure;  ///< Pa
  VectorField<Dim> velocity;     ///< intrinsic, m/s
};

/// The value at a node is the mean of the elements' linear fields there, weighted with their
/// volumes. A linear field at a vertex may exceed the range of its face pressures, so the mean is
/// limited to the range of the pressures at the faces and in the elements around the node.
/// Pressures are compared after subtraction of the weight of water, `weight` = rho g in Pa/m, up to
/// the node: water at rest has equal ones. `porosity` per element.
template <int Dim>
NodalFields<Dim> nodal_fields(const Grid<Dim>& grid, const MixedFlow<Dim>& flow,
                              const std::vector<double>& element_pressure,
                              const std::vector<double>& porosity, const Vector<Dim>& weight);

}  // namespace suffuse
