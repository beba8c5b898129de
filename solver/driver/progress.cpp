#include "driver/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace suffuse {
namespace {

constexpr double seconds_between_redraws = 0.1;
constexpr double seconds_between_lines = 5.0;
constexpr int bar_width = 30;

/// 75 s -> "1:15", 4000 s -> "1:06:40".
std::string clock_text(double seconds) {
  const long whole = std::lround(seconds);
  char text[32];
  if (whole >= 3600) {
    std::snprintf(text, sizeof text, "%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60, whole % 60);
  } else {
    std::snprintf(text, sizeof text, "%ld:%02ld", whole / 60, whole % 60);
  }
  return text;
}

}  // namespace

std::string outlook(const Standing& standing) {
  char text[80];
  if (standing.soil_fails) return "soil fails";
  if (standing.time_left) return clock_text(*standing.time_left) + " left";
  if (!(standing.step > 2.0 * standing.first_step)) return "time left not known yet";
  std::snprintf(text, sizeof text, "%ssteps grow from %.1g s",
                standing.from_rest ? "starting from rest: " : "", standing.first_step);
  return text;
}

Progress::Progress(double start, double end, bool from_rest, bool quiet)
    : standing_{.time = start, .end = end, .from_rest = from_rest, .time_left = {}},
      time_left_(start, end),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) != 0),
      start_(Clock::now()),
      reported_(start_),
      last_(start_) {}

void Progress::report(double time, double dt, bool soil_fails) {
  if (quiet_) return;
  const Clock::time_point now = Clock::now();
  const auto seconds = [](Clock::duration d) { return std::chrono::duration<double>(d).count(); };
  standing_.time = time;
  standing_.step = dt;
  if (standing_.first_step == 0.0) standing_.first_step = dt;
  standing_.soil_fails = soil_fails;
  // The time of a failure is left out, because its pace differs from that of other times.
  if (soil_fails) in_failure_ += now - reported_;
  reported_ = now;
  if (!soil_fails) standing_.time_left = time_left_.at(seconds(now - start_ - in_failure_), time);
  if (seconds(now - last_) < (terminal_ ? seconds_between_redraws : seconds_between_lines)) return;
  last_ = now;
  if (terminal_) {
    draw_bar();
    bar_shown_ = true;
  } else {
    std::fprintf(stderr, "t = %.6g of %.6g s, step %.3g s, %s\n", time, standing_.end, dt,
                 outlook(standing_).c_str());
  }
}

void Progress::draw_bar() const {
  const double share = std::clamp(standing_.time / standing_.end, 0.0, 1.0);
  const int filled = static_cast<int>(share * bar_width);
  const std::string bar =
      std::string(filled, '#') + std::string(static_cast<std::size_t>(bar_width) - filled, '.');
  std::fprintf(stderr, "\r[%s] %3.0f %%  t = %.5g of %.5g s  step %.3g s  %s \033[K", bar.c_str(),
               100.0 * share, standing_.time, standing_.end, standing_.step,
               outlook(standing_).c_str());
  std::fflush(stderr);
}

void Progress::say(const std::string& line) {
  if (bar_shown_) std::fputs("\r\033[K", stderr);
  std::fprintf(stderr, "%s\n", line.c_str());
}

void Progress::finish() {
  if (bar_shown_) std::fputs("\r\033[K", stderr);
  bar_shown_ = false;
}

}  // namespace suffuse
