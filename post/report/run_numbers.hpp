#pragma once

/// The most important numbers of a run, for the top of a report.

#include <optional>
#include <string>
#include <vector>

#include "checks/checks.hpp"
#include "checks/heave_safety.hpp"
#include "results/reader.hpp"
#include "results/run_record.hpp"
#include "tables/ledger_report.hpp"

namespace suffuse {

/// Numbers that a run does not have yet, or that results of an earlier version lack, are unset or
/// empty.
struct RunNumbers {
  RunRecord record;
  double end = 0.0;                 ///< last time in the tables, s
  std::size_t rows = 0;             ///< number of rows in the tables
  std::optional<double> fines_out;  ///< kg (per metre of thickness in 2D)
  /// `fines_out` in per cent of the dry mass at the start of the soils that exchange fines.
  std::optional<double> fines_percent;
  std::vector<Balance> balances;
  std::optional<Balance> worst;    ///< the balance with the largest residual
  std::vector<PartSafety> safety;  ///< all soil first
  std::optional<CheckReport> checks;
  std::string checks_refused;  ///< why there are no checks

  /// The least safety of the boundaries through which water leaves; null if it rises at none. Soil
  /// above holds down what rises within the model.
  [[nodiscard]] const LeastSafety* least_safety_at_exits() const;
};

/// Throws FileError.
RunNumbers run_numbers(const ResultsReader& run);

/// A paragraph with the numbers.
std::string summary_text(const ResultsReader& run, const RunNumbers& numbers);

}  // namespace suffuse
