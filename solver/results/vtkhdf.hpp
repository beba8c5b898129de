#pragma once

/// The VTKHDF 1.0 UnstructuredGrid layout, as VTK 9.1's vtkHDFReader and ParaView 5.11 read it:
/// https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html, "VTKHDF File Format".

#include <cstdint>
#include <string>
#include <vector>

#include "case/hdf5_io.hpp"
#include "case/material_points.hpp"
#include "case/mesh.hpp"
#include "results/writer.hpp"

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

/// Writes the group /VTKHDF. Fields that are vectors in the plane (2 components) get a zero third
/// component, as VTK wants of a vector; their attribute `components` keeps what they had.
void write_vtkhdf(Hdf5File& file, VtkGrid grid, const std::vector<Field>& cell_fields,
                  const std::vector<Field>& point_fields);

/// Writes `field` to GROUP/NAME with its unit and components as attributes; `shape` ends before the
/// components.
void write_field(Hdf5File& file, const std::string& group, const Field& field,
                 std::vector<std::size_t> shape);

/// Reads what write_field or write_vtkhdf wrote, at least one component wide; padding is taken off
/// again. Throws FileError.
Field read_field(const Hdf5File& file, const std::string& group, const std::string& name);

}  // namespace suffuse
