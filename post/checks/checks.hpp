#pragma once

/// All checks of a run, as text and as a table.

#include <optional>
#include <string>
#include <vector>

#include "checks/check_row.hpp"
#include "scene/check_settings.hpp"
#include "tables/table_output.hpp"

namespace suffuse {

struct CheckReport {
  std::vector<CheckRow> rows;
  /// Mechanisms that nothing here judges, by phase of a failure: "breach: overtopping, ...".
  std::vector<std::string> not_looked_at;
  /// Highest heads and pressures that no snapshot has: sentences.
  std::vector<std::string> unseen_peaks{};
  /// Why checks could not be made whose settings do not suit the model: messages.
  std::vector<std::string> refused{};
};

/// The settings of the run's scene with some keys of [check] changed: `KEY=VALUE`. Throws
/// InputError.
CheckSettings check_settings(const ResultsReader& results, const std::vector<std::string>& changes);

/// Throws FileError.
CheckReport check_run(const ResultsReader& results, const CheckSettings& settings);

/// The rows with exceeded limits first, otherwise in their order.
std::vector<CheckRow> exceeded_first(std::vector<CheckRow> rows);
/// "EXCEEDED", "kept", or "-" for a row without a factor.
std::string limit_word(const CheckRow& row);

/// The rows as an aligned table, those with exceeded limits first; since when factors are below 1;
/// what was not looked at.
std::string check_text(const CheckReport& report, const TextStyle& style = {});

/// CSV: mechanism, where, clause, t, effect, resistance, unit, factor, x, y (z in space), note,
/// t_below_1. Times in s; in `unit`, which is in their heads then.
std::string check_table(const CheckReport& report, int dimension,
                        const std::optional<TimeUnit>& unit = {});

/// Writes `check_table`; `-` is standard output. Throws FileError.
void write_checks(const std::string& path, const CheckReport& report, int dimension,
                  const std::optional<TimeUnit>& unit = {});

/// Throws NumericalError, naming mechanism, place and time, if a limit state is passed: a factor
/// below 1.
void require_limit_states(const CheckReport& report);
/// Throws InputError with the messages of checks that could not be made.
void require_all_checks(const CheckReport& report);

}  // namespace suffuse
