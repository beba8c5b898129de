#include "driver/exchange_sentences.hpp"

#include "scene/scene_schema.hpp"

namespace suffuse {
namespace {

/// "soil sand" or "soils sand and silt": those that satisfy a condition; empty: none.
template <class Condition>
std::string soils_that(const Scene& scene, const Condition& holds) {
  std::vector<std::string> names;
  for (const Soil& soil : scene.soils) {
    if (holds(soil)) names.push_back(soil.region);
  }
  if (names.empty()) return "";
  return (names.size() > 1 ? "soils " : "soil ") + listed(names, "and");
}

/// Describes each drive with its soils.
void describe_erosion(const Scene& scene, const std::string& because, Plan& plan) {
  const auto erodes_by = [](const Soil& soil, const DriveLaw* drive) {
    const ErosionModel model = soil.erosion_model();
    return erodes(model) && model.drive == drive;
  };
  bool any = false;
  for (const DriveLaw* drive : drive_laws()) {
    const std::string soils =
        soils_that(scene, [&](const Soil& soil) { return erodes_by(soil, drive); });
    if (soils.empty()) continue;
    plan.sentences.push_back(
        std::string("run: erosion by ").append(drive->word).append(", " + soils).append(because));
    any = true;
  }
  if (any) return;
  plan.sentences.push_back(because.empty() ? "skip: erosion, no soil erodes"
                                           : "run: erosion" + because);
}

}  // namespace

void describe_exchange(const Scene& scene, const std::string& because, Plan& plan) {
  const auto say = [&](const std::string& sentence) { plan.sentences.push_back(sentence); };
  describe_erosion(scene, because, plan);
  const std::string catching =
      soils_that(scene, [](const Soil& soil) { return soil.deposition.deposits(); });
  say(catching.empty() ? "skip: deposition, no soil catches fines"
      : plan.erosion   ? "run: deposition, " + catching + because
                       : "skip: deposition, no fines get into the liquid");
  const bool thickens = scene.liquid.viscosity_model.depends_on_concentration();
  say(!thickens        ? "skip: viscosity of the suspension, it is that of the water"
      : plan.transport ? "run: viscosity of the suspension, by the law " +
                             std::string(scene.liquid.viscosity_model.law->word)
                       : "skip: viscosity of the suspension, no grains get into the liquid");
  const std::string following = soils_that(scene, [](const Soil& soil) {
    return soil.exchanges() && soil.conductivity_model().depends_on_porosity();
  });
  say(following.empty() || !plan.erosion
          ? "skip: conductivity that follows pores, no soil has it and changes"
          : "run: conductivity that follows pores, " + following);
}

}  // namespace suffuse
