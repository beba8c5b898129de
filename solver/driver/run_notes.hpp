#pragma once

/// State of a run in addition to its loop. It is listed once, for resumed runs and for runs that
/// start from the last state of another run.

#include <string>
#include <vector>

#include "driver/row_checks.hpp"
#include "driver/spent_energy.hpp"

namespace suffuse {

struct RunNotes {
  RowChecks checks;
  SpentEnergy energy = {};
  std::vector<std::string> warnings = {};
  std::vector<std::string> origin = {};  ///< origin of the initial state, for run.json

  void archive(StateArchive& archive) { archive(checks, energy, warnings, origin); }
};

}  // namespace suffuse
