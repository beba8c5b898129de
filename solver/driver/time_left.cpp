#include "driver/time_left.hpp"

namespace suffuse {
namespace {

/// Largest ratio of two paces that agree.
constexpr double agreement = 2.0;
/// A stretch takes this share of the wall time before it, at least `shortest_stretch` and
/// `fewest_intervals`, in which growing steps grow by more than `agreement`.
constexpr double stretch_share = 0.25;
constexpr double shortest_stretch = 0.2;  // s
constexpr int fewest_intervals = 8;

}  // namespace

std::optional<double> TimeLeft::at(double elapsed, double time) {
  ++intervals_;
  const double stretch = elapsed - begin_.elapsed;
  if (intervals_ >= fewest_intervals && time > begin_.time &&
      stretch >= shortest_stretch + stretch_share * begin_.elapsed) {
    const double pace = stretch / (time - begin_.time);
    known_ = known_ || (pace_ && pace < agreement * *pace_ && *pace_ < agreement * pace);
    pace_ = pace;
    begin_ = {elapsed, time};
    intervals_ = 0;
  }
  if (!known_) return std::nullopt;
  return time < end_ ? *pace_ * (end_ - time) : 0.0;
}

}  // namespace suffuse
