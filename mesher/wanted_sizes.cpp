#include "wanted_sizes.hpp"

#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "common/errors.hpp"
#include "mesh/place_text.hpp"
#include "mesh_limits.hpp"
#include "mesh_problems.hpp"
#include "scene/geometry_checks.hpp"
#include "scene/scene_schema.hpp"
#include "size_field.hpp"

namespace suffuse {

namespace {

/// Number of regular elements of these sizes: integral of 1/h^d over the volume of one of size 1,
/// by a rule that is exact for polynomials of degree 2.
template <int Dim>
double element_count(const MeshSizes<Dim>& sizes) {
  const double per_volume = Dim == 2 ? 4.0 / std::sqrt(3.0) : 6.0 * std::sqrt(2.0);
  constexpr double corner_weight = 1.0 / ((Dim + 1) * (Dim + 2));
  const auto density = [&](double size) { return per_volume / std::pow(size, Dim); };
  double count = 0.0;
  for (int e = 0; e < sizes.mesh.element_count(); ++e) {
    double mean = 0.0;
    double corners = 0.0;
    for (const int node : sizes.mesh.elements[e]) {
      mean += sizes.size[node] / (Dim + 1);
      corners += density(sizes.size[node]);
    }
    count += element_volume(sizes.mesh, e) *
             (corner_weight * corners + (1.0 - (Dim + 1) * corner_weight) * density(mean));
  }
  return count;
}

[[noreturn]] void refuse_sizes(const WantedSizes& wanted, const std::string& found,
                               const std::string& expected) {
  throw InputError(InputProblem{wanted.path, "", found, expected, ""});
}

std::string dimension_text(int dimension) {
  return dimension == 2 ? "two dimensions" : "three dimensions";
}

template <int Dim>
std::string box_text(const Vector<Dim>& low, const Vector<Dim>& high) {
  // Boxes of curved models have margins of some 1e-7.
  const auto without_margin = [&](const Vector<Dim>& x) -> Vector<Dim> {
    return (x.array().abs() < 1e-6 * (high - low).norm()).select(0.0, x);
  };
  return place_text<Dim>(without_margin(low)) + " to " + place_text<Dim>(without_margin(high));
}

template <int Dim>
double longest_edge(const Mesh<Dim>& mesh) {
  double longest = 0.0;
  for (const auto& corners : mesh.elements) {
    for (const int a : corners) {
      for (const int b : corners)
        longest = std::max(longest, (mesh.nodes[a] - mesh.nodes[b]).norm());
    }
  }
  return longest;
}

template <int Dim>
void refuse_other_box(const WantedSizes& wanted, const Mesh<Dim>& mesh, const ModelBox& box) {
  constexpr double tolerance = 1e-6;
  Vector<Dim> low = mesh.nodes.front();
  Vector<Dim> high = low;
  for (const Vector<Dim>& x : mesh.nodes) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  const Vector<Dim> model_low = Eigen::Map<const Vector<Dim>>(box.low.data());
  const Vector<Dim> model_high = Eigen::Map<const Vector<Dim>>(box.high.data());
  double allowed = tolerance * (model_high - model_low).norm();
  if (box.curved) allowed = std::max(allowed, longest_edge(mesh));
  const double difference =
      std::max((low - model_low).cwiseAbs().maxCoeff(), (high - model_high).cwiseAbs().maxCoeff());
  if (difference <= allowed) return;
  refuse_sizes(wanted, "sizes of a mesh from " + box_text<Dim>(low, high),
               "those of a mesh of this scene, from " + box_text<Dim>(model_low, model_high));
}

}  // namespace

WantedSizes read_wanted_sizes(const std::string& path) {
  if (read_mesh_sizes_dimension(path) == 2) return {path, read_mesh_sizes<2>(path)};
  return {path, read_mesh_sizes<3>(path)};
}

SceneDocument scene_with_sizes(SceneDocument document, const WantedSizes& wanted) {
  const GeometrySettings& geometry = document.scene.geometry;
  MeshStructure& structure = document.scene.mesh.structure;
  const bool from_file = !geometry.file.empty();
  if (is_mesh_file(geometry.file)) {
    refuse_key(document, "geometry.file", '"' + geometry.file + "\" with --sizes",
               "a .geo or .step file: a .msh file has a mesh already");
  }
  if (!document.where.contains("mesh.structure")) structure = MeshStructure::free;
  const bool crossed = structure == MeshStructure::crossed;
  if (structure == MeshStructure::regular || (crossed && !from_file)) {
    refuse_key(document, "mesh.structure",
               std::string(crossed ? "\"crossed\"" : "\"regular\"") + " with --sizes",
               "\"free\", or no such key: elements of a pattern have one size");
  }
  const double count =
      std::visit([](const auto& sizes) { return element_count(sizes); }, wanted.sizes);
  if (count > max_element_count) {
    refuse_sizes(
        wanted,
        "sizes that make some " + short_number(std::round(count / 1e6)) + " million elements",
        "larger sizes, which make at most 5 million");
  }
  document.where.erase("mesh.size");
  return document;
}

void refuse_sizes_of_another_model(const WantedSizes& wanted, const ModelBox& box) {
  if (wanted.dimension() != box.dimension) {
    refuse_sizes(wanted, "sizes of a mesh in " + dimension_text(wanted.dimension()),
                 "those of a mesh of this scene, in " + dimension_text(box.dimension));
  }
  std::visit([&](const auto& sizes) { refuse_other_box(wanted, sizes.mesh, box); }, wanted.sizes);
}

void refuse_sizes_of_other_regions(const WantedSizes& wanted, std::vector<std::string> regions) {
  std::vector<std::string> others =
      std::visit([](const auto& sizes) { return sizes.mesh.region_names; }, wanted.sizes);
  std::ranges::sort(others);
  std::ranges::sort(regions);
  if (others == regions) return;
  const auto listed_names = [](std::vector<std::string> names) {
    for (std::string& name : names) name = shown_value(name);
    return (names.size() > 1 ? "regions " : "region ") + listed(names, "and");
  };
  refuse_sizes(wanted, "sizes of a mesh with the " + listed_names(others),
               "those of a mesh of this scene, with the " + listed_names(regions));
}

SizesInGmsh::SizesInGmsh(const WantedSizes& wanted, double scale) {
  for (const std::string option : {"Mesh.MeshSizeExtendFromBoundary", "Mesh.MeshSizeFromPoints",
                                   "Mesh.MeshSizeFromCurvature"}) {
    gmsh::option::setNumber(option, 0.0);
  }
  // Gmsh's own precision along curves takes ten times as long as the rest where sizes differ much.
  gmsh::option::setNumber("Mesh.LcIntegrationPrecision", 1e-5);
  // Regular tetrahedra do not fill space: those of Gmsh are larger than it is asked for.
  gmsh::option::setNumber("Mesh.MeshSizeFactor", wanted.dimension() == 2 ? 1.0 : 0.82);
  // A callback and not a field of Gmsh: a field of views has no size beyond the chord of a curved
  // boundary, and would take the place of a field of the user's file.
  std::visit(
      [&]<int Dim>(const MeshSizes<Dim>& sizes) {
        const auto field = std::make_shared<const SizeField<Dim>>(sizes);
        gmsh::model::mesh::setSizeCallback([field, scale](int, int, double x, double y, double z) {
          const std::array<double, 3> at{x * scale, y * scale, z * scale};
          return field->at(Eigen::Map<const Vector<Dim>>(at.data())) / scale;
        });
      },
      wanted.sizes);
}

SizesInGmsh::~SizesInGmsh() {
  gmsh::model::mesh::removeSizeCallback();
}

}  // namespace suffuse
