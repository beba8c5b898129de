#pragma once

/// What is wrong where a scene is not TOML.

#include <string>

#include "common/errors.hpp"

namespace suffuse {

/// A number with a decimal comma and a word without quotes are named with their key and what is
/// expected; other faults are told in the words of the parser. \param where  place of the line, for
/// the message
InputProblem toml_fault(const std::string& text, std::size_t line, const std::string& where,
                        const std::string& parser_says);

}  // namespace suffuse
