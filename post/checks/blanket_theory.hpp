#pragma once

/// Blanket theory: flow in an aquifer below a levee, along it, and through the cover beside the
/// levee, across it (EM 1110-2-1913, Appendix B; Brandon and others 2018, ERDC/GSL TR-18-24).

#include <string>
#include <vector>

#include "scene/check_settings.hpp"

namespace suffuse {

/// The ground on one side of a levee.
struct BlanketSide {
  double length = 0.0;              ///< of the aquifer beyond the toe, m
  double cover_thickness = 0.0;     ///< m; 0: no cover
  double cover_conductivity = 0.0;  ///< across the cover, m/s
  AquiferEnd end = AquiferEnd::infinite;

  [[nodiscard]] bool covered() const { return cover_thickness > 0.0; }
};

/// A levee that nothing flows through, on an aquifer.
struct BlanketSection {
  double base = 0.0;                  ///< L2, from toe to toe, m
  double aquifer_thickness = 0.0;     ///< d, m
  double aquifer_conductivity = 0.0;  ///< along the aquifer, m/s
  BlanketSide riverside{};
  BlanketSide landside{};
};

/// Length of an aquifer below a tight cover that resists as this side does, x1 or x3, m: 1/c of a
/// cover that goes on for ever, tanh(c L)/c where the aquifer is open at its end, 1/(c tanh(c L))
/// where it is closed, c^2 = k_cover / (k d t_cover); 0.43 d without a cover.
double effective_length(const BlanketSection& section, const BlanketSide& side);

/// Share of the difference of head from river to landside that is left below the cover at the
/// landside toe: h_0/H = x3 / (x1 + L2 + x3). 0 without a cover there.
double toe_share(const BlanketSection& section);

/// Which assumptions the section does not meet, as sentences: vertical equipotentials (L2 >= d),
/// and conductivities with a ratio of 10 and more.
std::vector<std::string> broken_assumptions(const BlanketSection& section);

}  // namespace suffuse
