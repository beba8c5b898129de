#include "scene/soil_grading.hpp"

#include <algorithm>

#include "scene/grading_checks.hpp"
#include "scene/scene_schema.hpp"

namespace suffuse {
namespace {

// Texts of the warnings about a soil that `law` erodes.

std::string stable(const GradingVerdict& verdict, const std::string& law) {
  return "is " + stability_text(verdict) + " by " + verdict.check + ", but erosion.law = " + law +
         " erodes it: fines of such a soil hardly move between its grains";
}

std::string load_bearing(const FinesContent& fines, const std::string& law) {
  return "has " + percent_text(fines.finer) + " of fines, above " +
         percent_text(load_bearing_fines) + ", but erosion.law = " + law +
         " erodes them: they carry load, and a skeleton without them would settle, which a rigid "
         "one does not";
}

}  // namespace

void derive_skeletons(Scene& scene, const std::function<bool(const std::string& key)>& given) {
  for (Soil& soil : scene.soils) {
    const std::string key = "soil." + shown_name(soil.region) + ".skeleton_fraction";
    if (soil.gradation.empty() || given(key)) continue;
    const auto fines = fines_content(soil.gradation);
    if (fines) soil.skeleton_fraction = (1.0 - soil.porosity) * (1.0 - fines->finer / 100.0);
  }
}

void check_grading_of(const Soil& soil, const std::string& table, const SceneInquiry& inquiry) {
  const std::string key = table + ".skeleton_fraction";
  if (soil.gradation.empty() || inquiry.given(key)) return;
  const auto report = [&](const std::string& found, const std::string& why,
                          const std::string& other) {
    inquiry.report({.key = key,
                    .found = found,
                    .expected = find_scene_key("soil.*.skeleton_fraction")->expected() + why,
                    .others = {other}});
  };
  if (!fines_content(soil.gradation)) {
    report("nothing, and a gradation that does not tell F*: its finest point is at F = " +
               percent_text(soil.gradation.smallest_finer()),
           "; or a gradation that starts at F = " + percent_text(search_limit(soil.gradation)) +
               " or below",
           table + ".gradation");
  }
  const bool uniform =
      std::ranges::all_of(soil.porosity_gradient, [](double x) { return x == 0.0; });
  if (!uniform) {
    report("nothing, although porosity_gradient is given",
           ": it is one number for the soil, and (1 - n_0)(1 - F*) changes from place to place",
           table + ".porosity_gradient");
  }
}

std::vector<std::string> grading_warnings(const SceneDocument& document) {
  std::vector<std::string> warnings;
  for (const Soil& soil : document.scene.soils) {
    if (soil.gradation.empty() || !soil.erosion.law->erodes()) continue;
    const std::string key = joined(joined("soil", shown_name(soil.region)), "gradation");
    const std::string start = document.locate(key).append(": ").append(key).append(": ");
    const std::string law = shown_value(std::string(soil.erosion.law->word));
    const GradingVerdict verdict = check_li_fannin(soil.gradation);
    if (verdict.stability == Stability::stable) warnings.push_back(start + stable(verdict, law));
    const auto fines = fines_content(soil.gradation);
    if (fines && fines->finer > load_bearing_fines) {
      warnings.push_back(start + load_bearing(*fines, law));
    }
  }
  return warnings;
}

}  // namespace suffuse
