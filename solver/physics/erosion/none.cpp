/// Soil that does not erode.

#include "physics/erosion/erosion_law.hpp"

namespace suffuse::erosion {

extern const ErosionLaw none{.word = "none", .equation = "no erosion", .rate_symbol = ""};

}  // namespace suffuse::erosion
