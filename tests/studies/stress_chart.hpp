#pragma once

/// Chart of the stress study: how the runs of each sweep ended, from the table that
/// `make -C workflows stress` writes.

#include <string>
#include <vector>

namespace suffuse {

/// Numbers of runs of one sweep, by verdict.
struct SweepCount {
  std::string sweep;
  int pass = 0;
  int refused = 0;
  int failed = 0;

  [[nodiscard]] int runs() const { return pass + refused + failed; }
};

/// Reads the columns sweep and verdict of a CSV file, and no others; sweeps in the order of the
/// file. Throws FileError with file and line; InputError for an unknown verdict.
std::vector<SweepCount> read_sweep_counts(const std::string& path);

/// A bar per sweep, stacked in greys: runs that passed, were refused, failed, with their numbers.
/// Throws InputError for an unknown suffix, FileError.
void draw_stress_chart(const std::vector<SweepCount>& sweeps, const std::string& path);

}  // namespace suffuse
