#include "time_limit.hpp"

#include <sys/time.h>
#include <unistd.h>

#include <cmath>
#include <csignal>

#include "case/errors.hpp"

namespace suffuse {

namespace {

/// What the handler writes: it may not allocate.
std::string text;

extern "C" void end_process(int) {
  static_cast<void>(!::write(STDERR_FILENO, text.data(), text.size()));
  ::_exit(static_cast<int>(ExitCode::wrong_input));
}

void set_timer(double seconds) {
  itimerval timer{};
  timer.it_value.tv_sec = static_cast<time_t>(seconds);
  timer.it_value.tv_usec =
      static_cast<suseconds_t>(1e6 * (seconds - static_cast<double>(timer.it_value.tv_sec)));
  ::setitimer(ITIMER_PROF, &timer, nullptr);
}

}  // namespace

TimeLimit::TimeLimit(double seconds, const std::string& message) {
  if (!std::isfinite(seconds)) return;
  text = message + '\n';
  std::signal(SIGPROF, end_process);
  set_timer(seconds);
}

TimeLimit::~TimeLimit() {
  set_timer(0.0);
  std::signal(SIGPROF, SIG_DFL);
}

}  // namespace suffuse
