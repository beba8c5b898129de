#include "gmsh_session.hpp"

#include <fcntl.h>
#include <gmsh.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <csignal>
#include <fstream>
#include <new>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "case/errors.hpp"

namespace suffuse {

namespace {

constexpr const char* no_memory = "not enough memory";

/// Of everything Gmsh logged since the session began; its errors do not always come as exceptions.
std::string first_logged_error(std::size_t from) {
  constexpr std::string_view prefix = "Error: ";
  std::vector<std::string> lines;
  gmsh::logger::get(lines);
  for (std::size_t i = from; i < lines.size(); ++i) {
    if (lines[i].starts_with(prefix)) return lines[i].substr(prefix.size());
  }
  return "";
}

std::size_t log_length() {
  std::vector<std::string> lines;
  gmsh::logger::get(lines);
  return lines.size();
}

}  // namespace

GmshSession::GmshSession() {
  constexpr bool read_configuration = false;
  gmsh::initialize(0, nullptr, read_configuration);
  // An error ends the meshing and is logged. As an exception, Gmsh's own choice, it would end the
  // program when it leaves one of Gmsh's parallel regions.
  gmsh::option::setNumber("General.AbortOnError", 1);
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::option::setNumber("General.NoPopup", 1);
  gmsh::option::setNumber("General.NumThreads", 1);
  gmsh::option::setNumber("Mesh.RandomSeed", 1);
  gmsh::logger::start();
}

GmshSession::~GmshSession() {
  gmsh::logger::stop();
  gmsh::finalize();
}

std::string gmsh_complaint(const std::function<void()>& body) {
  const std::size_t before = log_length();
  std::string thrown;
  try {
    body();
  } catch (const std::string& message) {
    thrown = message;
  } catch (const char* message) {
    thrown = message;
  } catch (int code) {
    thrown = "error " + std::to_string(code);
  } catch (const std::bad_alloc&) {
    thrown = no_memory;
  } catch (const std::length_error&) {
    thrown = no_memory;
  }
  const std::string logged = first_logged_error(before);
  return logged.empty() ? thrown : logged;
}

namespace {

/// Of this process from now on. The address sanitizer reserves address space without end.
void limit_use(double seconds, double bytes) {
  const auto whole_seconds = static_cast<rlim_t>(std::ceil(seconds));
  const rlimit time{whole_seconds, whole_seconds};
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CPU, &time);
  ::setrlimit(RLIMIT_CORE, &no_core);
#ifndef __SANITIZE_ADDRESS__
  double pages = 0.0;
  std::ifstream("/proc/self/statm") >> pages;
  const auto most =
      static_cast<rlim_t>(pages * static_cast<double>(::sysconf(_SC_PAGESIZE)) + bytes);
  const rlimit memory{most, most};
  ::setrlimit(RLIMIT_AS, &memory);
#else
  static_cast<void>(bytes);
#endif
}

/// Libraries print as they end; that is dropped.
void silence() {
  const int nowhere = ::open("/dev/null", O_WRONLY);
  if (nowhere < 0) return;
  ::dup2(nowhere, STDOUT_FILENO);
  ::dup2(nowhere, STDERR_FILENO);
}

}  // namespace

std::string gmsh_crash(const std::function<void()>& body, double max_seconds, double max_bytes) {
  constexpr int too_much = 3;
  const pid_t child = ::fork();
  if (child < 0) throw FileError("no second process can be started to read a file in");
  if (child == 0) {
    silence();
    limit_use(max_seconds, max_bytes);
    ::_exit(gmsh_complaint(body) == no_memory ? too_much : 0);
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return "";
  const bool over_limit = WIFEXITED(status)
                              ? WEXITSTATUS(status) == too_much
                              : WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL;
  return over_limit ? "takes more time or memory than its size explains" : "crashes";
}

}  // namespace suffuse
