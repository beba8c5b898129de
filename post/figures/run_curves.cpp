#include "figures/run_curves.hpp"

#include <algorithm>

#include "files/number_text.hpp"
#include "values/scene_words.hpp"

namespace suffuse {
namespace {

constexpr std::size_t marker_count = 24;
constexpr int curve_intervals = 480;

/// Colours of Okabe and Ito, which colour-blind readers can tell apart. Runs with the same
/// filling of markers differ in brightness too.
constexpr Color dark_blue{0.0, 0.27, 0.53};
constexpr Color vermilion{0.835, 0.369, 0.0};
constexpr Color sky_blue{0.337, 0.706, 0.914};
constexpr Color green{0.0, 0.45, 0.32};
constexpr Color orange{0.902, 0.624, 0.0};
constexpr Color purple{0.8, 0.475, 0.655};

constexpr Color grey{0.6, 0.6, 0.6};

constexpr std::array<Color, 6> all_colors{dark_blue, vermilion, sky_blue, green, orange, purple};
constexpr std::array<Color, 3> cold_colors{dark_blue, sky_blue, green};
constexpr std::array<Color, 3> warm_colors{vermilion, orange, purple};
constexpr std::array<Marker, 4> all_markers{Marker::circle, Marker::square, Marker::diamond,
                                            Marker::target};
constexpr std::array<Marker, 2> single_point_markers{Marker::circle, Marker::square};
constexpr std::array<Marker, 2> double_point_markers{Marker::diamond, Marker::target};

template <std::size_t Markers, std::size_t Colors>
RunStyle style_of(std::size_t number, const std::array<Marker, Markers>& markers,
                  const std::array<Color, Colors>& colors) {
  return {markers[number % Markers], (number / Markers) % 2 == 1, colors[number % Colors]};
}

/// Whether the same curve is among `curves`.
bool is_drawn(const std::vector<Curve>& curves, const Curve& curve) {
  return std::any_of(curves.begin(), curves.end(), [&](const Curve& other) {
    return other.dash == curve.dash && other.x == curve.x && other.y == curve.y;
  });
}

}  // namespace

std::vector<RunStyle> run_styles(const std::vector<ResultsReader>& runs) {
  std::vector<RunStyle> styles;
  const bool mixed = is_mixed(runs);
  std::size_t singles = 0;
  std::size_t doubles = 0;
  for (const auto& run : runs) {
    if (!mixed) {
      styles.push_back(style_of(styles.size(), all_markers, all_colors));
    } else if (is_double_point(run)) {
      styles.push_back(style_of(doubles++, double_point_markers, warm_colors));
    } else {
      styles.push_back(style_of(singles++, single_point_markers, cold_colors));
    }
  }
  return styles;
}

RunStyle curve_style(std::size_t number) {
  return style_of(number, all_markers, all_colors);
}

std::string law_label(const Specimen& specimen) {
  const ErosionModel erosion = specimen.portions.front().soil.erosion_model();
  if (!erosion.law->erodes()) return "exact, no erosion";
  return "exact, " + law_text(erosion, number_text(erosion.rate));
}

std::vector<double> exact_times(double end, const Specimen& specimen) {
  std::vector<double> times;
  for (int k = 0; k <= curve_intervals; ++k) times.push_back(end * k / curve_intervals);
  for (const auto& portion : specimen.portions) {
    const double start = portion.soil.erosion.start;
    if (start > 0.0 && start < end) times.push_back(start);
  }
  if (specimen.portions.size() == 1) {
    const double exhausted = exact_exhaustion(specimen);
    if (exhausted > 0.0 && exhausted < end) times.push_back(exhausted);
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

Curve with_fewer_markers(Curve curve, std::size_t run, std::size_t runs) {
  if (curve.x.size() <= marker_count + 1) return curve;
  const double start = curve.x.front();
  const double spacing = (curve.x.back() - start) / static_cast<double>(marker_count);
  double next = start + spacing * static_cast<double>(run) / static_cast<double>(runs);
  curve.marked.clear();
  for (std::size_t row = 0; row < curve.x.size(); ++row) {
    if (curve.x[row] < next) continue;
    curve.marked.push_back(row);
    while (next <= curve.x[row] && spacing > 0.0) next += spacing;
  }
  return curve;
}

RunCurves::RunCurves(const std::vector<ResultsReader>& runs)
    : labels_(run_labels(runs)), styles_(run_styles(runs)) {
  for (const auto& run : runs) {
    soils_.push_back(specimen(run));
    const std::string law = law_label(soils_.back());
    if (std::ranges::find(laws_, law) == laws_.end()) laws_.push_back(law);
  }
}

std::string RunCurves::soil_name() const {
  return specimen_name(std::ranges::all_of(soils_, &Specimen::has_all_soil));
}

Curve RunCurves::exact_line(std::size_t run, const std::vector<double>& x,
                            const std::vector<double>& y) const {
  Curve line;
  line.label = law_label(soils_[run]);
  line.dash = static_cast<Dash>((std::ranges::find(laws_, line.label) - laws_.begin()) % 5);
  line.x = x;
  line.y = y;
  return line;
}

void RunCurves::add_exact(std::size_t run, const std::vector<double>& x,
                          const std::vector<double>& y, const std::string& more) {
  Curve line = exact_line(run, x, y);
  line.label += more;
  if (std::ranges::any_of(exact_, [&](const Curve& other) {
        return other.dash == line.dash && !other.label.empty() && other.label != line.label;
      })) {
    line.color = grey;
  }
  add_line(line);
}

void RunCurves::add_unlabelled_exact(std::size_t run, const std::vector<double>& x,
                                     const std::vector<double>& y) {
  Curve line = exact_line(run, x, y);
  line.label.clear();
  add_line(line);
}

void RunCurves::add_line(const Curve& line) {
  if (!is_drawn(exact_, line)) exact_.push_back(line);
}

void RunCurves::add_run(std::size_t run, std::vector<double> x, std::vector<double> y) {
  Curve points;
  points.label = label(run);
  points.x = std::move(x);
  points.y = std::move(y);
  points.markers = true;
  points.marker = styles_[run].marker;
  points.hollow = styles_[run].hollow;
  points.color = styles_[run].color;
  add_run(run, points);
}

void RunCurves::add_run(std::size_t run, Curve curve) {
  computed_.push_back(with_fewer_markers(std::move(curve), run, size()));
}

Chart RunCurves::chart(const std::string& title, const std::string& y_label) const {
  Chart chart{title, "time (s)", y_label, exact_};
  chart.curves.insert(chart.curves.end(), computed_.begin(), computed_.end());
  return chart;
}

}  // namespace suffuse
