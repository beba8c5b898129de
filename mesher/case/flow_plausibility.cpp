#include <cmath>
#include <limits>

#include "case/plausibility_base.hpp"
#include "common/short_number.hpp"
#include "mesh/faces.hpp"

namespace suffuse {
namespace {

// Limits within which there is no warning.
/// Largest height of a head above the model, in model heights and in m; the larger one applies.
constexpr double farthest_head = 3.0;
constexpr double least_far_head = 30.0;
/// m/s, which are 3.6 m/h; the heaviest rain ever measured had 0.6e-3 m/s.
constexpr double heaviest_rain = 1e-3;
/// Hydraulic gradient.
constexpr double steepest = 100.0;
/// Least ratio of a pressure to the pressure under water as high as the model. It is checked if the
/// latter is more than `noticed` Pa.
constexpr double least_pressure = 2e-3;
constexpr double noticed = 1e3;
/// Round-off of heads and heights, in model heights.
constexpr double level_margin = 1e-6;
/// Upward part of the unit normal of faces that rise by 5 degrees.
constexpr double nearly_level = 0.996;

template <int Dim>
class Flow : private PlausibilityBase<Dim> {
 public:
  using PlausibilityBase<Dim>::PlausibilityBase;

  std::vector<std::string> run() {
    check_sideways();
    check_missing_gravity();
    if (scene_.water_level && given("initial.water_level")) {
      check_head("initial.water_level", *scene_.water_level);
    }
    for (const BoundaryCondition& boundary : scene_.boundaries) check_boundary(boundary);
    if (!check_low_heads()) {
      for (const BoundaryCondition& boundary : scene_.boundaries) check_low_head(boundary);
    }
    return std::move(warnings_);
  }

 private:
  using Base = PlausibilityBase<Dim>;
  using Base::given;
  using Base::mesh_;
  using Base::scene_;
  using Base::warn;
  using Base::warnings_;
  using Base::z;

  /// The key that gives the head of a boundary.
  [[nodiscard]] std::string head_key(const BoundaryCondition& b) const {
    return joined(b.key, given(joined(b.key, "file")) ? "file" : "head");
  }
  /// Longest distance of a head from a model of this size that is usual, m.
  [[nodiscard]] static double usual_distance(double size) {
    return std::max(farthest_head * size, least_far_head);
  }

  [[nodiscard]] bool has_heads() const {
    return std::ranges::any_of(scene_.boundaries, [](const auto& b) { return b.head.has_value(); });
  }

  /// Whether the run has to find the free surface of the water.
  [[nodiscard]] bool has_free_surface() const {
    return std::ranges::any_of(scene_.soils, &Soil::drains) ||
           std::ranges::any_of(scene_.boundaries,
                               [](const auto& b) { return b.seepage_face || b.rain; });
  }

  void check_sideways() {
    if (!has_heads() && !has_free_surface() && !scene_.moves()) return;
    const double across =
        Dim == 2 ? std::abs(scene_.gravity[0]) : std::hypot(scene_.gravity[0], scene_.gravity[1]);
    if (across <= std::abs(scene_.gravity[Dim - 1])) return;
    std::vector<double> g(scene_.gravity.begin(), scene_.gravity.begin() + Dim);
    std::string text = shown_value(g) + " points sideways, more across " + (Dim == 2 ? "y" : "z") +
                       " than along it";
    g.assign(Dim, 0.0);
    g.back() = -9.81;
    warn("gravity", text + "; " + shown_value(g) + " is usual");
  }

  void check_missing_gravity() {
    if (given("gravity")) return;
    for (const BoundaryCondition& b : scene_.boundaries) {
      if (!b.head) continue;
      warn(head_key(b),
           std::string("a head without gravity is a pressure in excess of the hydrostatic one; ") +
               (Dim == 2 ? "gravity = [0.0, -9.81] is usual, and gravity = [0.0, 0.0]"
                         : "gravity = [0.0, 0.0, -9.81] is usual, and gravity = [0.0, 0.0, 0.0]") +
               " says that there is none");
      return;
    }
  }

  void check_boundary(const BoundaryCondition& b) {
    const double end = scene_.time.end;
    if (b.head) {
      check_head(head_key(b), b.head->range(0.0, end).second);
      check_crest(b);
    }
    if (b.rain) check_rain(joined(b.key, "rain"), b.rain->range(0.0, end).second);
    const auto largest = [end](const TimeFunction& value) {
      const auto [low, high] = value.range(0.0, end);
      return std::max(std::abs(low), std::abs(high));
    };
    if (b.pressure) check_pressure(joined(b.key, "pressure"), largest(*b.pressure));
    if (b.darcy_flux) check_flux(joined(b.key, "darcy_flux"), largest(*b.darcy_flux), false);
    if (b.velocity) check_flux(joined(b.key, "velocity"), largest(*b.velocity), true);
  }

  /// Without gravity a head is compared with 0, and with the largest length of the model instead of
  /// its height. Heads below: `check_low_heads` and `check_low_head`.
  void check_head(const std::string& key, double head) {
    const bool falls = has_gravity(scene_.gravity);
    const auto [low, high] = falls ? this->heights() : std::pair(0.0, 0.0);
    const double size = falls ? high - low : extent(mesh_).maxCoeff();
    const double usual = usual_distance(size);
    if (head - high <= usual) return;
    const std::string model =
        falls ? "the model lies between " + short_number(low) + " and " + short_number(high) + " m"
              : "the model is " + short_number(size) + " m long";
    warn(key, short_number(head) + " m, and " + model + "; up to " + short_number(usual) +
                  " m above it are usual");
  }

  /// Heads that all lie far below the model leave it dry: their datum is probably another one.
  /// Returns whether there is a warning of it.
  bool check_low_heads() {
    if (!has_gravity(scene_.gravity)) return false;
    const BoundaryCondition* highest = nullptr;
    double head = -std::numeric_limits<double>::infinity();
    for (const BoundaryCondition& b : scene_.boundaries) {
      if (!b.head || b.head->range(0.0, scene_.time.end).second <= head) continue;
      highest = &b;
      head = b.head->range(0.0, scene_.time.end).second;
    }
    const auto [low, high] = this->heights();
    if (!highest || low - head <= usual_distance(high - low)) return false;
    warn(head_key(*highest), short_number(head) +
                                 " m, the highest head, and the model lies between " +
                                 short_number(low) + " and " + short_number(high) +
                                 " m: no water reaches it. Are heads and heights of one datum?");
    return true;
  }

  /// A head that stays below its boundary or well prescribes no pressure there: what holds above
  /// its level holds everywhere. The level of a reservoir may rise.
  void check_low_head(const BoundaryCondition& b) {
    const auto found = std::ranges::find(mesh_.boundaries, b.on, &BoundarySet<Dim>::name);
    if (!b.head || b.is_reservoir() || b.dry == DryPart::suction || !has_gravity(scene_.gravity) ||
        found == mesh_.boundaries.end()) {
      return;
    }
    double lowest = std::numeric_limits<double>::infinity();
    for (const auto& face : found->faces) {
      for (const int node : face) lowest = std::min(lowest, z(node));
    }
    const double head = b.head->range(0.0, scene_.time.end).second;
    if (head >= lowest - level_margin * this->height_of_model()) return;
    warn(head_key(b),
         (b.head->is_constant() ? "" : "at most ") + short_number(head) +
             " m, and the lowest point of " + shown_value(b.on) + " is at " + short_number(lowest) +
             " m: no water stands there, and " +
             (b.dry == DryPart::impervious ? "none crosses it" : "it acts as a seepage face") +
             ". Are heads and heights of one datum?" +
             (b.is_well() ? "" : " A suction takes dry = \"suction\""));
  }

  /// Water that stands on a slope and is higher than the model would flow over it, to where water
  /// seeps out.
  void check_crest(const BoundaryCondition& b) {
    const auto seeps = [](const BoundaryCondition& other) { return other.seepage_face; };
    if (!has_gravity(scene_.gravity) || this->has_free_water() || !is_slope(b.on) ||
        std::ranges::none_of(scene_.boundaries, seeps)) {
      return;
    }
    const double head = b.head->range(0.0, scene_.time.end).second;
    const double crest = this->heights().second;
    if (head <= crest + level_margin * this->height_of_model()) return;
    warn(head_key(b), short_number(head) + " m, and the highest ground is at " +
                          short_number(crest) +
                          " m: water would flow over it, which no result takes into account");
  }

  /// Whether a boundary has a face that is neither level nor upright.
  [[nodiscard]] bool is_slope(const std::string& boundary) const {
    const auto found = std::ranges::find(mesh_.boundaries, boundary, &BoundarySet<Dim>::name);
    if (found == mesh_.boundaries.end()) return false;
    const Vector<Dim> up = -Eigen::Map<const Vector<Dim>>(scene_.gravity.data()).normalized();
    return std::ranges::any_of(found->faces, [&](const auto& face) {
      const double upward = std::abs(face_normal<Dim>(mesh_, face).normalized().dot(up));
      return upward > Base::nearly_upright && upward < nearly_level;
    });
  }

  void check_rain(const std::string& key, double rain) {
    double fastest = 0.0;
    for (const Soil& soil : scene_.soils) fastest = std::max(fastest, soil.conductivity);
    if (rain <= heaviest_rain || rain <= fastest) return;
    warn(key, short_number(rain) + " m/s, and no soil conducts more than " + short_number(fastest) +
                  " m/s; at most " + short_number(heaviest_rain) +
                  " is usual: 1 mm/h is 2.8e-7 m/s");
  }

  /// \param speed     of the liquid across a boundary, m/s
  /// \param in_pores  it is that in the pores, not the volume per area
  void check_flux(const std::string& key, double speed, bool in_pores) {
    double gradient = std::numeric_limits<double>::infinity();
    for (const Soil& soil : scene_.soils) {
      const double flux = in_pores ? soil.porosity * speed : speed;
      gradient = std::min(gradient, flux / (soil.conductivity * std::max(1.0, soil.anisotropy())));
    }
    if (scene_.soils.empty() || gradient <= steepest) return;
    warn(key, short_number(speed) + " m/s takes a gradient of at least " + short_number(gradient) +
                  " in every soil; up to " + short_number(steepest) + " is usual");
  }

  void check_pressure(const std::string& key, double pressure) {
    if (!has_gravity(scene_.gravity) || pressure == 0.0) return;
    const double water =
        unit_weight(scene_.liquid.density, scene_.gravity) * this->height_of_model();
    if (water <= noticed || pressure >= least_pressure * water) return;
    warn(key, short_number(pressure) + " Pa, and water as high as the model has " +
                  short_number(water) + " Pa; pressures are in Pa, 1 kPa = 1e3 Pa");
  }
};

}  // namespace

template <int Dim>
std::vector<std::string> flow_warnings(const SceneDocument& document, const Mesh<Dim>& mesh) {
  return Flow<Dim>(document, mesh).run();
}

template std::vector<std::string> flow_warnings(const SceneDocument&, const Mesh<2>&);
template std::vector<std::string> flow_warnings(const SceneDocument&, const Mesh<3>&);

}  // namespace suffuse
