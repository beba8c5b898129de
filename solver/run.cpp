#include "run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>
#include <utility>

#include "case/errors.hpp"
#include "double_point.hpp"
#include "interrupt.hpp"
#include "memory.hpp"
#include "progress.hpp"
#include "single_point.hpp"
#include "step_loop.hpp"

namespace suffuse {
namespace {

/// One run of a formulation, SinglePoint or DoublePoint.
template <template <int> class Model, int Dim>
class FormulationRun {
 public:
  FormulationRun(Case<Dim> c, const Plan& plan, const SolverOptions& options,
                 const std::string& folder, bool quiet)
      : case_(std::move(c)),
        plan_(plan),
        options_(options),
        start_(std::chrono::steady_clock::now()),
        writer_(folder, case_),
        model_(case_, plan),
        progress_(case_.document.scene.time.end, quiet),
        loop_(case_.document.scene, model_) {
    // The model has points of its own by now.
    case_.liquid_points = {};
  }

  ExitCode run() {
    for (const std::string& warning : plan_.warnings) warn(warning);
    try {
      loop();
    } catch (const NumericalError& error) {
      progress_.finish();
      write_info("failed", error.what());
      throw;
    }
    progress_.finish();
    if (interrupted()) {
      write_info("interrupted", "");
      std::ostringstream line;
      line << "interrupted at t = " << model_.time() << " s; what is written is complete";
      progress_.say(line.str());
      return ExitCode::interrupted;
    }
    write_info("done", "");
    return ExitCode::done;
  }

 private:
  using State = typename Model<Dim>::State;

  void loop() {
    write_info("running", "");
    const auto write = [this](const State& state, const FlowMoment<Dim>& moment,
                              OutputSchedule::Due due) { output(state, moment, due); };
    loop_.start(write);
    while (!loop_.finished() && !interrupted()) {
      loop_.advance(write);
      for (const std::string& warning : model_.take_warnings()) warn(warning);
      progress_.report(model_.time(), model_.last_step());
    }
  }

  void output(const State& state, const FlowMoment<Dim>& moment, OutputSchedule::Due due) {
    if (due.row) {
      const HistoryRow row = model_.history_row(state, moment);
      check_finite(row);
      check_compression(row);
      warn_of_speed(row.speed_max);
      writer_.append_history(row);
      writer_.append_ledger(model_.ledger(state));
      const std::vector<RegionRow> regions = model_.region_rows(state);
      writer_.append_regions(regions);
    }
    if (due.snapshot) writer_.write_snapshot(model_.snapshot(state, moment, model_.steps()));
  }

  static void check_finite(const HistoryRow& row) {
    for (const auto& [name, member] : history_columns) {
      if (std::isfinite(row.*member)) continue;
      std::ostringstream message;
      message << name << " is no longer a number at t = " << row.t << " s";
      throw NumericalError(message.str());
    }
  }

  /// The equation of state is that of water hardly compressed.
  void check_compression(const HistoryRow& row) {
    const double modulus = case_.document.scene.liquid.bulk_modulus;
    const double pressure = std::max(std::abs(row.pressure_min), std::abs(row.pressure_max));
    std::ostringstream message;
    message << "pressures reach " << pressure << " Pa at t = " << row.t << " s, "
            << pressure / modulus << " times the water's bulk modulus";
    if (pressure >= modulus) {
      throw NumericalError(
          message.str() +
          ": water cannot be compressed like that; look at the boundary conditions");
    }
    if (pressure < 0.1 * modulus || compression_warned_) return;
    compression_warned_ = true;
    warn(message.str() + ": the liquid is no longer weakly compressible");
  }

  /// Scaled masses must stay light against the waves they carry: S <= (0.1 c / v)^2.
  void warn_of_speed(double speed) {
    const double scaling = case_.document.scene.time.mass_scaling;
    const LiquidProperties& liquid = case_.document.scene.liquid;
    const double wave = std::sqrt(liquid.bulk_modulus / liquid.density);
    if (speed_warned_ || scaling <= 1.0 || speed * std::sqrt(scaling) <= 0.1 * wave) return;
    speed_warned_ = true;
    std::ostringstream message;
    message << "mass_scaling = " << scaling << " slows the pressure wave to "
            << wave / std::sqrt(scaling) << " m/s, less than ten times the flow's " << speed
            << " m/s: pressures are not to be trusted";
    warn(message.str());
  }

  void warn(const std::string& text) {
    warnings_.push_back(text);
    progress_.say("suffuse-solver: warning: " + text);
  }

  void write_info(const std::string& status, const std::string& message) {
    RunInfo info;
    info.status = status;
    info.message = message;
    info.steps = model_.steps();
    info.solid_points = case_.solid_points.size();
    info.liquid_points = model_.liquid_points();
    info.elements = case_.mesh.element_count();
    info.threads = options_.threads;
    info.wall_seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    info.memory_bytes = peak_memory();
    info.passes = model_.passes();
    info.plan = plan_.sentences;
    info.warnings = warnings_;
    writer_.write_run_info(info);
  }

  Case<Dim> case_;
  const Plan& plan_;
  const SolverOptions& options_;
  std::chrono::steady_clock::time_point start_;
  ResultsWriter<Dim> writer_;
  Model<Dim> model_;
  Progress progress_;
  StepLoop<Model<Dim>> loop_;
  bool speed_warned_ = false;
  bool compression_warned_ = false;
  std::vector<std::string> warnings_;
};

}  // namespace

template <int Dim>
int run_case(Case<Dim> c, const Plan& plan, const SolverOptions& options, const std::string& folder,
             bool quiet) {
  catch_interrupts();
  const bool single_point = c.document.scene.formulation == Formulation::single_point;
  const ExitCode code =
      single_point
          ? FormulationRun<SinglePoint, Dim>(std::move(c), plan, options, folder, quiet).run()
          : FormulationRun<DoublePoint, Dim>(std::move(c), plan, options, folder, quiet).run();
  return static_cast<int>(code);
}

template int run_case(Case<2>, const Plan&, const SolverOptions&, const std::string&, bool);

}  // namespace suffuse
