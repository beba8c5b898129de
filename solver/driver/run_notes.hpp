#pragma once

/// What a run keeps in addition to its loop. It is part of the state of the run: listed once, for
/// the run that goes on and for one that starts from the last state of another.

#include <string>
#include <vector>

#include "driver/row_checks.hpp"
#include "driver/spent_energy.hpp"

namespace suffuse {

struct RunNotes {
  RowChecks checks;
  SpentEnergy energy = {};
  std::vector<std::string> warnings = {};
  std::vector<std::string> origin = {};  ///< of the state that the run started from, for run.json

  void archive(StateArchive& archive) { archive(checks, energy, warnings, origin); }
};

}  // namespace suffuse
