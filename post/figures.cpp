#include "figures.hpp"

#include <algorithm>
#include <map>

#include "case/closest_name.hpp"
#include "case/errors.hpp"
#include "flow_figures.hpp"
#include "model_sketch.hpp"
#include "soil_figures.hpp"

namespace suffuse {
namespace {

const std::string model_name = "model";

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
      {"outflow", outflow_charts},
      {"comparison", comparison}};
  return makers;
}

}  // namespace

std::vector<std::string> figure_names() {
  std::vector<std::string> names{model_name};
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
                 const std::string& path) {
  if (name != model_name) {
    draw_charts(make_figure(name, runs), path);
    return;
  }
  if (runs.size() != 1) {
    throw InputError(
        std::vector{InputProblem{"suffuse-post figure model", "RESULTS",
                                 std::to_string(runs.size()) + " folders", "one", ""}});
  }
  draw_model_sketch(runs.front(), path);
}

}  // namespace suffuse
