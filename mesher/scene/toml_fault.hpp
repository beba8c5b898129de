#pragma once

/// Describes the fault of a scene that is not TOML.

#include <string>

#include "common/errors.hpp"

namespace suffuse {

/// A decimal comma and a word without quotes are reported with key and expected value; for other
/// faults the message is the parser's.
/// \param where  place of the line, for the message
InputProblem toml_fault(const std::string& text, std::size_t line, const std::string& where,
                        const std::string& parser_says);

}  // namespace suffuse
