#pragma once

/// The rows of a model that a rank holds, for the state of a run.

#include <array>

#include "grid/grid.hpp"
#include "results/state_archive.hpp"
#include "solid/soil_map.hpp"

namespace suffuse {

/// Number of each solid point in the whole model: points are in the order of their elements. All
/// ranks have to call it.
template <int Dim>
std::vector<long> point_numbers(const Grid<Dim>& grid, const SoilMap<Dim>& soils);

/// The solid points that are here, of which a rank owns those of its elements. Likewise.
template <int Dim>
OwnRows point_rows(const Grid<Dim>& grid, const SoilMap<Dim>& soils);

class RankState final : public SharedState {
 public:
  /// All ranks have to call it. Keeps a reference to the grid's ranks.
  template <int Dim>
  RankState(const Grid<Dim>& grid, const SoilMap<Dim>& soils);

  [[nodiscard]] const Rows& rows(RowKind kind) const override {
    return rows_[static_cast<std::size_t>(kind)];
  }
  [[nodiscard]] std::vector<std::uint8_t> gather(std::vector<std::uint8_t> own) const override {
    return ranks_.gather(std::move(own));
  }
  [[nodiscard]] bool keeps() const override { return ranks_.rank() == 0; }
  [[nodiscard]] bool all_equal(std::uint64_t number) const override;

 private:
  const Ranks& ranks_;
  std::array<Rows, 4> rows_;  ///< by RowKind
};

}  // namespace suffuse
