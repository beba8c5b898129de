#pragma once

/// Makes a case from a scenario, as suffuse-mesher does.

#include "stress/scenario.hpp"

namespace suffuse::stress {

/// The scene that every scenario changes: the paper's soil under 6 kPa, all fines eroded by the
/// constant law between 0.1 and 0.7 of the run.
std::string scene_text(Scheme scheme, double end);

/// The scene with its changes, meshed, checked against the mesh, seeded and disturbed. Explicit
/// runs get the end that their steps take them to. Throws InputError as the mesher would.
template <int Dim>
Case<Dim> make_case(const Scenario& scenario);

}  // namespace suffuse::stress
