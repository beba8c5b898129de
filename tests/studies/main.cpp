/// suffuse-studies: charts of the accuracy and stress studies, from the tables that they write.

#include <CLI/CLI.hpp>

#include "common/errors.hpp"
#include "drawing/chart.hpp"
#include "drawing/picture.hpp"
#include "studies/accuracy_chart.hpp"
#include "studies/stress_chart.hpp"

namespace {

using namespace suffuse;

struct Arguments {
  std::string table;
  std::string problem;
  std::string output;
};

CLI::App* add_command(CLI::App& app, Arguments& a, const std::string& name,
                      const std::string& sentence) {
  auto* command = app.add_subcommand(name, sentence);
  command->add_option("TABLE", a.table, "table that make -C workflows " + name + " writes")
      ->required()
      ->type_name("FILE.csv");
  command->add_option("-o,--output", a.output, "picture to write: .png, .svg or .pdf")
      ->required()
      ->type_name("FILE");
  return command;
}

int run(int argc, char** argv) {
  CLI::App app{"Charts of the project's own studies.", "suffuse-studies"};
  app.require_subcommand(1);
  Arguments a;
  auto* accuracy = add_command(app, a, "accuracy", "Chart of wall time against error");
  accuracy->add_option("--problem", a.problem, "the problem whose runs to draw")->required();
  const auto* stress = add_command(app, a, "stress", "Chart of how the runs of each sweep ended");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int code = app.exit(error);
    return static_cast<int>(code == 0 ? ExitCode::done : ExitCode::wrong_input);
  }
  picture_format(a.output, "suffuse-studies " + app.get_subcommands().front()->get_name());
  if (stress->parsed()) {
    draw_stress_chart(read_sweep_counts(a.table), a.output);
  } else {
    draw_charts(accuracy_charts(read_accuracy_runs(a.table), a.problem), a.output);
  }
  return static_cast<int>(ExitCode::done);
}

}  // namespace

int main(int argc, char** argv) {
  return suffuse::run_program("suffuse-studies", [&] { return run(argc, argv); });
}
