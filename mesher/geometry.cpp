#include "geometry.hpp"

#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "box.hpp"
#include "case/consistency.hpp"
#include "column.hpp"
#include "common/errors.hpp"
#include "common/short_number.hpp"
#include "geometry_file.hpp"
#include "gmsh_session.hpp"
#include "hilbert_order.hpp"
#include "inner_cuts.hpp"
#include "mesh_extraction.hpp"
#include "mesh_limits.hpp"
#include "mesh_problems.hpp"
#include "scene/geometry_checks.hpp"
#include "scene/scene_defaults.hpp"
#include "scene/scene_schema.hpp"

namespace suffuse {

namespace fs = std::filesystem;

namespace {

bool divides(double size, double length) {
  const double rows = length / size;
  return std::abs(rows - std::round(rows)) <= 1e-9 * rows;
}

void note_size(const GeometryRequest& request, std::vector<std::string>& notes) {
  const Scene& scene = request.document.scene;
  if (request.wanted) return;
  if (!request.document.where.contains("mesh.size")) {
    notes.push_back(default_size_note(request.document, scene.mesh.size));
    return;
  }
  if (scene.mesh.structure == MeshStructure::free) return;
  const double size = scene.mesh.size;
  std::vector<std::pair<std::string, double>> sides{{"width", scene.geometry.width},
                                                    {"height", scene.geometry.height}};
  if (scene.geometry.is_box()) sides.insert(sides.begin() + 1, {"depth", scene.geometry.depth});
  for (const auto& [side, length] : sides) {
    if (divides(size, length)) continue;
    const int rows = element_rows(length, size);
    notes.push_back("mesh.size " + short_number(size) + " does not divide the " + side + " " +
                    short_number(length) + ": it has " + std::to_string(rows) + " elements of " +
                    short_number(length / rows));
  }
}

int rows_beside_specimen(const LayerSettings& rows) {
  return rows.inflow + rows.free_above + rows.above + rows.below + rows.free_below + rows.outflow;
}

/// Gives Gmsh the wanted sizes for a shape, or the scene's as the largest. Throws InputError where
/// they are those of a mesh of another shape.
void set_sizes(const GeometryRequest& request, const ColumnShape& column,
               std::optional<SizesInGmsh>& sizes) {
  const Scene& scene = request.document.scene;
  if (!request.wanted) {
    gmsh::option::setNumber("Mesh.MeshSizeMax", scene.mesh.size);
    return;
  }
  const GeometrySettings& geometry = scene.geometry;
  const double bottom = column.level(column.layers.front().bottom);
  const double top = column.level(column.layers.back().top);
  const ModelBox box = geometry.is_box()
                           ? ModelBox{3, {0.0, 0.0, bottom}, {column.width, geometry.depth, top}}
                           : ModelBox{2, {0.0, bottom, 0.0}, {column.width, top, 0.0}};
  refuse_sizes_of_another_model(*request.wanted, box);
  sizes.emplace(*request.wanted, 1.0);
}

void build_column(const GeometryRequest& request, std::vector<std::string>& notes) {
  const Scene& scene = request.document.scene;
  const double width = scene.geometry.width;
  const int beside = rows_beside_specimen(scene.geometry.layers);
  if (!request.wanted) {
    refuse_too_many_triangles(request.document, width * scene.geometry.height, width * beside);
  }
  const ColumnShape column = column_of(scene);
  std::optional<SizesInGmsh> sizes;
  set_sizes(request, column, sizes);
  const std::string complaint = gmsh_complaint([&] { mesh_column(column, scene.mesh); });
  if (!complaint.empty()) throw FileError("Gmsh could not mesh the column: " + complaint);
  note_size(request, notes);
}

ExtractedMesh<3> build_box(const GeometryRequest& request, std::vector<std::string>& notes) {
  const Scene& scene = request.document.scene;
  const GeometrySettings& geometry = scene.geometry;
  const double floor = geometry.width * geometry.depth;
  if (!request.wanted) {
    refuse_too_many_tetrahedra(request.document, floor * geometry.height,
                               floor * rows_beside_specimen(geometry.layers));
  }
  note_size(request, notes);
  const ColumnShape column = column_of(scene);
  if (scene.mesh.structure != MeshStructure::free) {
    ExtractedMesh<3> box;
    box.mesh = regular_box(column, geometry.depth, scene.mesh.size);
    box.comparable = true;
    return box;
  }
  const GmshSession session;
  std::optional<SizesInGmsh> sizes;
  set_sizes(request, column, sizes);
  const std::string complaint =
      gmsh_complaint([&] { mesh_free_box(column, geometry.depth, scene.mesh.size); });
  if (!complaint.empty()) throw FileError("Gmsh could not mesh the box: " + complaint);
  return extract_mesh<3>(read_gmsh_model());
}

/// Sets the place in the scene and the key of the problems of the mesh.
void place_problems(const SceneDocument& document, std::vector<InputProblem>& problems) {
  const bool from_file = !document.scene.geometry.file.empty();
  const std::string key = from_file ? "geometry.file" : "geometry.shape";
  for (InputProblem& problem : problems) {
    problem.where = document.locate(key);
    problem.key = key;
    if (from_file) {
      problem.found = '"' + document.scene.geometry.file + "\" with " + problem.found;
    }
  }
}

/// Replaces the problems of boundaries, walls and wells by one problem if the geometry has no named
/// curves.
/// \param curves  that can be named, as text
template <int Dim>
void explain_missing_curves(const SceneDocument& document, const std::string& curves,
                            std::vector<InputProblem>& problems) {
  const auto is_name = [](const InputProblem& problem) { return problem.key.ends_with(".on"); };
  std::vector<std::string> names;
  for (const InputProblem& problem : problems) {
    if (is_name(problem)) names.push_back(problem.found);
  }
  if (names.empty()) return;
  std::erase_if(problems, is_name);
  const std::string word = MeshWords<Dim>::boundary;
  problems.push_back({document.locate("geometry.file"), "geometry.file",
                      '"' + document.scene.geometry.file + "\" with no physical " + word,
                      "a physical " + word + " for " + listed(names, "and") + ", as in Physical " +
                          (Dim == 2 ? "Curve(" : "Surface(") + names.front() + ") = {1};" + curves,
                      ""});
}

/// Advises on names: Gmsh reads names of faces in a STEP file, if any, but none of edges.
template <int Dim>
void advise_on_step(const SceneDocument& document, std::vector<InputProblem>& problems) {
  const std::string& file = document.scene.geometry.file;
  problems.push_back({document.locate("geometry.file"), "geometry.file", "",
                      "for names that the STEP file lacks, a .geo file that gives them: "
                      "SetFactory(\"OpenCASCADE\"); "
                      "Geometry.OCCTargetUnit = \"M\"; Merge \"" +
                          file + "\"; Physical " +
                          (Dim == 2 ? "Surface(\"specimen\") = {1}; Physical Curve"
                                    : "Volume(\"specimen\") = {1}; Physical Surface") +
                          "(\"top\") = {3};",
                      ""});
}

/// Cuts walls and wells into the mesh and compares it with the scene.
template <int Dim>
Geometry<Dim> finished(const GeometryRequest& request, ExtractedMesh<Dim> extracted,
                       std::vector<std::string> notes) {
  const SceneDocument& document = request.document;
  place_problems(document, extracted.problems);
  for (Vector<Dim>& x : extracted.mesh.nodes) x *= document.scene.geometry.scale;
  if (extracted.comparable) {
    const InnerNames inner = cut_walls_and_wells(document, extracted, notes);
    SceneDocument complete = document;
    complete_for_mesh(complete, Dim);
    std::ranges::move(scene_problems(complete, extracted.mesh, inner),
                      std::back_inserter(extracted.problems));
    if (extracted.curves_to_name) {
      explain_missing_curves<Dim>(document, *extracted.curves_to_name, extracted.problems);
    }
  }
  const bool lacks_names = !extracted.problems.empty() && extracted.mesh.boundaries.empty();
  if (lacks_names && is_step_file(document.scene.geometry.file)) {
    advise_on_step<Dim>(document, extracted.problems);
  }
  if (!extracted.problems.empty()) throw InputError(std::move(extracted.problems));
  if (request.wanted) {
    refuse_sizes_of_other_regions(*request.wanted, extracted.mesh.region_names);
    notes.insert(notes.begin(), "sizes of elements are those of " + request.wanted->path);
  }
  if (extracted.turned > 0) {
    notes.push_back(std::to_string(extracted.turned) +
                    (Dim == 2 ? " clockwise triangles were turned round"
                              : " tetrahedra inside out were turned round"));
  }
  return {in_hilbert_order(extracted.mesh), std::move(notes)};
}

std::vector<std::string> notes_on(const SceneDocument& document, const GmshReply& reply) {
  std::vector<std::string> notes;
  if (reply.meshes_itself) {
    notes.emplace_back("the .geo file meshes itself, mesh.size does not apply");
  }
  if (reply.wants_threads) {
    notes.emplace_back("Gmsh ran on one thread, whatever the file asks for");
  }
  if (reply.default_size > 0.0) {
    notes.push_back(default_size_note(document, reply.default_size));
  }
  const FileLimits& limits = reply.limits;
  if (limits.smallest) {
    notes.emplace_back(
        "Mesh.MeshSizeMin of the file holds: elements are larger than the sizes ask");
  }
  if (limits.largest) {
    notes.emplace_back("Mesh.MeshSizeMax of the file holds: elements are finer than the sizes ask");
  }
  if (limits.field) {
    notes.emplace_back("the field of sizes of the file holds where it is finer than the sizes ask");
  }
  return notes;
}

/// The mesh of the user's file, in its own dimension.
AnyGeometry geometry_from_file(const GeometryRequest& request) {
  const SceneDocument& document = request.document;
  const GmshReply reply = read_geometry_file(request);
  if (reply.model.dimension == 3) {
    return finished(request, extract_mesh<3>(reply.model), notes_on(document, reply));
  }
  const bool users_own = reply.meshes_itself || is_mesh_file(document.scene.geometry.file);
  const bool crossed = document.scene.mesh.structure == MeshStructure::crossed && !users_own;
  const Quadrangles quadrangles = crossed ? Quadrangles::cut_along_diagonals : Quadrangles::refused;
  return finished(request, extract_mesh<2>(reply.model, quadrangles), notes_on(document, reply));
}

Geometry<2> column_geometry(const GeometryRequest& request) {
  std::vector<std::string> notes;
  ExtractedMesh<2> extracted;
  {
    const GmshSession session;
    build_column(request, notes);
    const bool crossed = request.document.scene.mesh.structure == MeshStructure::crossed;
    extracted = extract_mesh<2>(read_gmsh_model(),
                                crossed ? Quadrangles::cut_along_diagonals : Quadrangles::refused);
  }
  return finished(request, std::move(extracted), std::move(notes));
}

}  // namespace

std::string geometry_path(const SceneDocument& document) {
  return (fs::path(document.path).parent_path() / document.scene.geometry.file).string();
}

AnyGeometry build_geometry(const GeometryRequest& request) {
  const GeometrySettings& geometry = request.document.scene.geometry;
  if (!geometry.file.empty()) return geometry_from_file(request);
  if (!geometry.is_box()) return column_geometry(request);
  std::vector<std::string> notes;
  ExtractedMesh<3> extracted = build_box(request, notes);
  return finished(request, std::move(extracted), std::move(notes));
}

}  // namespace suffuse
