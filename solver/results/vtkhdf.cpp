#include "results/vtkhdf.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <stdexcept>

#include "common/errors.hpp"
#include "files/layout.hpp"

namespace suffuse {
namespace {

constexpr int vtk_vertex = 1;
constexpr int vtk_triangle = 5;
constexpr int vtk_tetrahedron = 10;

template <int Dim>
void append_position(std::vector<double>& points, const Vector<Dim>& x) {
  for (int d = 0; d < 3; ++d) points.push_back(d < Dim ? x[d] : 0.0);
}

/// The field's values, padded with zeros to `width` numbers per entity.
std::vector<double> padded(const Field& field, int width) {
  std::vector<double> values;
  const std::size_t entities = field.values.size() / field.components;
  values.reserve(entities * width);
  for (std::size_t i = 0; i < entities; ++i) {
    for (int k = 0; k < width; ++k) {
      values.push_back(k < field.components ? field.values[i * field.components + k] : 0.0);
    }
  }
  return values;
}

void write_values(Hdf5File& file, const std::string& group, const Field& field,
                  std::vector<std::size_t> shape, int width, FieldPrecision precision) {
  std::size_t entities = 1;
  for (const std::size_t extent : shape) entities *= extent;
  if (field.components < 1 || field.values.size() != entities * field.components) {
    throw std::logic_error("field " + field.name + " has " + std::to_string(field.values.size()) +
                           " values for " + std::to_string(entities) + " entities of " +
                           std::to_string(field.components) + " components");
  }
  if (width > 1) shape.push_back(width);
  const std::string dataset = group + "/" + field.name;
  const auto write = [&](const std::vector<double>& values) {
    if (precision == FieldPrecision::float32 && !field.is_whole) {
      const std::vector<float> rounded(values.begin(), values.end());
      file.write_compressed(dataset, std::span<const float>(rounded), shape);
    } else {
      file.write_compressed(dataset, std::span<const double>(values), shape);
    }
  };
  if (width == field.components) {
    write(field.values);
  } else {
    write(padded(field, width));
  }
  const std::int64_t components = field.components;
  file.attribute(dataset, "unit", field.unit);
  file.attribute(dataset, "components", std::span(&components, 1));
}

void write_data(Hdf5File& file, const std::string& group, const std::vector<Field>& fields,
                FieldPrecision precision) {
  file.create_group(group);
  for (const auto& field : fields) {
    const std::size_t entities = field.values.size() / std::max(1, field.components);
    write_values(file, group, field, {entities}, field.components == 2 ? 3 : field.components,
                 precision);
  }
}

constexpr const char* cell_data = "/VTKHDF/CellData";
constexpr const char* point_data = "/VTKHDF/PointData";

/// Writes the group with the attributes that VTK requires.
void write_type(Hdf5File& file) {
  constexpr std::array<std::int64_t, 2> version{1, 0};
  file.create_group("/VTKHDF");
  file.attribute("/VTKHDF", "Version", std::span<const std::int64_t>(version));
  file.attribute("/VTKHDF", "Type", std::string("UnstructuredGrid"));
}

void write_count(Hdf5File& file, const std::string& name, std::size_t count) {
  const auto value = static_cast<std::int64_t>(count);
  file.write("/VTKHDF/" + name, std::span(&value, 1), {1});
}

void write_offsets(Hdf5File& file, std::size_t cells, int nodes_per_cell) {
  std::vector<std::int64_t> offsets(cells + 1);
  for (std::size_t c = 0; c <= cells; ++c) {
    offsets[c] = static_cast<std::int64_t>(c) * nodes_per_cell;
  }
  file.write_compressed("/VTKHDF/Offsets", std::span<const std::int64_t>(offsets), {cells + 1});
}

std::string region_array(std::size_t region, std::string name) {
  std::ranges::replace(name, '/', '_');
  return std::string(layout::field_data_group) + "/region " + std::to_string(region) + ": " + name;
}

}  // namespace

template <int Dim>
VtkGrid vtk_grid(const Mesh<Dim>& mesh) {
  VtkGrid grid;
  grid.nodes_per_cell = Dim + 1;
  grid.cell_type = Dim == 2 ? vtk_triangle : vtk_tetrahedron;
  for (const auto& x : mesh.nodes) append_position<Dim>(grid.points, x);
  for (const auto& element : mesh.elements) {
    grid.connectivity.insert(grid.connectivity.end(), element.begin(), element.end());
  }
  return grid;
}

template <int Dim>
VtkGrid vtk_grid(const Mesh<Dim>& mesh, const MaterialPoints<Dim>& points) {
  std::vector<double> positions;
  for (int p = 0; p < points.size(); ++p) {
    append_position<Dim>(positions, points.position(mesh, p));
  }
  return vtk_grid(std::move(positions));
}

VtkGrid vtk_grid(std::vector<double> points) {
  VtkGrid grid;
  grid.cell_type = vtk_vertex;
  grid.connectivity.resize(points.size() / 3);
  std::iota(grid.connectivity.begin(), grid.connectivity.end(), 0);
  grid.points = std::move(points);
  return grid;
}

void write_vtkhdf(Hdf5File& file, VtkGrid grid, const VtkFields& fields) {
  write_type(file);
  const std::size_t points = grid.points.size() / 3;
  const std::size_t cells = grid.connectivity.size() / grid.nodes_per_cell;
  write_count(file, "NumberOfPoints", points);
  write_count(file, "NumberOfCells", cells);
  write_count(file, "NumberOfConnectivityIds", grid.connectivity.size());

  // Frees each array when it is written: for millions of points all would take much memory.
  file.write_compressed("/VTKHDF/Points", std::span<const double>(grid.points), {points, 3});
  file.attribute("/VTKHDF/Points", "unit", std::string("m"));
  grid.points = {};
  file.write_compressed("/VTKHDF/Connectivity", std::span<const std::int64_t>(grid.connectivity),
                        {grid.connectivity.size()});
  grid.connectivity = {};
  write_offsets(file, cells, grid.nodes_per_cell);
  const std::vector<std::uint8_t> types(cells, grid.cell_type);
  file.write_compressed("/VTKHDF/Types", std::span<const std::uint8_t>(types), {cells});

  write_data(file, cell_data, fields.cell, fields.precision);
  write_data(file, point_data, fields.point, fields.precision);
}

void write_vtkhdf_on(Hdf5File& file, const std::string& grid_file,
                     const std::vector<std::string>& linked, const VtkFields& fields) {
  write_type(file);
  for (const char* name : {"NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds", "Points",
                           "Connectivity", "Offsets", "Types"}) {
    file.link_to(std::string("/VTKHDF/") + name, grid_file);
  }
  write_data(file, cell_data, fields.cell, fields.precision);
  for (const std::string& name : linked) {
    file.link_to(std::string(cell_data) + "/" + name, grid_file);
  }
  write_data(file, point_data, fields.point, fields.precision);
}

void write_region_names(Hdf5File& file, const std::vector<std::string>& names) {
  file.create_group(layout::field_data_group);
  for (std::size_t r = 0; r < names.size(); ++r) {
    const auto number = static_cast<std::int64_t>(r);
    file.write(region_array(r, names[r]), std::span(&number, 1), {1});
  }
}

void link_region_names(Hdf5File& file, const std::string& grid_file,
                       const std::vector<std::string>& names) {
  file.create_group(layout::field_data_group);
  for (std::size_t r = 0; r < names.size(); ++r) {
    file.link_to(region_array(r, names[r]), grid_file);
  }
}

void write_field(Hdf5File& file, const std::string& group, const Field& field,
                 std::vector<std::size_t> shape, FieldPrecision precision) {
  write_values(file, group, field, std::move(shape), field.components, precision);
}

Field read_field(const Hdf5File& file, const std::string& group, const std::string& name) {
  const std::string dataset = group + "/" + name;
  Field field;
  field.name = name;
  field.unit = file.text_attribute(dataset, "unit");
  const std::int64_t components = file.integer_attribute(dataset, "components");
  const bool padded = components == 2 && (group == cell_data || group == point_data);
  const std::int64_t width = padded ? 3 : components;
  const std::vector<std::size_t> shape = file.shape(dataset);
  const bool is_flat = shape.size() == 1 && width == 1;
  const bool is_table =
      shape.size() == 2 && width > 1 && shape[1] == static_cast<std::size_t>(width);
  if (!is_flat && !is_table) {
    throw FileError(file.path() + ": " + dataset + ": its shape is not that of " +
                    std::to_string(components) + " components; it is damaged");
  }
  field.components = static_cast<int>(components);
  field.values = file.read_doubles(dataset);
  if (padded) {
    for (std::size_t i = 0; i < shape[0]; ++i) {
      field.values[2 * i] = field.values[3 * i];
      field.values[2 * i + 1] = field.values[3 * i + 1];
    }
    field.values.resize(2 * shape[0]);
  }
  return field;
}

template VtkGrid vtk_grid<2>(const Mesh<2>&);
template VtkGrid vtk_grid<3>(const Mesh<3>&);
template VtkGrid vtk_grid<2>(const Mesh<2>&, const MaterialPoints<2>&);
template VtkGrid vtk_grid<3>(const Mesh<3>&, const MaterialPoints<3>&);

}  // namespace suffuse
