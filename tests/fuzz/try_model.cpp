#include "case/case_file.hpp"
#include "driver/output_schedule.hpp"
#include "driver/plan.hpp"
#include "edited_files.hpp"
#include "formulation/two_phase_model.hpp"
#include "refusal.hpp"
#include "targets.hpp"

namespace suffuse::fuzz {
namespace {

/// Longer runs are skipped: they are no findings, because --explain announces them.
constexpr double max_steps = 2e4;
constexpr double max_rows = 1e3;
constexpr int max_intervals = 2;

bool is_long(const Scene& scene, const Plan& plan) {
  const bool many_steps =
      (scene.time.scheme == FlowScheme::explicit_nodal || plan.flow.step_given) &&
      scene.time.end > max_steps * plan.flow.step;
  return many_steps || scene.time.end > max_rows * scene.output.every ||
         scene.time.end > max_rows * scene.output.snapshot_every;
}

/// Runs the first intervals, with their outputs.
template <int Dim>
void run(const Case<Dim>& c, const Plan& plan) {
  const auto model = make_model(c, plan);
  OutputSchedule schedule(c.document.scene);
  const auto output = [&] {
    const OutputSchedule::Due due = schedule.take(model->time());
    const FlowState<Dim> flow = model->flow_state();
    if (due.row) {
      static_cast<void>(model->history_row(flow));
      static_cast<void>(model->ledger());
      static_cast<void>(model->region_rows());
    }
    if (due.snapshot) static_cast<void>(model->snapshot(flow));
  };
  output();
  for (int i = 0; i < max_intervals && !schedule.finished(); ++i) {
    model->advance(schedule.next());
    output();
    static_cast<void>(model->take_warnings());
  }
}

template <int Dim>
void try_in(const std::string& path) {
  Case<Dim> c;
  const bool is_case = is_taken(path, [&] { c = read_case<Dim>(path); });
  forget_files();
  if (!is_case) return;
  static_cast<void>(is_taken([&] {
    const Plan plan = make_plan(c, {});
    if (is_long(c.document.scene, plan)) return;
    run(c, plan);
  }));
}

}  // namespace

void try_model(const std::string& input) {
  const std::string path = lay_out_case(input);
  int dimension = 2;
  static_cast<void>(is_taken(path, [&] { dimension = read_case_dimension(path); }));
  dimension == 3 ? try_in<3>(path) : try_in<2>(path);
}

}  // namespace suffuse::fuzz
