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
};

/// Masses inside a boundary, kg.
struct Stored {
  double solid = 0.0;
  double erodible = 0.0;
  double water = 0.0;
  double fines = 0.0;
  double eroded = 0.0;
};

/// Sums crossings over the outer boundary (account 0) and over the boundary of region r
/// (account r + 1).
template <int Dim>
class BoundaryAccounts {
 public:
  explicit BoundaryAccounts(const Grid<Dim>& grid);

  /// Books what crossed each face along its normal, kg.
  void book(const std::vector<double>& water, const std::vector<double>& fines);

  [[nodiscard]] std::vector<Crossed> totals() const;

 private:
  struct OutwardFace {
    int face;
    double sign;  ///< +1 where the face's normal points out of the account
  };
  struct Sums {
    CompensatedSum water_in, fines_in, water_out, fines_out;
  };
  std::vector<std::vector<OutwardFace>> faces_;  ///< per account
  std::vector<Sums> sums_;
};

/// A row of the ledger from what is stored, what crossed and what was stored at the start.
LedgerRow ledger_row(double time, const Stored& stored, const Crossed& crossed,
                     const Stored& initial);

}  // namespace suffuse
