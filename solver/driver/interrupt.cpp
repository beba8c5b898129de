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
  // A program started by nohup must go on ignoring it.
  if (std::signal(SIGHUP, request) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
  // The program that read the messages has ended: no reason to end the run.
  std::signal(SIGPIPE, SIG_IGN);
}

bool interrupted() {
  return requested != 0;
}

}  // namespace suffuse
