/// The subcommands `render`, `animate` and `figure`.

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <optional>

#include "commands/command.hpp"
#include "common/closest_name.hpp"
#include "common/errors.hpp"
#include "drawing/picture.hpp"
#include "figures/figures.hpp"
#include "figures/film.hpp"
#include "figures/render.hpp"
#include "tables/table_output.hpp"
#include "values/run_names.hpp"
#include "values/sample.hpp"

namespace suffuse {
namespace {

/// What is drawn, in one picture or in many.
struct FieldOptions {
  std::string results;
  RenderRequest request;
  std::string time;
  std::string range;
  std::string view;
  std::string cut;
  std::string levels;
  std::string camera;

  /// The request, with the values of the options that are given as text.
  [[nodiscard]] RenderRequest read() const {
    RenderRequest result = request;
    if (!time.empty()) result.time = parse_time(time, "suffuse-post render");
    if (!range.empty()) result.range = parse_range(range);
    if (!view.empty()) result.view = parse_view(view);
    if (!cut.empty()) result.cut = parse_cut(cut, "suffuse-post render");
    if (!camera.empty()) result.camera = parse_camera(camera);
    if (!levels.empty()) result.levels = parse_levels(levels);
    return result;
  }
};

void declare_field(CLI::App& command, FieldOptions& o) {
  add_results(command, o.results);
  command.add_option("--field", o.request.field, "what to show")->required();
  command.add_option("--on", o.request.on, "where, if the field lives in several places")
      ->type_name("cell|node|solid|liquid");
  command
      .add_option("--range", o.range,
                  "range of the colours; without it that of the values but for the outermost "
                  "hundredth, where that is far outside")
      ->type_name("LO:HI");
  command.add_flag("--change", o.request.change, "what changed since the start");
  command.add_flag("--log", o.request.logarithmic, "colours by the logarithm");
  command.add_flag("--contours", o.request.contours, "lines of equal values");
  command.add_flag("--vectors", o.request.vectors, "arrows of the flux");
  command.add_flag(
      "--streamlines", o.request.streamlines,
      "streamlines, with a tenth of the discharge between two; of a model in space sixty, "
      "with the same discharge each, in the colours of the field");
  command.add_option("--view", o.view, "two corners of the part to show, m")
      ->type_name("X0,Y0:X1,Y1");
  command
      .add_option("--cut", o.cut,
                  "of a model in space, the plane to show, m; without it the surface is shown")
      ->type_name("x=X|y=Y|z=Z");
  command
      .add_option("--camera", o.camera,
                  "of a model in space: from where it is seen, degrees from the front to the right "
                  "and above the horizon; without it 31,28.8")
      ->type_name("AZIMUTH,ELEVATION");
  command.add_option("--iso", o.levels, "of a model in space: surfaces of equal values")
      ->type_name("VALUE,...");
}

void declare_render(CLI::App& command, FieldOptions& o) {
  declare_field(command, o);
  auto* time = command
                   .add_option("--time", o.time,
                               "time, s or with its unit, as 2.5d: the nearest snapshot; without "
                               "it the last")
                   ->type_name(time_form);
  command
      .add_flag("--all", o.request.all, "every snapshot, in the same colours: FILE_0000.png, ...")
      ->excludes(time);
  command
      .add_option("-o,--output", o.request.output,
                  "picture to write: .png, .svg or .pdf; without it RESULTS-FIELD.png")
      ->type_name("FILE");
}

void render_field(const FieldOptions& o) {
  const ResultsReader results(o.results);
  RenderRequest request = o.read();
  if (request.output.empty()) request.output = folder_name(results) + "-" + request.field + ".png";
  refuse_inside(results, "-o", request.output);
  for (const auto& path : render(results, request)) std::cout << path << "\n";
}

struct AnimateOptions {
  FieldOptions field;
  int rate = 10;
  std::string output;
};

void declare_animate(CLI::App& command, AnimateOptions& o) {
  declare_field(command, o.field);
  command.add_option("--fps", o.rate, "snapshots per second")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  command
      .add_option("-o,--output", o.output,
                  "film: .mp4 needs ffmpeg, .png is an animated PNG, a name that ends in / is a "
                  "folder of pictures")
      ->required()
      ->type_name("FILE.mp4|FILE.png|FOLDER/");
}

void animate(const AnimateOptions& o) {
  check_film_output(o.output);
  const ResultsReader results(o.field.results);
  refuse_inside(results, "-o", o.output);
  const std::string written = write_film(results, {o.field.read(), o.rate, o.output});
  if (written != o.output) {
    std::cerr << "suffuse-post animate: there is no ffmpeg: the film is an animated PNG\n";
  }
  std::cout << written << "\n";
}

struct FigureCommandOptions {
  std::string name;
  std::vector<std::string> arguments;  ///< results folders, after the columns of "curves"; a file
  FigureOptions figure;
  std::string time;
  std::string output;
};

void declare_axes(CLI::App& command, AxisOptions& o) {
  CLI::Option_group* axes = command.add_option_group("axes of charts");
  axes->add_option(
          "--time-unit", o.time_unit,
          "of charts against time; without it that which fits the run, or s with --x-range")
      ->type_name(time_unit_words());
  axes->add_option("--x-range", o.x_range, "ends of the axis")->type_name("LO:HI");
  axes->add_option("--y-range", o.y_range, "ends of the axis")->type_name("LO:HI");
  axes->add_flag("--log-x", o.log_x, "a logarithmic axis");
  axes->add_flag("--log-y", o.log_y, "a logarithmic axis");
}

void declare_figure(CLI::App& command, FigureCommandOptions& o) {
  command.add_option("NAME", o.name, "one of " + quoted_list(figure_names()))->required();
  command
      .add_option("RESULTS", o.arguments,
                  "results folders; before them the columns of \"curves\": COLUMN, "
                  "TABLE.COLUMN, TABLE.COLUMN:NAME; of \"slip\" the file of suffuse-solver "
                  "--mechanism")
      ->required()
      ->type_name("[COLUMN...] FOLDER...|FILE");
  command
      .add_option("--time", o.time,
                  "of \"flownet\", \"head\" and \"saturation\", s or with its unit, as 2.5d: the "
                  "nearest snapshot; without it the last")
      ->type_name(time_form);
  command
      .add_option("--tubes", o.figure.tubes,
                  "of \"flownet\": tubes of equal discharge; without it as many as make squares")
      ->type_name("N");
  command.add_option("--line", o.figure.line, "of \"profile\": two ends, m")
      ->type_name("X0,Y0[,Z0]:X1,Y1[,Z1]");
  command.add_option("--fields", o.figure.fields, "of \"profile\"")->type_name("NAME,...");
  command
      .add_option("--times", o.figure.times,
                  "of \"profile\", s or with their units, with commas between; all: those of the "
                  "snapshots; without it the last")
      ->type_name("T,...|all");
  command.add_option("--count", o.figure.count, "of \"profile\": points on the line")
      ->capture_default_str();
  command.add_flag("--change", o.figure.change, "of \"profile\": what changed since the start");
  command
      .add_option("--x", o.figure.x, "of \"curves\": column along the x-axis, in the place of t")
      ->type_name("COLUMN");
  command
      .add_option(
          "--measured", o.figure.measured,
          "points to draw with the curves: of \"curves\" columns t [UNIT] and those drawn; of "
          "\"profile\" distance and the fields; of \"fines-lost\" hours, and fines_lost, "
          "conductance or both; a column run where there are several")
      ->type_name("FILE.csv");
  declare_axes(command, o.figure.axes);
  command.add_option("-o,--output", o.output, "picture to write: .png, .svg or .pdf")
      ->required()
      ->type_name("FILE");
}

/// Columns of "curves" come before the folders.
void figure(const FigureCommandOptions& o) {
  picture_format(o.output);
  FigureOptions options = o.figure;
  if (!o.time.empty()) options.time = parse_time(o.time, "suffuse-post figure");
  std::vector<std::string> folders = o.arguments;
  if (is_of_file(o.name)) {
    if (folders.size() != 1) {
      throw InputError(InputProblem{"suffuse-post figure " + o.name, "FILE",
                                    std::to_string(folders.size()) + " files", "one"});
    }
    draw_figure_of_file(o.name, folders.front(), o.output, options);
    return;
  }
  if (o.name == "curves") {
    const auto first = std::ranges::find_if(
        folders, [](const std::string& text) { return std::filesystem::is_directory(text); });
    options.columns.assign(folders.begin(), first);
    folders.erase(folders.begin(), first);
    if (folders.empty()) {
      throw InputError(InputProblem{"suffuse-post figure curves", "RESULTS", "none",
                                    "a results folder behind the columns"});
    }
  }
  const auto runs = open_all(folders);
  for (const auto& run : runs) refuse_inside(run, "-o", o.output);
  draw_figure(o.name, runs, o.output, options);
}

}  // namespace

void add_picture_commands(Commands& commands) {
  commands.add("render", "Pictures of a field on the model", declare_render, render_field);
  commands.add("animate", "A film of a field on the model", declare_animate, animate);
  commands.add("figure", "A figure of one or more runs", declare_figure, figure);
}

}  // namespace suffuse
