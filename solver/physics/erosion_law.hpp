#pragma once

/// Erosion laws: how porosity grows where grains are eroded in place (D^S n_L/Dt = phi_e for a
/// rigid skeleton, Eq. 1 of the paper).

#include "case/scene.hpp"

namespace suffuse {

/// One soil's law with what it needs to be evaluated.
struct ErosionModel {
  ErosionLaw law = ErosionLaw::none;
  double rate = 0.0;          ///< alpha, beta or kappa, 1/s; lambda, 1/m
  double start = 0.0;         ///< t_0, s
  double porosity_max = 1.0;  ///< n_L,max
};

/// phi_e at a time, 1/s: Eq. 6, Eq. 7, kappa (n_L,max - n_L), or lambda (n_L,max - n_L) |q| with
/// `flux` = |q| in m/s, which no other law looks at; zero before the start and once nothing is left
/// to erode.
double erosion_rate(const ErosionModel& model, double porosity, double time, double flux);

/// Porosity at time `to` of soil that had `porosity` at time `from`. Split at the start of erosion
/// and at exhaustion, so the length of the interval costs no accuracy: Eq. 6 and the first-order
/// law are exact, Eq. 7 is integrated to about 1e-13. The flux law is exact for `flux`, the mean of
/// |q| over the interval, m/s. Never above porosity_max.
double porosity_after(const ErosionModel& model, double porosity, double from, double to,
                      double flux);

}  // namespace suffuse
