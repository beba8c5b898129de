#pragma once

/// Fluidised grains of the single-point formulation: concentration as a discontinuous linear field,
/// carried by the face volumes of the flow. Conserves grains to round-off (Eq. 3 of the paper,
/// corrected, in conservative form).

#include <vector>

#include "flow/face_conditions.hpp"
#include "grid/element_field.hpp"
#include "grid/grid.hpp"

namespace suffuse {

/// Pore volume and the volume of fluidised grains in it, per element and field node, m3.
template <int Dim>
struct FinesState {
  ElementField<Dim> pore_volume;
  ElementField<Dim> fines_volume;
};

/// Two-stage strong-stability-preserving Runge-Kutta over upwind face fluxes, concentration limited
/// after each stage (Kuzmin 2010, vertex-based: means of the elements around a vertex bound the
/// value there; an element's fines are never changed, only how they lie in it).
template <int Dim>
class EulerianTransport {
 public:
  EulerianTransport(const Grid<Dim>& grid, const std::vector<FaceCondition>& conditions);

  /// Largest number of times that `face_volume` may cross in one step: a step that moves
  /// `face_volume` m3 through each face keeps concentrations within bounds while this is >= 1.
  [[nodiscard]] double steps_allowed(const FinesState<Dim>& state,
                                     const std::vector<double>& face_volume) const;

  /// Moves the state over an interval in which `face_volume` m3 of liquid crossed each face and
  /// `eroded` m3 of grains joined the liquid. Returns the volume of grains that crossed each face,
  /// m3. Throws NumericalError where the element's mean concentration leaves [0, 1).
  std::vector<double> advance(FinesState<Dim>& state, const std::vector<double>& face_volume,
                              const ElementField<Dim>& eroded) const;

  /// Brings concentrations at the vertices within the means of the elements around them and, at an
  /// inlet, the concentration that enters; an element's mean does not change. `advance` leaves its
  /// state limited and expects it so.
  void limit(FinesState<Dim>& state, const std::vector<double>& face_volume) const;

  /// Mean concentration, weighted with pore volume, of the liquid that crosses each face when it
  /// runs along `face_volume`.
  [[nodiscard]] std::vector<double> face_concentration(
      const FinesState<Dim>& state, const std::vector<double>& face_volume) const;

 private:
  using FaceValues = std::array<double, Dim>;

  [[nodiscard]] ElementField<Dim> vertex_concentration(const FinesState<Dim>& state) const;
  /// Upwind concentration at the nodes of a face.
  [[nodiscard]] FaceValues upwind(int face, double volume,
                                  const ElementField<Dim>& at_vertices) const;
  /// One Euler stage: grains that move, added to `change`, and through faces, added to `crossed`.
  void add_transport(const FinesState<Dim>& state, const std::vector<double>& face_volume,
                     ElementField<Dim>& change, std::vector<double>& crossed) const;

  const Grid<Dim>& grid_;
  const std::vector<FaceCondition>& conditions_;
  /// Position of each face node among the vertices of the left and the right element.
  std::vector<std::array<int, Dim>> left_local_;
  std::vector<std::array<int, Dim>> right_local_;
};

}  // namespace suffuse
