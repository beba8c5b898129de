#include "figures/figures.hpp"

#include <algorithm>
#include <stdexcept>

#include "common/closest_name.hpp"
#include "common/errors.hpp"
#include "figures/axes.hpp"
#include "figures/boundary_figures.hpp"
#include "figures/flow_figures.hpp"
#include "figures/flow_net.hpp"
#include "figures/gradation_figure.hpp"
#include "figures/model_sketch.hpp"
#include "figures/permeameter_figure.hpp"
#include "figures/profile.hpp"
#include "figures/seepage_map.hpp"
#include "figures/slip_figure.hpp"
#include "figures/soil_figures.hpp"
#include "figures/table_curves.hpp"

namespace suffuse {
namespace {

using Runs = std::vector<ResultsReader>;
using Options = FigureOptions;

/// A figure of `suffuse-post figure`: charts of runs, or a picture of one run or file.
struct Figure {
  std::string name;
  std::vector<Chart> (*charts)(const Runs&, const Options&) = nullptr;
  void (*picture)(const ResultsReader&, const std::string& path, const Options&) = nullptr;
  void (*of_file)(const std::string& file, const std::string& path) = nullptr;
};

Figure of_charts(const std::string& name,
                 std::vector<Chart> (*charts)(const Runs&, const Options&)) {
  return {.name = name, .charts = charts};
}

Figure of_picture(const std::string& name,
                  void (*picture)(const ResultsReader&, const std::string&, const Options&)) {
  return {.name = name, .picture = picture};
}

std::vector<Chart> fines_lost(const Runs& runs, const Options& options) {
  if (options.measured.empty()) return fines_lost_charts(runs);
  return fines_lost_charts(runs, read_measured_points(options.measured));
}

std::vector<Chart> comparison(const Runs& runs) {
  return {porosity_chart(runs), eroded_and_solid_chart(runs), outflow_charts(runs).front()};
}

/// All figures, sorted by name.
const std::vector<Figure>& figures() {
  using Path = std::string;
  static const std::vector<Figure> all{
      of_charts("boundaries",
                [](const Runs& runs, const Options&) { return boundary_charts(runs); }),
      of_charts("comparison", [](const Runs& runs, const Options&) { return comparison(runs); }),
      of_charts("curves", table_curves),
      of_charts(
          "empty-elements",
          [](const Runs& runs, const Options&) { return std::vector{empty_elements_chart(runs)}; }),
      of_charts("fines-lost", fines_lost),
      of_picture("flownet",
                 [](const ResultsReader& run, const Path& path, const Options& options) {
                   draw_flow_net(flow_net(run, options.time, options.tubes), path);
                 }),
      of_charts("flux",
                [](const Runs& runs, const Options&) { return std::vector{flux_chart(runs)}; }),
      of_charts("gradation", [](const Runs& runs,
                                const Options&) { return std::vector{gradation_chart(runs)}; }),
      of_picture("head",
                 [](const ResultsReader& run, const Path& path, const Options& options) {
                   draw_seepage_map(head_map(run, options.time), path);
                 }),
      of_charts("masses",
                [](const Runs& runs, const Options&) { return std::vector{masses_chart(runs)}; }),
      of_picture("model", [](const ResultsReader& run, const Path& path,
                             const Options&) { draw_model_sketch(run, path); }),
      of_charts("outflow", [](const Runs& runs, const Options&) { return outflow_charts(runs); }),
      of_charts("porosity",
                [](const Runs& runs, const Options&) { return std::vector{porosity_chart(runs)}; }),
      of_charts("profile", profile_charts),
      of_picture("saturation",
                 [](const ResultsReader& run, const Path& path, const Options& options) {
                   draw_seepage_map(saturation_map(run, options.time), path);
                 }),
      {.name = "slip", .of_file = draw_slip},
      of_charts("solid-mass", [](const Runs& runs, const Options&) {
        return std::vector{solid_mass_chart(runs)};
      })};
  return all;
}

const Figure& find_figure(const std::string& name) {
  const auto found = std::ranges::find(figures(), name, &Figure::name);
  if (found != figures().end()) return *found;
  throw InputError(InputProblem{"suffuse-post figure", "NAME", "\"" + name + "\"",
                                quoted_list(figure_names()), closest_name(name, figure_names())});
}

/// An option that only some figures use.
struct OptionUse {
  std::string option;
  bool given;
  std::vector<std::string> figures;
};

std::vector<OptionUse> option_uses(const Options& o) {
  const Options none;
  return {{"--time", o.time.has_value(), {"flownet", "head", "saturation"}},
          {"--tubes", o.tubes.has_value(), {"flownet"}},
          {"--measured", !o.measured.empty(), {"curves", "fines-lost", "profile"}},
          {"COLUMN", !o.columns.empty(), {"curves"}},
          {"--x", !o.x.empty(), {"curves"}},
          {"--line", !o.line.empty(), {"profile"}},
          {"--times", !o.times.empty(), {"profile"}},
          {"--fields", !o.fields.empty(), {"profile"}},
          {"--count", o.count != none.count, {"profile"}},
          {"--change", o.change, {"profile"}}};
}

/// Throws InputError for an option that the figure does not use.
void check_options(const Figure& figure, const Options& options) {
  const std::string command = "suffuse-post figure " + figure.name;
  for (const OptionUse& use : option_uses(options)) {
    if (!use.given || std::ranges::find(use.figures, figure.name) != use.figures.end()) continue;
    throw InputError(InputProblem{command, use.option, "it with the figure \"" + figure.name + '"',
                                  "it with " + quoted_list(use.figures)});
  }
  const AxisOptions& axes = options.axes;
  const bool has_axes = axes.log_x || axes.log_y || !axes.x_range.empty() ||
                        !axes.y_range.empty() || !axes.time_unit.empty();
  if (has_axes && figure.charts == nullptr) {
    throw InputError(std::vector{
        InputProblem{command, "axes", "an option of axes", "none: this figure is no chart", ""}});
  }
}

}  // namespace

std::vector<std::string> figure_names() {
  std::vector<std::string> names;
  for (const Figure& figure : figures()) names.push_back(figure.name);
  return names;
}

bool is_of_file(const std::string& name) {
  return find_figure(name).of_file != nullptr;
}

void draw_figure_of_file(const std::string& name, const std::string& file, const std::string& path,
                         const FigureOptions& options) {
  const Figure& figure = find_figure(name);
  if (figure.of_file == nullptr) throw std::logic_error(name + " is of no file");
  check_options(figure, options);
  figure.of_file(file, path);
}

std::vector<Chart> make_figure(const std::string& name, const std::vector<ResultsReader>& runs,
                               const FigureOptions& options) {
  const Figure& figure = find_figure(name);
  if (figure.charts == nullptr) throw std::logic_error(name + " is no chart");
  check_options(figure, options);
  std::vector<Chart> charts = figure.charts(runs, options);
  for (Chart& chart : charts) set_axes(options.axes, "suffuse-post figure " + name, chart);
  return charts;
}

void draw_figure(const std::string& name, const std::vector<ResultsReader>& runs,
                 const std::string& path, const FigureOptions& options) {
  const Figure& figure = find_figure(name);
  if (figure.charts != nullptr) {
    draw_charts(make_figure(name, runs, options), path);
    return;
  }
  check_options(figure, options);
  if (runs.size() != 1) {
    throw InputError(InputProblem{"suffuse-post figure " + name, "RESULTS",
                                  std::to_string(runs.size()) + " folders", "one"});
  }
  if (figure.picture == nullptr) throw std::logic_error(name + " is of no run");
  figure.picture(runs.front(), path, options);
}

}  // namespace suffuse
