#include "values/run_names.hpp"

#include <algorithm>
#include <filesystem>

namespace suffuse {

std::string folder_name(const ResultsReader& run) {
  auto folder = std::filesystem::path(run.folder()).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();
  return folder.stem().string();
}

bool is_double_point(const ResultsReader& run) {
  return run.scene().scene.formulation == Formulation::double_point;
}

bool is_mixed(const std::vector<ResultsReader>& runs) {
  return std::ranges::any_of(runs, is_double_point) && !std::ranges::all_of(runs, is_double_point);
}

std::vector<std::string> run_labels(const std::vector<ResultsReader>& runs) {
  std::vector<std::string> labels;
  const bool mixed = is_mixed(runs);
  for (const auto& run : runs) {
    const auto& name = run.scene().scene.name;
    const auto same_name = std::ranges::count_if(
        runs, [&](const ResultsReader& other) { return other.scene().scene.name == name; });
    std::string label = same_name > 1 ? folder_name(run) : name;
    if (mixed) label += is_double_point(run) ? ", double-point" : ", single-point";
    if (run.status() != "done") label += " (" + run.status() + ")";
    labels.push_back(label);
  }
  return labels;
}

}  // namespace suffuse
