#pragma once

#include <sstream>
#include <string>

namespace suffuse {

/// A number as text for messages: six digits, and no sign of a zero.
inline std::string short_number(double value) {
  std::ostringstream text;
  text << (value == 0.0 ? 0.0 : value);
  return text.str();
}

}  // namespace suffuse
