#include "tables/ledger_report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "common/errors.hpp"
#include "files/number_text.hpp"
#include "files/tables.hpp"
#include "files/time_unit.hpp"
#include "tables/table_output.hpp"

namespace suffuse {
namespace {

/// Rows of `table` whose column `name` has `value`.
Table rows_where(const Table& table, const std::string& name, double value) {
  Table selected{table.names, std::vector<std::vector<double>>(table.names.size())};
  const auto& key = table.column(name);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (key[row] != value) continue;
    for (std::size_t k = 0; k < table.columns.size(); ++k) {
      selected.columns[k].push_back(table.columns[k][row]);
    }
  }
  return selected;
}

std::vector<double> sum(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> total(a);
  std::transform(a.begin(), a.end(), b.begin(), total.begin(), std::plus<>());
  return total;
}

/// Mass of all grains in the model. Ledgers of earlier versions have no column `pending`.
std::vector<double> stored_grains(const Table& table) {
  const auto grains = sum(table.column("solid"), table.column("fines"));
  return table.has("pending") ? sum(grains, table.column("pending")) : grains;
}

/// Grains that solid points carried in, minus out; ledgers of earlier versions have no such column.
std::vector<double> carried_grains(const Table& table) {
  return table.has("carried") ? table.column("carried") : std::vector<double>(table.rows());
}

Balance balance(const Table& table, const std::string& place, const std::string& constituent) {
  const bool is_water = constituent == "water";
  if (table.rows() == 0) throw FileError("the ledger of " + place + " has no rows yet");
  const auto stored = is_water ? table.column("water") : stored_grains(table);
  const auto& in = table.column(is_water ? "water_in" : "fines_in");
  const auto& out = table.column(is_water ? "water_out" : "fines_out");
  const auto& reported = table.column(is_water ? "residual_water" : "residual_grains");

  const auto carried = is_water ? std::vector<double>(table.rows()) : carried_grains(table);

  Balance b;
  b.place = place;
  b.constituent = constituent;
  b.initial = stored.front() + out.front() - in.front();
  b.in = in.back();
  b.out = out.back();
  b.stored = stored.back();
  b.carried = carried.back();
  if (!is_water) b.eroded = table.column("eroded").back();
  if (!is_water && table.has("deposited")) b.deposited = table.column("deposited").back();
  b.worst_time = table.column("t").front();
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double formed = std::abs(stored[row] + (out[row] - in[row]) - carried[row] - b.initial);
    // After thousands of pore volumes the stored mass is below the rounding of `in` and `out`. Then
    // the difference is meaningless; the solver forms its residual before that rounding.
    const double rounding =
        std::numeric_limits<double>::epsilon() * (stored[row] + in[row] + out[row]);
    const double significant = formed <= rounding ? 0.0 : formed;
    const double share = relative_residual(significant, b.initial, in[row], carried[row]);
    for (const double residual : {std::abs(reported[row]), share}) {
      if (residual <= b.worst_residual) continue;
      b.worst_residual = residual;
      b.worst_time = table.column("t")[row];
      if (std::isnan(residual)) return b;
    }
  }
  return b;
}

std::string in_column(double value, const char* format) {
  char buffer[48];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

/// Pending grains and liquid points of a double-point run.
std::string liquid_point_text(const Table& ledger) {
  const auto& pending = ledger.column("pending");
  const auto largest = std::ranges::max_element(pending);
  const auto& t = ledger.column("t");
  const auto last = [&](const char* name) { return number_text(ledger.column(name).back()); };
  return "pending grains: " + in_column(pending.back(), "%.6g") + " kg, at most " +
         in_column(*largest, "%.6g") +
         " kg at t = " + in_column(t[static_cast<std::size_t>(largest - pending.begin())], "%.6g") +
         " s\nliquid points: " + last("points") + "; entered " + last("points_in") + ", left " +
         last("points_out") + "\n";
}

}  // namespace

std::vector<Balance> balances(const ResultsReader& results) {
  const Table ledger = results.ledger();
  std::vector<Balance> found{balance(ledger, "model", "water"), balance(ledger, "model", "grains")};
  if (results.regions().size() < 2) return found;
  const Table all = results.region_ledgers();
  for (std::size_t r = 0; r < results.regions().size(); ++r) {
    const Table region = rows_where(all, "region", static_cast<double>(r));
    for (const auto* constituent : {"water", "grains"}) {
      found.push_back(balance(region, results.regions()[r], constituent));
    }
  }
  return found;
}

std::string balance_text(const ResultsReader& results, const std::vector<Balance>& balances) {
  const Table ledger = results.ledger();
  const auto& t = ledger.column("t");
  const TimeUnit unit = fitting_time_unit(t.back());
  std::string text = results.folder() + ": " + results.status() + ", " + std::to_string(t.size()) +
                     " rows, t = " + short_text(t.front() / unit.seconds) + " .. " +
                     time_text(t.back(), unit) + "; masses in kg" +
                     (results.dimension() == 2 ? " per metre of thickness\n" : "\n");
  std::size_t longest = 6;
  for (const auto& b : balances) longest = std::max(longest, b.place.size());
  const int place = -static_cast<int>(longest) - 2;
  text += padded("place", place) + padded("", -8);
  for (const auto* head :
       {"initial", "in", "out", "stored", "eroded", "deposited", "worst residual"}) {
    text += padded(head, 15);
  }
  text += padded("at t (" + unit.name + ")", 15);
  text += "\n";
  for (const auto& b : balances) {
    text += padded(b.place, place) + padded(b.constituent, -8);
    for (const double mass : {b.initial, b.in, b.out, b.stored}) {
      text += padded(in_column(mass, "%.8g"), 15);
    }
    for (const double mass : {b.eroded, b.deposited}) {
      text += padded(b.constituent == "water" ? "-" : in_column(mass, "%.8g"), 15);
    }
    text += padded(in_column(b.worst_residual, "%.2e"), 15);
    text += padded(in_column(b.worst_time / unit.seconds, "%.6g"), 15) + "\n";
  }
  for (const auto& b : balances) {
    if (b.carried == 0.0) continue;
    text += b.place + ": soil that moved carried " + in_column(b.carried, "%.8g") + " kg in\n";
  }
  if (results.scene().scene.formulation == Formulation::double_point) {
    text += liquid_point_text(ledger);
  }
  return text;
}

void check_stored_water(const ResultsReader& results) {
  const Table history = results.history();
  if (!history.has("eos_error")) return;
  const std::vector<double>& misfit = history.column("eos_error");
  const auto bad = std::ranges::find_if_not(misfit, [](double m) { return m <= max_eos_error; });
  if (bad == misfit.end()) return;
  const double t = history.column("t")[static_cast<std::size_t>(bad - misfit.begin())];
  throw NumericalError("an element holds water that differs by a share of " +
                       in_column(*bad, "%.3g") +
                       " from what its pores take at t = " + in_column(t, "%.6g") + " s; at most " +
                       in_column(max_eos_error, "%.3g") + " may be missing or too much");
}

void check_balances(const std::vector<Balance>& balances, double tolerance) {
  for (const auto& b : balances) {
    if (b.worst_residual <= tolerance) continue;
    throw NumericalError(b.place + ": " + b.constituent + ": residual " +
                         in_column(b.worst_residual, "%.3g") +
                         " at t = " + in_column(b.worst_time, "%.6g") +
                         " s is larger than the tolerance " + number_text(tolerance));
  }
}

std::string history_text(const ResultsReader& results, const TimeUnit& unit) {
  const Table history = with_units(results.history(), results.dimension(), unit);
  if (history.rows() == 0) throw FileError(results.folder() + ": history.csv has no rows yet");
  const std::vector<std::string> headings = history.headings();
  const std::string longest =
      std::ranges::max(headings, {}, [](const std::string& h) { return h.size(); });
  const int column = -static_cast<int>(longest.size()) - 2;
  std::string text = results.folder() + ": " + results.status() + ", " +
                     std::to_string(history.rows()) + " rows\n" + padded("column", column);
  for (const auto* head : {"first", "last", "smallest", "largest"}) text += padded(head, 15);
  text += "\n";
  for (std::size_t k = 0; k < headings.size(); ++k) {
    const auto& values = history.columns[k];
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    text += padded(headings[k], column);
    for (const double value : {values.front(), values.back(), *low, *high}) {
      text += padded(in_column(value, "%.8g"), 15);
    }
    text += "\n";
  }
  return text;
}

}  // namespace suffuse
