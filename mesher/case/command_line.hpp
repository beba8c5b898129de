#pragma once

/// The command line of a program. What is wrong with it is said in the same way by all three:
/// `PROGRAM: error: got FOUND; expected EXPECTED (see --help); did you mean SUGGESTION?`

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "case/closest_name.hpp"
#include "case/errors.hpp"

namespace suffuse {

/// The last lines of --help: ExitCode in words.
inline const std::string exit_codes_help =
    "Exit codes: 0 done, 2 wrong input, 3 a computation or a check failed, 4 a file cannot be "
    "read or written, 130 interrupted (SIGINT, SIGTERM, SIGHUP).";

/// What is wrong with the first argument that no option or command takes.
inline InputError unknown_argument(const CLI::App& app) {
  const std::string first = app.remaining(true).front();
  std::string program = app.get_name();
  std::vector<std::string> known;
  std::vector<const CLI::App*> commands{&app};
  for (const CLI::App* command : app.get_subcommands()) {
    commands.push_back(command);
    program += ' ' + command->get_name();
  }
  for (const CLI::App* command : commands) {
    for (const CLI::Option* option : command->get_options()) {
      for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
    }
  }
  const bool is_option = first.starts_with("-");
  return InputError(std::vector{InputProblem{
      "", "", '"' + first + '"',
      (is_option ? "an option of " : "no more arguments of ") + program + " (see --help)",
      is_option ? closest_name(first.substr(0, first.find('=')), known) : ""}});
}

/// Reads the arguments. The exit code where the program is done: after --help or --version. Throws
/// InputError.
inline std::optional<int> parse_command_line(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ExtrasError&) {
    throw unknown_argument(app);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    throw InputError(std::string(error.what()) + " (see --help)");
  }
  return std::nullopt;
}

}  // namespace suffuse
