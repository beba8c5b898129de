#pragma once

/// The dry mass of soils that exchange fines. Checks and reports give losses as shares of that at
/// the start.

#include <string>
#include <vector>

#include "results/reader.hpp"

namespace suffuse {

/// Dry mass of one soil, kg (per metre of thickness in 2D).
struct DryMass {
  std::string region;
  double start = 0.0;
  double last = 0.0;  ///< at `time`
  double time = 0.0;  ///< s
};

/// Masses of each soil of the run that exchanges fines and has mass. Throws FileError.
std::vector<DryMass> dry_masses(const ResultsReader& results);

/// Dry mass at the start of all of them, kg (per metre of thickness in 2D). Throws FileError.
double dry_mass_at_start(const ResultsReader& results);

}  // namespace suffuse
