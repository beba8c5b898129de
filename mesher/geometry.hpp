#pragma once

/// The mesh that a scene asks for: the built-in column or box, or the user's own file.

#include <string>
#include <variant>
#include <vector>

#include "mesh/mesh.hpp"
#include "scene/scene.hpp"
#include "wanted_sizes.hpp"

namespace suffuse {

template <int Dim>
struct Geometry {
  Mesh<Dim> mesh;
  std::vector<std::string> notes;  ///< what the user should know, one sentence each
};

/// Processor time of Gmsh over a file, s.
inline constexpr double default_geometry_seconds = 600.0;

/// What is meshed, and how.
struct GeometryRequest {
  const SceneDocument& document;
  /// Processor time that Gmsh may take over a file, which can hold an endless loop, s.
  double max_seconds = default_geometry_seconds;
  /// Null: the sizes of the scene and of its geometry file hold. Otherwise `document` is that of
  /// `scene_with_sizes`.
  const WantedSizes* wanted = nullptr;
};

using AnyGeometry = std::variant<Geometry<2>, Geometry<3>>;

/// Builds the mesh with Gmsh and holds the scene against it. Throws InputError with every problem
/// found, FileError when the geometry file cannot be read. A file with volumes is of three
/// dimensions. Problems name nodes and elements by
/// Gmsh's numbers, those of the user's .msh, and places of a file by its own coordinates; the mesh
/// is in the order of `hilbert_order.hpp`.
///
/// A .geo or .step file is meshed here: sizes and fields in the file hold, `mesh.size` is the size
/// where the file says nothing and an upper bound elsewhere. A .geo that meshes itself and a .msh
/// are used as they are, and refused where there are wanted sizes. Lengths in a .step file are
/// converted from its own unit to metres; those in .geo and .msh files are in `geometry.scale`
/// metres.
AnyGeometry build_geometry(const GeometryRequest& request);

/// The geometry of `build_geometry` where its dimension is known.
template <int Dim>
Geometry<Dim> build_geometry_of(const SceneDocument& document) {
  return std::get<Geometry<Dim>>(build_geometry({.document = document}));
}

/// The file that `geometry.file` names, relative to the scene's folder.
std::string geometry_path(const SceneDocument& document);

}  // namespace suffuse
