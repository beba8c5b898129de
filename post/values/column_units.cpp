#include "values/column_units.hpp"

#include <algorithm>
#include <map>
#include <vector>

#include "case/scene_schema.hpp"

namespace suffuse {
namespace {

const std::map<std::string, std::string>& column_texts() {
  static const std::map<std::string, std::string> texts{
      {"t", "time (s)"},
      {"dt", "step (s)"},
      {"porosity_mean", "mean porosity (-)"},
      {"flux_in", "liquid that enters (m3/s)"},
      {"flux_out", "liquid that leaves (m3/s)"},
      {"concentration_out", "concentration of what leaves (-)"},
      {"concentration_min", "smallest concentration (-)"},
      {"concentration_max", "largest concentration (-)"},
      {"pressure_min", "smallest pressure (Pa)"},
      {"pressure_max", "largest pressure (Pa)"},
      {"speed_max", "largest speed of the liquid (m/s)"},
      {"turbidity_out", "turbidity of what leaves (g/l)"},
      {"turbidity_max", "largest turbidity of what leaves (g/l)"},
      {"solid", "solid (kg)"},
      {"erodible", "solid that can still erode (kg)"},
      {"water", "water (kg)"},
      {"fines", "fluidised fines (kg)"},
      {"eroded", "fines eroded (kg)"},
      {"deposited", "fines deposited (kg)"},
      {"water_in", "water that entered (kg)"},
      {"water_out", "water that left (kg)"},
      {"fines_in", "fines that entered (kg)"},
      {"fines_out", "fines that left (kg)"},
      {"fines_lost", "fines lost (kg)"},
      {"fines_lost_percent", "fines lost (%)"},
      {"complete_computed", "time until all fines are eroded (s)"},
      {"darcy_flux", "Darcy flux (m/s)"},
      {"steps", "steps (-)"},
  };
  return texts;
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
  const auto text = column_texts().find(name);
  if (text != column_texts().end()) return text->second;
  for (const SceneKey& key : scene_keys()) {
    if (!fits(name, key.pattern)) continue;
    const auto steps = steps_of(name);
    const std::string unit = unit_of(key, steps.size() > 1 ? steps[1] : "", scene);
    return unit.empty() ? name : name + " (" + unit + ")";
  }
  return name;
}

}  // namespace suffuse
