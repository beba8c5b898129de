#pragma once

/// The first-order law, which a scene can name in two ways.

#include "physics/local_state.hpp"

namespace suffuse::erosion {

/// n_e - residual
double first_order_state(const LocalState& state);
/// The erodible fines decay exponentially in scaled time.
double porosity_after_first_order(const LocalState& state, double scaled_time);

}  // namespace suffuse::erosion
