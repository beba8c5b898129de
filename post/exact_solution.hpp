#pragma once

/// Exact porosity of soil at rest under each erosion law; independent of the solver. The laws
/// depend on porosity alone, so a point of the soil knows its own answer.

#include "case/scene.hpp"

namespace suffuse {

/// Porosity at time `t` (s) of soil that had porosity `initial` (0 < initial <= n_L,max) until
/// erosion started.
///
/// - constant (Eq. 6): min(n_L,max, n_0 + alpha (t - t_0))
/// - logarithmic (Eq. 7): li(n_L/n_L,max) = li(n_0/n_L,max) - beta (t - t_0)/n_L,max
/// - first-order: n_L,max - (n_L,max - n_0) exp(-kappa (t - t_0))
double exact_porosity(const Soil& soil, double initial, double t);

/// When that soil has lost all its fines, s: infinity where the law only approaches it, or where
/// nothing erodes.
double exhaustion_time(const Soil& soil, double initial);

}  // namespace suffuse
