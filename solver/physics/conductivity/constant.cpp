/// Conductivity does not depend on porosity.

#include "physics/conductivity/conductivity_law.hpp"

namespace suffuse::conductivity {

extern const ConductivityLaw constant{.word = "constant", .description = "not at all"};

}  // namespace suffuse::conductivity
