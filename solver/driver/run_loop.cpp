#include "driver/run_loop.hpp"

#include <algorithm>
#include <sstream>

#include "driver/interrupt.hpp"
#include "driver/transport_cost.hpp"
#include "field/channel_width.hpp"
#include "mesh/place_text.hpp"

namespace suffuse {

template <int Dim>
void RunLoop<Dim>::run(OutputSink<Dim>& sink) {
  const bool at_the_start = schedule_.past_rows().count == 0;
  if (at_the_start && model_->solid().has_inertia()) {
    sink.warn(
        "the soil has no equilibrium at t = 0 s: from there on it moves with its inertia, until it "
        "has come to rest");
  }
  if (at_the_start) output(sink);
  const auto interrupted_anywhere = [this] { return any_of_all(model_->ranks(), interrupted()); };
  bool is_running = true;
  while (is_running && !schedule_.finished() && !interrupted_anywhere()) {
    schedule_.follow_failure(model_->time(), model_->solid().has_inertia(), model_->last_step());
    warn_of_outputs(sink);
    model_->advance(schedule_.next());
    for (const std::string& warning : model_->take_warnings()) sink.warn(warning);
    warn_of_points(sink);
    output(sink);
    is_running = sink.continue_after_interval();
  }
}

template <int Dim>
void RunLoop<Dim>::warn_of_points(OutputSink<Dim>& sink) {
  // A check after every interval would take time. The first intervals often belong to the start-up.
  constexpr long every = 16;
  if (warned_of_points_ || model_->steps() % every != 0) return;
  if (const auto warning = many_crossings_warning(*model_, end_)) {
    warned_of_points_ = true;
    sink.warn(*warning);
  }
}

template <int Dim>
void RunLoop<Dim>::warn_of_channels(OutputSink<Dim>& sink) {
  // Two elements across have a border on either side.
  constexpr double narrow = 1.5;
  if (warned_of_channels_ || !model_->solid().soils().exchange_depends_on().flux) return;
  const auto width = relative_channel_width(model_->grid(), model_->solid());
  if (!width || *width > narrow) return;
  warned_of_channels_ = true;
  std::ostringstream text;
  text.precision(2);
  text << "erosion opens channels that are " << *width << " elements wide at t = " << model_->time()
       << " s: where they run and how much they lose depends on the mesh; an erosion.length gives "
          "them a width";
  sink.warn(text.str());
}

template <int Dim>
void RunLoop<Dim>::warn_of_border(OutputSink<Dim>& sink) {
  constexpr double noticed = 0.05;
  if (warned_of_border_ || !model_->solid().moves()) return;
  const MaterialPoints<Dim>& points = model_->solid().soils().points();
  for (int p = 0; p < points.size(); ++p) {
    if (std::ranges::min(points.barycentric[p]) > -noticed) continue;
    warned_of_border_ = true;
    std::ostringstream text;
    text << "soil has risen over the edge of the mesh by more than " << 100.0 * noticed
         << " % of an element at " << place_text<Dim>(points.position(model_->grid().mesh, p))
         << ", t = " << model_->time()
         << " s: the mesh holds it in less room than it takes, so that its pores, flow and "
            "gradients are wrong there; give it room above (a region free_above, or one with free "
            "= true)";
    sink.warn(text.str());
    return;
  }
}

template <int Dim>
void RunLoop<Dim>::warn_of_outputs(OutputSink<Dim>& sink) {
  if (warned_of_outputs_ || !schedule_.writes_each_step()) return;
  warned_of_outputs_ = true;
  std::ostringstream text;
  text << "output.failure_every is shorter than the steps of the soil that fails, "
       << model_->last_step() << " s at t = " << model_->time()
       << " s: each step is written, with a snapshot";
  sink.warn(text.str());
}

template <int Dim>
void RunLoop<Dim>::output(OutputSink<Dim>& sink) {
  const OutputSchedule::Due due = schedule_.take(model_->time());
  if (!due.row && !due.snapshot) return;
  const FlowState<Dim> flow = model_->flow_state();
  if (due.snapshot) {
    warn_of_channels(sink);
    warn_of_border(sink);
  }
  // The row comes first, because the snapshot stores the number of rows.
  if (due.row) sink.write_row(flow);
  if (due.snapshot) sink.write_snapshot(flow);
}

template class RunLoop<2>;
template class RunLoop<3>;

}  // namespace suffuse
