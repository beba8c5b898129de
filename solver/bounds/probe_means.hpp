#pragma once

/// How far heads and gradients at the probes of the scene can be off: means over a disc, as at a
/// point a gradient can be infinite.

#include <optional>
#include <vector>

#include "bounds/discharge_bounds.hpp"
#include "bounds/seepage_problem.hpp"

namespace suffuse {

/// Per probe of the scene; none where no head determines the heads there, and where heads of two
/// boundaries differ where these meet.
template <int Dim>
std::vector<std::optional<ProbeMeans>> probe_means(SeepageProblem<Dim>& problem);

}  // namespace suffuse
