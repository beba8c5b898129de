#pragma once

/// Errors of commands about wrong options.

#include <string>

#include "common/errors.hpp"

namespace suffuse {

/// Throws an InputError: `COMMAND: OPTION: got FOUND; expected EXPECTED; did you mean SUGGESTION?`
[[noreturn]] inline void refuse(const std::string& command, const std::string& option,
                                const std::string& found, const std::string& expected,
                                const std::string& suggestion = {}) {
  throw InputError(InputProblem{command, option, found, expected, suggestion});
}

/// What a message expects where a scene lacks a key: `KEY in the scene, such as EXAMPLE`
inline std::string missing_key(const std::string& key, const std::string& example) {
  return key + " in the scene, such as " + example;
}

}  // namespace suffuse
