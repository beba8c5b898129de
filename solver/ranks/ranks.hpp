#pragma once

/// The ranks that share a run: processes that hold a part of the mesh each, and send each other
/// what they do not have. A program of one process is alone: nothing is sent, and every call gives
/// back what it got. All ranks have to make the same calls in the same order.

#include <span>
#include <vector>

#include "ranks/exact_sum.hpp"
#include "ranks/own_rows.hpp"

namespace suffuse {

class Ranks {
 public:
  Ranks() = default;
  virtual ~Ranks() = default;
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  [[nodiscard]] virtual int rank() const { return 0; }
  [[nodiscard]] virtual int count() const { return 1; }
  /// Replaces each sum of this rank by the sum over all ranks.
  virtual void sum(const std::vector<ExactSum*>& /*sums*/) const {}
  /// Replaces each value by the largest of all ranks.
  virtual void largest(std::span<double> /*values*/) const {}
  /// Sum of the counts of lower ranks.
  [[nodiscard]] virtual long before(long /*count*/) const { return 0; }
  /// Rows of which this rank holds those with the numbers `global` in the whole mesh, ascending,
  /// and owns those from `first` to `last`.
  [[nodiscard]] virtual OwnRows rows(const std::vector<long>& /*global*/, int first,
                                     int last) const {
    return {first, last, nullptr};
  }
};

/// The sums over all ranks, of those of this one.
inline std::vector<double> values_of_all(const Ranks& ranks, std::vector<ExactSum> sums) {
  std::vector<ExactSum*> all;
  all.reserve(sums.size());
  for (ExactSum& sum : sums) all.push_back(&sum);
  ranks.sum(all);
  std::vector<double> result;
  result.reserve(sums.size());
  for (const ExactSum& sum : sums) result.push_back(sum.value());
  return result;
}

}  // namespace suffuse
