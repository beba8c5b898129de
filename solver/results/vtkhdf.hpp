#pragma once

/// The VTKHDF 1.0 UnstructuredGrid layout, as VTK 9.1's vtkHDFReader and ParaView 5.11 read it:
/// https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html, "VTKHDF File Format".

#include <cstdint>
#include <string>
#include <vector>

#include "common/hdf5_io.hpp"
#include "mesh/material_points.hpp"
#include "mesh/mesh.hpp"
#include "results/writer.hpp"
#include "scene/scene.hpp"

namespace suffuse {

/// Cells of one kind on points in space.
struct VtkGrid {
  std::vector<double> points;  ///< x, y, z of every point, m
  std::vector<std::int64_t> connectivity;
  int nodes_per_cell = 1;
  std::uint8_t cell_type = 1;  ///< VTK's number: 1 vertex, 5 triangle, 10 tetrahedron
};

/// Triangles or tetrahedra.
template <int Dim>
VtkGrid vtk_grid(const Mesh<Dim>& mesh);

/// One vertex cell per material point.
template <int Dim>
VtkGrid vtk_grid(const Mesh<Dim>& mesh, const MaterialPoints<Dim>& points);

/// One vertex cell per position of `points` (x, y, z of each).
VtkGrid vtk_grid(std::vector<double> points);

/// Fields of a file, on cells and points, and their precision.
struct VtkFields {
  std::vector<Field> cell = {};
  std::vector<Field> point = {};
  FieldPrecision precision = FieldPrecision::float64;
};

/// Writes the group /VTKHDF. Vectors in the plane (2 components) get a zero third component, which
/// VTK requires; their attribute `components` stays 2.
void write_vtkhdf(Hdf5File& file, VtkGrid grid, const VtkFields& fields);

/// Writes the group /VTKHDF with links to the grid of the file `grid_file`, in the same folder, and
/// to its cell fields `linked`.
void write_vtkhdf_on(Hdf5File& file, const std::string& grid_file,
                     const std::vector<std::string>& linked, const VtkFields& fields);

/// Writes the names of the regions: for each an array `region NUMBER: NAME` in the grid's field
/// data, which holds the number. VTK reads only text of variable length, on which HDF5 crashes in
/// damaged files, so the text is in the names of the arrays. `/` ends a name in HDF5 and becomes
/// `_`.
void write_region_names(Hdf5File& file, const std::vector<std::string>& names);

/// Links to the names of the regions in the file `grid_file`, in the same folder.
void link_region_names(Hdf5File& file, const std::string& grid_file,
                       const std::vector<std::string>& names);

/// Writes `field` to GROUP/NAME with its unit and components as attributes; `shape` does not
/// include the components.
void write_field(Hdf5File& file, const std::string& group, const Field& field,
                 std::vector<std::size_t> shape, FieldPrecision precision);

/// Reads a field written by write_field or write_vtkhdf, with at least one component; removes
/// padding. Throws FileError.
Field read_field(const Hdf5File& file, const std::string& group, const std::string& name);

}  // namespace suffuse
