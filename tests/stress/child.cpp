#include "stress/child.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace suffuse::stress {
namespace {

/// A program that waits forever uses no processor time: it is ended when its wall time is this
/// multiple of its limit.
constexpr double max_waiting = 30.0;

[[noreturn]] void become(std::vector<char*> words, const std::string& log, double max_seconds) {
  const int file = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (file >= 0) {
    dup2(file, STDOUT_FILENO);
    dup2(file, STDERR_FILENO);
    close(file);
  }
  const auto whole_seconds = static_cast<rlim_t>(std::ceil(max_seconds));
  const rlimit limit{whole_seconds, whole_seconds + 1};
  setrlimit(RLIMIT_CPU, &limit);
  words.push_back(nullptr);
  execv(words.front(), words.data());
  _exit(127);
}

}  // namespace

ChildEnd run_child(const std::vector<std::string>& arguments, const std::string& log,
                   double max_seconds) {
  std::vector<std::string> copies = arguments;
  std::vector<char*> words;
  words.reserve(copies.size() + 1);
  for (std::string& word : copies) words.push_back(word.data());
  const auto start = std::chrono::steady_clock::now();
  const auto seconds = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no child process could be made");
  if (child == 0) become(words, log, max_seconds);

  ChildEnd end;
  int status = 0;
  rusage used{};
  while (wait4(child, &status, WNOHANG, &used) == 0) {
    if (!end.timed_out && seconds() > max_waiting * max_seconds) {
      end.timed_out = true;
      kill(child, SIGKILL);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  const auto seconds_of = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  end.seconds = seconds_of(used.ru_utime) + seconds_of(used.ru_stime);
  if (WIFEXITED(status)) end.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
  end.timed_out |= end.signal == SIGXCPU;
  std::ostringstream text;
  text << std::ifstream(log, std::ios::binary).rdbuf();
  end.output = text.str();
  return end;
}

}  // namespace suffuse::stress
