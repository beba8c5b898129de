#pragma once

/// Sentences of a plan about the exchange of fines.

#include <string>

#include "driver/plan.hpp"

namespace suffuse {

/// What fines do between solid and liquid, and what they change: which drives run in which soils,
/// and which couplings run or are skipped. `because`: why a pass runs that is not needed, or empty.
void describe_exchange(const Scene& scene, const std::string& because, Plan& plan);

}  // namespace suffuse
