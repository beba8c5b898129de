#include "driver/memory.hpp"

#include <sys/resource.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <fstream>
#include <string>

namespace suffuse {

double peak_memory() {
  constexpr double kilobyte = 1024.0;
  // VmHWM counts this program alone. getrusage also counts the program that called exec, such as a
  // large shell or test runner.
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    double kilobytes = 0.0;
    if (word == "VmHWM:" && status >> kilobytes) return kilobyte * kilobytes;
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return kilobyte * static_cast<double>(usage.ru_maxrss);
}

void give_memory_back() {
#ifdef __GLIBC__
  constexpr int large = 1 << 20;
  // Open MPI forbids blocks of their own, which are all that can be returned at once.
  constexpr int most_blocks = 65536;
  mallopt(M_MMAP_MAX, most_blocks);
  mallopt(M_MMAP_THRESHOLD, large);
  mallopt(M_TRIM_THRESHOLD, 4 * large);
#endif
}

}  // namespace suffuse
