#include <sstream>
#include <vector>

#include "case/consistency.hpp"
#include "post/synthetic_results.hpp"
#include "refusal.hpp"
#include "scene/scene.hpp"
#include "seeds.hpp"
#include "targets.hpp"

namespace suffuse::fuzz {

void try_scene(const std::string& input) {
  const std::string mark = "#set ";
  std::vector<std::string> overrides;
  std::istringstream lines(input);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(mark)) overrides.push_back(line.substr(mark.size()));
  }
  static_cast<void>(is_taken([&] {
    SceneDocument document = parse_scene(input, "scene.toml", overrides);
    require(document.scene.time.end > 0.0, "a scene without an end");
    for (const auto& [key, place] : document.where) {
      require(document.locate(key) == place, "a key is not found where it was given");
    }
    for (const Soil& soil : document.scene.soils) {
      require(soil.porosity > 0.0 && soil.porosity_max() > 0.0, "a soil without pores");
      require(document.scene.find_soil(soil.region) != nullptr, "a soil that is not found");
    }
    static const Mesh<2> column = testing::double_point::column().mesh;
    static const Mesh<3> box = layered_box();
    const bool in_space = document.scene.geometry.is_box();
    complete_for_mesh(document, in_space ? 3 : 2);
    std::vector<InputProblem> problems =
        in_space ? scene_problems(document, box) : scene_problems(document, column);
    if (!problems.empty()) throw InputError(std::move(problems));
  }));
}

}  // namespace suffuse::fuzz
