#include "scene/geometry_checks.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>

#include "scene/scene_check_base.hpp"

namespace suffuse {
namespace {

class GeometryChecks : private SceneCheckBase {
 public:
  using SceneCheckBase::SceneCheckBase;

  void run() const {
    check_geometry();
    if (given("geometry.shape") && !refused("geometry.shape")) check_shape();
    if (given("mesh.error")) check_error();
  }

 private:
  void check_geometry() const {
    const bool file = given("geometry.file");
    const bool shape = given("geometry.shape");
    if (file && shape)
      report("geometry.shape", "a shape and a file", "one of the two", {"geometry.file"});
    if (!file && !shape) report("geometry", "neither file nor shape", "one of the two");
    if (file && !shape) check_file();
  }

  void check_file() const {
    for (const std::string name : {"width", "depth", "height"}) {
      const std::string key = joined("geometry", name);
      if (given(key)) {
        report(key, "a " + name + " with geometry.file", name + " with a built-in shape only",
               {"geometry.file"});
      }
    }
    for (const std::string& key : keys_of("geometry.layers")) {
      if (!given(key)) continue;
      report(key, "a layer with geometry.file",
             "layers with a built-in shape only: a file has regions of its own", {"geometry.file"});
    }
    check_scale();
    if (is_mesh_file(scene_.geometry.file)) {
      check_mesh_of_file();
    } else if (given("mesh.structure") && scene_.mesh.structure == MeshStructure::regular) {
      report("mesh.structure", "\"regular\" for geometry.file",
             "\"crossed\" or \"free\": only the built-in shapes have a regular mesh",
             {"geometry.file"});
    }
  }

  void check_scale() const {
    if (!given("geometry.scale") || !is_step_file(scene_.geometry.file)) return;
    report("geometry.scale", "a scale of a STEP file",
           "no such key: the file states its own unit, and is read in metres", {"geometry.file"});
  }

  /// Refuses keys that have no effect on a mesh from a file, which is used unchanged.
  void check_mesh_of_file() const {
    for (const std::string key : {"mesh.size", "mesh.structure", "mesh.error"}) {
      if (!given(key)) continue;
      report(key, "a key with a .msh file",
             "no such key: the elements of the file are used as they are", {"geometry.file"});
    }
  }

  void check_shape() const {
    if (given("geometry.scale")) {
      report("geometry.scale", "a scale with geometry.shape", "no such key: lengths are in m",
             {"geometry.shape"});
    }
    const bool box = scene_.geometry.is_box();
    std::vector<std::string> sides{"geometry.width", "geometry.height"};
    double smallest = std::min(scene_.geometry.width, scene_.geometry.height);
    if (box) {
      sides.emplace_back("geometry.depth");
      smallest = std::min(smallest, scene_.geometry.depth);
    } else if (given("geometry.depth")) {
      report("geometry.depth", "a depth with shape = \"column\"",
             "no such key: a column is two-dimensional, a box has a depth", {"geometry.shape"});
    }
    for (const std::string& key : sides) require_for_shape(key);
    if (given("mesh.size") && scene_.mesh.size > smallest) {
      report("mesh.size", shown_value(scene_.mesh.size),
             "h <= " + shown_number(smallest) + " m, the smaller of width" +
                 (box ? ", depth" : "") + " and height",
             sides);
    }
    box ? check_structure_of_box() : check_plane_vectors();
  }

  /// Meshing again needs elements whose size varies, and the estimate a flow that becomes steady.
  void check_error() const {
    const std::string structure = "mesh.structure";
    const bool pattern = scene_.mesh.structure == MeshStructure::regular ||
                         (scene_.mesh.structure == MeshStructure::crossed && !from_file());
    if (given(structure) && !refused(structure) && pattern) {
      report(
          "mesh.error",
          "an error with structure = " +
              shown_value(std::string(scene_.mesh.structure == MeshStructure::regular ? "regular"
                                                                                      : "crossed")),
          "structure = \"free\", or no such key: elements of a pattern have one size", {structure});
    }
    if (scene_.time.scheme == FlowScheme::explicit_nodal && !refused("time.scheme")) {
      report("mesh.error", "an error with scheme = \"explicit\"",
             "scheme = \"implicit\": the error is that of its flow", {"time.scheme"});
    }
  }

  [[nodiscard]] bool from_file() const { return given("geometry.file"); }

  void require_for_shape(const std::string& key) const {
    require(key, key, "for shape = \"" + scene_.geometry.shape + '"', "geometry.shape");
  }

  void check_structure_of_box() const {
    if (scene_.mesh.structure != MeshStructure::crossed || refused("mesh.structure")) return;
    report("mesh.structure", "\"crossed\" with shape = \"box\"",
           "\"regular\" or \"free\": only triangles can be crossed", {"geometry.shape"});
  }

  void check_plane_vectors() const {
    check_two_dimensional("gravity", scene_.gravity);
    for (const Soil& soil : scene_.soils) {
      const std::string table = table_of(soil);
      check_two_dimensional(table + ".porosity_gradient", soil.porosity_gradient);
      check_two_dimensional(table + ".porosity_origin", soil.porosity_origin);
    }
  }

  void check_two_dimensional(const std::string& key, const std::array<double, 3>& value) const {
    if (value[2] != 0.0) {
      report(key, shown_value(std::vector(value.begin(), value.end())),
             "two numbers: a column is two-dimensional", {"geometry.shape"});
    }
  }
};

std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return std::tolower(c); });
  return extension;
}

}  // namespace

void check_geometry(const Scene& scene, const SceneInquiry& inquiry) {
  GeometryChecks(scene, inquiry).run();
}

bool is_geo_file(const std::string& path) {
  return extension_of(path) == ".geo";
}

bool is_mesh_file(const std::string& path) {
  return extension_of(path) == ".msh";
}

bool is_step_file(const std::string& path) {
  const std::string extension = extension_of(path);
  return extension == ".step" || extension == ".stp";
}

}  // namespace suffuse
