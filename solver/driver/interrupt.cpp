#include "driver/interrupt.hpp"

#include <csignal>

namespace suffuse {
namespace {

volatile std::sig_atomic_t requested = 0;
void request(int) {
  requested = 1;
}

}  // namespace

void catch_interrupts() {
  requested = 0;
  std::signal(SIGINT, request);
  std::signal(SIGTERM, request);
  std::signal(SIGUSR1, request);
  // A program started by nohup must continue to ignore SIGHUP.
  if (std::signal(SIGHUP, request) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
  // The run continues if the program that reads its messages ends.
  std::signal(SIGPIPE, SIG_IGN);
}

bool interrupted() {
  return requested != 0;
}

}  // namespace suffuse
