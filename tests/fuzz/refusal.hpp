#pragma once

/// Checks that the sources refuse as they promise.

#include <functional>
#include <stdexcept>
#include <string>

#include "common/errors.hpp"

namespace suffuse::fuzz {

inline void require(bool holds, const std::string& what) {
  if (!holds) throw std::logic_error(what);
}

/// Runs `body`, which may throw the errors that programs report if they have a message; other
/// exceptions are findings. Returns whether it threw none.
inline bool is_taken(const std::function<void()>& body) {
  try {
    body();
    return true;
  } catch (const InputError& error) {
    require(!error.problems().empty() && *error.what() != '\0', "an error of input says nothing");
  } catch (const FileError& error) {
    require(*error.what() != '\0', "an error of a file says nothing");
  } catch (const NumericalError& error) {
    require(*error.what() != '\0', "a numerical error says nothing");
  }
  return false;
}

/// Like `is_taken(body)`, if only a file can be the cause: every message must name it.
inline bool is_taken(const std::string& path, const std::function<void()>& body) {
  try {
    body();
    return true;
  } catch (const FileError& error) {
    require(std::string(error.what()).starts_with(path), "an error of a file without its name");
  }
  return false;
}

}  // namespace suffuse::fuzz
