#pragma once

#include <cstddef>
#include <string>

namespace suffuse {

/// A text of unknown origin as it may be printed: of at most 100 000 bytes, and without control
/// characters, which can move a terminal's cursor; ends of lines stay.
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
