#include "case/case_file.hpp"
#include "driver/output_schedule.hpp"
#include "driver/plan.hpp"
#include "edited_files.hpp"
#include "formulation/two_phase_model.hpp"
#include "refusal.hpp"
#include "targets.hpp"

namespace suffuse::fuzz {
namespace {

/// Runs that take long are no finding: they say how long beforehand (--explain).
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

/// The first intervals, with their outputs.
void run(const Case<2>& c, const Plan& plan) {
  const auto model = make_model(c, plan);
  OutputSchedule schedule(c.document.scene);
  const auto output = [&] {
    const OutputSchedule::Due due = schedule.take(model->time());
    const FlowState<2> flow = model->flow_state();
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

}  // namespace

void try_model(const std::string& input) {
  const std::string path = lay_out_case(input);
  Case<2> c;
  const bool is_case = is_taken(path, [&] { c = read_case<2>(path); });
  forget_files();
  if (!is_case) return;
  static_cast<void>(is_taken([&] {
    const Plan plan = make_plan(c, {});
    if (is_long(c.document.scene, plan)) return;
    run(c, plan);
  }));
}

}  // namespace suffuse::fuzz
