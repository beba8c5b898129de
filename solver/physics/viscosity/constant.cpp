/// The viscosity does not depend on the fines.

#include "physics/viscosity/viscosity_law.hpp"

namespace suffuse::viscosity {

extern const ViscosityLaw constant{.word = "constant", .description = "mu = mu_0"};

}  // namespace suffuse::viscosity
