#include "physics/retention/retention_law.hpp"

#include <stdexcept>
#include <string>

namespace suffuse {

const RetentionLaw* retention_law(std::string_view word) {
  for (const RetentionLaw* law : retention_laws()) {
    if (law->word == word) return law;
  }
  throw std::invalid_argument("no retention law '" + std::string(word) + "'");
}

}  // namespace suffuse
