#pragma once

/// How the runs of the stress study ended, from the table of `make -C workflows stress`.

#include <string>
#include <vector>

namespace suffuse {

/// Runs of one sweep.
struct SweepCount {
  std::string sweep;
  int pass = 0;
  int refused = 0;
  int failed = 0;

  [[nodiscard]] int runs() const { return pass + refused + failed; }
};

/// Reads the columns sweep and verdict of a CSV file, and no others; sweeps in the order of the
/// file. Throws FileError with file and line; InputError for a verdict that is none.
std::vector<SweepCount> read_sweep_counts(const std::string& path);

/// A bar per sweep, stacked of what passed, was refused and failed, with the numbers, in greys.
/// Throws InputError for an unknown suffix, FileError.
void draw_stress_chart(const std::vector<SweepCount>& sweeps, const std::string& path);

}  // namespace suffuse
