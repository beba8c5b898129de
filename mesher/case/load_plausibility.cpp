#include <array>
#include <limits>
#include <map>
#include <set>

#include "case/plausibility_base.hpp"
#include "common/short_number.hpp"
#include "mesh/faces.hpp"
#include "mesh/place_text.hpp"

namespace suffuse {
namespace {

/// Depth of water on the ground, over the height of the model, from which on there is a warning.
constexpr double noticed_depth = 1e-2;

/// Water on soil that moves.
template <int Dim>
class WaterLoads : private PlausibilityBase<Dim> {
 public:
  using PlausibilityBase<Dim>::PlausibilityBase;

  std::vector<std::string> run() {
    if (!scene_.moves() || this->has_free_water() || !has_gravity(scene_.gravity)) return {};
    const std::vector<Ground> ground = ground_that_moves(Base::nearly_upright);
    for (const BoundaryCondition& b : scene_.boundaries) {
      check_pressure(b, ground);
      check_traction(b, ground);
    }
    check_bare_ground(ground_that_moves(-Base::nearly_upright));
    return std::move(warnings_);
  }

 private:
  using Face = std::array<int, Dim>;
  using Base = PlausibilityBase<Dim>;
  using Base::mesh_;
  using Base::scene_;
  using Base::warn;
  using Base::warnings_;

  /// An outer face on top of soil that moves, not of a wall or a well inside the mesh.
  struct Ground {
    Face face;  ///< as `face_key`
    Vector<Dim> centre;
  };

  [[nodiscard]] bool soil_moves(int element) const {
    const Soil* soil = scene_.find_soil(mesh_.region_names[mesh_.element_region[element]]);
    return soil && soil->skeleton.moves();
  }

  /// \param least_up  upward part of the unit normals; below 0 for upright faces too
  [[nodiscard]] std::vector<Ground> ground_that_moves(double least_up) const {
    const FaceTable<Dim> faces(mesh_);
    const Vector<Dim> up = -Eigen::Map<const Vector<Dim>>(scene_.gravity.data()).normalized();
    std::set<Face> of_slits;
    for (const std::string& name : scene_.names_of_slits()) of_slits.merge(faces_of(name));
    std::vector<Ground> ground;
    for (int e = 0; e < mesh_.element_count(); ++e) {
      for (int a = 0; a <= Dim && soil_moves(e); ++a) {
        const Face face = face_opposite<Dim>(mesh_.elements[e], a);
        if (faces.owners(face) != 1 || of_slits.contains(face_key<Dim>(face))) continue;
        Vector<Dim> centre = Vector<Dim>::Zero();
        for (const int i : face) centre += mesh_.nodes[i] / Dim;
        Vector<Dim> normal = face_normal<Dim>(mesh_, face).normalized();
        if (normal.dot(element_centroid(mesh_, e) - centre) > 0.0) normal = -normal;
        if (normal.dot(up) < least_up) continue;
        ground.push_back({face_key<Dim>(face), centre});
      }
    }
    return ground;
  }

  /// The faces with a name, as `face_key`.
  [[nodiscard]] std::set<Face> faces_of(const std::string& name) const {
    std::set<Face> faces;
    for (const BoundarySet<Dim>& set : mesh_.boundaries) {
      for (const Face& face : set.faces) {
        if (set.name == name) faces.insert(face_key<Dim>(face));
      }
    }
    return faces;
  }

  /// A pressure of the pores is no load: water that stands on soil has a head.
  void check_pressure(const BoundaryCondition& b, const std::vector<Ground>& ground) {
    if (!b.pressure || b.traction || b.fix != Fixing::none) return;
    const auto [low, high] = b.pressure->range(0.0, scene_.time.end);
    if (high <= 0.0) return;
    const std::set<Face> faces = faces_of(b.on);
    if (std::ranges::none_of(ground, [&](const Ground& g) { return faces.contains(g.face); })) {
      return;
    }
    warn(joined(b.key, "pressure"),
         "presses on the water in the pores alone, not on the soil, which moves; water that stands "
         "on it has a head, other loads are a traction");
  }

  /// A traction holds the pressure of the water too, which it takes the place of.
  void check_traction(const BoundaryCondition& b, const std::vector<Ground>& ground) {
    if (!b.head || !b.traction || b.fix != Fixing::none) return;
    const auto down = Eigen::Map<const Vector<Dim>>(scene_.gravity.data()).normalized();
    double load = 0.0;
    for (const auto& [time, components] : b.traction->knots) {
      load = std::max(load, Eigen::Map<const Vector<Dim>>(components.data()).dot(down));
    }
    const double head = b.head->range(0.0, scene_.time.end).second;
    const std::set<Face> faces = faces_of(b.on);
    for (const Ground& g : ground) {
      const double depth = head - height(g.centre, scene_.gravity);
      const double pressure = unit_weight(scene_.liquid.density, scene_.gravity) * depth;
      if (!faces.contains(g.face) || depth <= noticed_depth * this->height_of_model()) continue;
      if (load >= pressure) continue;
      warn(joined(b.key, "traction"),
           "takes the place of the pressure of the water, which stands " + short_number(depth) +
               " m high on the ground at " + place_text<Dim>(g.centre) + " and presses with " +
               short_number(pressure) + " Pa there; a traction has to hold that pressure too");
      return;
    }
  }

  /// Water above ground without a boundary: up to the level at the start, and to the heads of
  /// boundaries beside it.
  void check_bare_ground(const std::vector<Ground>& ground) {
    std::set<Face> known;
    std::map<int, double> head_at;  // of the nodes of boundaries
    for (const BoundaryCondition& b : scene_.boundaries) {
      for (const Face& face : faces_of(b.on)) {
        known.insert(face);
        if (!b.head || b.is_well()) continue;
        const double head = b.head->range(0.0, scene_.time.end).second;
        for (const int i : face) {
          double& highest = head_at.try_emplace(i, head).first->second;
          highest = std::max(highest, head);
        }
      }
    }
    double depth = noticed_depth * this->height_of_model();
    const Ground* deepest = nullptr;
    for (const Ground& g : ground) {
      if (known.contains(g.face)) continue;
      double level = scene_.water_level.value_or(-std::numeric_limits<double>::infinity());
      for (const int i : g.face) {
        if (const auto found = head_at.find(i); found != head_at.end()) {
          level = std::max(level, found->second);
        }
      }
      const double above = level - height(g.centre, scene_.gravity);
      if (above <= depth) continue;
      depth = above;
      deepest = &g;
    }
    if (!deepest) return;
    warn("boundary", "none on the ground at " + place_text<Dim>(deepest->centre) +
                         ", above which water stands " + short_number(depth) +
                         " m high: it does not press on the soil there, which moves; a boundary "
                         "with its head does so");
  }
};

}  // namespace

template <int Dim>
std::vector<std::string> load_warnings(const SceneDocument& document, const Mesh<Dim>& mesh) {
  return WaterLoads<Dim>(document, mesh).run();
}

template std::vector<std::string> load_warnings(const SceneDocument&, const Mesh<2>&);
template std::vector<std::string> load_warnings(const SceneDocument&, const Mesh<3>&);

}  // namespace suffuse
