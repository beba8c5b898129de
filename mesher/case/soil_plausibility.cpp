#include <cmath>

#include "case/plausibility_base.hpp"
#include "common/short_number.hpp"
#include "physics/skeleton/skeleton_law.hpp"
#include "scene/grading_checks.hpp"

namespace suffuse {
namespace {

// Limits within which there is no warning.
/// The largest ratio of a conductivity to that of Hazen's rule, k = 0.01 d10^2 with d10 in mm and k
/// in m/s. Sizes in m make the ratio a million.
constexpr double most_over_hazen = 1e3;
constexpr double least_friction = 1.5;   // degrees; 1.5 radians are 86 degrees
constexpr double least_cohesion = 50.0;  // Pa
constexpr double noticed_stress = 1e4;   // Pa; a cohesion of a few Pa has no effect at more
constexpr double most_strain = 0.5;      // the largest stress over the modulus

template <int Dim>
class Soils : private PlausibilityBase<Dim> {
 public:
  using PlausibilityBase<Dim>::PlausibilityBase;

  std::vector<std::string> run() {
    const double stress = largest_stress();
    for (const Soil& soil : scene_.soils) {
      check_sizes(soil);
      check_fines(soil);
      check_friction(soil);
      check_cohesion(soil, stress);
      check_stiffness(soil, stress);
      check_earth_pressure(soil);
    }
    for (const BoundaryCondition& boundary : scene_.boundaries) {
      check_loaded_soil(boundary);
      check_traction(boundary);
    }
    return std::move(warnings_);
  }

 private:
  using Base = PlausibilityBase<Dim>;
  using Base::given;
  using Base::mesh_;
  using Base::scene_;
  using Base::table_of;
  using Base::warn;
  using Base::warnings_;

  void check_sizes(const Soil& soil) {
    if (soil.gradation.empty()) return;
    constexpr double tenth = 10.0;
    // Below the first point of the gradation sizes are unknown: d10 is at most the smallest size.
    const double d10 = soil.gradation.smallest_finer() <= tenth ? soil.gradation.size(tenth)
                                                                : soil.gradation.smallest_size();
    const double hazen = 0.01 * d10 * d10;
    if (soil.conductivity <= most_over_hazen * hazen) return;
    warn(joined(table_of(soil), "gradation"),
         "d10 = " + short_number(d10) + " mm, of which a conductivity of some " +
             short_number(hazen) + " m/s is usual, and the soil has " +
             short_number(soil.conductivity) + "; sizes are in mm, not in m");
  }

  /// Checks only a given `skeleton_fraction`; for one from a gradation the check of gradations
  /// warns.
  void check_fines(const Soil& soil) {
    const std::string key = joined(table_of(soil), "skeleton_fraction");
    if (!soil.erosion.law->erodes() || !given(key)) return;
    const double fines = 100.0 * (soil.porosity_max() - soil.porosity) / (1.0 - soil.porosity);
    if (fines <= load_bearing_fines) return;
    warn(key, percent_text(fines) +
                  " of the solid is fines, 1 - n_C/(1 - n_0), which erode; up to " +
                  percent_text(load_bearing_fines) +
                  " are usual: more of them carry load, and are not fines between coarse grains");
  }

  void check_friction(const Soil& soil) {
    double friction = 0.0;
    for (const auto& [share, value] : soil.skeleton.friction.pairs) {
      friction = std::max(friction, value);
    }
    if (friction == 0.0 || friction >= least_friction) return;
    warn(joined(joined(table_of(soil), "skeleton"), "friction"),
         short_number(friction) +
             " degrees; sand has 30 and more. Angles are in degrees, not in "
             "radians");
  }

  /// The largest stress that the weight of the soil and the tractions make, Pa.
  [[nodiscard]] double largest_stress() const {
    double heaviest = 0.0;
    for (const Soil& soil : scene_.soils) {
      heaviest = std::max(heaviest, soil.porosity * scene_.liquid.density +
                                        (1.0 - soil.porosity) * soil.grain_density);
    }
    double stress = heaviest * acceleration(scene_.gravity) * this->height_of_model();
    for (const BoundaryCondition& b : scene_.boundaries) {
      if (!b.traction) continue;
      for (const auto& [time, load] : b.traction->knots) {
        stress = std::max(stress, std::hypot(load[0], load[1], load[2]));
      }
    }
    return stress;
  }

  void check_cohesion(const Soil& soil, double stress) {
    double cohesion = 0.0;
    for (const auto& [share, value] : soil.skeleton.cohesion.pairs) {
      cohesion = std::max(cohesion, value);
    }
    if (cohesion == 0.0 || cohesion >= least_cohesion || stress <= noticed_stress) return;
    warn(joined(joined(table_of(soil), "skeleton"), "cohesion"),
         short_number(cohesion) + " Pa, and stresses reach some " +
             short_number(std::round(stress / 1e3)) +
             " kPa; cohesions are in Pa, 1 kPa = 1e3 Pa, and 0 is none");
  }

  void check_stiffness(const Soil& soil, double stress) {
    const std::string key = joined(joined(table_of(soil), "skeleton"), "young");
    if (!soil.skeleton.moves() || !given(key)) return;
    const double young = soil.skeleton.at(1.0).young;
    if (stress <= most_strain * young) return;
    warn(key, short_number(young) + " Pa, and stresses reach some " +
                  short_number(std::stod(three_digits(stress))) +
                  " Pa, which would press the soil together; moduli are in Pa, 1 MPa = 1e6 Pa");
  }

  /// Warns of a K_0 that soil without cohesion cannot have.
  void check_earth_pressure(const Soil& soil) {
    if (!scene_.earth_pressure || !soil.skeleton.moves()) return;
    const SkeletonParameters skeleton = soil.skeleton.at(1.0);
    if (skeleton.friction == 0.0 || skeleton.cohesion > 0.0) return;
    const double active = (1.0 - std::sin(skeleton.friction)) / (1.0 + std::sin(skeleton.friction));
    const double ratio = *scene_.earth_pressure;
    if (ratio >= active && ratio <= 1.0 / active) return;
    warn("initial.stress",
         "K_0 = " + short_number(ratio) + ", and soil \"" + soil.region + "\" yields outside of " +
             short_number(std::stod(three_digits(active))) + " to " +
             short_number(std::stod(three_digits(1.0 / active))) +
             " (Rankine), from the active to the passive earth pressure: it starts at the limit, "
             "or has no equilibrium");
  }

  /// 1/c_v, mean over the soil that moves, s/m2.
  [[nodiscard]] double consolidation() const {
    double sum = 0.0;
    double volume = 0.0;
    for (int e = 0; e < mesh_.element_count(); ++e) {
      const Soil* soil = scene_.find_soil(mesh_.region_names[mesh_.element_region[e]]);
      if (!soil || !soil->skeleton.moves()) continue;
      const double part = element_volume(mesh_, e);
      const double conductivity =
          std::isnan(soil->conductivity_across) ? soil->conductivity : soil->conductivity_across;
      const double storage = 1.0 / soil->skeleton.at(1.0).oedometer_modulus() +
                             soil->porosity / scene_.liquid.bulk_modulus;
      sum += part * unit_weight(scene_.liquid.density, scene_.gravity) * storage / conductivity;
      volume += part;
    }
    return volume > 0.0 ? sum / volume : 0.0;
  }

  /// Warns of a traction beside regions without a soil alone.
  void check_loaded_soil(const BoundaryCondition& b) {
    if (!b.traction) return;
    const auto set = std::ranges::find(mesh_.boundaries, b.on, &BoundarySet<Dim>::name);
    if (set == mesh_.boundaries.end()) return;
    std::vector<char> of_soil(mesh_.nodes.size(), 0);
    for (int e = 0; e < mesh_.element_count(); ++e) {
      if (!scene_.find_soil(mesh_.region_names[mesh_.element_region[e]])) continue;
      for (const int node : mesh_.elements[e]) of_soil[node] = 1;
    }
    const auto is_loaded = [&](const auto& face) {
      return std::ranges::all_of(face, [&](int node) { return of_soil[node] != 0; });
    };
    if (std::ranges::any_of(set->faces, is_loaded)) return;
    warn(joined(b.key, "traction"),
         "\"" + b.on + "\" lies along no soil: the load acts on nothing");
  }

  /// Warns of a traction given as a number, which acts from the start, when the soil is in
  /// equilibrium and its water at rest.
  void check_traction(const BoundaryCondition& b) {
    const bool is_number = b.traction && b.traction->knots.size() == 1;
    if (!is_number || !scene_.initial_from.empty()) return;
    const auto& load = b.traction->knots.front().second;
    if (load == VectorFunction::Components{}) return;
    const double height = this->height_of_model();
    const double time = height * height * consolidation();
    if (time <= scene_.time.end) return;
    warn(joined(b.key, "traction"),
         "a load that is there at t = 0 is taken as drained, and the soil consolidates in some " +
             short_number(std::stod(three_digits(time))) + " s (H^2/c_v), longer than the run of " +
             short_number(scene_.time.end) +
             " s. A table from 0, [[0, 0, 0], [60, ...]], lets the load come during the run; one "
             "without a change says that the soil has consolidated");
  }
};

}  // namespace

template <int Dim>
std::vector<std::string> soil_warnings(const SceneDocument& document, const Mesh<Dim>& mesh) {
  return Soils<Dim>(document, mesh).run();
}

template std::vector<std::string> soil_warnings(const SceneDocument&, const Mesh<2>&);
template std::vector<std::string> soil_warnings(const SceneDocument&, const Mesh<3>&);

}  // namespace suffuse
