#pragma once

/// What a check found for one mechanism at one place.

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

  [[nodiscard]] bool fails() const { return factor && *factor < 1.0; }
};

}  // namespace suffuse
