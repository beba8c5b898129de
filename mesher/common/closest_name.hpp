#pragma once

/// Suggestions for misspelt names, and lists of names for messages.

#include <string>
#include <vector>

namespace suffuse {

/// Number of letters to insert, remove, replace or swap with a neighbour that turns one name into
/// the other; case does not count.
std::size_t edit_distance(const std::string& a, const std::string& b);

/// The candidate that takes the fewest single-letter edits (swapping two neighbours counts as one)
/// to reach, or empty when none takes at most a third of the letters. Ties go to the first.
std::string closest_name(const std::string& name, const std::vector<std::string>& candidates);

/// `"a", "b" or "c"`; `none` when empty.
std::string quoted_list(const std::vector<std::string>& names);

}  // namespace suffuse
