#include "checks/unseen_peaks.hpp"

#include <algorithm>

#include "files/number_text.hpp"
#include "files/time_unit.hpp"

namespace suffuse {
namespace {

constexpr double least_share = 0.01;  ///< of the range

/// The first time in [begin, end] at which the value is largest.
double time_of_peak(const TimeFunction& value, double begin, double end) {
  std::vector<double> times{begin};
  for (const double t : value.breakpoints()) {
    if (t > begin && t < end) times.push_back(t);
  }
  times.push_back(end);
  return std::ranges::max(times, {}, [&](double t) { return value.value(t); });
}

}  // namespace

std::vector<std::string> unseen_peaks(const ResultsReader& results) {
  const std::vector<double>& times = results.times();
  std::vector<std::string> sentences;
  const auto add = [&](const BoundaryCondition& boundary, const char* name, const char* unit,
                       const std::optional<TimeFunction>& given) {
    if (!given) return;
    const auto [low, high] = given->range(times.front(), times.back());
    const auto value_at = [&](double t) { return given->value(t); };
    const double seen = value_at(std::ranges::max(times, {}, value_at));
    if (high - seen <= least_share * (high - low)) return;
    const double at = time_of_peak(*given, times.front(), times.back());
    sentences.push_back("the highest " + std::string(name) + " at \"" + boundary.on + "\", " +
                        short_text(high) + " " + unit +
                        " at t = " + time_text(at, fitting_time_unit(times.back())) +
                        ", is between snapshots, which have at most " + short_text(seen) + " " +
                        unit + "; a smaller output.snapshot_every shows it");
  };
  for (const BoundaryCondition& boundary : results.scene().scene.boundaries) {
    add(boundary, "head", "m", boundary.head);
    add(boundary, "pressure", "Pa", boundary.pressure);
  }
  return sentences;
}

}  // namespace suffuse
