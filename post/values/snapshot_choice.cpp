#include "values/snapshot_choice.hpp"

#include <cmath>
#include <filesystem>
#include <vector>

#include "common/errors.hpp"
#include "files/layout.hpp"
#include "files/number_text.hpp"
#include "values/fields.hpp"
#include "values/run_names.hpp"

namespace suffuse {

void expect_lists_of_snapshots(const ResultsReader& results) {
  namespace fs = std::filesystem;
  const std::string first = layout::in_folder(results.folder(), layout::snapshot("mesh", 0));
  // A run that goes on writes its first snapshot before the lists.
  if (results.status() == "running" || !fs::exists(first)) return;
  std::vector<std::string> kinds{"mesh", "solid"};
  if (is_double_point(results)) kinds.emplace_back("liquid");
  for (const std::string& kind : kinds) {
    const std::string list = layout::in_folder(results.folder(), layout::series(kind));
    if (!fs::exists(list)) throw FileError(list + ": cannot be read");
  }
}

void expect_snapshots(const ResultsReader& results) {
  if (!results.times().empty()) return;
  expect_lists_of_snapshots(results);
  throw FileError(results.folder() + ": has no snapshot yet");
}

std::size_t chosen_snapshot(const ResultsReader& results, const std::optional<double>& time,
                            const std::string& command) {
  const std::size_t index = snapshot_at(results, time);
  if (!time) return index;
  const auto& times = results.times();
  const std::size_t count = times.size();
  const double before = count > 1 ? 0.5 * (times[1] - times[0]) : 0.0;
  const double after = count > 1 ? 0.5 * (times[count - 1] - times[count - 2]) : 0.0;
  if (*time >= times.front() - before && *time <= times.back() + after) return index;
  throw InputError(InputProblem{command, "--time", number_text(*time),
                                "a time from " + number_text(times.front()) + " to " +
                                    number_text(times.back()) + " s, the first and last snapshot"});
}

}  // namespace suffuse
