#pragma once

/// The loop of a run: advances the model by intervals, and passes its state to a sink at every
/// output time. A run and the trial of an estimate both use it, so they take the same steps.

#include <memory>
#include <string>

#include "driver/output_schedule.hpp"
#include "formulation/two_phase_model.hpp"
#include "results/restart_point.hpp"
#include "results/state_archive.hpp"
#include "results/writer.hpp"

namespace suffuse {

/// Receives the output of a run.
template <int Dim>
class OutputSink {
 public:
  virtual ~OutputSink() = default;

  /// Receives a warning of the model, before the output of the same step.
  virtual void warn(const std::string& text) = 0;
  /// Receives a row for every table, before the snapshot of the same step.
  virtual void write_row(const FlowState<Dim>& flow) = 0;
  virtual void write_snapshot(const FlowState<Dim>& flow) = 0;
  /// Called after every interval and its output. The loop ends if it returns false.
  virtual bool continue_after_interval() = 0;
};

/// The rows of every table at one time. All ranks have to make them; rank 0 has them all.
struct OutputRows {
  template <int Dim>
  OutputRows(const TwoPhaseModel<Dim>& model, const FlowState<Dim>& flow)
      : history(model.history_row(flow)),
        ledger(model.ledger()),
        regions(model.region_rows()),
        boundaries(model.boundary_rows(flow)),
        probes(model.probe_rows(flow)),
        sections(model.section_rows(flow)) {}

  template <int Dim>
  void append_to(ResultsWriter<Dim>& writer) const {
    writer.append_history(history);
    writer.append_ledger(ledger);
    writer.append_regions(regions);
    writer.append_boundaries(boundaries);
    writer.append_probes(probes);
    writer.append_sections(sections);
  }

  HistoryRow history;
  LedgerRow ledger;
  std::vector<RegionRow> regions;
  std::vector<BoundaryRow> boundaries;
  std::vector<ProbeRow> probes;
  std::vector<SectionRow> sections;
};

/// The options of a model whose state is set after it is made.
inline ModelOptions with_later_stress(ModelOptions options) {
  options.soil_start = SoilStart::stress_later;
  return options;
}

template <int Dim>
class RunLoop {
 public:
  /// Makes the model in its initial state, or in the state `earlier`. Keeps a reference to the
  /// case.
  RunLoop(const Case<Dim>& c, const ModelOptions& options,
          const EarlierState<Dim>* earlier = nullptr)
      : model_(make_model(c, earlier ? with_later_stress(options) : options)),
        schedule_(c.document.scene),
        end_(c.document.scene.time.end) {
    if (earlier) model_->start_from(*earlier);
  }

  /// Runs from the start, with the output of t = 0, or from the restored state, until the end, an
  /// interrupt, or a stop by the sink. Throws NumericalError, and what the sink throws.
  void run(OutputSink<Dim>& sink);

  [[nodiscard]] bool finished() const { return schedule_.finished(); }
  [[nodiscard]] const TwoPhaseModel<Dim>& model() const { return *model_; }
  [[nodiscard]] TwoPhaseModel<Dim>& model() { return *model_; }
  [[nodiscard]] const OutputSchedule& schedule() const { return schedule_; }

  void archive(StateArchive& archive) {
    archive(*model_, schedule_, warned_of_points_, warned_of_outputs_, warned_of_channels_,
            warned_of_border_);
  }
  /// The state from which a run can continue: that of the loop and of `more`, in this order. On
  /// several ranks all have to call it, and rank 0 gets the state of all.
  template <class... More>
  RestartPoint restart_point(More&... more) {
    RestartPoint point;
    point.time = model_->time();
    point.rows = schedule_.past_rows().count;
    point.snapshots = schedule_.past_snapshots().count;
    StateArchive state(model_->shared_state());
    state.reserve(state_size_ + state_size_ / 8);  // the number of points may have grown
    state(*this, more...);
    point.state = state.finish();
    state_size_ = point.state.size();
    return point;
  }

 private:
  void output(OutputSink<Dim>& sink);
  void warn_of_points(OutputSink<Dim>& sink);
  void warn_of_outputs(OutputSink<Dim>& sink);
  void warn_of_channels(OutputSink<Dim>& sink);
  void warn_of_border(OutputSink<Dim>& sink);

  std::unique_ptr<TwoPhaseModel<Dim>> model_;
  OutputSchedule schedule_;
  double end_;                       ///< of the run, s
  bool warned_of_points_ = false;    ///< the warning of many crossings was given
  bool warned_of_outputs_ = false;   ///< the warning of an output each step was given
  bool warned_of_channels_ = false;  ///< the warning of channels as narrow as elements was given
  bool warned_of_border_ = false;    ///< the warning of soil over the edge of the mesh was given
  std::size_t state_size_ = 0;       ///< of the last restart point, bytes
};

}  // namespace suffuse
