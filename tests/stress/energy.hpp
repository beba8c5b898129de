#pragma once

/// The energy of the flow schemes, in process: a sealed box is let go from a random pressure.

#include <iosfwd>
#include <string>

namespace suffuse::stress {

/// What the sweep does, for the table.
std::string energy_sweep_is();

/// Appends a line per run. Returns how many failed.
int run_energy_sweep(std::ostream& table);

}  // namespace suffuse::stress
