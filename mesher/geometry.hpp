#pragma once

/// The mesh of a scene: the built-in column or box, or the user's own file.

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

/// Largest processor time of Gmsh for a file, s.
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

/// Builds the mesh with Gmsh and compares it with the scene. Throws InputError with every problem
/// found, FileError if the geometry file cannot be read. A file with volumes has three dimensions.
/// Problems name nodes and elements by Gmsh's numbers, those of the user's .msh, and places of a
/// file by its own coordinates; the mesh is in the order of `hilbert_order.hpp`.
///
/// A .geo or .step file is meshed here: sizes and fields of the file apply, and `mesh.size` is an
/// upper bound and the size where the file gives none. A .geo that meshes itself and a .msh are
/// used unchanged, and refused where there are wanted sizes. Lengths in a .step file are
/// converted from its own unit to metres; those in .geo and .msh files are in `geometry.scale`
/// metres.
AnyGeometry build_geometry(const GeometryRequest& request);

/// `build_geometry` for a known dimension.
template <int Dim>
Geometry<Dim> build_geometry_of(const SceneDocument& document) {
  return std::get<Geometry<Dim>>(build_geometry({.document = document}));
}

/// The file that `geometry.file` names, relative to the scene's folder.
std::string geometry_path(const SceneDocument& document);

}  // namespace suffuse
