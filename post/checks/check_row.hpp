#pragma once

/// What a check found for one mechanism at one place.

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "results/reader.hpp"

namespace suffuse {

/// The worst state of one mechanism at one place, over all snapshots.
struct CheckRow {
  std::string mechanism;      ///< "hyd-forces", "filter" and so on, see docs/use/checks.md
  std::string where;          ///< boundary, region, or "base -> filter"
  std::string clause;         ///< where the criterion is written
  double time = unset;        ///< of the snapshot, s; not a number where time plays no part
  double effect = unset;      ///< with its partial factor
  double resistance = unset;  ///< with its partial factor, in the unit of the effect
  std::string unit{};
  std::optional<double> factor{};  ///< resistance over effect; nothing: the mechanism does not act
  std::vector<double> place{};     ///< m; empty: everywhere
  std::string note{};              ///< a sentence about this row; may be empty
  /// Time of the first snapshot whose factor is below 1, s; not a number where there is none.
  double first_below = unset;

  [[nodiscard]] bool fails() const { return factor && *factor < 1.0; }
  /// Takes note of the factor of a snapshot. Snapshots come in the order of time.
  void note_factor(double found, double at) {
    if (found < 1.0 && std::isnan(first_below)) first_below = at;
  }
};

}  // namespace suffuse
