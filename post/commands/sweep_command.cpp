/// The subcommand `sweep`.

#include "commands/command.hpp"
#include "common/errors.hpp"
#include "drawing/picture.hpp"
#include "figures/sweep_figures.hpp"

namespace suffuse {
namespace {

struct SweepOptions {
  std::string table;
  std::string x;
  std::vector<std::string> y;
  std::vector<std::string> over_time;
  std::string output;
};

void declare_sweep(CLI::App& command, SweepOptions& o) {
  command.add_option("TABLE", o.table, "sweep.csv of make's target sweep; results lie beside it")
      ->required()
      ->type_name("FILE.csv");
  auto* y = command.add_option("--y", o.y, "columns of the table; without --x their distributions")
                ->delimiter(',')
                ->type_name("COLUMN,...");
  command.add_option("--x", o.x, "key or column to draw them over")->needs(y)->type_name("COLUMN");
  command
      .add_option("--over-time", o.over_time,
                  "columns of history.csv or ledger.csv, to draw against time")
      ->delimiter(',')
      ->excludes(y)
      ->type_name("COLUMN,...");
  command.add_option("-o,--output", o.output, "picture to write: .png, .svg or .pdf")
      ->required()
      ->type_name("FILE");
}

void sweep(const SweepOptions& o) {
  picture_format(o.output, "suffuse-post sweep");
  if (o.y.empty() && o.over_time.empty()) {
    throw InputError(InputProblem{"suffuse-post sweep", "", "neither", "--y or --over-time"});
  }
  const SweepTable table = read_sweep(o.table);
  if (o.y.empty()) {
    draw_charts(over_time_charts(table, o.over_time), o.output);
  } else if (o.x.empty()) {
    draw_charts(distribution_charts(table, o.y), o.output);
  } else {
    const ResultsReader first(table.results().front());
    draw_charts(over_key_charts(table, o.x, o.y, &first.scene().scene), o.output);
  }
}

}  // namespace

void add_sweep_command(Commands& commands) {
  commands.add("sweep", "A figure of the runs of a sweep, with median and 10 to 90 %",
               declare_sweep, sweep);
}

}  // namespace suffuse
