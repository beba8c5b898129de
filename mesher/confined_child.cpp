#include "confined_child.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <new>
#include <optional>
#include <stdexcept>
#include <vector>

#include "common/errors.hpp"
#include "plain_text.hpp"
#include "system_call_filter.hpp"

// Address sanitizers reserve unlimited address space.
#if defined(__SANITIZE_ADDRESS__)
#define SUFFUSE_ADDRESS_SANITIZER
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define SUFFUSE_ADDRESS_SANITIZER
#endif
#endif
#ifdef SUFFUSE_ADDRESS_SANITIZER
#include <sanitizer/common_interface_defs.h>
#endif

namespace suffuse {

namespace {

using How = ChildEnd::How;

/// First byte of the child's output; another one is `report_mark`.
constexpr char reply_mark = 'R';
constexpr char no_memory_mark = 'M';
constexpr char unconfined_mark = 'U';

// In the child

void set_limit(__rlimit_resource resource, double value) {
  const auto whole = static_cast<rlim_t>(std::min(std::ceil(value), 1e18));
  const rlimit limit{whole, whole};
  ::setrlimit(resource, &limit);
}

/// Sets limits in case the parent, which watches the times more exactly, cannot do so.
void limit_use(const ChildLimits& limits) {
  constexpr double open_files = 64.0;
  set_limit(RLIMIT_CPU, limits.processor_seconds + 1.0);
  set_limit(RLIMIT_CORE, 0.0);
  set_limit(RLIMIT_NOFILE, open_files);
  set_limit(RLIMIT_FSIZE, limits.bytes);  // size of files in memory
#ifndef SUFFUSE_ADDRESS_SANITIZER
  double pages = 0.0;
  std::ifstream("/proc/self/statm") >> pages;
  set_limit(RLIMIT_AS, pages * static_cast<double>(::sysconf(_SC_PAGESIZE)) + limits.bytes);
#endif
}

/// Removes the signal handlers and the mask inherited from the parent.
void reset_signals() {
  for (int signal = 1; signal < NSIG; ++signal) std::signal(signal, SIG_DFL);
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
}

/// If a library ends the child, skips the exit handlers inherited from the parent.
void leave_nothing_to_do_at_exit() {
  static_cast<void>(std::atexit([] { ::_exit(1); }));
#ifdef SUFFUSE_ADDRESS_SANITIZER
  __sanitizer_set_death_callback([] { std::abort(); });  // a finding counts as a crash
#endif
}

/// Keeps only this descriptor, with a new number that it returns; nothing else is read or shown.
int keep_only(int descriptor) {
  constexpr int kept = STDERR_FILENO + 1;
  const int nowhere = ::open("/dev/null", O_RDWR);
  if (nowhere < 0 || ::dup2(descriptor, kept) < 0) ::_exit(1);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(nowhere, stream);
  ::close_range(kept + 1, ~0U, 0);
  return kept;
}

void write_all(int descriptor, const char* bytes, std::size_t size) {
  while (size > 0) {
    const ssize_t written = ::write(descriptor, bytes, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) ::_exit(1);
    bytes += written;
    size -= static_cast<std::size_t>(written);
  }
}

void write_all(int descriptor, char mark, const std::string& text) {
  write_all(descriptor, &mark, 1);
  write_all(descriptor, text.data(), text.size());
}

[[noreturn]] void be_child(const std::function<void()>& prepare,
                           const std::function<std::string()>& body, const ChildLimits& limits,
                           int descriptor, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);
  reset_signals();
  descriptor = keep_only(descriptor);
  limit_use(limits);
  leave_nothing_to_do_at_exit();
  try {
    prepare();
    confine_process(descriptor);
  } catch (const FileError& error) {
    write_all(descriptor, unconfined_mark, error.what());
    ::_exit(1);
  }
  try {
    write_all(descriptor, reply_mark, body());
  } catch (const std::bad_alloc&) {
    write_all(descriptor, no_memory_mark, "");
  } catch (const std::length_error&) {
    write_all(descriptor, no_memory_mark, "");
  }
  // Ends without destructors and exit handlers copied from the parent, and without a leak check.
  ::_exit(0);
}

// In the parent

/// Reads from the child until it closes its end or exceeds a limit.
class Watch {
 public:
  Watch(pid_t child, int descriptor, const ChildLimits& limits)
      : limits_(limits), descriptor_(descriptor) {
    if (::clock_getcpuclockid(child, &processor_clock_) != 0) {
      throw FileError("the processor time of a process cannot be told");
    }
  }

  /// Returns the limit that the child exceeded, if any.
  std::optional<How> run(std::string& bytes) {
    constexpr int milliseconds = 50;
    std::vector<char> part(std::size_t{1} << 20U);
    for (;;) {
      if (const std::optional<How> over = limit_passed()) return over;
      pollfd waiting{descriptor_, POLLIN, 0};
      if (::poll(&waiting, 1, milliseconds) <= 0) continue;
      const ssize_t size = ::read(descriptor_, part.data(), part.size());
      if (size < 0 && errno == EINTR) continue;
      if (size <= 0) return std::nullopt;
      bytes.append(part.data(), static_cast<std::size_t>(size));
      if (static_cast<double>(bytes.size()) > limits_.bytes) return How::memory;
    }
  }

 private:
  using Clock = std::chrono::steady_clock;

  std::optional<How> limit_passed() {
    timespec spent{};
    ::clock_gettime(processor_clock_, &spent);
    const double seconds =
        static_cast<double>(spent.tv_sec) + 1e-9 * static_cast<double>(spent.tv_nsec);
    if (seconds > limits_.processor_seconds) return How::processor_time;
    // A pause of both processes (Ctrl-Z) does not count.
    constexpr double longest_round = 1.0;
    const Clock::time_point now = Clock::now();
    waited_ += std::min(std::chrono::duration<double>(now - last_round_).count(), longest_round);
    last_round_ = now;
    if (waited_ > limits_.wall_seconds) return How::wall_time;
    return std::nullopt;
  }

  const ChildLimits& limits_;
  int descriptor_;
  clockid_t processor_clock_{};
  Clock::time_point last_round_ = Clock::now();
  double waited_ = 0.0;
};

std::string words_for(const std::string& report) {
  const char what = report.empty() ? static_cast<char>(Refused::process) : report.front();
  const std::string name = report.empty() ? "" : plain_text(report.substr(1));
  const std::string file = name.empty() ? "" : " \"" + name + '"';
  switch (static_cast<Refused>(what)) {
    case Refused::process:
      break;
    case Refused::writing:
      return name.empty() ? "make, change or remove files" : "write the file" + file;
    case Refused::network:
      return "open a connection";
    case Refused::waiting:
      return "wait";
    case Refused::special:
      return "read" + file + ", no regular file";
  }
  return "run a command or start a process";
}

ChildEnd end_of(int status, std::string bytes) {
  const char mark = bytes.empty() ? '\0' : bytes.front();
  bytes.erase(0, 1);
  if (mark == unconfined_mark) throw FileError(plain_text(bytes));
  if (mark == no_memory_mark) return {How::memory, ""};
  if (mark == report_mark) return {How::refused, words_for(bytes)};
  if (WIFSIGNALED(status)) {
    switch (WTERMSIG(status)) {
      case SIGSYS:
        return {How::refused, words_for("")};
      case SIGXCPU:
        return {How::processor_time, ""};
      case SIGKILL:  // sent by the system if memory runs out
      case SIGXFSZ:
        return {How::memory, ""};
      default:
        return {How::crashed, ""};
    }
  }
  if (mark != reply_mark || WEXITSTATUS(status) != 0) return {How::left, ""};
  return {How::replied, std::move(bytes)};
}

/// Ends the child in any case.
class Child {
 public:
  explicit Child(pid_t id) : id_(id) {}
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() { wait(); }

  /// Ends the child and returns its status. A child that has begun to end keeps its own status.
  int wait() {
    if (id_ < 0) return status_;
    ::kill(id_, SIGKILL);
    while (::waitpid(id_, &status_, 0) < 0 && errno == EINTR) {
    }
    id_ = -1;
    return status_;
  }

 private:
  pid_t id_;
  int status_ = 0;
};

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close(); }
  [[nodiscard]] int number() const { return number_; }
  void close() {
    if (number_ >= 0) ::close(number_);
    number_ = -1;
  }

 private:
  int number_;
};

}  // namespace

ChildEnd run_confined(const std::function<void()>& prepare,
                      const std::function<std::string()>& body, const ChildLimits& limits) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw FileError("no pipe to another process can be made");
  const Descriptor reading(ends[0]);
  Descriptor writing(ends[1]);
  // The program that started this one may have ignored this signal; then there would be no status.
  std::signal(SIGCHLD, SIG_DFL);
  const pid_t parent = ::getpid();
  const pid_t id = ::fork();
  if (id < 0) throw FileError("no second process can be started to read a file in");
  if (id == 0) be_child(prepare, body, limits, writing.number(), parent);
  writing.close();
  Child child(id);
  std::string bytes;
  const std::optional<How> over = Watch(id, reading.number(), limits).run(bytes);
  const int status = child.wait();
  if (over) return {*over, ""};
  return end_of(status, std::move(bytes));
}

}  // namespace suffuse
