#pragma once

/// Volume of solid that points carry from region to region of the mesh.

#include <vector>

#include "grid/grid.hpp"

namespace suffuse {

class RegionGains {
 public:
  explicit RegionGains(std::size_t regions) : gain_(regions) {}

  /// Books points that have moved. `region`: of each element; `from` and `to`: element of each
  /// point; `volume`: of its solid, m3.
  void book(const std::vector<int>& region, const std::vector<int>& from,
            const std::vector<int>& to, const std::vector<double>& volume) {
    for (std::size_t p = 0; p < volume.size(); ++p) {
      if (region[from[p]] == region[to[p]]) continue;
      gain_[region[from[p]]].add(-volume[p]);
      gain_[region[to[p]]].add(volume[p]);
    }
  }
  /// Gain of each region so far, m3.
  [[nodiscard]] std::vector<double> values() const {
    std::vector<double> result;
    result.reserve(gain_.size());
    for (const ExactSum& sum : gain_) result.push_back(sum.value());
    return result;
  }

  void archive(auto& archive) { archive(gain_); }

 private:
  std::vector<ExactSum> gain_;
};

}  // namespace suffuse
