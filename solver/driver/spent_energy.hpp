#pragma once

/// The energy dissipated by water in the soil, from the power in the rows of the history.

#include "files/tables.hpp"
#include "results/state_archive.hpp"

namespace suffuse {

class SpentEnergy {
 public:
  /// Energy until a row, J. Rows must come in order; power is linear between them.
  double at(const HistoryRow& row) {
    energy_ += 0.5 * (row.t - time_) * (power_ + row.power);
    time_ = row.t;
    power_ = row.power;
    return energy_;
  }

  void archive(StateArchive& archive) { archive(time_, power_, energy_); }

 private:
  double time_ = 0.0;    ///< of the last row, s
  double power_ = 0.0;   ///< W
  double energy_ = 0.0;  ///< J
};

}  // namespace suffuse
