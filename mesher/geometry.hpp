#pragma once

/// The mesh of a scene: the built-in column or box, or the user's own file.

#include <string>
#include <variant>
#include <vector>

#include "mesh/mesh.hpp"
#include "scene/scene.hpp"

namespace suffuse {

template <int Dim>
struct Geometry {
  Mesh<Dim> mesh;
  std::vector<std::string> notes;  ///< what the user should know, one sentence each
};

/// Largest processor time of Gmsh for a file, s.
inline constexpr double default_geometry_seconds = 600.0;

using AnyGeometry = std::variant<Geometry<2>, Geometry<3>>;

/// Builds the mesh with Gmsh and compares it with the scene. Throws InputError with every problem
/// found, FileError if the geometry file cannot be read. A file with volumes has three dimensions.
/// Problems name nodes and elements by Gmsh's numbers, those of the user's .msh, and places of a
/// file by its own coordinates; the mesh is in the order of `hilbert_order.hpp`.
///
/// A .geo or .step file is meshed here: sizes and fields of the file apply, and `mesh.size` is an
/// upper bound and the size where the file gives none. A .geo that meshes itself and a .msh are
/// used unchanged. Lengths in a .step file are converted from its own unit to metres; those in .geo
/// and .msh files are in `geometry.scale` metres.
/// \param max_seconds  of processor time that Gmsh may take for a file, which can contain an
///   endless loop
AnyGeometry build_geometry(const SceneDocument& document,
                           double max_seconds = default_geometry_seconds);

/// `build_geometry` for a known dimension.
template <int Dim>
Geometry<Dim> build_geometry_of(const SceneDocument& document) {
  return std::get<Geometry<Dim>>(build_geometry(document));
}

/// The file that `geometry.file` names, relative to the scene's folder.
std::string geometry_path(const SceneDocument& document);

}  // namespace suffuse
