#pragma once

/// Sentences of a plan about the exchange of fines.

#include <string>

#include "driver/plan.hpp"

namespace suffuse {

/// Describes the exchange of fines and its effects: the drives of each soil, and the couplings that
/// are run or skipped. `because`: reason for running a pass that is not needed, or empty.
void describe_exchange(const Scene& scene, const std::string& because, Plan& plan);

}  // namespace suffuse
