#include "flow/implicit_settings.hpp"

#include <algorithm>

namespace suffuse {

template <int Dim>
bool has_condition(const Grid<Dim>& grid, const std::vector<FaceCondition>& conditions,
                   FaceKind kind) {
  const bool here = std::ranges::find(conditions, kind, &FaceCondition::kind) != conditions.end();
  return any_of_all(grid.ranks(), here);
}

template bool has_condition(const Grid<2>&, const std::vector<FaceCondition>&, FaceKind);
template bool has_condition(const Grid<3>&, const std::vector<FaceCondition>&, FaceKind);

bool depends_on_pores(const Scene& scene, const FlowOptions& options) {
  const auto depends = [](const Soil& soil) {
    return soil.conductivity_law->depends_on_porosity() || soil.erosion.momentum_transfer ||
           soil.drag == SoilDrag::ergun;
  };
  return options.inertia || scene.liquid.viscosity_model.depends_on_concentration() ||
         std::ranges::any_of(scene.soils, depends);
}

ImplicitSettings scheme_settings(const Scene& scene, const FlowOptions& options) {
  ImplicitSettings settings;
  settings.bulk_modulus = scene.liquid.bulk_modulus;
  settings.inertia = options.inertia;
  // The motion of the solid is found at the end of a step only.
  settings.stepping = scene.moves() ? TimeStepping::monotone : scene.time.stepping;
  settings.threads = options.threads;
  return settings;
}

StepSettings step_settings(const Scene& scene, const FlowOptions& options, bool follows_pores,
                           const std::vector<FaceCondition>& conditions,
                           const std::vector<double>& kinks) {
  StepSettings settings;
  settings.tolerance = scene.time.tolerance;
  settings.end = scene.time.end;
  if (options.step_given) settings.given_step = options.step;
  settings.unnoticed = options.unnoticed;
  settings.length_alone_changes_matrix = !follows_pores;
  settings.kinks = kinks;
  // Forces on an element's nodes jump when soil leaves or enters it.
  settings.starts_anew_after_jumps = scene.moves();
  const bool drains = std::ranges::any_of(conditions, &FaceCondition::switches) ||
                      std::ranges::any_of(scene.soils, &Soil::drains);
  settings.crosses_jumps = scene.moves() || drains;
  settings.pressure_spreads = scene.moves() && !drains;
  settings.threads = options.threads;
  return settings;
}

BlendingSettings blending_settings(const Scene& scene, const FlowOptions& options,
                                   bool follows_pores) {
  const auto [lightest, heaviest] =
      std::minmax(scene.liquid.density, scene.soils.front().grain_density);
  return {!options.step_given, follows_pores, lightest, heaviest};
}

}  // namespace suffuse
