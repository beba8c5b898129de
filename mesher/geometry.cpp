#include "geometry.hpp"

#include <gmsh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <string_view>

#include "box.hpp"
#include "case/consistency.hpp"
#include "case/errors.hpp"
#include "case/geometry_checks.hpp"
#include "case/scene_schema.hpp"
#include "case/short_number.hpp"
#include "column.hpp"
#include "curve_crossings.hpp"
#include "geometry_scan.hpp"
#include "gmsh_session.hpp"
#include "hilbert_order.hpp"
#include "inner_cuts.hpp"
#include "mesh_extraction.hpp"
#include "mesh_problems.hpp"
#include "point_sizes.hpp"
#include "time_limit.hpp"

namespace suffuse {

namespace fs = std::filesystem;

namespace {

/// Beyond this a misplaced decimal point is likelier than intent.
constexpr double max_elements = 5e6;

[[noreturn]] void refuse(const SceneDocument& document, const std::string& key,
                         const std::string& found, const std::string& expected) {
  throw InputError(
      std::vector<InputProblem>{{document.locate(key), key, found, expected, std::string()}});
}

[[noreturn]] void refuse_size(const SceneDocument& document, double smallest,
                              const std::string& elements) {
  refuse(document, "mesh.size", short_number(document.scene.mesh.size),
         "at least " + short_number(smallest) + ", which makes 5 million " + elements + " here");
}

/// \param area  m2
/// \param strip  width of what is meshed besides, in rows of elements, all rows together, m
void refuse_too_many_triangles(const SceneDocument& document, double area, double strip = 0.0) {
  // Triangles fill half a square each: max_elements = 2 (area + strip size) / size^2.
  const double smallest =
      (strip + std::sqrt(strip * strip + 2.0 * area * max_elements)) / max_elements;
  if (document.scene.mesh.size < smallest) refuse_size(document, smallest, "triangles");
}

/// \param volume  m3
/// \param layer  area of what is meshed besides, in rows of elements, all rows together, m2
void refuse_too_many_tetrahedra(const SceneDocument& document, double volume, double layer = 0.0) {
  // Tetrahedra fill a sixth of a cube each: max_elements = 6 (volume + layer size) / size^3.
  const auto count = [&](double size) {
    return 6.0 * (volume + layer * size) / (size * size * size);
  };
  double smallest = std::cbrt(6.0 * volume / max_elements);
  while (count(smallest) > max_elements * (1.0 + 1e-9)) {
    smallest = std::cbrt(6.0 * (volume + layer * smallest) / max_elements);
  }
  if (document.scene.mesh.size < smallest) refuse_size(document, smallest, "tetrahedra");
}

bool divides(double size, double length) {
  const double rows = length / size;
  return std::abs(rows - std::round(rows)) <= 1e-9 * rows;
}

void note_rounding(const Scene& scene, std::vector<std::string>& notes) {
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

void build_column(const SceneDocument& document, std::vector<std::string>& notes) {
  const Scene& scene = document.scene;
  const double width = scene.geometry.width;
  const int beside = rows_beside_specimen(scene.geometry.layers);
  refuse_too_many_triangles(document, width * scene.geometry.height, width * beside);
  const std::string complaint = gmsh_complaint([&] { mesh_column(column_of(scene), scene.mesh); });
  if (!complaint.empty()) throw FileError("Gmsh could not mesh the column: " + complaint);
  note_rounding(scene, notes);
}

ExtractedMesh<3> build_box(const SceneDocument& document, std::vector<std::string>& notes) {
  const Scene& scene = document.scene;
  const GeometrySettings& geometry = scene.geometry;
  const double floor = geometry.width * geometry.depth;
  refuse_too_many_tetrahedra(document, floor * geometry.height,
                             floor * rows_beside_specimen(geometry.layers));
  note_rounding(scene, notes);
  const ColumnShape column = column_of(scene);
  if (scene.mesh.structure != MeshStructure::free) {
    ExtractedMesh<3> box;
    box.mesh = regular_box(column, geometry.depth, scene.mesh.size);
    box.comparable = true;
    return box;
  }
  const GmshSession session;
  const std::string complaint =
      gmsh_complaint([&] { mesh_free_box(column, geometry.depth, scene.mesh.size); });
  if (!complaint.empty()) throw FileError("Gmsh could not mesh the box: " + complaint);
  return extract_mesh<3>();
}

constexpr const char* advice_on_mesh =
    "a mesh that Gmsh can read: open it in Gmsh, look at it and save it anew";

/// Gmsh names an edge of its own that it cannot recover; the user knows the curves.
std::string crossings_behind(const std::string& complaint) {
  const std::vector<std::string> crossings =
      complaint.starts_with("Unable to recover") ? curve_crossings() : std::vector<std::string>{};
  return listed(crossings, "and");
}

/// `'FILE', line N: MESSAGE` is how Gmsh places an error in a script.
InputProblem gmsh_problem(const SceneDocument& document, const std::string& path,
                          const std::string& complaint) {
  constexpr std::string_view before_line = "', line ";
  const std::size_t name_end = complaint.find(before_line);
  const std::size_t message = complaint.find(": ", std::min(name_end, complaint.size()));
  if (complaint.starts_with('\'') && message != std::string::npos) {
    const std::size_t line = name_end + before_line.size();
    return {complaint.substr(1, name_end - 1) + ":" + complaint.substr(line, message - line), "",
            complaint.substr(message + 2), "valid Gmsh text", ""};
  }
  const std::string where = document.locate("geometry.file");
  if (const std::string crossings = crossings_behind(complaint); !crossings.empty()) {
    return {where, "geometry.file", '"' + path + "\" with " + crossings,
            "curves that meet at points of both alone: split them there, or use BooleanFragments",
            ""};
  }
  return {where, "geometry.file", '"' + path + "\", of which Gmsh says: " + complaint,
          is_mesh_file(path) ? advice_on_mesh : "a geometry that Gmsh can mesh", ""};
}

void run_gmsh(const SceneDocument& document, const std::string& path,
              const std::function<void()>& body) {
  const std::string complaint = gmsh_complaint(body);
  if (!complaint.empty()) {
    throw InputError(std::vector<InputProblem>{gmsh_problem(document, path, complaint)});
  }
}

/// The labels of a STEP file's shapes become physical groups. Gmsh gives them as paths of an
/// assembly; the last part is the shape's own name.
void name_groups_by_label(int dimension) {
  gmsh::vectorpair entities;
  gmsh::model::getEntities(entities, dimension);
  std::map<std::string, std::vector<int>> groups;
  for (const auto& [ignored, tag] : entities) {
    std::string label;
    gmsh::model::getEntityName(dimension, tag, label);
    label = label.substr(label.rfind('/') + 1);
    const bool automatic = label.starts_with("Open CASCADE STEP translator");
    if (!label.empty() && !automatic) groups[label].push_back(tag);
  }
  for (const auto& [name, tags] : groups) {
    const int group = gmsh::model::addPhysicalGroup(dimension, tags);
    gmsh::model::setPhysicalName(dimension, group, name);
  }
}

void open_step(const std::string& path) {
  gmsh::option::setString("Geometry.OCCTargetUnit", "M");
  gmsh::open(path);
  const int dimension = model_dimension();
  gmsh::vectorpair regions;
  gmsh::model::getEntities(regions, dimension);
  if (regions.size() > 1) {
    gmsh::model::occ::removeAllDuplicates();  // neighbours come with a border each
    gmsh::model::occ::synchronize();
  }
  name_groups_by_label(dimension);
  name_groups_by_label(dimension - 1);
}

bool has_mesh(int dimension) {
  std::vector<int> types;
  std::vector<std::vector<std::size_t>> tags;
  std::vector<std::vector<std::size_t>> nodes;
  gmsh::model::mesh::getElements(types, tags, nodes, dimension);
  return !types.empty();
}

void generate_mesh(const SceneDocument& document, const std::string& path, int dimension) {
  std::array<double, 6> box{};
  gmsh::model::getBoundingBox(-1, -1, box[0], box[1], box[2], box[3], box[4], box[5]);
  const double scale = document.scene.geometry.scale;
  const double area = (box[3] - box[0]) * scale * (box[4] - box[1]) * scale;
  if (dimension == 2) {
    refuse_too_many_triangles(document, area);
  } else {
    refuse_too_many_tetrahedra(document, area * (box[5] - box[2]) * scale);
  }
  const double size = document.scene.mesh.size / scale;  // in the file's unit
  double largest = 0.0;
  gmsh::option::getNumber("Mesh.MeshSizeMax", largest);
  if (size < largest) gmsh::option::setNumber("Mesh.MeshSizeMax", size);
  if (dimension == 2 && document.scene.mesh.structure == MeshStructure::crossed) {
    // Triangles twice as large, each then split into three quadrangles by Gmsh: its recombination
    // of triangles into quadrangles crashes on small models (4.8).
    gmsh::option::setNumber("Mesh.MeshSizeFactor", 2.0);
    gmsh::option::setNumber("Mesh.SubdivisionAlgorithm", 1);
  }
  run_gmsh(document, path, [&] {
    if (std::isfinite(size)) set_default_point_size(size);
    gmsh::model::mesh::generate(dimension);
  });
}

/// Meshes alone: Gmsh reads them in next to no time.
void refuse_what_ends_gmsh(const SceneDocument& document, const std::string& path) {
  constexpr double seconds = 10.0;
  constexpr double seconds_per_byte = 2e-6;  // a hundred times what it takes
  constexpr double memory = 1e9;
  constexpr double memory_per_byte = 100.0;
  std::error_code ignored;
  const auto bytes = static_cast<double>(fs::file_size(path, ignored));
  const std::string crash =
      gmsh_crash([&] { gmsh::open(path); }, seconds + seconds_per_byte * bytes,
                 memory + memory_per_byte * bytes);
  if (!crash.empty()) {
    refuse(document, "geometry.file",
           '"' + document.scene.geometry.file + "\", over which Gmsh " + crash, advice_on_mesh);
  }
}

InputProblem too_long(const SceneDocument& document, double max_seconds) {
  return {document.locate("geometry.file"), "geometry.file",
          '"' + document.scene.geometry.file + "\", over which Gmsh has spent " +
              short_number(max_seconds) + " s of processor time without an end",
          "a file without endless loops and with sizes that suit the model; for a large one a "
          "longer --geometry-timeout",
          ""};
}

/// Whether the mesh is the user's own, to be taken as it is.
bool build_from_file(const SceneDocument& document, double max_seconds,
                     std::vector<std::string>& notes) {
  const std::string path = geometry_path(document);
  const bool is_step = is_step_file(path);
  if (!is_step && !is_mesh_file(path) && !is_geo_file(path)) {
    refuse(document, "geometry.file", '"' + document.scene.geometry.file + '"',
           "a file ending in .geo, .msh, .step or .stp");
  }
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) {
    throw FileError(document.locate("geometry.file") + ": geometry.file: there is no file " + path);
  }
  std::vector<InputProblem> dangers = scan_geometry_file(path);
  if (!dangers.empty()) throw InputError(std::move(dangers));

  if (is_mesh_file(path)) refuse_what_ends_gmsh(document, path);
  const TimeLimit limit(max_seconds, too_long(document, max_seconds).message());
  run_gmsh(document, path, [&] { is_step ? open_step(path) : gmsh::open(path); });
  if (is_mesh_file(path)) return true;
  const int dimension = model_dimension();
  if (dimension == 3 && document.where.contains("mesh.structure") &&
      document.scene.mesh.structure == MeshStructure::crossed) {
    refuse(document, "mesh.structure", "\"crossed\" for a file with volumes",
           "\"free\", or no such key: only triangles can be crossed");
  }
  if (has_mesh(dimension)) {
    notes.emplace_back("the .geo file meshes itself, mesh.size does not apply");
    return true;
  }
  generate_mesh(document, path, dimension);
  return false;
}

/// Where a problem of the mesh comes from.
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

/// One problem in the place of one for each boundary, wall and well, where the geometry has no
/// named curves at all.
/// \param curves  that could be named, as text
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

/// Gmsh reads names of faces from a STEP file, where the CAD program wrote any, but none of edges.
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

/// Cuts walls and wells into the mesh and holds the scene against it.
template <int Dim>
Geometry<Dim> finished(const SceneDocument& document, ExtractedMesh<Dim> extracted,
                       std::vector<std::string> notes) {
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
  if (extracted.turned > 0) {
    notes.push_back(std::to_string(extracted.turned) +
                    (Dim == 2 ? " clockwise triangles were turned round"
                              : " tetrahedra inside out were turned round"));
  }
  return {in_hilbert_order(extracted.mesh), std::move(notes)};
}

/// The mesh of the user's file, in the dimension that it has.
AnyGeometry geometry_from_file(const SceneDocument& document, double max_seconds) {
  std::vector<std::string> notes;
  std::variant<ExtractedMesh<2>, ExtractedMesh<3>> extracted;
  {
    const GmshSession session;
    const bool users_own = build_from_file(document, max_seconds, notes);
    if (model_dimension() == 3) {
      extracted = extract_mesh<3>();
    } else {
      const bool crossed = document.scene.mesh.structure == MeshStructure::crossed && !users_own;
      extracted =
          extract_mesh<2>(crossed ? Quadrangles::cut_along_diagonals : Quadrangles::refused);
    }
  }
  return std::visit(
      [&](auto& mesh) -> AnyGeometry {
        return finished(document, std::move(mesh), std::move(notes));
      },
      extracted);
}

Geometry<2> column_geometry(const SceneDocument& document) {
  std::vector<std::string> notes;
  ExtractedMesh<2> extracted;
  {
    const GmshSession session;
    build_column(document, notes);
    const bool crossed = document.scene.mesh.structure == MeshStructure::crossed;
    extracted = extract_mesh<2>(crossed ? Quadrangles::cut_along_diagonals : Quadrangles::refused);
  }
  return finished(document, std::move(extracted), std::move(notes));
}

}  // namespace

std::string geometry_path(const SceneDocument& document) {
  return (fs::path(document.path).parent_path() / document.scene.geometry.file).string();
}

AnyGeometry build_geometry(const SceneDocument& document, double max_seconds) {
  const GeometrySettings& geometry = document.scene.geometry;
  if (!geometry.file.empty()) return geometry_from_file(document, max_seconds);
  if (!geometry.is_box()) return column_geometry(document);
  std::vector<std::string> notes;
  ExtractedMesh<3> extracted = build_box(document, notes);
  return finished(document, std::move(extracted), std::move(notes));
}

}  // namespace suffuse
