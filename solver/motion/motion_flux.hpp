#pragma once

/// Volume of soil with its pores that crosses the faces of the mesh as the soil moves.

#include <vector>

#include "equilibrium/step_equilibrium.hpp"

namespace suffuse {

/// Volume that each face sweeps along its normal as its nodes move in straight lines, m3: the mean
/// displacement times the mean normal on the way. The sum over an element is exactly its growth,
/// even if it rotates. 0 at faces without soil on either side.
template <int Dim>
std::vector<double> swept_volumes(const Grid<Dim>& grid, const PointsByElement& sorted,
                                  const NodeVectors<Dim>& displacement);

/// Linear displacements with a pressure per element lock, and pressures oscillate, if the liquid
/// cannot leave. So each face between two elements with soil may bulge along its normal, by a
/// bubble d that is zero at its edges and in equilibrium with the change of total stress over the
/// step on both sides and its own elastic stiffness a,
///
///     d = -(m/a) n.[d sigma' - dp I].n,    m = 2|f|/3 (2D), 9|f|/20 (3D),
///
/// The bubble carries the volume m d through the face (docs/theory/moving-soil.md, "Motion of the
/// soil"). Faces of rigid soil have none.
template <int Dim>
class FaceBubbles {
 public:
  /// Keeps references.
  /// \param inertia  mass per element over the square of the step's length, N/m: adds to the
  ///                 stiffness a and slows the bubble. Empty: no inertia.
  FaceBubbles(const Grid<Dim>& grid, const StepEquilibrium<Dim>& step,
              const std::vector<double>& inertia = {});

  /// Adds the volumes of the bubbles, m3, to those through faces.
  /// \param pressure_change  of each element over the step, Pa
  void add(const std::vector<double>& pressure_change, std::vector<double>& face_volume) const;

 private:
  const Grid<Dim>& grid_;
  const StepEquilibrium<Dim>& step_;
  std::vector<double> softness_;  ///< m^2/a per face, m3/Pa
};

}  // namespace suffuse
