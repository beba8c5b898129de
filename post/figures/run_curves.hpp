#pragma once

/// Labels, styles and exact curves of runs, the same in all figures.

#include <string>
#include <vector>

#include "drawing/chart.hpp"
#include "values/run_names.hpp"
#include "values/specimen.hpp"

namespace suffuse {

/// Marker and colour of a run.
struct RunStyle {
  Marker marker = Marker::circle;
  bool hollow = false;
  Color color{};
};

/// One style per run. In a figure with both formulations, single-point runs get cold colours and
/// circles or squares, double-point runs warm colours and diamonds or targets.
std::vector<RunStyle> run_styles(const std::vector<ResultsReader>& runs);

/// The style of a curve that does not belong to a run, by its number.
RunStyle curve_style(std::size_t number);

/// "exact, constant law, 0.001 1/s"
std::string law_label(const Specimen& specimen);

/// Times at which to draw an exact curve from 0 to `end`, including those at which erosion starts
/// and ends, where the curve has kinks.
std::vector<double> exact_times(double end, const Specimen& specimen);

/// The curve with markers at about 24 rows only, evenly in time. The times differ from run to run,
/// so that markers do not hide one another.
Curve with_fewer_markers(Curve curve, std::size_t run, std::size_t runs);

/// Collects the curves of one chart: exact ones, and those of the runs.
class RunCurves {
 public:
  explicit RunCurves(const std::vector<ResultsReader>& runs);

  [[nodiscard]] std::size_t size() const { return labels_.size(); }
  [[nodiscard]] const Specimen& soil(std::size_t run) const { return soils_[run]; }
  /// "the soil", or "the soil that erodes" when a run has soil that does not.
  [[nodiscard]] std::string soil_name() const;
  [[nodiscard]] const std::string& label(std::size_t run) const { return labels_[run]; }
  [[nodiscard]] const RunStyle& style(std::size_t run) const { return styles_[run]; }

  /// Appends `text` to the label of a run.
  void extend_label(std::size_t run, const std::string& text) { labels_[run] += text; }

  /// Adds an exact curve of a run. Its dash and its label are those of the erosion law, with `more`
  /// after the label; a further curve of the same law is grey. Equal curves are drawn once.
  void add_exact(std::size_t run, const std::vector<double>& x, const std::vector<double>& y,
                 const std::string& more = "");
  /// Adds an exact curve of a run without a row in the legend.
  void add_unlabelled_exact(std::size_t run, const std::vector<double>& x,
                            const std::vector<double>& y);
  /// Adds a line with its own style and label, under the curves of the runs.
  void add_line(const Curve& line);
  /// Adds a curve of markers in the style of the run.
  void add_run(std::size_t run, std::vector<double> x, std::vector<double> y);
  /// Adds any curve of a run, with fewer markers.
  void add_run(std::size_t run, Curve curve);
  /// The chart, with time on the x axis. Curves of runs cover exact ones.
  [[nodiscard]] Chart chart(const std::string& title, const std::string& y_label) const;

 private:
  [[nodiscard]] Curve exact_line(std::size_t run, const std::vector<double>& x,
                                 const std::vector<double>& y) const;

  std::vector<Specimen> soils_;
  std::vector<std::string> labels_;
  std::vector<RunStyle> styles_;
  std::vector<std::string> laws_;
  std::vector<Curve> exact_;
  std::vector<Curve> computed_;
};

}  // namespace suffuse
