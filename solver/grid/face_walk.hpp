#pragma once

/// Moves points with the liquid that crosses faces, exactly within each element (Pollock 1988, on
/// simplices), in the Raviart-Thomas field of the volumes through the faces.

#include <vector>

#include "grid/point_place.hpp"

namespace suffuse {

/// Liquid in one interval. Points move with flux / porosity; porosity is linear in time from start
/// to end. Nothing crosses a face of zero volume.
template <int Dim>
struct FaceWalkField {
  const std::vector<double>& face_volume;     ///< along each face's normal, whole interval, m3
  const std::vector<double>& porosity_start;  ///< per element
  const std::vector<double>& porosity_end;    ///< per element
  bool all_passages = false;                  ///< report passages through unchanged pores too
  /// Part of the change of porosity, per element, by exchange of solid and liquid. Null: all of it.
  /// The rest is moving solid, whose place liquid takes through faces.
  const std::vector<double>* exchanged = nullptr;
};

/// The path of a point through an element.
template <int Dim>
struct FacePassage {
  int element;
  std::array<double, Dim + 1> barycentric;  ///< in the middle between its ends
  double growth;                            ///< of the pores around the point by exchange, 1: none
  double path = 0.0;                        ///< length of the path, m; with `all_passages` only
  double clock = 0.0;                       ///< integral of ds/n, s in shares of the interval
};

/// Walks `place` through the interval's shares from `from` to `to` (0 <= from <= to <= 1). With
/// V_k the volume out of the element of measure |e| through the face opposite vertex k, and the
/// clock tau = integral of ds/n,
///
///   d lambda_k / d tau = (lambda_k sum_j V_j - V_k) / (Dim |e|)
///
/// so that each coordinate and the moment at which it vanishes have closed forms. Adds passages
/// with a change of porosity, or all if the field says so, to `passages`. Returns the outer face by
/// which the point left, with the place on that face, or -1. Throws NumericalError if the point
/// crosses faces without end; `id` is for the message.
template <int Dim>
int walk_along_faces(const Grid<Dim>& grid, const FaceWalkField<Dim>& field, PointPlace<Dim>& place,
                     double from, double to, long id, std::vector<FacePassage<Dim>>& passages);

/// Largest change of a barycentric coordinate over the interval by the volume through one face of
/// the element: about how many times a point could cross it.
template <int Dim>
double crossings(const Grid<Dim>& grid, const FaceWalkField<Dim>& field, int element);

}  // namespace suffuse
