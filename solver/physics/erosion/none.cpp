/// Soil that does not erode.

#include "physics/erosion/erosion_law.hpp"

namespace suffuse::erosion {

extern const ErosionLaw none{
    .word = "none", .equation = "No erosion", .rate_symbol = "", .rate_unit = ""};

}  // namespace suffuse::erosion
