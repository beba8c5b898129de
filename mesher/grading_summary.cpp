#include "grading_summary.hpp"

#include <algorithm>
#include <iomanip>
#include <sstream>

#include "scene/grading_checks.hpp"
#include "scene/scene_schema.hpp"

namespace suffuse {
namespace {

std::string fines_line(const Gradation& gradation) {
  const auto fines = fines_content(gradation);
  if (!fines) {
    return "fines: F* cannot be told, the finest point is at F = " +
           percent_text(gradation.smallest_finer());
  }
  return "fines: F* = " + percent_text(fines->finer) + " finer than " + three_digits(fines->size) +
         " mm, where H/F = " + three_digits(fines->ratio) + " is smallest" +
         (fines->at_limit ? " within the search; there is no gap" : "");
}

std::string skeleton_line(const Soil& soil, bool given) {
  const std::string value = "skeleton: n_C = " + three_digits(soil.skeleton_fraction);
  if (!given) return value + " = (1 - n_0)(1 - F*), as skeleton_fraction is not given";
  const double fines = 100.0 * (1.0 - soil.skeleton_fraction / (1.0 - soil.porosity));
  return value + " as given, fines of " + percent_text(fines);
}

}  // namespace

std::string grading_summary(const SceneDocument& document) {
  std::ostringstream text;
  for (const Soil& soil : document.scene.soils) {
    if (soil.gradation.empty()) continue;
    const std::string key = "soil." + shown_name(soil.region) + ".skeleton_fraction";
    text << "  grading of " << soil.region << '\n'
         << "    " << fines_line(soil.gradation) << '\n'
         << "    " << skeleton_line(soil, document.where.contains(key)) << '\n';
    const std::vector<GradingVerdict> verdicts = check_grading(soil.gradation);
    std::size_t width = 0;
    for (const GradingVerdict& v : verdicts) width = std::max(width, stability_text(v).size());
    for (const GradingVerdict& verdict : verdicts) {
      text << "    " << std::left << std::setw(23) << verdict.check
           << std::setw(static_cast<int>(width) + 2) << stability_text(verdict) << verdict.reason
           << '\n';
    }
  }
  return text.str();
}

std::string grading_report(const SceneDocument& document) {
  const std::string summary = grading_summary(document);
  if (!summary.empty()) return document.path + '\n' + summary;
  return document.path + ": no soil has a gradation, nothing to check\n";
}

}  // namespace suffuse
