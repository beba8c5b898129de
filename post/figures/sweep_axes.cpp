#include "figures/sweep_axes.hpp"

#include <algorithm>
#include <map>
#include <vector>

#include "scene/scene_schema.hpp"
#include "tables/table_output.hpp"
#include "values/name_words.hpp"

namespace suffuse {
namespace {

/// Units of columns of the table of runs that no table of a run has.
const std::map<std::string, std::string>& run_table_units() {
  static const std::map<std::string, std::string> units{{"fines_lost", "kg"},
                                                        {"fines_lost_percent", "%"},
                                                        {"turbidity_max", "g/l"},
                                                        {"darcy_flux", "m/s"},
                                                        {"complete_exact", "s"},
                                                        {"complete_computed", "s"},
                                                        {"error_solid_percent", "%"},
                                                        {"error_eroded_percent", "%"},
                                                        {"error_porosity_percent", "%"},
                                                        {"steps", "1"}};
  return units;
}

/// The steps of a dotted key, with a step `[]` for each entry of a list.
std::vector<std::string> steps_of(const std::string& key) {
  std::vector<std::string> steps(1);
  bool quoted = false;
  for (const char c : key) {
    if (c == '"') quoted = !quoted;
    if (c == ']' && !quoted && steps.back().starts_with('[')) {
      steps.back() = "[]";
    } else if (!quoted && (c == '.' || c == '[')) {
      if (!steps.back().empty()) steps.emplace_back();
      if (c == '[') steps.back() = "[";
    } else {
      steps.back() += c;
    }
  }
  return steps;
}

bool fits(const std::string& key, const std::string& pattern) {
  return std::ranges::equal(steps_of(key), steps_of(pattern),
                            [](const std::string& step, const std::string& allowed) {
                              return allowed == "*" || step == allowed;
                            });
}

/// The unit of a key, `-` for none. The schema lists the units of drives with their words in
/// quotes.
std::string unit_of(const SceneKey& key, const std::string& soil, const Scene* scene) {
  if (key.unit.find('"') == std::string::npos) return key.unit.empty() ? "-" : key.unit;
  if (!scene) return "";
  const auto found = std::ranges::find(scene->soils, soil, &Soil::region);
  if (found == scene->soils.end()) return "";
  const DriveLaw& drive = *found->erosion_model().drive;
  return std::string(key.leaf() == "rate" ? drive.rate_unit : drive.unit);
}

}  // namespace

std::string axis_text(const std::string& name, const Scene* scene) {
  constexpr int dimension = 2;
  const auto own = run_table_units().find(name);
  const std::string unit_of_column = own == run_table_units().end()
                                         ? column_unit(name, dimension)
                                         : shown_unit(own->second, dimension);
  if (!unit_of_column.empty()) return column_words(name) + " (" + unit_of_column + ")";
  for (const SceneKey& key : scene_keys()) {
    if (!fits(name, key.pattern)) continue;
    const auto steps = steps_of(name);
    const std::string unit = unit_of(key, steps.size() > 1 ? steps[1] : "", scene);
    std::string label = name;
    if (!unit.empty()) label.append(" (").append(unit).append(")");
    return label;
  }
  return name;
}

}  // namespace suffuse
