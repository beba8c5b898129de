#include "report/run_numbers.hpp"

#include <algorithm>

#include "files/number_text.hpp"
#include "physics/head.hpp"
#include "report/report_pictures.hpp"
#include "values/derived_fields.hpp"
#include "values/dry_mass.hpp"
#include "values/name_words.hpp"
#include "values/scene_words.hpp"
#include "values/snapshot_choice.hpp"

namespace suffuse {
namespace {

std::optional<double> last_of(const Table& table, const std::string& column) {
  if (table.rows() == 0 || !table.has(column)) return std::nullopt;
  return table.column(column).back();
}

bool has_gradients(const ResultsReader& run) {
  if (run.times().empty()) return false;
  const auto names = run.field_names(0, "cell");
  return std::ranges::find(names, "hydraulic_gradient") != names.end();
}

std::string fines_text(const ResultsReader& run, const RunNumbers& numbers) {
  const bool has_fines = std::ranges::any_of(run.scene().scene.soils, &Soil::exchanges);
  if (!numbers.fines_out || (!has_fines && *numbers.fines_out == 0.0)) return "";
  std::string text = short_text(*numbers.fines_out) + " kg of fines";
  if (run.dimension() == 2) text += " per metre of thickness";
  text += " left the model";
  if (!run.scene().scene.initial_from.empty()) text += " in this stage";
  if (numbers.fines_percent) {
    text += ", " + short_text(*numbers.fines_percent) +
            " % of the dry mass at the start of the soils that exchange fines";
  }
  return text + ". ";
}

std::string safety_sentence(const RunNumbers& numbers, const Scene& scene, const TimeUnit& unit) {
  if (numbers.safety.empty()) return "";
  const auto place = [&](const LeastSafety& least) {
    return short_text(least.safety) + ", at " + place_text(least.place) +
           " m and t = " + time_text(least.time, unit);
  };
  const LeastSafety* exit = numbers.least_safety_at_exits();
  std::string text = exit == nullptr
                         ? "Water rises at no boundary that it leaves through. "
                         : "The least safety against heave where water leaves is " + place(*exit) +
                               ". It is that of one element: beside the corner of a "
                               "structure it falls with the size of elements. ";
  const auto& anywhere = numbers.safety.front().least;
  if (anywhere && anywhere->safety < 1.0) {
    text +=
        "In all soil the least safety is " + place(*anywhere) +
        ": below 1 water lifts soil that nothing holds down. It is below 1 for the first time "
        "at t = " +
        time_text(numbers.safety.front().first_below.value_or(anywhere->time), unit) +
        (scene.moves() ? ". "
                       : ": from then on results of a skeleton that stays in place mean nothing, "
                         "unless the place lies deep in the soil. ");
  }
  return text + (has_gravity(scene.gravity) ? "" : capitalized(without_gravity) + ". ");
}

/// A report has no checks where the run has no gradients yet.
void add_checks(const ResultsReader& run, RunNumbers& numbers) {
  if (!has_gradients(run)) {
    numbers.checks_refused = "these results have no hydraulic gradient";
    return;
  }
  numbers.checks = check_run(run, run.scene().scene.check);
}

}  // namespace

RunNumbers run_numbers(const ResultsReader& run) {
  expect_lists_of_snapshots(run);
  RunNumbers numbers;
  numbers.record = read_run_record(run.folder());
  const Table history = run.history();
  numbers.rows = history.rows();
  numbers.end = last_of(history, "t").value_or(0.0);
  numbers.fines_out = last_of(history, "fines_out");
  if (const double mass = dry_mass_at_start(run); numbers.fines_out && mass > 0.0) {
    numbers.fines_percent = 100.0 * *numbers.fines_out / mass;
  }
  if (run.ledger().rows() > 0) numbers.balances = balances(run);
  for (const Balance& balance : numbers.balances) {
    const bool is_worse =
        !numbers.worst || !(balance.worst_residual <= numbers.worst->worst_residual);
    if (is_worse) numbers.worst = balance;
  }
  if (has_gradients(run)) numbers.safety = safety_of(run);
  add_checks(run, numbers);
  return numbers;
}

const LeastSafety* RunNumbers::least_safety_at_exits() const {
  const LeastSafety* found = nullptr;
  for (std::size_t k = 1; k < safety.size(); ++k) {
    const auto& least = safety[k].least;
    if (least && (found == nullptr || least->safety < found->safety)) found = &*least;
  }
  return found;
}

std::string summary_text(const ResultsReader& run, const RunNumbers& numbers) {
  const RunInfo& info = numbers.record.info;
  const TimeUnit unit = fitting_time_unit(numbers.end);
  std::string text = "Status: " + run.status() + (info.message.empty() ? "" : ", " + info.message) +
                     ". The run is a " + scene_word(run.scene().scene.formulation) + " model of " +
                     std::to_string(info.elements) +
                     " elements, computed until t = " + time_text(numbers.end, unit) + " in " +
                     std::to_string(info.steps) + " steps. ";
  if (run.scene().scene.moves() && numbers.rows > 0) {
    text += "At " + motion_text(run.history(), unit) + ". ";
  }
  text += fines_text(run, numbers) + safety_sentence(numbers, run.scene().scene, unit);
  if (numbers.worst) {
    text += "The largest residual of the mass balance is " +
            short_text(numbers.worst->worst_residual) + ", of " + numbers.worst->constituent +
            " in " + (numbers.worst->place == "model" ? "the model" : numbers.worst->place) + ". ";
  }
  const std::size_t warnings = info.warnings.size();
  return text + (warnings == 0   ? "The solver gave no warning."
                 : warnings == 1 ? "The solver gave one warning."
                                 : "The solver gave " + std::to_string(warnings) + " warnings.");
}

}  // namespace suffuse
