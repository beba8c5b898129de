#include "physics/drive/drive_law.hpp"

#include <stdexcept>
#include <string>

namespace suffuse {

const DriveLaw* drive_law(std::string_view word) {
  for (const DriveLaw* law : drive_laws()) {
    if (law->word == word) return law;
  }
  throw std::invalid_argument("no drive '" + std::string(word) + "'");
}

}  // namespace suffuse
