#include "summary.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <iomanip>
#include <sstream>

#include "case/free_space.hpp"

namespace suffuse {

namespace {

/// Below this angle steps are small and interpolation is poor, degrees.
constexpr double poor_angle = 5.0;

struct Line {
  std::string label;
  std::string value;
};

std::string number(double value, const std::string& unit) {
  std::ostringstream text;
  text << value << ' ' << unit;
  return text.str();
}

template <int Dim>
double region_volume(const Mesh<Dim>& mesh, std::size_t region) {
  double volume = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (mesh.element_region[e] == static_cast<int>(region)) volume += element_volume(mesh, e);
  }
  return volume;
}

/// Number of points, and that per element: `400 (12 to 40 per element)`.
template <int Dim>
std::string liquid_counts(const Mesh<Dim>& mesh, const MaterialPoints<Dim>& points) {
  std::vector<int> counts(mesh.elements.size(), 0);
  for (const int element : points.element) ++counts[static_cast<std::size_t>(element)];
  const auto [least, most] = std::ranges::minmax(counts);
  const std::string range =
      std::to_string(least) + (most > least ? " to " + std::to_string(most) : "") + " per element";
  return std::to_string(points.size()) + " (" + range + ")";
}

template <int Dim>
double boundary_size(const Mesh<Dim>& mesh, const BoundarySet<Dim>& set) {
  double size = 0.0;
  for (const auto& face : set.faces) {
    const Vector<Dim> along = mesh.nodes[face[1]] - mesh.nodes[face[0]];
    if constexpr (Dim == 2) {
      size += along.norm();
    } else {
      size += 0.5 * along.cross(mesh.nodes[face[2]] - mesh.nodes[face[0]]).norm();
    }
  }
  return size;
}

/// The median length of the elements' edges, in addition to the size that the scene asks for.
template <int Dim>
std::string edge_text(const Mesh<Dim>& mesh, const SceneDocument& document) {
  std::vector<double> lengths;
  lengths.reserve(mesh.elements.size() * Dim * (Dim + 1) / 2);
  for (const auto& corners : mesh.elements) {
    for (int a = 0; a <= Dim; ++a) {
      for (int b = a + 1; b <= Dim; ++b) {
        lengths.push_back((mesh.nodes[corners[b]] - mesh.nodes[corners[a]]).norm());
      }
    }
  }
  const auto middle = lengths.begin() + std::ssize(lengths) / 2;
  std::ranges::nth_element(lengths, middle);
  std::ostringstream text;
  text << std::setprecision(3) << *middle << " m";
  if (document.where.contains("mesh.size")) {
    text << "; mesh.size is " << document.scene.mesh.size << " m";
  }
  return text.str();
}

}  // namespace

template <int Dim>
std::string case_summary(const Case<Dim>& c, const std::vector<std::string>& notes) {
  const Mesh<Dim>& mesh = c.mesh;
  std::vector<Line> lines{{"elements", std::to_string(mesh.element_count())},
                          {"nodes", std::to_string(mesh.node_count())},
                          {"solid points", std::to_string(c.solid_points.size())}};
  if (c.liquid_points.size() > 0) {
    lines.push_back({"liquid points", liquid_counts(mesh, c.liquid_points)});
  }
  lines.push_back({"median edge", edge_text(mesh, c.document)});
  lines.push_back({"smallest angle", number(smallest_angle(mesh), "degrees")});
  for (std::size_t r = 0; r < mesh.region_names.size(); ++r) {
    const std::string& region = mesh.region_names[r];
    const std::string free = free_space_text(mesh, c.document.scene, static_cast<int>(r));
    lines.push_back({"region " + region, number(region_volume(mesh, r), Dim == 2 ? "m2" : "m3") +
                                             (free.empty() ? "" : ", ") + free});
  }
  for (const BoundarySet<Dim>& set : mesh.boundaries) {
    lines.push_back(
        {"boundary " + set.name, number(boundary_size(mesh, set), Dim == 2 ? "m" : "m2")});
  }
  std::size_t width = 0;
  for (const Line& line : lines) width = std::max(width, line.label.size());
  std::ostringstream text;
  for (const Line& line : lines) {
    text << "  " << std::left << std::setw(static_cast<int>(width) + 2) << line.label << line.value
         << '\n';
  }
  for (const std::string& note : notes) text << "  note: " << note << '\n';
  return text.str();
}

template <int Dim>
std::string angle_warning(const Mesh<Dim>& mesh) {
  const double angle = smallest_angle(mesh);
  if (angle >= poor_angle) return "";
  return "the smallest angle is " + number(angle, "degrees") +
         "; below 5 degrees steps are short and results poor: change the geometry or mesh.size" +
         (Dim == 3 ? ", or take Gmsh's HXT (Mesh.Algorithm3D = 10 in the geometry file), which "
                     "makes another mesh each time: keep the case file for later stages"
                   : "");
}

template std::string case_summary(const Case<2>&, const std::vector<std::string>&);
template std::string case_summary(const Case<3>&, const std::vector<std::string>&);
template std::string angle_warning(const Mesh<2>&);
template std::string angle_warning(const Mesh<3>&);

}  // namespace suffuse
