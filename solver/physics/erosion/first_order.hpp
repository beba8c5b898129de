#pragma once

/// The first-order law, which has two names.

#include "physics/local_state.hpp"

namespace suffuse::erosion {

/// n_e - residual
double first_order_state(const LocalState& state);
/// What is left decays exponentially.
double porosity_after_first_order(const LocalState& state, double scaled_time);

}  // namespace suffuse::erosion
