#pragma once

/// The lines that suffuse-mesher prints about its result.

#include <string>
#include <vector>

#include "case/case_file.hpp"

namespace suffuse {

/// Counts, median edge, smallest angle, areas of the regions (and which of them are free water or
/// air) and lengths of the boundaries, in three dimensions volumes and areas, then the notes; one
/// aligned line each.
template <int Dim>
std::string case_summary(const Case<Dim>& c, const std::vector<std::string>& notes);

/// A sentence if the smallest angle is below 5 degrees, otherwise empty.
template <int Dim>
std::string angle_warning(const Mesh<Dim>& mesh);

}  // namespace suffuse
