#pragma once

/// Exact porosity of soil at rest under each erosion law; independent of the solver. Laws that
/// depend on porosity alone give a point of the soil its own answer, whatever the flow.

#include "case/scene.hpp"

namespace suffuse {

/// Whether the law depends on porosity alone; else nothing is exact without the flow.
bool has_exact_porosity(const Soil& soil);

/// Porosity at time `t` (s) of soil that had porosity `initial` (0 < initial <= n_L,max) until
/// erosion started.
///
/// - constant (Eq. 6): min(n_L,max, n_0 + alpha (t - t_0))
/// - logarithmic (Eq. 7): li(n_L/n_L,max) = li(n_0/n_L,max) - beta (t - t_0)/n_L,max
/// - first-order: n_L,max - (n_L,max - n_0) exp(-kappa (t - t_0))
/// - flux: not a number while there is something to erode, as |q| is not known here
double exact_porosity(const Soil& soil, double initial, double t);

/// When that soil has lost all its fines, s: infinity where the law only approaches it, or where
/// nothing erodes.
double exhaustion_time(const Soil& soil, double initial);

}  // namespace suffuse
