#pragma once

/// The case file, which suffuse-mesher writes and suffuse-solver reads. One HDF5 file; see
/// docs/reference/file-formats.md.

#include <string>

#include "mesh/material_points.hpp"
#include "mesh/mesh.hpp"
#include "scene/scene.hpp"

namespace suffuse {

template <int Dim>
struct Case {
  SceneDocument document;
  Mesh<Dim> mesh;
  MaterialPoints<Dim> solid_points;
  MaterialPoints<Dim> liquid_points{};  ///< double-point only; volumes are those of liquid
};

/// Writes to a temporary file next to `path` and renames it. Liquid points are written for
/// double-point scenes only. Throws FileError.
template <int Dim>
void write_case(const std::string& path, const Case<Dim>& c);

/// Throws FileError when the file is missing, is not a case file, is of another schema version or
/// another dimension, or is inconsistent (sizes, indices out of range, values not finite).
template <int Dim>
Case<Dim> read_case(const std::string& path);

/// 2 or 3. Throws FileError.
int read_case_dimension(const std::string& path);

}  // namespace suffuse
