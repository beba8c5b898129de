#pragma once

/// The loop of a run: the model advances, interval by interval, and hands its state to a sink at
/// every output time. A run and the trial of an estimate take the same steps, as both go through
/// it.

#include <memory>
#include <string>

#include "driver/output_schedule.hpp"
#include "formulation/two_phase_model.hpp"
#include "results/restart_point.hpp"
#include "results/state_archive.hpp"
#include "results/writer.hpp"

namespace suffuse {

/// What becomes of the output of a run.
template <int Dim>
class OutputSink {
 public:
  virtual ~OutputSink() = default;

  /// A warning of the model. Comes before the output of the same step.
  virtual void warn(const std::string& text) = 0;
  /// A row of every table is due. Comes before the snapshot of the same step.
  virtual void write_row(const FlowState<Dim>& flow) = 0;
  virtual void write_snapshot(const FlowState<Dim>& flow) = 0;
  /// After every interval, with its output. The loop ends where this is false.
  virtual bool continue_after_interval() = 0;
};

/// A row of every table but the history.
template <int Dim>
void append_tables(ResultsWriter<Dim>& writer, const TwoPhaseModel<Dim>& model,
                   const FlowState<Dim>& flow) {
  writer.append_ledger(model.ledger());
  writer.append_regions(model.region_rows());
  writer.append_boundaries(model.boundary_rows(flow));
  writer.append_probes(model.probe_rows(flow));
  writer.append_sections(model.section_rows(flow));
}

template <int Dim>
class RunLoop {
 public:
  /// Makes the model at its start, which is `earlier` where there is any. Keeps a reference to the
  /// case.
  RunLoop(const Case<Dim>& c, const ModelOptions& options,
          const EarlierState<Dim>* earlier = nullptr)
      : model_(make_model(c, options)),
        schedule_(c.document.scene),
        end_(c.document.scene.time.end) {
    if (earlier) model_->start_from(*earlier);
  }

  /// From the start, with the output of t = 0, or from the restored state: to the end, to an
  /// interrupt, or until the sink stops it. Throws NumericalError, and what the sink throws.
  void run(OutputSink<Dim>& sink);

  [[nodiscard]] bool finished() const { return schedule_.finished(); }
  [[nodiscard]] const TwoPhaseModel<Dim>& model() const { return *model_; }
  [[nodiscard]] TwoPhaseModel<Dim>& model() { return *model_; }
  [[nodiscard]] const OutputSchedule& schedule() const { return schedule_; }

  void archive(StateArchive& archive) {
    archive(*model_, schedule_, warned_of_points_, warned_of_outputs_);
  }
  /// From where a run can continue: the state of the loop and of `more`, for an archive that is
  /// given the same.
  template <class... More>
  RestartPoint restart_point(More&... more) {
    RestartPoint point;
    point.time = model_->time();
    point.rows = schedule_.past_rows().count;
    point.snapshots = schedule_.past_snapshots().count;
    StateArchive state;
    state.reserve(state_size_ + state_size_ / 8);  // points may have become more
    state(*this, more...);
    point.state = state.finish();
    state_size_ = point.state.size();
    return point;
  }

 private:
  void output(OutputSink<Dim>& sink);
  void warn_of_points(OutputSink<Dim>& sink);
  void warn_of_outputs(OutputSink<Dim>& sink);

  std::unique_ptr<TwoPhaseModel<Dim>> model_;
  OutputSchedule schedule_;
  double end_;                      ///< of the run, s
  bool warned_of_points_ = false;   ///< that they have far to go
  bool warned_of_outputs_ = false;  ///< that each step is written
  std::size_t state_size_ = 0;      ///< of the last restart point, bytes
};

}  // namespace suffuse
