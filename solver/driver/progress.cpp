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

Progress::Progress(double end, bool quiet)
    : end_(end),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) != 0),
      start_(Clock::now()),
      last_(start_) {}

void Progress::report(double time, double dt) {
  if (quiet_) return;
  const Clock::time_point now = Clock::now();
  const double since_last = std::chrono::duration<double>(now - last_).count();
  if (since_last < (terminal_ ? seconds_between_redraws : seconds_between_lines)) return;
  last_ = now;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const double left = time > 0.0 ? elapsed * std::max(0.0, end_ - time) / time : 0.0;
  if (terminal_) {
    draw_bar(time, dt, left);
    bar_shown_ = true;
  } else {
    std::fprintf(stderr, "t = %.6g of %.6g s, step %.3g s, %s left\n", time, end_, dt,
                 clock_text(left).c_str());
  }
}

void Progress::draw_bar(double time, double dt, double left) const {
  const double share = std::clamp(time / end_, 0.0, 1.0);
  const int filled = static_cast<int>(share * bar_width);
  const std::string bar =
      std::string(filled, '#') + std::string(static_cast<std::size_t>(bar_width) - filled, '.');
  std::fprintf(stderr, "\r[%s] %3.0f %%  t = %.5g of %.5g s  step %.3g s  %s left \033[K",
               bar.c_str(), 100.0 * share, time, end_, dt, clock_text(left).c_str());
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
