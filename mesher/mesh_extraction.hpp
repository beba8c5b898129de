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
  /// physical volumes and surfaces; nodes that no element uses are left out. Complete only if there
  /// are no problems.
  Mesh<Dim> mesh;
  /// Physical curves (surfaces) that lie inside the mesh: what a wall or a well may name.
  std::vector<BoundarySet<Dim>> inner_curves;
  /// Physical points that are nodes of the mesh: what a well may name.
  std::vector<NamedNode> points;
  /// The faults of the mesh: `found` and `expected` only, because the caller knows its origin.
  std::vector<InputProblem> problems;
  /// End of a message for a geometry that names no curve (surface): it lists those that can get a
  /// name.
  std::optional<std::string> curves_to_name;
  /// Number of elements with negative orientation that were reoriented.
  int turned = 0;
  /// False if so much is missing that a comparison with the scene would only add messages.
  bool comparable = false;
};

enum class Quadrangles {
  refused,
  /// Cuts into four triangles that meet where the diagonals cross. The four divergences of such a
  /// quadrangle are not independent, so linear velocities have enough freedom for one pressure per
  /// triangle, unlike on general triangles.
  cut_along_diagonals,
};

/// \param model  of dimension `Dim`, without a `gmsh_model_defect`
/// \param quadrangles  of a mesh in two dimensions
template <int Dim>
ExtractedMesh<Dim> extract_mesh(const GmshModel& model,
                                Quadrangles quadrangles = Quadrangles::refused);

}  // namespace suffuse
