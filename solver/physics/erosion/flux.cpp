/// The first-order law combined with the drive "flux": the erodible fines decay exponentially with
/// the volume of liquid that has passed.

#include "physics/erosion/erosion_law.hpp"
#include "physics/erosion/first_order.hpp"

namespace suffuse::erosion {

extern const ErosionLaw flux{.word = "flux",
                             .equation = "that of \"first-order\", with drive = \"flux\"",
                             .rate_symbol = "lambda",
                             .drive = "flux",
                             .state = first_order_state,
                             .porosity_after = porosity_after_first_order};

}  // namespace suffuse::erosion
