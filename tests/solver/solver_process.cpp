#include "solver/solver_process.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "common/errors.hpp"
#include "common/hdf5_io.hpp"
#include "files/layout.hpp"
#include "results/reader.hpp"
#include "test_paths.hpp"

namespace suffuse::test {
namespace {

/// Processes that take longer hang. Sanitizers make a run up to a hundred times slower.
#ifdef __SANITIZE_ADDRESS__
constexpr std::chrono::minutes longest_run{60};
#else
constexpr std::chrono::minutes longest_run{2};
#endif

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

const std::string liquid_and_soil = R"(
[liquid]
density = 1000.0
bulk_modulus = 2.0e7
viscosity = 1.0e-3
[soil.specimen]
porosity = 0.3
skeleton_fraction = 0.6
grain_density = 2700.0
conductivity = 2.0e-2
)";

const std::string single_point = R"(name = "single"
formulation = "single-point"
geometry = {shape = "column", width = 0.5, height = 1.0}
mesh.size = 0.125
output = {every = 0.01, snapshot_every = 0.05, restarts = 1000}
boundary = [
  {on = "top", pressure = 6.0e3, concentration = 0.01},
  {on = "bottom", pressure = 0.0, concentration = 0.0},
]
)" + liquid_and_soil + "erosion = {law = \"flux\", rate = 4.0}\n";

const std::string double_point = R"(name = "double"
formulation = "double-point"
geometry = {shape = "column", width = 0.5, height = 0.5, layers = {inflow = 1, above = 1, below = 1, outflow = 1}}
mesh.size = 0.125
points.liquid_per_element = 3
output = {every = 0.1, snapshot_every = 0.5, restarts = 1000}
boundary = [
  {on = "inflow", darcy_flux = 0.012, concentration = 0.01},
  {on = "outflow", pressure = 0.0, concentration = 0.0},
]
)" + liquid_and_soil + R"(erosion = {law = "first-order", rate = 5e-2, start = 0.1}
[soil.buffer]
like = "specimen"
erosion.law = "none"
)";

/// Files of a folder, with their names in it.
std::map<std::string, std::string> files_in(const std::string& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    files[fs::relative(entry.path(), folder).string()] = read_file(entry.path().string());
  }
  return files;
}

/// run.json without entries that differ between two runs of the same case.
nlohmann::json comparable(const std::string& text) {
  nlohmann::json info = nlohmann::json::parse(text);
  for (const char* key : {"threads", "wall_seconds", "memory_bytes", "resumed_at"}) info.erase(key);
  for (auto& pass : info["passes"]) pass.erase("seconds");
  return info;
}

void read_places(const ResultsReader& results, std::size_t index, const std::string& kind) {
  if (results.dimension() == 3) {
    static_cast<void>(results.point_positions<3>(index, kind));
  } else {
    static_cast<void>(results.point_positions(index, kind));
  }
}

void read_snapshots(const ResultsReader& results) {
  std::vector<std::string> places{"cell", "node", "element_vertex", "solid"};
  const bool has_liquid = results.scene().scene.formulation == Formulation::double_point;
  if (has_liquid) places.emplace_back("liquid");
  for (std::size_t i = 0; i < results.times().size(); ++i) {
    for (const std::string& place : places) {
      for (const std::string& name : results.field_names(i, place)) {
        static_cast<void>(results.field(i, place, name));
      }
    }
    read_places(results, i, "solid");
    if (has_liquid) read_places(results, i, "liquid");
  }
}

/// Names the files of a series that are missing.
std::string missing_files(const std::string& results, const std::string& kind) {
  const std::string path = layout::in_folder(results, layout::series(kind));
  if (!fs::exists(path)) return "";
  std::string missing;
  const nlohmann::json series = nlohmann::json::parse(read_file(path));
  for (const auto& entry : series.at("files")) {
    const auto name = entry.at("name").get<std::string>();
    try {
      const Hdf5File file(layout::in_folder(results, name), Hdf5File::Mode::read);
      if (file.double_attribute(layout::own_group, "time") != entry.at("time")) {
        missing += name + " has another time\n";
      }
    } catch (const FileError& error) {
      missing += std::string(error.what()) + "\n";
    }
  }
  return missing;
}

}  // namespace

std::ostream& operator<<(std::ostream& out, const Mode& mode) {
  return out << mode.name;
}

Process::Process(const std::vector<std::string>& words, std::string error,
                 const std::function<void()>& prepare)
    : error_(std::move(error)) {
  id_ = ::fork();
  if (id_ < 0) throw std::runtime_error("no new process");
  if (id_ > 0) return;
  const int sink = ::open(error_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  ::dup2(sink, STDOUT_FILENO);
  ::dup2(sink, STDERR_FILENO);
  prepare();
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  ::execvp(arguments.front(), arguments.data());
  ::_exit(127);
}

Process::~Process() {
  if (!running()) return;
  ::kill(id_, SIGKILL);
  ::waitpid(id_, &status_, 0);
}

bool Process::running() {
  if (!ended_) ended_ = ::waitpid(id_, &status_, WNOHANG) == id_;
  return !ended_;
}

void Process::signal(int number) const {
  if (!ended_) ::kill(id_, number);
}

Outcome Process::wait() {
  const auto end = Clock::now() + longest_run;
  while (running()) {
    if (Clock::now() > end) ::kill(id_, SIGKILL);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return {WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_), read_file(error_)};
}

bool wait_for(Process& process, const std::function<bool()>& condition) {
  while (process.running()) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::microseconds(300));
  }
  return false;
}

std::vector<Mode> five_modes() {
  const std::vector<std::string> of_explicit{
      R"(time={end = 5.0, scheme = "explicit", mass_scaling = 100.0})"};
  std::vector<std::string> at_points = of_explicit;
  at_points.emplace_back("flow.integration=material-point");
  return {
      {"single_point_explicit", single_point, {R"(time={end = 0.5, scheme = "explicit"})"}},
      {"single_point_implicit",
       single_point,
       {"soil.specimen.conductivity_law=kozeny-carman", "time={end = 5.0}",
        "output={every = 0.1, snapshot_every = 0.5, restarts = 1000}"}},
      {"double_point_explicit", double_point, of_explicit},
      // Undamped waves in free water would need a million steps.
      {"double_point_implicit", double_point, {"time={end = 5.0, inertia = false}"}},
      {"double_point_at_points", double_point, at_points},
  };
}

Mode moving_mode() {
  return {"moving_soil_implicit",
          single_point,
          {"output={every = 0.1, snapshot_every = 0.5, restarts = 1000}",
           "soil.specimen.conductivity_law=kozeny-carman",
           R"(soil.specimen.skeleton={law = "mohr-coulomb", young = [[1.0, 6e5], [0.0, 2e5]], )"
           R"(poisson = 0.2, friction = [[1.0, 35.0], [0.0, 28.0]], cohesion = 2e3})",
           R"(boundary=[{on = "top", pressure = 6e3, concentration = 0.01, )"
           R"(traction = [[0.0, 0.0, -6e3], [2.0, 0.0, -3e4]]}, )"
           R"({on = "bottom", pressure = 0.0, concentration = 0.0, fix = "both"}, )"
           R"({on = "left", fix = "normal"}, {on = "right", fix = "normal"}])",
           "time={end = 5.0}"}};
}

Mode with(Mode mode, const std::string& name, const std::vector<std::string>& sets) {
  mode.name = name;
  mode.sets.insert(mode.sets.end(), sets.begin(), sets.end());
  return mode;
}

std::vector<std::string> solver_words(const std::string& case_path, const std::string& results,
                                      const std::vector<std::string>& options) {
  std::vector<std::string> words{test::program_folder() + "/suffuse-solver", case_path, "-o",
                                 results, "--quiet"};
  words.insert(words.end(), options.begin(), options.end());
  return words;
}

std::string Workplace::make_case(const Mode& mode) const {
  const std::string scene = folder_.write(mode.name + ".toml", mode.scene);
  std::vector<std::string> words{test::program_folder() + "/suffuse-mesher", scene, "-o",
                                 path(mode.name + ".case.h5")};
  for (const std::string& set : mode.sets) words.insert(words.end(), {"--set", set});
  const Outcome outcome = Process(words, path("mesher.txt")).wait();
  if (outcome.code != 0) throw std::runtime_error("suffuse-mesher: " + outcome.error);
  return words[3];
}

Outcome Workplace::solve(const std::string& case_path, const std::string& results,
                         const std::vector<std::string>& options,
                         const std::function<void()>& prepare) const {
  return Process(solver_words(case_path, results, options), path("solver.txt"), prepare).wait();
}

std::string Workplace::copy(const std::string& results, const std::string& name) const {
  fs::remove_all(path(name));
  fs::copy(results, path(name), fs::copy_options::recursive);
  return path(name);
}

void stop_after_snapshot(const std::string& results, int index) {
  for (const std::string kind : {"mesh", "solid", "liquid", "state"}) {
    for (int later = index + 1; later < 1000; ++later) {
      fs::remove(layout::in_folder(results, layout::snapshot(kind, later)));
    }
  }
  const std::string path = layout::in_folder(results, layout::run_info);
  std::string info = read_file(path);
  const std::string done = "\"status\": \"done\"";
  if (const auto at = info.find(done); at != std::string::npos) {
    info.replace(at, done.size(), "\"status\": \"running\"");
  }
  std::ofstream(path, std::ios::binary) << info;
}

long lines_in(const std::string& path) {
  const std::string text = read_file(path);
  return std::ranges::count(text, '\n');
}

int snapshots_in(const std::string& results) {
  int count = 0;
  while (fs::exists(layout::in_folder(results, layout::snapshot("mesh", count)))) ++count;
  return count;
}

std::string difference(const std::string& results, const std::string& others) {
  std::map<std::string, std::string> these = files_in(results);
  std::map<std::string, std::string> those = files_in(others);
  std::string differences;
  for (auto* files : {&these, &those}) files->erase(layout::lock);
  for (const auto& [name, bytes] : those) {
    if (!these.contains(name)) differences += name + " is only in " + others + "\n";
  }
  for (const auto& [name, bytes] : these) {
    if (!those.contains(name)) {
      differences += name + " is only in " + results + "\n";
    } else if (name == layout::run_info) {
      const nlohmann::json patch = nlohmann::json::diff(comparable(bytes), comparable(those[name]));
      if (!patch.empty()) differences += name + " differs: " + patch.dump() + "\n";
    } else if (bytes != those[name]) {
      const auto [a, b] = std::ranges::mismatch(bytes, those[name]);
      differences += name + " differs from byte " + std::to_string(a - bytes.begin()) + " on\n";
    }
  }
  return differences;
}

std::string contents(const std::string& folder) {
  std::ostringstream all;
  for (const auto& [name, bytes] : files_in(folder)) {
    all << name << ' ' << bytes.size() << ' ' << bytes;
  }
  return all.str();
}

std::string flaws_after_kill(const std::string& results) {
  std::string found;
  for (const std::string kind : {"mesh", "solid", "liquid"}) {
    found += missing_files(results, kind);
  }
  try {
    const ResultsReader reader(results);
    read_snapshots(reader);
    static_cast<void>(reader.history());
    static_cast<void>(reader.ledger());
    static_cast<void>(reader.region_ledgers());
    static_cast<void>(reader.boundaries());
  } catch (const std::exception& error) {
    found += std::string(error.what()) + "\n";
  }
  return found;
}

std::string flaws(const std::string& results) {
  std::string found = flaws_after_kill(results);
  for (const char* table : {layout::history, layout::ledger, layout::regions, layout::boundaries}) {
    const std::string text = read_file(layout::in_folder(results, table));
    if (!text.ends_with('\n')) found += std::string(table) + " ends within a row\n";
  }
  return found;
}

}  // namespace suffuse::test
