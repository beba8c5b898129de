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

/// What the fields of a file belong to, and how they are stored.
struct VtkFields {
  std::vector<Field> cell = {};
  std::vector<Field> point = {};
  FieldPrecision precision = FieldPrecision::float64;
};

/// Writes the group /VTKHDF. Fields that are vectors in the plane (2 components) get a zero third
/// component, as VTK wants of a vector; their attribute `components` keeps what they had.
void write_vtkhdf(Hdf5File& file, VtkGrid grid, const VtkFields& fields);

/// Writes the group /VTKHDF with links to the grid of the file `grid_file`, in the same folder, and
/// to its fields of cells, which are `linked`.
void write_vtkhdf_on(Hdf5File& file, const std::string& grid_file,
                     const std::vector<std::string>& linked, const VtkFields& fields);

/// Names the numbers of the field `region`: for each region an array of the grid's field data with
/// its number, called `region NUMBER: NAME`. VTK reads text of variable length alone, of which a
/// damaged file makes HDF5 crash, so the text is in the names; `/` ends one in HDF5 and becomes
/// `_`.
void write_region_names(Hdf5File& file, const std::vector<std::string>& names);

/// Links to the names of the regions in the file `grid_file`, in the same folder.
void link_region_names(Hdf5File& file, const std::string& grid_file,
                       const std::vector<std::string>& names);

/// Writes `field` to GROUP/NAME with its unit and components as attributes; `shape` ends before the
/// components.
void write_field(Hdf5File& file, const std::string& group, const Field& field,
                 std::vector<std::size_t> shape, FieldPrecision precision);

/// Reads what write_field or write_vtkhdf wrote, at least one component wide; padding is taken off
/// again. Throws FileError.
Field read_field(const Hdf5File& file, const std::string& group, const std::string& name);

}  // namespace suffuse
