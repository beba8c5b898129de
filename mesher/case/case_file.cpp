#include "case/case_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <sstream>

#include "case/consistency.hpp"
#include "case/mesh_io.hpp"
#include "common/pending_file.hpp"
#include "mesh/faces.hpp"
#include "mesh/place_text.hpp"

namespace suffuse {

namespace {

constexpr FileKind case_file{"suffuse-case", "a case file", "suffuse-mesher", "suffuse-mesher", 2};
constexpr const char* solid_group = "/solid_points";
constexpr const char* liquid_group = "/liquid_points";
/// Tolerance for barycentric coordinates, which are sums and products of a few doubles.
constexpr double barycentric_tolerance = 1e-12;
/// Relative tolerance for the sum of the volumes of an element's points, up to a thousand doubles.
constexpr double volume_tolerance = 1e-9;

std::string boundary_group(std::size_t index) {
  return "/boundaries/" + std::to_string(index);
}

template <int Dim>
void write_boundaries(Hdf5File& file, const Mesh<Dim>& mesh) {
  file.create_group("/boundaries");
  for (std::size_t i = 0; i < mesh.boundaries.size(); ++i) {
    const std::string group = boundary_group(i);
    file.write_text(group + "/name", mesh.boundaries[i].name);
    file.write(group + "/faces", flattened<std::int32_t>(mesh.boundaries[i].faces),
               {mesh.boundaries[i].faces.size(), std::size_t{Dim}});
  }
}

template <int Dim>
void write_points(Hdf5File& file, const std::string& group, const MaterialPoints<Dim>& points) {
  const std::size_t count = points.element.size();
  file.write(group + "/element", std::span<const std::int32_t>(points.element), {count});
  file.write(group + "/barycentric", flattened<double>(points.barycentric),
             {count, std::size_t{Dim + 1}});
  file.attribute(group + "/barycentric", "unit", std::string("1"));
  file.write(group + "/volume", points.volume, {count});
  file.attribute(group + "/volume", "unit", std::string(Dim == 2 ? "m3/m" : "m3"));
}

void write_scene(Hdf5File& file, const SceneDocument& document) {
  file.write_text("/scene/text", document.text);
  file.write_text("/scene/path", document.path);
  if (!document.scene.initial_from.empty()) file.write_text("/scene/folder", document.folder);
  file.write_texts("/scene/overrides", document.overrides);
  if (document.files.empty()) return;
  std::vector<std::string> names;
  std::vector<std::string> texts;
  for (const auto& [name, text] : document.files) {
    names.push_back(name);
    texts.push_back(text);
  }
  file.write_texts("/scene/file_names", names);
  file.write_texts("/scene/file_texts", texts);
}

/// Reads one case file. Every error names the file.
template <int Dim>
class CaseReader : private ElementReader<Dim> {
 public:
  explicit CaseReader(const Hdf5File& file)
      : ElementReader<Dim>(file, "write the case file anew with suffuse-mesher") {}

  [[nodiscard]] Mesh<Dim> mesh() const {
    Mesh<Dim> mesh = this->read_elements();
    read_boundaries(mesh);
    return mesh;
  }

  [[nodiscard]] MaterialPoints<Dim> solid_points(const Mesh<Dim>& mesh, const Scene& scene) const {
    MaterialPoints<Dim> points = read_points(solid_group, mesh);
    for (int p = 0; p < points.size(); ++p) {
      const std::string& region = mesh.region_names[mesh.element_region[points.element[p]]];
      if (!scene.is_free_water(region)) continue;
      fail(std::string(solid_group) + "/element",
           "point " + std::to_string(p) + " lies in \"" + region + "\", which is free water");
    }
    check_volumes(solid_group, mesh, points, [&](int e) {
      const bool free = scene.is_free_water(mesh.region_names[mesh.element_region[e]]);
      return free ? 0.0 : element_volume(mesh, e);
    });
    return points;
  }

  [[nodiscard]] MaterialPoints<Dim> liquid_points(const Mesh<Dim>& mesh, const Scene& scene) const {
    const bool expected = scene.formulation == Formulation::double_point;
    if (!expected && file_.exists(liquid_group)) {
      fail(liquid_group, "the scene is single-point; expected no liquid points");
    }
    if (!expected) return {};
    MaterialPoints<Dim> points = read_points(liquid_group, mesh);
    check_volumes(liquid_group, mesh, points, [&](int e) {
      const Soil* soil = scene.find_soil(mesh.region_names[mesh.element_region[e]]);
      // n_0 is linear: its mean is its value at the centroid.
      const double porosity = soil ? soil->initial_porosity(element_centroid(mesh, e)) : 1.0;
      return porosity * element_volume(mesh, e);
    });
    return points;
  }

  /// The text of the scene is checked again: a version with other keys may have written it.
  [[nodiscard]] SceneDocument scene(const Mesh<Dim>& mesh) const {
    const std::string text = file_.read_text("/scene/text");
    const std::string path = file_.read_text("/scene/path");
    try {
      SceneDocument document =
          parse_scene(text, path, file_.read_texts("/scene/overrides"), scene_files());
      if (file_.exists("/scene/folder")) document.folder = file_.read_text("/scene/folder");
      complete_for_mesh(document, Dim);
      std::vector<InputProblem> problems = scene_problems(document, mesh);
      if (!problems.empty()) throw InputError(std::move(problems));
      return document;
    } catch (const InputError& error) {
      fail("/scene", std::string("the scene within is not valid:\n") + error.what() + "\n");
    }
  }

 private:
  using Base = ElementReader<Dim>;
  using Base::check_names;
  using Base::fail;
  using Base::file_;
  using Base::read_indices;

  /// Texts of the files that the scene names; without any the case has no such data sets.
  [[nodiscard]] std::map<std::string, std::string> scene_files() const {
    if (!file_.exists("/scene/file_names")) return {};
    const std::vector<std::string> names = file_.read_texts("/scene/file_names");
    const std::vector<std::string> texts = file_.read_texts("/scene/file_texts");
    if (names.size() != texts.size()) fail("/scene/file_texts", "expected one text per name");
    std::map<std::string, std::string> files;
    for (std::size_t i = 0; i < names.size(); ++i) files.emplace(names[i], texts[i]);
    return files;
  }

  void read_boundaries(Mesh<Dim>& mesh) const {
    const FaceTable<Dim> faces(mesh);
    const std::size_t count = file_.children("/boundaries").size();
    std::vector<std::string> names;
    for (std::size_t i = 0; i < count; ++i) {
      const std::string group = boundary_group(i);
      BoundarySet<Dim> set{file_.read_text(group + "/name"),
                           this->template read_rows<Dim>(group + "/faces", mesh.node_count())};
      for (const auto& face : set.faces) {
        if (faces.owners(face) != 1) {
          fail(group + "/faces", "a face of \"" + set.name + "\" is not an outer face of the mesh");
        }
      }
      names.push_back(set.name);
      mesh.boundaries.push_back(std::move(set));
    }
    check_names("/boundaries", names);
  }

  [[nodiscard]] MaterialPoints<Dim> read_points(const std::string& group,
                                                const Mesh<Dim>& mesh) const {
    const std::string barycentric = group + "/barycentric";
    MaterialPoints<Dim> points;
    points.element = read_indices(group + "/element", mesh.element_count());
    points.barycentric =
        this->template unflatten<Dim + 1>(barycentric, file_.read_doubles(barycentric));
    points.volume = file_.read_doubles(group + "/volume");
    const std::size_t count = points.element.size();
    if (points.barycentric.size() != count || points.volume.size() != count) {
      fail(group, "element, barycentric and volume differ in length");
    }
    if (!std::ranges::is_sorted(points.element)) {
      fail(group + "/element", "expected points sorted by element");
    }
    for (std::size_t p = 0; p < count; ++p) check_point(group, points, p);
    return points;
  }

  void check_point(const std::string& group, const MaterialPoints<Dim>& points,
                   std::size_t p) const {
    double sum = 0.0;
    bool inside = true;
    for (double share : points.barycentric[p]) {
      sum += share;
      inside = inside && share >= -barycentric_tolerance;
    }
    if (!inside || !(std::abs(sum - 1.0) <= barycentric_tolerance)) {
      fail(group + "/barycentric",
           "the coordinates of point " + std::to_string(p) + " do not lie in its element");
    }
    if (!(std::isfinite(points.volume[p]) && points.volume[p] > 0.0)) {
      fail(group + "/volume",
           "the volume of point " + std::to_string(p) + " is not positive and finite");
    }
  }

  /// Checks that the volumes of the points of each element add up to the volume that they
  /// represent: sums over points must equal sums over elements.
  template <class VolumeOf>
  void check_volumes(const std::string& group, const Mesh<Dim>& mesh,
                     const MaterialPoints<Dim>& points, const VolumeOf& volume_of) const {
    std::vector<double> sum(mesh.elements.size(), 0.0);
    for (int p = 0; p < points.size(); ++p) sum[points.element[p]] += points.volume[p];
    for (int e = 0; e < mesh.element_count(); ++e) {
      const double expected = volume_of(e);
      if (std::abs(sum[e] - expected) <= volume_tolerance * expected) continue;
      std::ostringstream message;
      message.precision(10);
      message << "the volumes of the points in element " << e << " at "
              << place_text<Dim>(element_centroid(mesh, e)) << " add up to " << sum[e]
              << " m3; expected " << expected;
      fail(group + "/volume", message.str());
    }
  }
};

}  // namespace

template <int Dim>
void write_case(const std::string& path, const Case<Dim>& c) {
  PendingFile pending(path);
  Hdf5File file(pending.temporary_path(), Hdf5File::Mode::create);
  write_header(file, case_file, Dim);
  write_elements(file, c.mesh);
  write_boundaries(file, c.mesh);
  write_points(file, solid_group, c.solid_points);
  if (c.document.scene.formulation == Formulation::double_point) {
    write_points(file, liquid_group, c.liquid_points);
  }
  write_scene(file, c.document);
  file.close();
  pending.commit();
}

template <int Dim>
Case<Dim> read_case(const std::string& path) {
  const Hdf5File file(path, Hdf5File::Mode::read);
  const int dimension = read_header(file, case_file);
  if (dimension != Dim) {
    throw FileError(path + ": is a case of dimension " + std::to_string(dimension) + "; expected " +
                    std::to_string(Dim));
  }
  const CaseReader<Dim> reader(file);
  Mesh<Dim> mesh = reader.mesh();
  SceneDocument document = reader.scene(mesh);
  MaterialPoints<Dim> solid = reader.solid_points(mesh, document.scene);
  MaterialPoints<Dim> liquid = reader.liquid_points(mesh, document.scene);
  return {std::move(document), std::move(mesh), std::move(solid), std::move(liquid)};
}

int read_case_dimension(const std::string& path) {
  return read_header(Hdf5File(path, Hdf5File::Mode::read), case_file);
}

template void write_case<2>(const std::string&, const Case<2>&);
template void write_case<3>(const std::string&, const Case<3>&);
template Case<2> read_case<2>(const std::string&);
template Case<3> read_case<3>(const std::string&);

}  // namespace suffuse
