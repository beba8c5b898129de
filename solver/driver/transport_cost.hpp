#pragma once

/// Cost of the transport of fines in a run, explicit and implicit, estimated from a part of the
/// run.

#include <optional>
#include <string>

#include "formulation/two_phase_model.hpp"

namespace suffuse {

/// Describes the present scheme of transport, and the cost of the other one until `end`, s.
template <int Dim>
std::string transport_sentence(const TwoPhaseModel<Dim>& model, double end);

/// A warning if liquid points have to cross very many elements: the cost, and an alternative.
template <int Dim>
std::optional<std::string> many_crossings_warning(const TwoPhaseModel<Dim>& model, double end);

}  // namespace suffuse
