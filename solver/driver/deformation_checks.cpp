#include "driver/deformation_checks.hpp"

#include "case/errors.hpp"
#include "case/scene_schema.hpp"
#include "physics/skeleton/skeleton_law.hpp"

namespace suffuse {

void refuse_moving_skeletons(const SceneDocument& document) {
  std::vector<InputProblem> problems;
  for (const Soil& soil : document.scene.soils) {
    if (!soil.skeleton.moves()) continue;
    const std::string key = joined(joined("soil", shown_name(soil.region)), "skeleton.law");
    problems.push_back({.where = document.locate(key),
                        .key = key,
                        .found = shown_value(std::string(soil.skeleton.law->word)),
                        .expected = "\"rigid\": this version moves no skeleton in a run, but tests "
                                    "a soil element (suffuse-solver --element-test)",
                        .suggestion = {}});
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

}  // namespace suffuse
