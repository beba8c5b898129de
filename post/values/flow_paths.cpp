#include "values/flow_paths.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "mesh/faces.hpp"

namespace suffuse {
namespace {

constexpr int none = -1;

/// The elements on the other side of the faces opposite to the corners of each element.
std::vector<std::array<int, 4>> neighbours(const Mesh<3>& mesh) {
  struct Side {
    int element;
    int corner;
  };
  std::vector<std::array<int, 4>> result(mesh.elements.size(), {none, none, none, none});
  std::map<std::array<int, 3>, Side> open;
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (int corner = 0; corner < 4; ++corner) {
      const auto key = face_key<3>(face_opposite<3>(mesh.elements[e], corner));
      const auto [found, is_first] = open.try_emplace(key, Side{e, corner});
      if (is_first) continue;
      result[e].at(corner) = found->second.element;
      result[found->second.element].at(found->second.corner) = e;
      open.erase(found);
    }
  }
  return result;
}

class Tracer {
 public:
  Tracer(const Mesh<3>& mesh, const std::vector<double>& flux)
      : mesh_(mesh), flux_(flux), neighbours_(neighbours(mesh)) {}

  [[nodiscard]] FlowPaths trace(int count) const;

 private:
  /// An outer face through which liquid enters.
  struct Inlet {
    int element;
    int corner;  ///< opposite to the face
    double discharge;
  };

  [[nodiscard]] Vector<3> flux_of(int e) const {
    return {flux_[3UL * e], flux_[3UL * e + 1], flux_[3UL * e + 2]};
  }
  /// Normal of the face opposite to a corner, times its area, pointing out of the element.
  [[nodiscard]] Vector<3> outward(int e, int corner) const {
    const auto face = face_opposite<3>(mesh_.elements[e], corner);
    const Vector<3>& a = mesh_.nodes[face[0]];
    const Vector<3> normal = 0.5 * (mesh_.nodes[face[1]] - a).cross(mesh_.nodes[face[2]] - a);
    return normal.dot(mesh_.nodes[mesh_.elements[e][corner]] - a) > 0.0 ? Vector<3>(-normal)
                                                                        : normal;
  }
  [[nodiscard]] std::vector<Inlet> inlets() const;
  [[nodiscard]] FlowPath path_from(int element, const Vector<3>& place) const;

  const Mesh<3>& mesh_;
  const std::vector<double>& flux_;
  std::vector<std::array<int, 4>> neighbours_;
};

std::vector<Tracer::Inlet> Tracer::inlets() const {
  std::vector<Inlet> result;
  for (int e = 0; e < mesh_.element_count(); ++e) {
    for (int corner = 0; corner < 4; ++corner) {
      if (neighbours_[e].at(corner) != none) continue;
      const double discharge = -outward(e, corner).dot(flux_of(e));
      if (discharge > 0.0) result.push_back({e, corner, discharge});
    }
  }
  return result;
}

FlowPath Tracer::path_from(int element, const Vector<3>& place) const {
  FlowPath path{{place}, {}};
  std::vector<char> was_in(mesh_.elements.size(), 0);
  Vector<3> x = place;
  int came_from = none;
  for (int e = element; e != none && was_in[e] == 0;) {
    was_in[e] = 1;
    const Vector<3> flux = flux_of(e);
    // The path leaves by the first face that it reaches among those through which the flux leaves.
    double time = std::numeric_limits<double>::infinity();
    int leaves_by = none;
    for (int corner = 0; corner < 4; ++corner) {
      const int next = neighbours_[e].at(corner);
      const Vector<3> normal = outward(e, corner);
      const double speed = normal.dot(flux);
      if (speed <= 0.0 || (next != none && next == came_from)) continue;
      const int on_face = mesh_.elements[e][(corner + 1) % 4];
      const double needed = std::max(0.0, normal.dot(mesh_.nodes[on_face] - x) / speed);
      if (needed >= time) continue;
      time = needed;
      leaves_by = corner;
    }
    if (leaves_by == none) break;
    x += time * flux;
    path.places.push_back(x);
    path.elements.push_back(e);
    came_from = e;
    e = neighbours_[e].at(leaves_by);
  }
  return path;
}

FlowPaths Tracer::trace(int count) const {
  const std::vector<Inlet> all = inlets();
  FlowPaths result;
  for (const Inlet& inlet : all) result.discharge += inlet.discharge;
  // One path at the middle of each share of the discharge, in the order of the mesh, which keeps
  // neighbours together.
  double passed = 0.0;
  int begun = 0;
  for (const Inlet& inlet : all) {
    passed += inlet.discharge;
    const auto face = face_opposite<3>(mesh_.elements[inlet.element], inlet.corner);
    for (; begun < count && (begun + 0.5) * result.discharge <= passed * count; ++begun) {
      // Several paths on one face are spread evenly over it.
      const double u = std::fmod(0.5 + 0.7548776662466927 * begun, 1.0);
      const double v = std::fmod(0.5 + 0.5698402909980532 * begun, 1.0);
      const double root = std::sqrt(u);
      const Vector<3> place = (1.0 - root) * mesh_.nodes[face[0]] +
                              root * (1.0 - v) * mesh_.nodes[face[1]] +
                              root * v * mesh_.nodes[face[2]];
      result.paths.push_back(path_from(inlet.element, place));
    }
  }
  return result;
}

}  // namespace

FlowPaths flow_paths(const Mesh<3>& mesh, const std::vector<double>& flux, int count) {
  return Tracer(mesh, flux).trace(count);
}

}  // namespace suffuse
