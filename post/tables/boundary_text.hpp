#pragma once

/// Liquid and grains that have crossed each boundary of the scene.

#include <string>

#include "results/reader.hpp"

namespace suffuse {

/// The last row of every boundary and their sums, as text. Throws FileError.
std::string boundaries_text(const ResultsReader& results);

}  // namespace suffuse
