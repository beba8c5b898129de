#include "figures/profile.hpp"

#include <functional>

#include "common/errors.hpp"
#include "drawing/color_map.hpp"
#include "drawing/ticks.hpp"
#include "figures/measured.hpp"
#include "files/time_unit.hpp"
#include "tables/table_output.hpp"
#include "values/name_words.hpp"
#include "values/refusal.hpp"
#include "values/run_names.hpp"
#include "values/sample.hpp"

namespace suffuse {
namespace {

const std::string profile_command = "suffuse-post figure profile";
constexpr std::size_t max_curves = 12;
const std::string distance = "distance";

/// Earlier curves are darker; dashes differ too, because colours may be lost in print.
Curve curve_at(std::size_t number, std::size_t count) {
  constexpr std::array<Dash, 5> dashes{Dash::solid, Dash::dashed, Dash::dash_dot, Dash::dotted,
                                       Dash::dash_dot_dot};
  constexpr double brightest = 0.75;  // lines on white must be seen
  Curve curve;
  curve.color = viridis(
      count < 2 ? 0.0 : brightest * static_cast<double>(number) / static_cast<double>(count - 1));
  curve.dash = dashes.at(number % dashes.size());
  curve.width = 3.0F;
  return curve;
}

SampleRequest request_of(const ResultsReader& run, const FigureOptions& options) {
  SampleRequest request;
  request.times =
      options.times.empty() ? std::vector{run.times().back()} : parse_times(run, options.times);
  request.positions = places_on(parse_line(options.line), options.count);
  request.fields = parse_field_names(options.fields);
  request.change = options.change;
  return request;
}

/// "(0.5, 0) to (0.5, 1) m"
std::string ends_text(const SampleLine& line) {
  const auto place = [](const Position& x) { return place_text({x.begin(), x.end()}); };
  return place(line.from) + " to " + place(line.to) + " m";
}

/// Labels of the curves of a run by their times.
using TimeLabel = std::function<std::string(double time)>;

TimeLabel time_label(const ResultsReader& run, const SampleRequest& request,
                     const std::string& unit_name) {
  if (!unit_name.empty()) {
    const TimeUnit unit = parse_time_unit(unit_name, profile_command);
    return [unit](double t) { return "t = " + tick_text(t / unit.seconds) + " " + unit.name; };
  }
  const double end = run.times().back();
  const double spacing = least_spacing(request.times);
  return [end, spacing](double t) { return "t = " + time_words(t, end, spacing); };
}

/// The column of the first field, behind time and place.
std::size_t first_field(const Table& table) {
  return table.has("z") ? 4 : 3;
}

void add_curves(const Table& table, const SampleRequest& request, const std::string& label,
                const TimeLabel& time_label, std::size_t before, std::size_t count,
                std::vector<Chart>& charts) {
  const std::size_t places = request.positions.size();
  for (std::size_t k = 0; k < charts.size(); ++k) {
    for (std::size_t i = 0; i < request.times.size(); ++i) {
      Curve curve = curve_at(before + i, count);
      curve.label = label + time_label(request.times[i]);
      for (std::size_t p = 0; p < places; ++p) {
        curve.x.push_back((request.positions[p] - request.positions[0]).norm());
        curve.y.push_back(table.columns[first_field(table) + k][i * places + p]);
      }
      charts[k].curves.push_back(std::move(curve));
    }
  }
}

}  // namespace

std::vector<Chart> profile_charts(const std::vector<ResultsReader>& runs,
                                  const FigureOptions& options) {
  if (options.line.empty())
    refuse(profile_command, "--line", "nothing", "x0,y0:x1,y1 or x0,y0,z0:x1,y1,z1 in metres");
  if (options.fields.empty()) refuse(profile_command, "--fields", "nothing", "names of fields");
  const SampleNames names{profile_command, "--times", "--line", "--fields"};
  const std::vector<std::string> labels = run_labels(runs);
  std::vector<SampleRequest> requests;
  std::size_t count = 0;
  for (const ResultsReader& run : runs) {
    requests.push_back(request_of(run, options));
    count += requests.back().times.size();
  }
  if (count > max_curves) {
    refuse(profile_command, "--times", std::to_string(count) + " curves",
           "at most " + std::to_string(max_curves));
  }
  std::vector<Chart> charts;
  std::vector<std::string> columns;
  std::size_t before = 0;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const Table table = sample(runs[r], requests[r], names);
    for (std::size_t k = charts.size() + first_field(table); k < table.names.size(); ++k) {
      const std::string what = (options.change ? "change of " : "") + field_words(table.names[k]);
      columns.push_back(table.names[k]);
      charts.push_back({capitalized(what) + " from " + ends_text(parse_line(options.line)),
                        "distance along the line (m)",
                        what + " (" + table.units[k] + ")",
                        {}});
    }
    const std::string label = runs.size() > 1 ? labels[r] + ", " : "";
    add_curves(table, requests[r], label, time_label(runs[r], requests[r], options.axes.time_unit),
               before, count, charts);
    before += requests[r].times.size();
  }
  if (options.measured.empty()) return charts;
  const MeasuredPoints measured = read_measured(options.measured);
  for (std::size_t k = 0; k < charts.size(); ++k) {
    add_measured(measured, distance, columns[k], labels, charts[k]);
  }
  return charts;
}

}  // namespace suffuse
