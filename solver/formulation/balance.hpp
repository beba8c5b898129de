#pragma once

/// Where water and grains are and what crossed which boundary: for the whole model and for each
/// region.

#include <array>
#include <vector>

#include "grid/compensated_sum.hpp"
#include "grid/grid.hpp"
#include "results/tables.hpp"

namespace suffuse {

/// Masses that crossed a boundary since the start, kg.
struct Crossed {
  double water_in = 0.0;
  double fines_in = 0.0;
  double water_out = 0.0;
  double fines_out = 0.0;
  double points_in = 0.0;  ///< liquid points, numbers
  double points_out = 0.0;
  double water_net = 0.0;  ///< out less in, with more digits than their difference
  double fines_net = 0.0;
};

/// Masses inside a boundary, kg.
struct Stored {
  double solid = 0.0;
  double erodible = 0.0;
  double water = 0.0;
  double fines = 0.0;
  double eroded = 0.0;
  double pending = 0.0;  ///< eroded, but not yet with any liquid
  double points = 0.0;   ///< liquid points, number
};

/// Running sums behind one `Stored`.
struct StoredSums {
  CompensatedSum solid, erodible, water, fines, eroded, pending;
  double points = 0.0;

  [[nodiscard]] Stored totals() const {
    return {solid.value(),  erodible.value(), water.value(), fines.value(),
            eroded.value(), pending.value(),  points};
  }
};

/// Running sums behind one `Crossed`.
struct CrossedSums {
  static constexpr bool has_no_gaps = true;  ///< see StateArchive
  CompensatedSum water_in, fines_in, water_out, fines_out;
  double points_in = 0.0;
  double points_out = 0.0;

  [[nodiscard]] Crossed totals() const {
    return {
        water_in.value(), fines_in.value(), water_out.value(),         fines_out.value(),
        points_in,        points_out,       water_out.minus(water_in), fines_out.minus(fines_in)};
  }
};

/// Which faces bound the model (account 0) and region r (account r + 1).
template <int Dim>
class BoundaryAccounts {
 public:
  explicit BoundaryAccounts(const Grid<Dim>& grid);

  [[nodiscard]] std::size_t count() const { return faces_.size(); }

  /// Books what crossed each face along its normal, kg, to `sums`, one per account.
  void book(const std::vector<double>& water, const std::vector<double>& fines,
            std::vector<CrossedSums>& sums) const;

 private:
  struct OutwardFace {
    int face;
    double sign;  ///< +1 where the face's normal points out of the account
  };
  std::vector<std::vector<OutwardFace>> faces_;  ///< per account
};

/// A row of the ledger from what is stored, what crossed and what was stored at the start.
LedgerRow ledger_row(double time, const Stored& stored, const Crossed& crossed,
                     const Stored& initial);

}  // namespace suffuse
