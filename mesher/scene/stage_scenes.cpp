#include "scene/stage_scenes.hpp"

#include <algorithm>
#include <cmath>

#include "common/errors.hpp"
#include "scene/law_texts.hpp"
#include "scene/scene_schema.hpp"

namespace suffuse {
namespace {

bool equal(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

bool same_gradient(const Soil& here, const Soil& there) {
  return here.porosity_gradient == there.porosity_gradient &&
         here.porosity_origin == there.porosity_origin;
}

bool same_retention(const Soil& here, const Soil& there) {
  const auto& a = here.retention;
  const auto& b = there.retention;
  if (a.law != b.law || a.residual_saturation != b.residual_saturation) return false;
  return a.law == nullptr ||
         std::ranges::all_of(retention_parameters(), [&](const RetentionParameter& parameter) {
           return equal(a.parameters.*parameter.value, b.parameters.*parameter.value);
         });
}

/// Compares the keys that must be equal in both scenes. Problems name the key of the later scene.
class Comparison {
 public:
  Comparison(const SceneDocument& here, const Scene& there, std::string folder)
      : here_(here), there_(there), folder_(std::move(folder)) {}

  void run() {
    const Scene& scene = here_.scene;
    const bool same_formulation = scene.formulation == there_.formulation;
    if (!same_formulation) report("formulation", "another one");
    same("liquid.density", scene.liquid.density, there_.liquid.density);
    if (!becomes_incompressible()) {
      same("liquid.bulk_modulus", scene.liquid.bulk_modulus, there_.liquid.bulk_modulus);
    }
    for (const Soil& soil : scene.soils) compare(soil);
    for (const Soil& soil : there_.soils) {
      if (scene.find_soil(soil.region) != nullptr || may_change(soil.region)) continue;
      report(table_of(soil), "no such soil");
    }
    if (!problems_.empty()) throw InputError(std::move(problems_));
  }

 private:
  static std::string table_of(const Soil& soil) { return joined("soil", shown_name(soil.region)); }

  /// After a rigid skeleton, soil with a retention moves, and its water is taken as incompressible.
  [[nodiscard]] bool becomes_incompressible() const {
    return here_.scene.moves() && !there_.moves() &&
           std::ranges::any_of(here_.scene.soils, &Soil::drains);
  }
  [[nodiscard]] bool may_change(const std::string& region) const {
    return here_.scene.moves() && there_.moves() &&
           here_.scene.is_free_water(region) != there_.is_free_water(region);
  }

  void compare(const Soil& soil) {
    const Soil* other = there_.find_soil(soil.region);
    const std::string table = table_of(soil);
    if (other == nullptr) {
      if (!may_change(soil.region)) report(table, "a soil");
      return;
    }
    if (here_.scene.moves() && there_.moves() && soil.skeleton.moves() != other->skeleton.moves()) {
      report(table + ".skeleton", soil.skeleton.moves() ? "a law" : "no law");
    }
    same(table + ".porosity", soil.porosity, other->porosity);
    same(table + ".skeleton_fraction", soil.skeleton_fraction, other->skeleton_fraction);
    same(table + ".grain_density", soil.grain_density, other->grain_density);
    if (!same_gradient(soil, *other)) report(table + ".porosity_gradient", "another one");
    if (!same_retention(soil, *other)) report(table + ".retention", "another one");
  }

  void same(const std::string& name, double here, double there) {
    if (equal(here, there)) return;
    problems_.push_back({.where = here_.locate(name),
                         .key = name,
                         .found = shown_number(here),
                         .expected = shown_number(there) + ", as in " + folder_ +
                                     ", from whose state the run starts",
                         .suggestion = ""});
  }
  void report(const std::string& name, const std::string& found) {
    problems_.push_back(
        {.where = here_.locate(name),
         .key = name,
         .found = found,
         .expected = "the same as in " + folder_ + ", from whose state the run starts",
         .suggestion = ""});
  }

  const SceneDocument& here_;
  const Scene& there_;
  std::string folder_;
  std::vector<InputProblem> problems_;
};

}  // namespace

void refuse_other_soils(const SceneDocument& here, const Scene& there, const std::string& folder) {
  Comparison(here, there, folder).run();
}

std::string key_of_other_state(const Scene& here, const Scene& there) {
  if (here.gravity != there.gravity) return "gravity";
  if (here.liquid.density != there.liquid.density) return "liquid.density";
  for (const Soil& soil : here.soils) {
    std::string table = joined("soil", shown_name(soil.region));
    const Soil* other = there.find_soil(soil.region);
    if (other == nullptr) return table;
    if (!equal(soil.porosity, other->porosity)) return table + ".porosity";
    if (!same_gradient(soil, *other)) return table + ".porosity_gradient";
    if (!equal(soil.skeleton_fraction, other->skeleton_fraction)) {
      return table + ".skeleton_fraction";
    }
    if (!equal(soil.grain_density, other->grain_density)) return table + ".grain_density";
    if (!same_retention(soil, *other)) return table + ".retention";
  }
  return "";
}

std::vector<std::string> construction(const Scene& here, const Scene& there,
                                      const std::vector<std::string>& regions) {
  std::vector<std::string> stages;
  for (const std::string& region : regions) {
    const bool has_soil = here.find_soil(region) != nullptr;
    if (has_soil == (there.find_soil(region) != nullptr)) continue;
    stages.push_back("region " + shown_value(region) + (has_soil ? " is filled" : " is dug out"));
  }
  return stages;
}

}  // namespace suffuse
