#pragma once

/// The dry mass of soils that exchange fines. Checks give losses as shares of that before the first
/// stage, reports what left in a run as a share of that at its start.

#include <string>
#include <vector>

#include "results/reader.hpp"

namespace suffuse {

/// Dry mass of one soil, kg (per metre of thickness in 2D).
struct DryMass {
  std::string region;
  /// Before the first stage, by the porosity of the scene; that at the start of this stage, if soil
  /// moves.
  double initial = 0.0;
  double start = 0.0;  ///< of this run
  double last = 0.0;   ///< at `time`, as if soil had carried none into or out of the region
  double time = 0.0;   ///< s
};

/// Masses of each soil of the run that exchanges fines and has mass. Throws FileError.
std::vector<DryMass> dry_masses(const ResultsReader& results);

/// Dry mass at the start of all of them, kg (per metre of thickness in 2D). Throws FileError.
double dry_mass_at_start(const ResultsReader& results);

}  // namespace suffuse
