#pragma once

/// What the transport of fines costs in a run, explicit and implicit, as far as a part of the run
/// shows.

#include <optional>
#include <string>

#include "formulation/two_phase_model.hpp"

namespace suffuse {

/// The scheme that carries fines at this moment, and what the other would cost until `end`, s.
template <int Dim>
std::string transport_sentence(const TwoPhaseModel<Dim>& model, double end);

/// Where liquid points would have to cross more elements than a user waits for: what that costs,
/// and what does without them.
template <int Dim>
std::optional<std::string> many_crossings_warning(const TwoPhaseModel<Dim>& model, double end);

}  // namespace suffuse
