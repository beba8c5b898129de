#pragma once

/// Mass balance of a run as text, and the check of its residuals.

#include <string>

#include "files/time_unit.hpp"
#include "results/reader.hpp"

namespace suffuse {

/// Mass balance of one constituent over the run, kg (per metre of thickness in 2D).
struct Balance {
  std::string place;        ///< "model" or a region's name
  std::string constituent;  ///< "water" or "grains"
  double initial = 0.0;
  double in = 0.0;
  double out = 0.0;
  double stored = 0.0;
  double eroded = 0.0;     ///< grains only
  double deposited = 0.0;  ///< grains only
  double carried = 0.0;  ///< grains only; came with soil that moved, minus those that left with it
  double worst_residual = 0.0;  ///< largest |residual| of any row, relative to `initial`
  double worst_time = 0.0;      ///< time of that row, s
};

/// Balances of water and grains (solid, fluidised and pending) of the whole model, then of every
/// region when there are several. The residual of a row is the larger of two: the solver's own, and
/// the one that follows from the masses in the table. Throws FileError when a table has no rows.
std::vector<Balance> balances(const ResultsReader& results);

/// The balances as an aligned table. For a double-point run two lines follow: the pending grains,
/// and the numbers of liquid points.
std::string balance_text(const ResultsReader& results, const std::vector<Balance>& balances);

/// Throws NumericalError, naming place, constituent and time, when a residual exceeds `tolerance`
/// or is not a number.
void check_balances(const std::vector<Balance>& balances, double tolerance);

/// Throws NumericalError, naming the time, if `eos_error` of history.csv is too large or not a
/// number: masses can balance although the pores cannot hold the water.
void check_stored_water(const ResultsReader& results);

/// First, last, smallest and largest value of every column of the history, with its unit.
std::string history_text(const ResultsReader& results, const TimeUnit& unit);

}  // namespace suffuse
