#include "values/snapshot_choice.hpp"

#include <cmath>

#include "common/errors.hpp"
#include "files/number_text.hpp"
#include "values/fields.hpp"

namespace suffuse {

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
