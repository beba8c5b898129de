#include "physics/conductivity/conductivity_law.hpp"

#include <stdexcept>
#include <string>

namespace suffuse {

const ConductivityLaw* conductivity_law(std::string_view word) {
  for (const ConductivityLaw* law : conductivity_laws()) {
    if (law->word == word) return law;
  }
  throw std::invalid_argument("no conductivity law '" + std::string(word) + "'");
}

}  // namespace suffuse
