/// suffuse-solver: runs a case file. suffuse-solver-mpi is the same for several ranks.

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "common/command_line.hpp"
#include "driver/interrupt.hpp"
#include "driver/memory.hpp"
#include "driver/rank_refusals.hpp"
#include "driver/run.hpp"
#include "driver/source_run.hpp"
#include "ranks/launch_ranks.hpp"
#include "ranks/start_ranks.hpp"
#include "tools/element_test.hpp"
#include "tools/estimate.hpp"
#include "tools/mesh_again.hpp"
#include "tools/rank_trial.hpp"
#include "tools/strength_table.hpp"

namespace {

using suffuse::Ranks;

const std::string program = SUFFUSE_PROGRAM;

struct Arguments {
  std::string case_path;
  std::string folder;
  suffuse::SolverOptions solver;
  int ranks = 1;
  std::vector<std::string> without_ranks;  ///< all arguments but --ranks, for other programs
  bool explain = false;
  std::optional<long> trial;
  suffuse::RunOptions run;
  suffuse::ElementTestOptions element;
  suffuse::SizesOptions sizes;
  bool strength_reduction = false;
  suffuse::StrengthReductionOptions strength;
};

std::string default_folder(const std::string& case_path) {
  const auto slash = case_path.find_last_of('/');
  std::string name = slash == std::string::npos ? case_path : case_path.substr(slash + 1);
  for (const std::string suffix : {".h5", ".case"}) {
    if (name.ends_with(suffix)) name.resize(name.size() - suffix.size());
  }
  return name + ".results";
}

/// Prints the plan of a run and its estimated cost. Leaves no files.
template <int Dim>
int explain(const suffuse::Case<Dim>& c, const suffuse::Plan& plan, const Arguments& arguments) {
  using namespace suffuse;
  if (arguments.ranks > 1) refuse_on_ranks(c);
  const int threads = arguments.solver.threads;
  const std::optional<SourceRun<Dim>> earlier = read_source_run(c, {.threads = threads});
  if (earlier) {
    for (const std::string& sentence : earlier->sentences) std::cout << sentence << '\n';
  }
  for (const std::string& sentence : plan.sentences) std::cout << sentence << '\n';
  for (const std::string& warning : plan.warnings) std::cout << "warning: " << warning << '\n';
  std::cout << std::flush;
  catch_interrupts();
  for (const std::string& sentence :
       sentences(estimate_run(c, plan, {}, earlier ? &earlier->state : nullptr), threads)) {
    std::cout << sentence << '\n';
  }
  if (arguments.ranks > 1) {
    std::cout << std::flush;
    for (const std::string& line : compare_ranks(arguments.ranks, arguments.without_ranks)) {
      std::cout << line << '\n';
    }
  }
  return static_cast<int>(ExitCode::done);
}

/// Makes the first steps of a run, and says what they cost. Leaves no files.
template <int Dim>
int try_first_steps(const suffuse::Case<Dim>& c, const suffuse::Plan& plan,
                    const Arguments& arguments) {
  using namespace suffuse;
  const Ranks& ranks = *arguments.solver.ranks;
  const bool speaks = ranks.rank() == 0;
  if (speaks && !arguments.trial) {
    for (const std::string& sentence : plan.sentences) std::cout << sentence << '\n';
    for (const std::string& warning : plan.warnings) std::cout << "warning: " << warning << '\n';
    std::cout << std::flush;
  }
  catch_interrupts();
  const RankTrial trial = try_ranks(c, plan, arguments.solver, arguments.trial.value_or(0));
  if (any_of_all(ranks, interrupted())) return static_cast<int>(ExitCode::interrupted);
  if (speaks) std::cout << sentence(trial) << '\n' << std::flush;
  return static_cast<int>(ExitCode::done);
}

template <int Dim>
int solve(const Arguments& arguments) {
  using namespace suffuse;
  Case<Dim> c = read_case<Dim>(arguments.case_path);
  const Plan plan = make_plan(c, arguments.solver);
  if (arguments.trial || (arguments.explain && arguments.solver.ranks->count() > 1)) {
    return try_first_steps(c, plan, arguments);
  }
  if (arguments.explain) return explain(c, plan, arguments);
  const std::string folder =
      arguments.folder.empty() ? default_folder(arguments.case_path) : arguments.folder;
  const int code =
      run_case(std::move(c), plan, arguments.solver, folder, arguments.run, arguments.case_path);
  const bool speaks = !arguments.run.quiet && arguments.solver.ranks->rank() == 0;
  if (speaks && code == 0) std::fprintf(stderr, "results in %s\n", folder.c_str());
  return code;
}

int solve_case(const Arguments& arguments) {
  suffuse::give_memory_back();
  return suffuse::read_case_dimension(arguments.case_path) == 2 ? solve<2>(arguments)
                                                                : solve<3>(arguments);
}

std::string refuse_empty(const std::string& name) {
  return name.empty() ? "got an empty name; expected that of a folder" : "";
}

/// Adds the options of the element test.
void add_element_test(CLI::App& app, suffuse::ElementTestOptions& element) {
  CLI::Option* table =
      app.add_option("--element-test", element.table,
                     "Run no case: put a soil of a scene, SCENE.toml in the place of the case, "
                     "through this table of strains and stresses; -o names the table of what it "
                     "answers (default: -, standard output)")
          ->type_name("TABLE.csv");
  app.add_option("--soil", element.soil, "Soil to test, where several have a law of the skeleton")
      ->type_name("NAME")
      ->needs(table);
  app.add_option("--set", element.overrides, "Change a key of the scene to test, repeatable")
      ->type_name("KEY=VALUE")
      ->type_size(1)
      ->allow_extra_args(false)
      ->needs(table);
  app.add_option("--steps", element.steps, "Rows of the answer for each row of the table")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str()
      ->needs(table);
  for (const char* other : {"--explain", "--no-skip", "--resume", "--force"}) {
    table->excludes(app.get_option(other));
  }
}

/// Adds the options of the strength reduction.
void add_strength_reduction(CLI::App& app, Arguments& arguments) {
  CLI::Option* mode = app.add_flag(
      "--strength-reduction", arguments.strength_reduction,
      "Do not run the case: find the factor of safety of its soil, by which tan(friction) and "
      "cohesion can be divided, at the start of the case; -o names the table of what it answers "
      "(default: -, standard output)");
  CLI::Option* state =
      app.add_option("--state", arguments.strength.state,
                     "Find it in the last state of a run on the same mesh and points, not at the "
                     "start: places, porosities, fines left and pore pressures of that run, "
                     "strengths and boundary loads of the case")
          ->check(refuse_empty)
          ->type_name("FOLDER")
          ->needs(mode);
  app.add_option("--time", arguments.strength.time,
                 "Time of a snapshot of that run, in s or with a unit, in the place of the last; "
                 "all: a row for each")
      ->type_name("TIME")
      ->needs(state);
  app.add_option("--region", arguments.strength.failing.regions,
                 "Only the soil of this region fails, other soil is elastic; more than once for "
                 "more regions")
      ->allow_extra_args(false)
      ->type_name("NAME")
      ->needs(mode);
  app.add_option("--deeper", arguments.strength.failing.depth,
                 "Leave out bodies that fail within this distance of the surface of the soil, m")
      ->check(suffuse::number_in(1e-6, 1e6))
      ->type_name("DEPTH")
      ->needs(mode);
  app.add_flag_callback(
         "--quadratic",
         [&arguments] { arguments.strength.displacements = suffuse::Displacements::quadratic; },
         "Find it with quadratic displacements: nearer to the limit on coarse meshes, and slower, "
         "up "
         "to some ten times on the same mesh")
      ->needs(mode);
  app.add_option("--mechanism", arguments.strength.mechanism,
                 "Write how the soil fails, on the mesh, as a file for ParaView")
      ->check(refuse_empty)
      ->type_name("FILE.hdf")
      ->needs(mode);
  for (const char* other :
       {"--explain", "--no-skip", "--resume", "--force", "--checkpoint-every", "--element-test"}) {
    mode->excludes(app.get_option(other));
  }
}

/// Adds the option of meshing again.
void add_sizes(CLI::App& app, suffuse::SizesOptions& sizes) {
  CLI::Option* mode =
      app.add_option(
             "--sizes", sizes.output,
             "Do not run the case: say between which values the discharge of its steady "
             "flow lies, and write sizes of elements for suffuse-mesher --sizes, with which "
             "it is known to mesh.error")
          ->check(refuse_empty)
          ->type_name("SIZES.h5");
  app.add_option("--from", sizes.run,
                 "Look at a run of the case with mesh.error, not at the steady flow of its start: "
                 "each element gets its largest error of all snapshots")
      ->check(refuse_empty)
      ->type_name("FOLDER")
      ->needs(mode);
  for (const char* other : {"--explain", "--no-skip", "--resume", "--force", "--checkpoint-every",
                            "--element-test", "--strength-reduction", "--output"}) {
    mode->excludes(app.get_option(other));
  }
}

int mesh_again(const Arguments& arguments) {
  suffuse::SizesOptions options = arguments.sizes;
  options.threads = arguments.solver.threads;
  if (suffuse::same_file(options.output, arguments.case_path)) {
    throw suffuse::InputError("--sizes " + options.output +
                              " would overwrite the case; name another file");
  }
  if (suffuse::read_case_dimension(arguments.case_path) == 2) {
    suffuse::write_sizes(suffuse::read_case<2>(arguments.case_path), options);
  } else {
    suffuse::write_sizes(suffuse::read_case<3>(arguments.case_path), options);
  }
  return static_cast<int>(suffuse::ExitCode::done);
}

int find_strength(Arguments& arguments) {
  if (!arguments.folder.empty()) arguments.strength.output = arguments.folder;
  arguments.strength.threads = arguments.solver.threads;
  arguments.strength.quiet = arguments.run.quiet;
  if (suffuse::read_case_dimension(arguments.case_path) == 2) {
    suffuse::run_strength_reduction(suffuse::read_case<2>(arguments.case_path), arguments.strength);
  } else {
    suffuse::run_strength_reduction(suffuse::read_case<3>(arguments.case_path), arguments.strength);
  }
  return static_cast<int>(suffuse::ExitCode::done);
}

/// Runs are shared by ranks, other modes are not.
void refuse_modes_on_ranks(const CLI::App& app, int ranks) {
  if (ranks == 1) return;
  for (const char* mode : {"--element-test", "--strength-reduction", "--sizes"}) {
    if (app.count(mode) == 0) continue;
    throw suffuse::InputError(suffuse::InputProblem{"", mode, std::to_string(ranks) + " ranks",
                                                    "one process: suffuse-solver", ""});
  }
}

/// The arguments but for an option and its value.
std::vector<std::string> without_option(const std::string& option, int argc, char** argv) {
  std::vector<std::string> others;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == option) {
      ++i;
    } else if (!word.starts_with(option + "=")) {
      others.push_back(word);
    }
  }
  return others;
}

int run(int argc, char** argv, std::shared_ptr<const Ranks> ranks) {
  Arguments arguments;
  CLI::App app{program + ": suffusion by the material point method", program};
  app.footer(suffuse::exit_codes_help);
  app.set_version_flag("--version", SUFFUSE_VERSION);
  app.add_option("case", arguments.case_path, "Case file that suffuse-mesher wrote")
      ->required()
      ->type_name("NAME.case.h5");
  app.add_option("-o,--output", arguments.folder, "Results folder (default: NAME.results)")
      ->check(refuse_empty)
      ->type_name("FOLDER");
  app.add_option("--threads", arguments.solver.threads, "Threads; results do not depend on them")
      ->check(CLI::Range(1, 1024));
  if (ranks->count() == 1) {
    // They are processes on this machine: many more than it has cores would bring it down.
    const int most = std::max(16, static_cast<int>(std::thread::hardware_concurrency()));
    app.add_option("--ranks", arguments.ranks,
                   "Share the run among this many processes, with mpirun and suffuse-solver-mpi")
        ->check(CLI::Range(1, most))
        ->type_name("N");
  }
  app.add_flag("--explain", arguments.explain,
               "Print what would run, what is skipped and what it would take, and stop");
  app.add_option("--trial", arguments.trial)->group("");  // by which --explain tries ranks
  app.add_flag("--no-skip", arguments.solver.no_skip, "Run every pass, needed or not");
  CLI::Option* resume = app.add_flag(
      "--resume", arguments.run.resume,
      "Go on with the run in the results folder; same results as if it had not stopped");
  app.add_flag("--force", arguments.run.force,
               "Replace what the results folder holds of another scene, mesh or points")
      ->excludes(resume);
  app.add_option("--checkpoint-every", arguments.run.checkpoint_every,
                 "Seconds without a snapshot after which the run keeps a checkpoint (0: never)")
      ->check(suffuse::number_in(0.0, 1e9))
      ->capture_default_str()
      ->type_name("SECONDS");
  app.add_flag("--quiet", arguments.run.quiet, "No progress, warnings only");
  add_element_test(app, arguments.element);
  add_strength_reduction(app, arguments);
  add_sizes(app, arguments.sizes);
  if (const auto code = suffuse::parse_command_line(app, argc, argv)) return *code;
  refuse_modes_on_ranks(app, std::max(ranks->count(), arguments.ranks));
  if (arguments.ranks > 1) {
    arguments.without_ranks = without_option("--ranks", argc, argv);
    if (!arguments.explain) return suffuse::launch_ranks(arguments.ranks, arguments.without_ranks);
  }
  arguments.solver.ranks = std::move(ranks);
  if (arguments.strength_reduction) return find_strength(arguments);
  if (!arguments.sizes.output.empty()) return mesh_again(arguments);
  if (arguments.element.table.empty()) return solve_case(arguments);
  arguments.element.scene = arguments.case_path;
  arguments.element.output = arguments.folder.empty() ? "-" : arguments.folder;
  suffuse::run_element_test(arguments.element);
  return static_cast<int>(suffuse::ExitCode::done);
}

}  // namespace

int main(int argc, char** argv) {
  std::shared_ptr<const Ranks> ranks;
  try {
    suffuse::prepare_process();
    ranks = suffuse::start_ranks();
    return run(argc, argv, ranks);
  } catch (...) {
    if (!ranks) return suffuse::report_current_exception(program);
    // An error that all ranks have is told once. One that a rank has alone ends the others, which
    // may wait for it.
    const bool is_shared = ranks->all_come();
    const int code = suffuse::report_current_exception(program, is_shared && ranks->rank() > 0);
    if (!is_shared) ranks->end_all(code);
    // Where one process has ended with an error, mpirun ends the others, perhaps before rank 0 has
    // told it.
    static_cast<void>(ranks->all_come());
    return code;
  }
}
