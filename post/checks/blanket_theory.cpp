#include "checks/blanket_theory.hpp"

#include <cmath>

#include "files/number_text.hpp"

namespace suffuse {

double effective_length(const BlanketSection& section, const BlanketSide& side) {
  // Share of the thickness by which a fragment without a cover resists (Pavlovsky, Harr).
  if (!side.covered()) return 0.43 * section.aquifer_thickness;
  const double c =
      std::sqrt(side.cover_conductivity /
                (section.aquifer_conductivity * section.aquifer_thickness * side.cover_thickness));
  switch (side.end) {
    case AquiferEnd::open:
      return std::tanh(c * side.length) / c;
    case AquiferEnd::closed:
      return 1.0 / (c * std::tanh(c * side.length));
    case AquiferEnd::infinite:
      break;
  }
  return 1.0 / c;
}

double toe_share(const BlanketSection& section) {
  if (!section.landside.covered()) return 0.0;
  const double exit = effective_length(section, section.landside);
  return exit / (effective_length(section, section.riverside) + section.base + exit);
}

std::vector<std::string> broken_assumptions(const BlanketSection& section) {
  std::vector<std::string> sentences;
  if (section.base < section.aquifer_thickness) {
    sentences.push_back("the levee is narrower (" + short_text(section.base) +
                        " m) than the aquifer is thick (" + short_text(section.aquifer_thickness) +
                        " m)");
  }
  for (const BlanketSide* side : {&section.riverside, &section.landside}) {
    const double ratio = section.aquifer_conductivity / side->cover_conductivity;
    if (!side->covered() || ratio >= 10.0) continue;
    sentences.push_back("the aquifer conducts " + short_text(ratio) +
                        " times as well as the cover; the theory needs 10 times");
  }
  return sentences;
}

}  // namespace suffuse
