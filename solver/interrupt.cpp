#include "interrupt.hpp"

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
}

bool interrupted() {
  return requested != 0;
}

}  // namespace suffuse
