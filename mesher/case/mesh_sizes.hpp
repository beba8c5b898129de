#pragma once

/// The file of sizes: what an error estimate of suffuse-solver asks of the next mesh. One HDF5
/// file; see docs/reference/file-formats.md.

#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace suffuse {

/// Wanted sizes of elements at the nodes of a mesh, linear in its elements. An element of size h
/// has the edges of a regular triangle or tetrahedron of edge length h; of a crossed mesh, its
/// area.
template <int Dim>
struct MeshSizes {
  Mesh<Dim> mesh;            ///< without boundaries
  std::vector<double> size;  ///< per node, m
};

/// Writes to a temporary file next to `path` and renames it. `mesh` may have boundaries; they are
/// not written. Throws FileError.
/// \param size  per node, m
template <int Dim>
void write_mesh_sizes(const std::string& path, const Mesh<Dim>& mesh,
                      const std::vector<double>& size);

/// Throws FileError when the file is missing, is not a file of sizes, is of another schema version
/// or another dimension, or is inconsistent (indices out of range, sizes that are not finite and
/// positive).
template <int Dim>
MeshSizes<Dim> read_mesh_sizes(const std::string& path);

/// 2 or 3. Throws FileError.
int read_mesh_sizes_dimension(const std::string& path);

}  // namespace suffuse
