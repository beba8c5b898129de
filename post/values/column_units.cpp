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

}  // namespace

std::string axis_text(const std::string& name) {
  const auto text = column_texts().find(name);
  if (text != column_texts().end()) return text->second;
  for (const SceneKey& key : scene_keys()) {
    if (fits(name, key.pattern) && !key.unit.empty()) return name + " (" + key.unit + ")";
  }
  return name;
}

}  // namespace suffuse
