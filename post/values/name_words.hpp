#pragma once

/// Fields and columns of tables in words, for titles and axes.

#include <string>

namespace suffuse {

/// "fines left" from the field `fines_left`, "Darcy flux along x" from `darcy_flux_x`.
std::string field_words(const std::string& name);
/// "fines that left" from the column `fines_out` of a table.
std::string column_words(const std::string& name);

/// The text with a capital at its start.
std::string capitalized(std::string text);

}  // namespace suffuse
