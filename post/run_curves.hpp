#pragma once

/// What the figures share: how runs are named and told apart, and which exact curve goes with
/// which.

#include <string>
#include <vector>

#include "chart.hpp"
#include "specimen.hpp"

namespace suffuse {

/// How the markers of a run look.
struct RunStyle {
  Marker marker = Marker::circle;
  bool hollow = false;
  Color color{};
};

/// One per run. Where both formulations are there, single-point runs have cold colours and circles
/// or squares, double-point runs warm colours and diamonds or targets.
std::vector<RunStyle> run_styles(const std::vector<ResultsReader>& runs);

/// The results folder's name without what is before it and without `.results`.
std::string folder_name(const ResultsReader& run);

/// Names of the runs; folders tell apart what the scenes call alike. Where both formulations are
/// there the name says which; a run that is not done says so.
std::vector<std::string> run_labels(const std::vector<ResultsReader>& runs);

/// True when both formulations are among the runs.
bool is_mixed(const std::vector<ResultsReader>& runs);
bool is_double_point(const ResultsReader& run);

/// "exact, constant law, 0.001 1/s"
std::string law_label(const Specimen& specimen);

/// Times of an exact curve from 0 to `end`, with the kinks where erosion starts and ends.
std::vector<double> exact_times(double end, const Specimen& specimen);

/// Markers at about `marker_count` rows, evenly in time; runs take turns, so that none hides
/// another.
Curve thinned(Curve curve, std::size_t run, std::size_t runs);

/// Curves of a figure in the making.
class RunCurves {
 public:
  explicit RunCurves(const std::vector<ResultsReader>& runs);

  [[nodiscard]] std::size_t size() const { return labels_.size(); }
  [[nodiscard]] const Specimen& soil(std::size_t run) const { return soils_[run]; }
  /// "the soil", or "the soil that erodes" when a run has some that does not.
  [[nodiscard]] std::string soil_name() const;
  [[nodiscard]] const std::string& label(std::size_t run) const { return labels_[run]; }
  [[nodiscard]] const RunStyle& style(std::size_t run) const { return styles_[run]; }

  /// Adds what the legend says of a run.
  void extend_label(std::size_t run, const std::string& text) { labels_[run] += text; }

  /// An exact curve of a run, in the dash of its law, which is its label with `more` behind it;
  /// grey where another of the same law came before. The same curve of several runs is drawn once.
  void add_exact(std::size_t run, const std::vector<double>& x, const std::vector<double>& y,
                 const std::string& more = "");
  /// The same without a row in the legend.
  void add_unlabelled_exact(std::size_t run, const std::vector<double>& x,
                            const std::vector<double>& y);
  /// A line of its own label below the runs.
  void add_line(const Curve& line);
  /// A curve of markers in the run's style.
  void add_run(std::size_t run, std::vector<double> x, std::vector<double> y);
  /// Any curve of a run, thinned.
  void add_run(std::size_t run, Curve curve);
  /// Exact curves first, runs over them, against time.
  [[nodiscard]] Chart chart(const std::string& title, const std::string& y_label) const;

 private:
  [[nodiscard]] Curve exact_line(std::size_t run, const std::vector<double>& x,
                                 const std::vector<double>& y) const;

  std::vector<Specimen> soils_;
  std::vector<std::string> labels_;
  std::vector<RunStyle> styles_;
  std::vector<std::string> laws_;
  std::vector<Curve> exact_;
  std::vector<Curve> numeric_;
};

}  // namespace suffuse
