#pragma once

/// The discharge of a run with `mesh.error`, and how far it can be off.

#include <string>

#include "results/reader.hpp"

namespace suffuse {

/// "Q = 1.408e-4 m3/s per m at t = 10 s, between 1.407e-4 and 1.410e-4", or as an estimate, at the
/// last time that has an interval. Empty where no row has one.
std::string discharge_text(const ResultsReader& results);

}  // namespace suffuse
