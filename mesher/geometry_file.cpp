#include "geometry_file.hpp"

#include <gmsh.h>
#include <omp.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <new>
#include <optional>
#include <string_view>

#include "common/short_number.hpp"
#include "confined_child.hpp"
#include "curve_crossings.hpp"
#include "geometry.hpp"
#include "gmsh_session.hpp"
#include "mesh_limits.hpp"
#include "mesh_problems.hpp"
#include "point_sizes.hpp"
#include "scene/geometry_checks.hpp"
#include "scene/scene_defaults.hpp"
#include "scene/scene_schema.hpp"

namespace suffuse {

namespace fs = std::filesystem;

namespace {

constexpr const char* advice_on_mesh =
    "a mesh that Gmsh can read: open it in Gmsh, look at it and save it anew";

const char* advice_on(const std::string& path) {
  return is_mesh_file(path) ? advice_on_mesh : "a geometry that Gmsh can mesh";
}

/// Describes the crossing curves behind Gmsh's message of an edge that it cannot recover.
std::string crossings_behind(const std::string& complaint) {
  const std::vector<std::string> crossings =
      complaint.starts_with("Unable to recover") ? curve_crossings() : std::vector<std::string>{};
  return listed(crossings, "and");
}

/// A problem from Gmsh's error in a script, which has the form `'FILE', line N: MESSAGE`.
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
          advice_on(path), ""};
}

void run_gmsh(const SceneDocument& document, const std::string& path,
              const std::function<void()>& body) {
  const std::string complaint = gmsh_complaint(body);
  if (complaint == no_memory) throw std::bad_alloc();
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
  const int dimension = gmsh_model_dimension();
  gmsh::vectorpair regions;
  gmsh::model::getEntities(regions, dimension);
  if (regions.size() > 1) {
    gmsh::model::occ::removeAllDuplicates();  // neighbours have separate borders in the file
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

/// Area or volume of the mesh of the current model, in the file's unit.
double meshed_volume(int dimension) {
  double volume = 0.0;
  std::vector<int> types;
  gmsh::model::mesh::getElementTypes(types, dimension);
  for (const int type : types) {
    std::vector<double> places;
    std::vector<double> weights;
    gmsh::model::mesh::getIntegrationPoints(type, "Gauss2", places, weights);
    std::vector<double> jacobians;
    std::vector<double> determinants;
    std::vector<double> coordinates;
    gmsh::model::mesh::getJacobians(type, places, jacobians, determinants, coordinates);
    for (std::size_t i = 0; i < determinants.size(); ++i) {
      volume += std::abs(determinants[i]) * weights[i % weights.size()];
    }
  }
  return volume;
}

/// The size of elements for a file without sizes in a scene without, m: by the area or volume of a
/// mesh as coarse as Gmsh makes it.
double default_size(const SceneDocument& document, int dimension) {
  gmsh::model::mesh::generate(dimension);
  const double volume =
      meshed_volume(dimension) * std::pow(document.scene.geometry.scale, dimension);
  gmsh::model::mesh::clear();
  const MeshStructure structure =
      dimension == 3 ? MeshStructure::free : document.scene.mesh.structure;
  return default_element_size(volume, dimension, structure, true);
}

/// The box of the regions of the current model.
ModelBox model_box(int dimension, double scale) {
  gmsh::vectorpair regions;
  gmsh::vectorpair parts;
  gmsh::model::getEntities(regions, dimension);
  gmsh::model::getBoundary(regions, parts, false, false, true);  // points
  constexpr double far = std::numeric_limits<double>::max();
  ModelBox box{dimension, {far, far, far}, {-far, -far, -far}};
  const auto extend = [&](const std::array<double, 3>& x) {
    for (int d = 0; d < 3; ++d) {
      box.low[d] = std::min(box.low[d], x[d] * scale);
      box.high[d] = std::max(box.high[d], x[d] * scale);
    }
  };
  for (const auto& [ignored, point] : parts) {
    std::vector<double> x;
    gmsh::model::getValue(0, point, {}, x);
    extend({x[0], x[1], x[2]});
  }
  gmsh::model::getEntities(parts, 1);
  for (const auto& [ignored, curve] : parts) {
    std::string type;
    gmsh::model::getType(1, curve, type);
    box.curved = box.curved || type != "Line";
  }
  if (!box.curved) return box;
  for (const auto& [ignored, region] : regions) {
    std::array<double, 3> low{};
    std::array<double, 3> high{};
    gmsh::model::getBoundingBox(dimension, region, low[0], low[1], low[2], high[0], high[1],
                                high[2]);
    extend(low);
    extend(high);
  }
  return box;
}

/// Limits that the file sets and that are narrower than the wanted sizes.
FileLimits limits_of_file(const WantedSizes& wanted, double scale) {
  const auto& [least, most] =
      std::visit([](const auto& sizes) { return std::ranges::minmax(sizes.size); }, wanted.sizes);
  double smallest = 0.0;
  double largest = 0.0;
  gmsh::option::getNumber("Mesh.MeshSizeMin", smallest);
  gmsh::option::getNumber("Mesh.MeshSizeMax", largest);
  return {smallest * scale > least, largest * scale < most, own_sizes().field};
}

/// Sets the size that the scene gives, or a default where neither it nor the file gives any.
void set_size_of_scene(const SceneDocument& document, int dimension, GmshReply& reply) {
  const double scale = document.scene.geometry.scale;
  double size = document.scene.mesh.size;
  if (std::isnan(size) && !own_sizes().any) {
    size = default_size(document, dimension);
    if (std::isfinite(size)) reply.default_size = size;
  }
  if (!std::isfinite(size)) return;
  size /= scale;  // in the file's unit
  double largest = 0.0;
  gmsh::option::getNumber("Mesh.MeshSizeMax", largest);
  if (size < largest) gmsh::option::setNumber("Mesh.MeshSizeMax", size);
  set_default_point_size(size);
}

void refuse_too_many_elements(const SceneDocument& document, int dimension) {
  std::array<double, 6> box{};
  gmsh::model::getBoundingBox(-1, -1, box[0], box[1], box[2], box[3], box[4], box[5]);
  const double scale = document.scene.geometry.scale;
  const double area = (box[3] - box[0]) * scale * (box[4] - box[1]) * scale;
  if (dimension == 2) {
    refuse_too_many_triangles(document, area);
  } else {
    refuse_too_many_tetrahedra(document, area * (box[5] - box[2]) * scale);
  }
}

void generate_mesh(const GeometryRequest& request, const std::string& path, int dimension,
                   GmshReply& reply) {
  const SceneDocument& document = request.document;
  const double scale = document.scene.geometry.scale;
  std::optional<SizesInGmsh> sizes;
  if (request.wanted) {
    run_gmsh(document, path, [&] {
      refuse_sizes_of_another_model(*request.wanted, model_box(dimension, scale));
      reply.limits = limits_of_file(*request.wanted, scale);
      sizes.emplace(*request.wanted, scale);
    });
  } else {
    refuse_too_many_elements(document, dimension);
  }
  run_gmsh(document, path, [&] {
    if (!request.wanted) set_size_of_scene(document, dimension, reply);
    if (dimension == 2 && document.scene.mesh.structure == MeshStructure::crossed) {
      // Triangles twice as large, each then split into three quadrangles by Gmsh: its recombination
      // of triangles into quadrangles crashes on small models (4.8). Of wanted sizes the elements
      // have the area, which takes triangles larger by the root of 3.
      gmsh::option::setNumber("Mesh.MeshSizeFactor", request.wanted ? 2.0 * std::sqrt(3.0) : 2.0);
      gmsh::option::setNumber("Mesh.SubdivisionAlgorithm", 1);
    }
    gmsh::model::mesh::generate(dimension);
  });
}

/// Whether the file requests more than the one thread of Gmsh. Refuses an impossible number.
bool wants_threads(const SceneDocument& document) {
  constexpr double most = 1024.0;
  bool several = false;
  for (const std::string option : {"General.NumThreads", "Mesh.MaxNumThreads1D",
                                   "Mesh.MaxNumThreads2D", "Mesh.MaxNumThreads3D"}) {
    double count = 0.0;
    gmsh::option::getNumber(option, count);
    if (count > most) {
      refuse_key(
          document, "geometry.file",
          '"' + document.scene.geometry.file + "\" with " + option + " = " + short_number(count),
          "at most " + short_number(most) + "; Gmsh uses one thread here");
    }
    several = several || count > 1.0;
  }
  return several;
}

/// Reads and meshes the file; runs in the confined child, within a session of Gmsh.
GmshReply mesh_file(const GeometryRequest& request, const std::string& path) {
  const SceneDocument& document = request.document;
  GmshReply reply;
  run_gmsh(document, path, [&] { is_step_file(path) ? open_step(path) : gmsh::open(path); });
  reply.wants_threads = wants_threads(document);
  const int dimension = gmsh_model_dimension();
  if (!is_mesh_file(path)) {
    if (dimension == 3 && document.where.contains("mesh.structure") &&
        document.scene.mesh.structure == MeshStructure::crossed) {
      refuse_key(document, "mesh.structure", "\"crossed\" for a file with volumes",
                 "\"free\", or no such key: only triangles can be crossed");
    }
    reply.meshes_itself = has_mesh(dimension);
    if (reply.meshes_itself && request.wanted) {
      refuse_key(document, "geometry.file",
                 '"' + document.scene.geometry.file + "\" with --sizes, which meshes itself",
                 "a file without a Mesh command");
    }
    if (!reply.meshes_itself) generate_mesh(request, path, dimension, reply);
  }
  run_gmsh(document, path, [&] { reply.model = read_gmsh_model(); });
  return reply;
}

std::string reply_of_child(const GeometryRequest& request, const std::string& path) {
  GmshReply reply;
  try {
    reply = mesh_file(request, path);
  } catch (const InputError& error) {
    reply.problems = error.problems();
  }
  return bytes_of(reply);
}

/// Limits for reading a mesh follow from its size; the time to make a mesh is unknown.
ChildLimits limits_for(const std::string& path, double max_seconds) {
  constexpr double seconds = 10.0;
  constexpr double seconds_per_byte = 2e-6;  // a hundred times the usual time
  constexpr double memory = 1e9;
  constexpr double memory_per_byte = 100.0;
  constexpr double wall_per_processor_time = 10.0;  // on a busy machine
  ChildLimits limits{max_seconds, 0.0, 0.0};
  if (is_mesh_file(path)) {
    std::error_code ignored;
    const auto bytes = static_cast<double>(fs::file_size(path, ignored));
    limits.processor_seconds = std::min(max_seconds, seconds + seconds_per_byte * bytes);
    limits.bytes = memory + memory_per_byte * bytes;
  } else {
    limits.bytes = static_cast<double>(::sysconf(_SC_PHYS_PAGES)) *
                   static_cast<double>(::sysconf(_SC_PAGESIZE));
  }
  limits.wall_seconds = wall_per_processor_time * limits.processor_seconds;
  return limits;
}

[[noreturn]] void refuse_end(const SceneDocument& document, const ChildEnd& end,
                             const ChildLimits& limits) {
  const std::string& name = document.scene.geometry.file;
  const bool is_mesh = is_mesh_file(name);
  const auto refuse = [&](const std::string& what, const std::string& expected) {
    refuse_key(document, "geometry.file", '"' + name + "\", " + what, expected);
  };
  switch (end.how) {
    case ChildEnd::How::refused:
      refuse("which has Gmsh " + end.text,
             "a geometry that reads regular files, runs no commands, writes nothing and does not "
             "wait");
      break;
    case ChildEnd::How::processor_time:
    case ChildEnd::How::wall_time:
      if (is_mesh) break;
      refuse("over which Gmsh has spent " +
                 short_number(end.how == ChildEnd::How::wall_time ? limits.wall_seconds
                                                                  : limits.processor_seconds) +
                 (end.how == ChildEnd::How::wall_time ? " s" : " s of processor time") +
                 " without an end",
             "a file without endless loops and with sizes that suit the model; for a large one a "
             "longer --geometry-timeout");
      break;
    case ChildEnd::How::memory:
      if (is_mesh) break;
      refuse("over which Gmsh needs more memory than this machine has",
             "sizes of elements that suit the model");
      break;
    case ChildEnd::How::left:
      refuse("which ends Gmsh before there is a mesh", "a file without Exit or Abort");
      break;
    case ChildEnd::How::crashed:
    case ChildEnd::How::replied:
      refuse("over which Gmsh crashes", advice_on(name));
  }
  refuse("over which Gmsh takes more time or memory than its size explains", advice_on_mesh);
  throw std::logic_error("unreachable");
}

/// Gmsh reads only the first statement of a last line that does not end.
void refuse_unread_end(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::size_t last = text.rfind('\n') + 1;  // 0 without a line before
  const std::string line = text.substr(last);
  if (std::ranges::count(line.substr(0, line.find("//")), ';') < 2) return;
  const auto number = std::ranges::count(text, '\n') + 1;
  throw InputError(InputProblem{path + ":" + std::to_string(number), "",
                                "statements on a last line that does not end, of which Gmsh reads "
                                "the first only",
                                "a newline at the end of the file", ""});
}

}  // namespace

GmshReply read_geometry_file(const GeometryRequest& request) {
  const SceneDocument& document = request.document;
  const std::string path = geometry_path(document);
  if (!is_step_file(path) && !is_mesh_file(path) && !is_geo_file(path)) {
    refuse_key(document, "geometry.file", '"' + document.scene.geometry.file + '"',
               "a file ending in .geo, .msh, .step or .stp");
  }
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) {
    throw FileError(document.locate("geometry.file") + ": geometry.file: there is no file " + path);
  }
  if (is_geo_file(path)) refuse_unread_end(path);
  const ChildLimits limits = limits_for(path, request.max_seconds);
  // Gmsh writes files when it starts and ends. It starts before confinement, and never ends.
  std::optional<GmshSession> of_child;
  const auto start_gmsh = [&of_child] {
    // Parallel regions get one thread for any request of the file: more cannot be started.
    ::omp_set_max_active_levels(0);
    of_child.emplace();
  };
  const ChildEnd end = run_confined(
      start_gmsh, [&] { return reply_of_child(request, path); }, limits);
  if (end.how != ChildEnd::How::replied) refuse_end(document, end, limits);
  GmshReply reply = reply_from(end.text);
  if (!reply.problems.empty()) throw InputError(std::move(reply.problems));
  return reply;
}

}  // namespace suffuse
