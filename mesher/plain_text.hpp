#pragma once

#include <cstddef>
#include <string>

namespace suffuse {

/// A text of unknown origin, made safe to print: at most 100 000 bytes, without control characters
/// except ends of lines.
inline std::string plain_text(std::string text) {
  constexpr std::size_t most = 100000;
  if (text.size() > most) text.resize(most);
  for (char& c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte < 0x20 && c != '\n') || byte == 0x7f) c = '?';
  }
  return text;
}

}  // namespace suffuse
