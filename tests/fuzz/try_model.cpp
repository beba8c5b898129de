#include "case/case_file.hpp"
#include "driver/plan.hpp"
#include "driver/step_loop.hpp"
#include "edited_files.hpp"
#include "formulation/double_point.hpp"
#include "formulation/single_point.hpp"
#include "refusal.hpp"
#include "targets.hpp"

namespace suffuse::fuzz {
namespace {

/// Runs that take long are no finding: they say how long beforehand (--explain).
constexpr double most_steps = 2e4;
constexpr double most_rows = 1e3;
constexpr int most_intervals = 2;

bool is_long(const Scene& scene, const Plan& plan) {
  const bool many_steps =
      (scene.time.scheme == FlowScheme::explicit_nodal || plan.flow.step_given) &&
      scene.time.end > most_steps * plan.flow.step;
  return many_steps || scene.time.end > most_rows * scene.output.every ||
         scene.time.end > most_rows * scene.output.snapshot_every;
}

/// All that outputs ask for.
template <class Model>
struct Outputs {
  const Model& model;

  void operator()(const auto& state, const auto& moment, OutputSchedule::Due due) const {
    if (due.row) {
      static_cast<void>(model.history_row(state, moment));
      static_cast<void>(model.ledger(state));
      static_cast<void>(model.region_rows(state));
    }
    if (due.snapshot) static_cast<void>(model.snapshot(state, moment, model.steps()));
  }
  void operator()(const auto& looks) const {
    for (const auto& look : looks) (*this)(look.state, look.flow, look.due);
  }
};

/// The first intervals.
template <class Model>
void run(const Case<2>& c, const Plan& plan) {
  Model model(c, plan);
  StepLoop<Model> loop(c.document.scene, model);
  const Outputs<Model> outputs{model};
  loop.start(outputs);
  for (int i = 0; i < most_intervals && !loop.finished(); ++i) {
    loop.advance(outputs);
    static_cast<void>(model.take_warnings());
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
    if (c.document.scene.formulation == Formulation::single_point) {
      run<SinglePoint<2>>(c, plan);
    } else {
      run<DoublePoint<2>>(c, plan);
    }
  }));
}

}  // namespace suffuse::fuzz
