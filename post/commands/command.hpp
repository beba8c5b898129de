#pragma once

/// Subcommands of suffuse-post. Each has its options in a struct of its own.

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "results/reader.hpp"

namespace suffuse {

/// The subcommands of a program, and the one that the user names.
class Commands {
 public:
  explicit Commands(CLI::App& app) : app_(app) {}

  /// Adds a subcommand. `declare` adds its options, which are stored in an `Options`; `action` gets
  /// them when the user names this command.
  template <class Options>
  void add(const std::string& name, const std::string& sentence,
           void (*declare)(CLI::App&, Options&), void (*action)(const Options&)) {
    const auto options = std::make_shared<Options>();
    CLI::App* command = app_.add_subcommand(name, sentence);
    declare(*command, *options);
    command->callback(
        [this, options, action] { chosen_ = [options, action] { action(*options); }; });
  }

  /// Runs the subcommand that the command line named.
  void run() const { chosen_(); }

 private:
  CLI::App& app_;
  std::function<void()> chosen_;
};

void add_balance_commands(Commands& commands);
void add_value_commands(Commands& commands);
void add_picture_commands(Commands& commands);
void add_sweep_command(Commands& commands);
void add_file_commands(Commands& commands);
void add_report_command(Commands& commands);

/// The argument RESULTS: one folder, or several.
void add_results(CLI::App& command, std::string& folder);
void add_results(CLI::App& command, std::vector<std::string>& folders);

/// Opens the folders. Throws FileError.
std::vector<ResultsReader> open_all(const std::vector<std::string>& folders);

/// Refuses to write into a results folder: its tables could be overwritten, and the solver deletes
/// the folder when it runs again. Throws InputError, naming `option`.
void refuse_inside(const ResultsReader& results, const std::string& option,
                   const std::string& path);

/// The output of a table, and the unit of its times.
struct TableOutput {
  std::string path;  ///< "-": standard output; empty: nowhere
  std::string time_unit = "s";
};

/// Values of options for one time.
inline constexpr const char* time_form = "T[s|min|h|d|a]";

/// Adds the option --csv, whose help says that it writes `what`, and --time-unit.
void add_table_options(CLI::App& command, TableOutput& output, const std::string& what);

/// Writes a table with its units to a file outside the results, or to standard output. Throws
/// InputError, FileError.
void write_csv(const ResultsReader& results, const TableOutput& output, const Table& table);

}  // namespace suffuse
