#pragma once

/// The command line of a program. All three programs report its errors in one form:
/// `PROGRAM: error: got FOUND; expected EXPECTED (see --help); did you mean SUGGESTION?`

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/closest_name.hpp"
#include "common/errors.hpp"

namespace suffuse {

/// The last lines of --help: ExitCode in words.
inline const std::string exit_codes_help =
    "Exit codes: 0 done, 2 wrong input, 3 a computation or a check failed, 4 a file cannot be "
    "read or written, 130 interrupted (SIGINT, SIGTERM, SIGHUP).";

/// The problem of the first argument that no option or command takes.
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
  return InputError(InputProblem{
      "", "", '"' + first + '"',
      (is_option ? "an option of " : "no more arguments of ") + program + " (see --help)",
      is_option ? closest_name(first.substr(0, first.find('=')), known) : ""});
}

/// Names a misspelt command, which CLI11 would report as a missing one.
inline void refuse_unknown_command(const CLI::App& app, const std::string& first) {
  std::vector<std::string> known;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    known.push_back(command->get_name());
  }
  if (known.empty() || first.starts_with("-") || std::ranges::count(known, first) > 0) return;
  throw InputError(std::vector{
      InputProblem{"", "", '"' + first + '"', quoted_list(known), closest_name(first, known)}});
}

/// Whether two paths name one file, which need not exist.
inline bool same_file(const std::string& a, const std::string& b) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  return fs::equivalent(a, b, ignored) ||
         fs::weakly_canonical(fs::absolute(a)) == fs::weakly_canonical(fs::absolute(b));
}

/// Checks that the value of an option is a number in [low, high]; CLI11's Range lets nan pass.
inline CLI::Validator number_in(double low, double high) {
  const CLI::Range range(low, high);
  return {[range](std::string& text) {
            double value = 0.0;
            const bool is_number = CLI::detail::lexical_cast(text, value) && !std::isnan(value);
            return is_number ? range(text) : "Value " + text + " is not a number";
          },
          range.get_description()};
}

/// Reads the arguments. Returns an exit code if the program is done, after --help or --version.
/// Throws InputError.
inline std::optional<int> parse_command_line(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    if (argc > 1) refuse_unknown_command(app, argv[1]);
    if (!app.remaining(true).empty()) throw unknown_argument(app);
    throw InputError(std::string(error.what()) + " (see --help)");
  }
  return std::nullopt;
}

}  // namespace suffuse
