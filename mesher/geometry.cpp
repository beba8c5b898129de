#include "geometry.hpp"

#include <gmsh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <string_view>

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
#include "point_sizes.hpp"
#include "time_limit.hpp"

namespace suffuse {

namespace fs = std::filesystem;

namespace {

/// Beyond this a misplaced decimal point is likelier than intent.
constexpr double max_triangles = 5e6;

[[noreturn]] void refuse(const SceneDocument& document, const std::string& key,
                         const std::string& found, const std::string& expected) {
  throw InputError(
      std::vector<InputProblem>{{document.locate(key), key, found, expected, std::string()}});
}

/// \param area  m2
/// \param strip  width of what is meshed besides, in rows of elements, all rows together, m
void refuse_too_many(const SceneDocument& document, double area, double strip = 0.0) {
  const double size = document.scene.mesh.size;
  // Triangles fill half a square each: max_triangles = 2 (area + strip size) / size^2.
  const double smallest =
      (strip + std::sqrt(strip * strip + 2.0 * area * max_triangles)) / max_triangles;
  if (!(size < smallest)) return;
  refuse(document, "mesh.size", short_number(size),
         "at least " + short_number(smallest) + ", which makes 5 million triangles here");
}

bool divides(double size, double length) {
  const double rows = length / size;
  return std::abs(rows - std::round(rows)) <= 1e-9 * rows;
}

void note_rounding(const Scene& scene, std::vector<std::string>& notes) {
  if (scene.mesh.structure == MeshStructure::free) return;
  const double size = scene.mesh.size;
  const std::array<std::pair<std::string, double>, 2> sides{
      {{"width", scene.geometry.width}, {"height", scene.geometry.height}}};
  for (const auto& [side, length] : sides) {
    if (divides(size, length)) continue;
    const int rows = element_rows(length, size);
    notes.push_back("mesh.size " + short_number(size) + " does not divide the " + side + " " +
                    short_number(length) + ": it has " + std::to_string(rows) + " elements of " +
                    short_number(length / rows));
  }
}

void build_column(const SceneDocument& document, std::vector<std::string>& notes) {
  const Scene& scene = document.scene;
  const double width = scene.geometry.width;
  const LayerSettings& rows = scene.geometry.layers;
  const int beside =
      rows.inflow + rows.free_above + rows.above + rows.below + rows.free_below + rows.outflow;
  refuse_too_many(document, width * scene.geometry.height, width * beside);
  const std::string complaint = gmsh_complaint([&] { mesh_column(column_of(scene), scene.mesh); });
  if (!complaint.empty()) throw FileError("Gmsh could not mesh the column: " + complaint);
  note_rounding(scene, notes);
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
  gmsh::vectorpair surfaces;
  gmsh::model::getEntities(surfaces, 2);
  if (surfaces.size() > 1) {
    gmsh::model::occ::removeAllDuplicates();  // neighbours come with a curve each
    gmsh::model::occ::synchronize();
  }
  name_groups_by_label(2);
  name_groups_by_label(1);
}

bool has_surface_mesh() {
  std::vector<int> types;
  std::vector<std::vector<std::size_t>> tags;
  std::vector<std::vector<std::size_t>> nodes;
  gmsh::model::mesh::getElements(types, tags, nodes, 2);
  return !types.empty();
}

void generate_mesh(const SceneDocument& document, const std::string& path) {
  std::array<double, 6> box{};
  gmsh::model::getBoundingBox(-1, -1, box[0], box[1], box[2], box[3], box[4], box[5]);
  const double scale = document.scene.geometry.scale;
  refuse_too_many(document, (box[3] - box[0]) * scale * (box[4] - box[1]) * scale);
  const double size = document.scene.mesh.size / scale;  // in the file's unit
  double largest = 0.0;
  gmsh::option::getNumber("Mesh.MeshSizeMax", largest);
  if (size < largest) gmsh::option::setNumber("Mesh.MeshSizeMax", size);
  if (document.scene.mesh.structure == MeshStructure::crossed) {
    // Triangles twice as large, each then split into three quadrangles by Gmsh: its recombination
    // of triangles into quadrangles crashes on small models (4.8).
    gmsh::option::setNumber("Mesh.MeshSizeFactor", 2.0);
    gmsh::option::setNumber("Mesh.SubdivisionAlgorithm", 1);
  }
  run_gmsh(document, path, [&] {
    if (std::isfinite(size)) set_default_point_size(size);
    gmsh::model::mesh::generate(2);
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
  if (has_surface_mesh()) {
    notes.emplace_back("the .geo file meshes itself, mesh.size does not apply");
    return true;
  }
  generate_mesh(document, path);
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
void explain_missing_curves(const SceneDocument& document, const std::string& curves,
                            std::vector<InputProblem>& problems) {
  const auto is_name = [](const InputProblem& problem) { return problem.key.ends_with(".on"); };
  std::vector<std::string> names;
  for (const InputProblem& problem : problems) {
    if (is_name(problem)) names.push_back(problem.found);
  }
  if (names.empty()) return;
  std::erase_if(problems, is_name);
  problems.push_back({document.locate("geometry.file"), "geometry.file",
                      '"' + document.scene.geometry.file + "\" with no physical curve",
                      "a physical curve for " + listed(names, "and") + ", as in Physical Curve(" +
                          names.front() + ") = {1};" + curves,
                      ""});
}

/// Gmsh reads names of faces from a STEP file, where the CAD program wrote any, but none of edges.
void advise_on_step(const SceneDocument& document, std::vector<InputProblem>& problems) {
  const std::string& file = document.scene.geometry.file;
  problems.push_back(
      {document.locate("geometry.file"), "geometry.file", "",
       "for names that the STEP file lacks, a .geo file that gives them: "
       "SetFactory(\"OpenCASCADE\"); "
       "Geometry.OCCTargetUnit = \"M\"; Merge \"" +
           file + "\"; Physical Surface(\"specimen\") = {1}; Physical Curve(\"top\") = {3};",
       ""});
}

}  // namespace

std::string geometry_path(const SceneDocument& document) {
  return (fs::path(document.path).parent_path() / document.scene.geometry.file).string();
}

Geometry build_geometry(const SceneDocument& document, double max_seconds) {
  Geometry result;
  ExtractedMesh extracted;
  {
    const GmshSession session;
    bool users_own = false;
    if (document.scene.geometry.file.empty()) {
      build_column(document, result.notes);
    } else {
      users_own = build_from_file(document, max_seconds, result.notes);
    }
    const bool crossed = document.scene.mesh.structure == MeshStructure::crossed && !users_own;
    extracted = extract_mesh(crossed ? Quadrangles::cut_along_diagonals : Quadrangles::refused);
  }
  place_problems(document, extracted.problems);
  for (Vector<2>& x : extracted.mesh.nodes) x *= document.scene.geometry.scale;
  if (extracted.comparable) {
    const InnerNames inner = cut_walls_and_wells(document, extracted, result.notes);
    std::ranges::move(scene_problems(document, extracted.mesh, inner),
                      std::back_inserter(extracted.problems));
    if (extracted.curves_to_name) {
      explain_missing_curves(document, *extracted.curves_to_name, extracted.problems);
    }
  }
  const bool lacks_names = !extracted.problems.empty() && extracted.mesh.boundaries.empty();
  if (lacks_names && is_step_file(document.scene.geometry.file)) {
    advise_on_step(document, extracted.problems);
  }
  if (!extracted.problems.empty()) throw InputError(std::move(extracted.problems));
  if (extracted.turned > 0) {
    result.notes.push_back(std::to_string(extracted.turned) +
                           " clockwise triangles were turned round");
  }
  result.mesh = in_hilbert_order(extracted.mesh);
  return result;
}

}  // namespace suffuse
