#include "values/run_names.hpp"

#include <algorithm>
#include <filesystem>

namespace suffuse {

namespace {

/// The absolute path of a run's folder without `.results`.
std::filesystem::path path_of(const ResultsReader& run) {
  auto folder = std::filesystem::absolute(run.folder()).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();
  return folder.extension() == ".results" ? folder.replace_extension() : folder;
}

/// The last `count` parts of a path.
std::string last_parts(const std::filesystem::path& path, std::ptrdiff_t count) {
  std::filesystem::path last;
  const auto parts = path.relative_path();
  const auto skipped =
      std::max<std::ptrdiff_t>(0, std::distance(parts.begin(), parts.end()) - count);
  for (auto part = std::next(parts.begin(), skipped); part != parts.end(); ++part) last /= *part;
  return last.string();
}

}  // namespace

std::string folder_name(const ResultsReader& run) {
  return path_of(run).filename().string();
}

std::vector<std::string> folder_names(const std::vector<ResultsReader>& runs) {
  std::vector<std::string> names;
  for (const ResultsReader& run : runs) {
    const auto path = path_of(run);
    std::ptrdiff_t count = 1;
    // A run that is given twice has the same path.
    while (std::ranges::any_of(runs, [&](const ResultsReader& other) {
      const auto its = path_of(other);
      return its != path && its.filename() == path.filename() &&
             last_parts(its, count) == last_parts(path, count);
    })) {
      ++count;
    }
    names.push_back(last_parts(path, count));
  }
  return names;
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
  const std::vector<std::string> folders = folder_names(runs);
  for (const auto& run : runs) {
    const auto& name = run.scene().scene.name;
    const auto same_name = std::ranges::count_if(
        runs, [&](const ResultsReader& other) { return other.scene().scene.name == name; });
    std::string label = same_name > 1 ? folders[labels.size()] : name;
    if (mixed) label += is_double_point(run) ? ", double-point" : ", single-point";
    if (run.status() != "done") label += " (" + run.status() + ")";
    labels.push_back(label);
  }
  return labels;
}

}  // namespace suffuse
