/// The subcommands `render` and `figure`.

#include <iostream>
#include <optional>

#include "case/closest_name.hpp"
#include "commands/command.hpp"
#include "drawing/picture.hpp"
#include "figures/figures.hpp"
#include "figures/render.hpp"
#include "values/run_names.hpp"

namespace suffuse {
namespace {

struct RenderOptions {
  std::string results;
  RenderRequest request;
  std::string range;
};

void declare_render(CLI::App& command, RenderOptions& o) {
  add_results(command, o.results);
  command.add_option("--field", o.request.field, "what to show")->required();
  auto* time = command.add_option("--time", o.request.time,
                                  "time, s: the nearest snapshot; without it the last");
  command
      .add_flag("--all", o.request.all, "every snapshot, in the same colours: FILE_0000.png, ...")
      ->excludes(time);
  command.add_option("--on", o.request.on, "where, if the field lives in several places")
      ->type_name("cell|node|solid|liquid");
  command.add_option("--range", o.range, "range of the colours; without it that of the values")
      ->type_name("LO,HI");
  command
      .add_option("-o,--output", o.request.output, "picture to write; without it RESULTS-FIELD.png")
      ->type_name("FILE.png");
}

void render_field(const RenderOptions& o) {
  const ResultsReader results(o.results);
  RenderRequest request = o.request;
  if (!o.range.empty()) request.range = parse_range(o.range);
  if (request.output.empty()) request.output = folder_name(results) + "-" + request.field + ".png";
  refuse_inside(results, "-o", request.output);
  for (const auto& path : render(results, request)) std::cout << path << "\n";
}

struct FigureCommandOptions {
  std::string name;
  std::vector<std::string> results;
  FigureOptions figure;
  std::string output;
};

void declare_figure(CLI::App& command, FigureCommandOptions& o) {
  command.add_option("NAME", o.name, "one of " + quoted_list(figure_names()))->required();
  add_results(command, o.results);
  command.add_option(
      "--time", o.figure.time,
      "of \"head\" and \"saturation\", s: the nearest snapshot; without it the last");
  command
      .add_option(
          "--measured", o.figure.measured,
          "of \"fines-lost\": points beside the curves; columns run, hours, and fines_lost, "
          "conductance or both")
      ->type_name("FILE.csv");
  command.add_option("-o,--output", o.output, "picture to write: .png, .svg or .pdf")
      ->required()
      ->type_name("FILE");
}

void figure(const FigureCommandOptions& o) {
  picture_format(o.output);
  const auto runs = open_all(o.results);
  for (const auto& run : runs) refuse_inside(run, "-o", o.output);
  draw_figure(o.name, runs, o.output, o.figure);
}

}  // namespace

void add_picture_commands(Commands& commands) {
  commands.add("render", "Pictures of a field on the model", declare_render, render_field);
  commands.add("figure", "A figure of one or more runs", declare_figure, figure);
}

}  // namespace suffuse
