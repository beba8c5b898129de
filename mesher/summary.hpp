#pragma once

/// The lines that suffuse-mesher prints about its result.

#include <string>
#include <vector>

#include "case/case_file.hpp"

namespace suffuse {

/// Counts, smallest angle, areas of the regions (and which of them are free water) and lengths of
/// the boundaries, then the notes; one aligned line each.
std::string case_summary(const Case<2>& c, const std::vector<std::string>& notes);

/// A sentence when the smallest angle is below 5 degrees, empty otherwise.
std::string angle_warning(const Mesh<2>& mesh);

}  // namespace suffuse
