#include "figures/slip_figure.hpp"

#include <algorithm>
#include <limits>

#include "common/errors.hpp"
#include "common/hdf5_io.hpp"
#include "figures/field_picture.hpp"
#include "files/layout.hpp"
#include "files/number_text.hpp"
#include "files/time_unit.hpp"
#include "results/vtkhdf.hpp"

namespace suffuse {
namespace {

constexpr const char* at_cells = "/VTKHDF/CellData";
constexpr int shown_digits = 4;

/// What `--mechanism` writes.
struct Mechanism {
  Mesh<2> mesh;
  std::vector<double> shear;   ///< per element, 1/m
  std::vector<double> motion;  ///< two components per node, over the largest
  std::vector<bool> air;       ///< per element: whether it holds no soil
  double factor = 0.0;
  double time = 0.0;  ///< s
};

[[noreturn]] void refuse_file(const std::string& path) {
  throw FileError(path +
                  ": is not a file of suffuse-solver --strength-reduction --mechanism, or damaged");
}

Mesh<2> read_mesh(const Hdf5File& file) {
  const std::vector<double> points = file.read_doubles("/VTKHDF/Points");
  const std::vector<std::int64_t> corners = file.read_integers("/VTKHDF/Connectivity");
  const auto nodes = static_cast<std::int64_t>(points.size() / 3);
  const std::size_t elements = file.shape("/VTKHDF/Types").at(0);
  if (corners.size() == 4 * elements) {
    throw InputError(InputProblem{"suffuse-post figure slip", "FILE",
                                  file.path() + ", a mechanism in space",
                                  "one of a plane model; ParaView shows those in space"});
  }
  const bool is_inside =
      std::ranges::all_of(corners, [&](std::int64_t node) { return node >= 0 && node < nodes; });
  if (corners.size() != 3 * elements || !is_inside) refuse_file(file.path());
  Mesh<2> mesh;
  for (std::size_t i = 0; i + 2 < points.size(); i += 3) {
    mesh.nodes.emplace_back(points[i], points[i + 1]);
  }
  for (std::size_t k = 0; k < corners.size(); k += 3) {
    mesh.elements.push_back({static_cast<int>(corners[k]), static_cast<int>(corners[k + 1]),
                             static_cast<int>(corners[k + 2])});
  }
  for (const double region : read_field(file, at_cells, "region").values) {
    mesh.element_region.push_back(static_cast<int>(region));
  }
  mesh.region_names = file.read_texts(layout::region_names);
  return mesh;
}

Mechanism read_mechanism(const std::string& path) {
  const Hdf5File file(path, Hdf5File::Mode::read);
  if (!file.exists("/VTKHDF/PointData/mechanism") || !file.exists(layout::region_names)) {
    refuse_file(path);
  }
  Mechanism found;
  found.mesh = read_mesh(file);
  found.shear = read_field(file, at_cells, "mechanism_shear").values;
  found.motion = read_field(file, "/VTKHDF/PointData", "mechanism").values;
  for (const double soil : read_field(file, at_cells, "soil").values) {
    found.air.push_back(soil == 0.0);
  }
  const std::string about = layout::field_data_group;
  const std::vector<double> factor = file.read_doubles(about + "/factor");
  const std::vector<double> time = file.read_doubles(about + "/t");
  const std::size_t elements = found.mesh.elements.size();
  const auto regions = static_cast<int>(found.mesh.region_names.size());
  const bool has_regions = std::ranges::all_of(
      found.mesh.element_region, [&](int region) { return region >= 0 && region < regions; });
  if (found.shear.size() != elements || found.air.size() != elements ||
      found.mesh.element_region.size() != elements || !has_regions ||
      found.motion.size() != 2 * found.mesh.nodes.size() || factor.size() != 1 ||
      time.size() != 1) {
    refuse_file(path);
  }
  found.factor = factor[0];
  found.time = time[0];
  return found;
}

/// Per region: whether no element of it holds soil.
std::vector<bool> regions_without_soil(const Mechanism& found) {
  std::vector<bool> open(found.mesh.region_names.size(), true);
  for (std::size_t e = 0; e < found.air.size(); ++e) {
    if (!found.air[e]) open[found.mesh.element_region[e]] = false;
  }
  return open;
}

FieldPicture picture_of(const Mechanism& found) {
  constexpr double endless = std::numeric_limits<double>::infinity();
  FieldPicture picture;
  picture.title = "Slip at the factor of safety " + digits_text(found.factor, shown_digits);
  if (found.time > 0.0) picture.title += ", " + time_words(found.time, found.time, endless);
  picture.label = "shear strain over the largest motion (1/m)";
  picture.where = "cell";
  picture.values = found.shear;
  picture.air = found.air;
  picture.arrow_label = "motion";
  picture.arrow_unit = "of the largest";
  std::vector<WeightedValue> values;
  for (int e = 0; e < found.mesh.element_count(); ++e) {
    Vector<2> mean = Vector<2>::Zero();
    for (const int node : found.mesh.elements[e]) {
      mean += Eigen::Map<const Vector<2>>(&found.motion[2 * static_cast<std::size_t>(node)]) / 3.0;
    }
    if (found.air[e]) mean.setZero();
    picture.arrows.insert(picture.arrows.end(), {mean[0], mean[1]});
    if (!found.air[e]) values.push_back({found.shear[e], element_volume(found.mesh, e)});
  }
  picture.scale = value_scale(std::move(values), {});
  picture.scale.range[0] = 0.0;
  return picture;
}

}  // namespace

void draw_slip(const std::string& file, const std::string& path) {
  const Mechanism found = read_mechanism(file);
  draw_field_picture(picture_model(found.mesh, std::nullopt, regions_without_soil(found)),
                     picture_of(found), path);
}

}  // namespace suffuse
