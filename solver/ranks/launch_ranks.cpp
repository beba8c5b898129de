#include "ranks/launch_ranks.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <thread>

#include "common/errors.hpp"

namespace suffuse {
namespace {

namespace fs = std::filesystem;

constexpr int signalled = 128;    ///< exit code of mpirun, less the signal that ended a process
constexpr int not_started = 127;  ///< exit code of the child where mpirun is not there

volatile std::sig_atomic_t asked_to_stop = 0;
void ask_to_stop(int) {
  asked_to_stop = 1;
}

fs::path shared_solver() {
  const fs::path folder = fs::read_symlink("/proc/self/exe").parent_path();
  fs::path program = folder / "suffuse-solver-mpi";
  if (fs::exists(program)) return program;
  throw FileError("--ranks: found no suffuse-solver-mpi in " + folder.string() +
                  ", the folder of suffuse-solver; install the package suffuse-mpi, or build "
                  "Suffuse where PETSc and MPI are installed (docs/use/ranks.md)");
}

/// Ends of a pipe for what the processes print: to read it, and to write it; -1: none.
struct Pipe {
  int read = -1;
  int write = -1;
};

Pipe open_pipe() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw FileError(std::string("mpirun: ") + std::strerror(errno));
  }
  return {ends[0], ends[1]};
}

/// All that was written; the processes have ended. A page fits into a pipe.
std::string printed_text(const Pipe& pipe) {
  ::close(pipe.write);
  std::string text;
  std::array<char, 4096> page{};
  for (ssize_t bytes = 0; (bytes = ::read(pipe.read, page.data(), page.size())) > 0;) {
    text.append(page.data(), static_cast<std::size_t>(bytes));
  }
  ::close(pipe.read);
  return text;
}

/// Becomes mpirun; does not return.
[[noreturn]] void become(std::vector<std::string> words, const Pipe& output) {
  // A terminal's Ctrl-C goes to all of its group: mpirun would kill its processes.
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  std::signal(SIGUSR1, SIG_IGN);  // until mpirun listens
  const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  if (nothing >= 0) ::dup2(nothing, STDIN_FILENO);
  if (output.write >= 0) ::dup2(output.write, STDOUT_FILENO);
  // Whoever starts a run as root means it.
  if (::geteuid() == 0) {
    ::setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
    ::setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
  }
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  ::execvp(pointers.front(), pointers.data());
  ::_exit(not_started);
}

/// Whether a process has child processes; true where the kernel does not say.
bool has_children(pid_t process) {
  std::error_code unknown;
  const fs::path tasks = "/proc/" + std::to_string(process) + "/task";
  for (const fs::directory_entry& task : fs::directory_iterator(tasks, unknown)) {
    std::ifstream children(task.path() / "children");
    std::string first;
    if (!children || children >> first) return true;
  }
  return static_cast<bool>(unknown);
}

/// Exit status of mpirun. It passes SIGUSR1 on to its processes, which may not listen yet: they get
/// it until they end. Throws NumericalError where mpirun, that of Open MPI 4.1 once in hundreds of
/// runs, does not end after its processes have.
int status_of(pid_t process) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds pause{50};
  constexpr std::chrono::seconds patience{10};
  bool has_started = false;
  Clock::time_point last_seen = Clock::now();  // of its processes
  int status = 0;
  for (;;) {
    const pid_t ended = ::waitpid(process, &status, WNOHANG);
    if (ended == process) break;
    if (ended < 0) throw FileError(std::string("mpirun: ") + std::strerror(errno));
    if (asked_to_stop != 0) ::kill(process, SIGUSR1);
    if (has_children(process)) {
      has_started = true;
      last_seen = Clock::now();
    } else if (has_started && Clock::now() - last_seen > patience) {
      ::kill(process, SIGKILL);
      ::waitpid(process, &status, 0);
      throw NumericalError(
          "mpirun did not end after its processes had; --resume goes on with the run, or says that "
          "it is complete");
    }
    std::this_thread::sleep_for(pause);
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : signalled + WTERMSIG(status);
}

}  // namespace

int launch_ranks(int ranks, const std::vector<std::string>& arguments, std::string* output) {
  // Ranks that are bound to cores wait for whatever else runs there.
  std::vector<std::string> words{"mpirun", "-q", "--bind-to", "none", "-n", std::to_string(ranks)};
  if (ranks > static_cast<int>(std::thread::hardware_concurrency())) {
    words.emplace_back("--oversubscribe");
  }
  // A process that a signal ends while it starts may leave mpirun waiting for ever.
  words.insert(words.end(), {"sh", "-c", "trap '' USR1; exec \"$0\" \"$@\"", shared_solver()});
  words.insert(words.end(), arguments.begin(), arguments.end());
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGUSR1}) {
    // A program started by nohup must continue to ignore SIGHUP.
    if (std::signal(signal, ask_to_stop) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
  const Pipe printed = output == nullptr ? Pipe{} : open_pipe();
  const pid_t process = ::fork();
  if (process < 0) throw FileError(std::string("mpirun: ") + std::strerror(errno));
  if (process == 0) become(std::move(words), printed);
  const int code = status_of(process);
  if (output != nullptr) *output = printed_text(printed);
  if (code == not_started) {
    throw FileError("--ranks: mpirun cannot be started; install Open MPI (openmpi-bin)");
  }
  if (code <= signalled || code == static_cast<int>(ExitCode::interrupted)) return code;
  throw NumericalError("a process of the run was ended by signal " +
                       std::to_string(code - signalled) +
                       "; go on from its last snapshot or checkpoint with --resume");
}

}  // namespace suffuse
