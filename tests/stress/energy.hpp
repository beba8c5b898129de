#pragma once

/// The energy of the flow schemes, in process: a sealed box starts from a random pressure.

#include <iosfwd>
#include <string>

namespace suffuse::stress {

/// Description of the sweep for the table.
std::string energy_sweep_is();

/// Appends a line per run. Returns how many failed.
int run_energy_sweep(std::ostream& table);

}  // namespace suffuse::stress
