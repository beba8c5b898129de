#include "figures/figures.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "case/closest_name.hpp"
#include "case/errors.hpp"
#include "figures/boundary_figures.hpp"
#include "figures/flow_figures.hpp"
#include "figures/gradation_figure.hpp"
#include "figures/model_sketch.hpp"
#include "figures/permeameter_figure.hpp"
#include "figures/seepage_map.hpp"
#include "figures/soil_figures.hpp"
#include "results/number_text.hpp"

namespace suffuse {
namespace {

using Runs = std::vector<ResultsReader>;
using FigureMaker = std::vector<Chart> (*)(const Runs&);

std::vector<Chart> comparison(const Runs& runs) {
  return {porosity_chart(runs), eroded_and_solid_chart(runs), outflow_charts(runs).front()};
}

const std::map<std::string, FigureMaker>& figure_makers() {
  static const std::map<std::string, FigureMaker> makers{
      {"porosity", [](const Runs& runs) { return std::vector{porosity_chart(runs)}; }},
      {"masses", [](const Runs& runs) { return std::vector{masses_chart(runs)}; }},
      {"solid-mass", [](const Runs& runs) { return std::vector{solid_mass_chart(runs)}; }},
      {"empty-elements", [](const Runs& runs) { return std::vector{empty_elements_chart(runs)}; }},
      {"flux", [](const Runs& runs) { return std::vector{flux_chart(runs)}; }},
      {"gradation", [](const Runs& runs) { return std::vector{gradation_chart(runs)}; }},
      {"outflow", outflow_charts},
      {"fines-lost", [](const Runs& runs) { return fines_lost_charts(runs); }},
      {"boundaries", boundary_charts},
      {"comparison", comparison}};
  return makers;
}

/// Draws a picture of one run, at a time where it has one.
using PictureMaker = void (*)(const ResultsReader&, const std::string&,
                              const std::optional<double>&);

const std::map<std::string, PictureMaker>& picture_makers() {
  using Time = std::optional<double>;
  static const std::map<std::string, PictureMaker> makers{
      {"model", [](const ResultsReader& run, const std::string& path,
                   const Time&) { draw_model_sketch(run, path); }},
      {"head", [](const ResultsReader& run, const std::string& path,
                  const Time& time) { draw_seepage_map(head_map(run, time), path); }},
      {"saturation", [](const ResultsReader& run, const std::string& path, const Time& time) {
         draw_seepage_map(saturation_map(run, time), path);
       }}};
  return makers;
}

}  // namespace

std::vector<std::string> figure_names() {
  std::vector<std::string> names;
  for (const auto& [name, maker] : picture_makers()) names.push_back(name);
  for (const auto& [name, maker] : figure_makers()) names.push_back(name);
  std::ranges::sort(names);
  return names;
}

std::vector<Chart> make_figure(const std::string& name, const std::vector<ResultsReader>& runs) {
  const auto found = figure_makers().find(name);
  if (found == figure_makers().end()) {
    throw InputError(
        std::vector{InputProblem{"suffuse-post figure", "NAME", "\"" + name + "\"",
                                 quoted_list(figure_names()), closest_name(name, figure_names())}});
  }
  return found->second(runs);
}

void draw_figure(const std::string& name, const std::vector<ResultsReader>& runs,
                 const std::string& path, const FigureOptions& options) {
  const auto picture = picture_makers().find(name);
  const std::optional<double>& time = options.time;
  const bool is_map = name == "head" || name == "saturation";
  if (time && !is_map) {
    throw InputError(std::vector{
        InputProblem{"suffuse-post figure " + name, "--time", number_text(*time),
                     "no time: it is for the figures \"head\" and \"saturation\"", ""}});
  }
  if (time && !std::isfinite(*time)) {
    throw InputError(std::vector{InputProblem{"suffuse-post figure " + name, "--time",
                                              number_text(*time), "a time in seconds", ""}});
  }
  if (!options.measured.empty()) {
    if (name != "fines-lost") {
      throw InputError(std::vector{
          InputProblem{"suffuse-post figure " + name, "--measured", options.measured,
                       "no measured points: they are for the figure \"fines-lost\"", ""}});
    }
    draw_charts(fines_lost_charts(runs, read_measured_points(options.measured)), path);
    return;
  }
  if (picture == picture_makers().end()) {
    draw_charts(make_figure(name, runs), path);
    return;
  }
  if (runs.size() != 1) {
    throw InputError(
        std::vector{InputProblem{"suffuse-post figure " + name, "RESULTS",
                                 std::to_string(runs.size()) + " folders", "one", ""}});
  }
  picture->second(runs.front(), path, time);
}

}  // namespace suffuse
