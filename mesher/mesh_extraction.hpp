#pragma once

/// Makes a mesh from that of a Gmsh model.

#include <optional>
#include <string>
#include <vector>

#include "common/errors.hpp"
#include "gmsh_model.hpp"
#include "mesh/mesh.hpp"

namespace suffuse {

/// A physical point at a node of the mesh.
struct NamedNode {
  std::string name;
  int node = -1;
};

template <int Dim>
struct ExtractedMesh {
  /// Physical surfaces are its regions, physical curves its boundaries, in three dimensions
  /// physical volumes and surfaces; nodes that no element uses are left out. Complete only when
  /// there are no problems.
  Mesh<Dim> mesh;
  /// Physical curves (surfaces) that lie inside the mesh: what a wall or a well may name.
  std::vector<BoundarySet<Dim>> inner_curves;
  /// Physical points that are nodes of the mesh: what a well may name.
  std::vector<NamedNode> points;
  /// The faults of the mesh: `found` and `expected` only, as the caller knows where it came from.
  std::vector<InputProblem> problems;
  /// End of a message for a geometry that names no curve (surface): it lists those that can get a
  /// name.
  std::optional<std::string> curves_to_name;
  /// Clockwise triangles, or tetrahedra inside out, that were turned round.
  int turned = 0;
  /// False when so much is missing that a comparison with the scene would only add more messages.
  bool comparable = false;
};

enum class Quadrangles {
  refused,
  /// Into four triangles that meet where the diagonals cross. Linear velocities can then follow any
  /// flow with one pressure per triangle: the four divergences of a quadrangle cut this way are not
  /// independent, where on general triangles they leave velocities too few freedoms.
  cut_along_diagonals,
};

/// \param model  of dimension `Dim`, without a `gmsh_model_defect`
/// \param quadrangles  of a mesh in two dimensions
template <int Dim>
ExtractedMesh<Dim> extract_mesh(const GmshModel& model,
                                Quadrangles quadrangles = Quadrangles::refused);

}  // namespace suffuse
