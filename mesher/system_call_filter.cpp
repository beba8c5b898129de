#include "system_call_filter.hpp"

#include <fcntl.h>
#include <seccomp.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <ucontext.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <optional>
#include <system_error>

#include "common/errors.hpp"

namespace suffuse {

namespace {

/// The descriptor to which the handler below reports; only globals can pass values to it.
int report_descriptor = -1;
/// The file of `WritesToMemory`, or -1.
int memory_file = -1;
bool is_confined = false;

/// Flags of `open` that write or create a file.
constexpr int writing_flags = O_WRONLY | O_RDWR | O_CREAT | O_TRUNC;
/// Only the handler opens files, and with this flag, so that opening a pipe does not block.
constexpr int handlers_flag = O_NONBLOCK;

/// System calls that need only memory and time, or use existing descriptors.
constexpr std::array allowed_calls{
    // memory
    SCMP_SYS(brk), SCMP_SYS(mmap), SCMP_SYS(munmap), SCMP_SYS(mremap), SCMP_SYS(mprotect),
    SCMP_SYS(madvise), SCMP_SYS(memfd_create),
    // descriptors
    SCMP_SYS(read), SCMP_SYS(readv), SCMP_SYS(pread64), SCMP_SYS(write), SCMP_SYS(writev),
    SCMP_SYS(lseek), SCMP_SYS(close), SCMP_SYS(dup), SCMP_SYS(fstat), SCMP_SYS(getdents64),
    SCMP_SYS(fadvise64),
    // a pipe leads back to this process, as there is no second one; sanitizers use it to test
    // addresses
    SCMP_SYS(pipe), SCMP_SYS(pipe2),
    // names of files
    SCMP_SYS(stat), SCMP_SYS(lstat), SCMP_SYS(newfstatat), SCMP_SYS(statx), SCMP_SYS(statfs),
    SCMP_SYS(fstatfs), SCMP_SYS(access), SCMP_SYS(faccessat), SCMP_SYS(faccessat2),
    SCMP_SYS(readlink), SCMP_SYS(readlinkat), SCMP_SYS(getcwd),
    // the process itself
    SCMP_SYS(exit), SCMP_SYS(exit_group), SCMP_SYS(futex), SCMP_SYS(getpid), SCMP_SYS(gettid),
    SCMP_SYS(getppid), SCMP_SYS(getuid), SCMP_SYS(geteuid), SCMP_SYS(getgid), SCMP_SYS(getegid),
    SCMP_SYS(getrusage), SCMP_SYS(getrlimit), SCMP_SYS(sched_getaffinity), SCMP_SYS(sched_yield),
    SCMP_SYS(rt_sigaction), SCMP_SYS(rt_sigprocmask), SCMP_SYS(rt_sigreturn), SCMP_SYS(sigaltstack),
    SCMP_SYS(restart_syscall),
    // time, chance and the machine
    SCMP_SYS(clock_gettime), SCMP_SYS(clock_getres), SCMP_SYS(gettimeofday), SCMP_SYS(time),
    SCMP_SYS(times), SCMP_SYS(getrandom), SCMP_SYS(uname), SCMP_SYS(sysinfo)};

/// The reason to end the process at a call, if any. `opened` decides on calls that open a file.
std::optional<Refused> refusal_of(long call) {
  switch (call) {
    case SYS_clone:
    case SYS_clone3:
    case SYS_execve:
    case SYS_execveat:
#ifdef SYS_fork
    case SYS_fork:
    case SYS_vfork:
#endif
      return Refused::process;
#ifdef SYS_creat
    case SYS_creat:
    case SYS_mkdir:
    case SYS_mknod:
    case SYS_unlink:
    case SYS_rmdir:
    case SYS_rename:
    case SYS_link:
    case SYS_symlink:
    case SYS_chmod:
    case SYS_chown:
#endif
    case SYS_mkdirat:
    case SYS_mknodat:
    case SYS_unlinkat:
    case SYS_renameat2:
    case SYS_renameat:
    case SYS_linkat:
    case SYS_symlinkat:
    case SYS_truncate:
    case SYS_fchmodat:
    case SYS_fchownat:
      return Refused::writing;
    case SYS_socket:
    case SYS_socketpair:
      return Refused::network;
    case SYS_nanosleep:
    case SYS_clock_nanosleep:
      return Refused::waiting;
    default:
      return std::nullopt;
  }
}

/// The registers of a system call that was refused, by the processor's convention.
class CallRegisters {
 public:
  explicit CallRegisters(void* context)
      : machine_(static_cast<ucontext_t*>(context)->uc_mcontext) {}

#if defined(__x86_64__)
  [[nodiscard]] long argument(int i) const {
    constexpr std::array<int, 3> order{REG_RDI, REG_RSI, REG_RDX};
    return machine_.gregs[order[i]];
  }
  void set_result(long value) {
    machine_.gregs[REG_RAX] = value;
  }
#elif defined(__aarch64__)
  [[nodiscard]] long argument(int i) const {
    return static_cast<long>(machine_.regs[i]);
  }
  void set_result(long value) {
    machine_.regs[0] = static_cast<unsigned long>(value);
  }
#else
#error "CallRegisters: the registers of this processor are missing"
#endif

  [[nodiscard]] const char* text(int i) const {
    return reinterpret_cast<const char*>(argument(i));
  }

 private:
  mcontext_t& machine_;
};

[[noreturn]] void report_and_end(Refused what, const char* name) {
  std::array<char, 1024> report{report_mark, static_cast<char>(what)};
  std::size_t size = 2;
  while (name != nullptr && *name != '\0' && size < report.size()) report[size++] = *name++;
  static_cast<void>(!::write(report_descriptor, report.data(), size));
  ::_exit(1);
}

/// A descriptor, or a negative error number as the kernel returns it.
long opened(int folder, const char* name, int flags) {
  if ((flags & writing_flags) != 0) {
    if (memory_file < 0) report_and_end(Refused::writing, name);
    return ::dup(memory_file);
  }
  const int file = ::openat(folder, name, flags | handlers_flag | O_NOCTTY);
  if (file < 0) return -errno;
  struct stat status {};
  if (::fstat(file, &status) != 0) return -errno;
  if (!S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode)) report_and_end(Refused::special, name);
  return file;
}

extern "C" void on_refused_call(int /*signal*/, siginfo_t* info, void* context) {
  const int errno_before = errno;
  CallRegisters registers(context);
  long result = -EPERM;
  if (info->si_syscall == SYS_openat) {
    result = opened(static_cast<int>(registers.argument(0)), registers.text(1),
                    static_cast<int>(registers.argument(2)));
#ifdef SYS_open
  } else if (info->si_syscall == SYS_open) {
    result = opened(AT_FDCWD, registers.text(0), static_cast<int>(registers.argument(1)));
#endif
  } else if (const std::optional<Refused> what = refusal_of(info->si_syscall)) {
    report_and_end(*what, nullptr);
  }
  registers.set_result(result);
  errno = errno_before;
}

[[noreturn]] void no_filter(int error) {
  throw FileError(
      "a geometry file can run commands, and this system has no way to prevent it: "
      "filters of system calls (seccomp) fail with \"" +
      std::generic_category().message(error) +
      "\"; expected a kernel, or a container, that allows them");
}

/// The filter of the kernel; it must not outlive its loading.
class Filter {
 public:
  Filter() : context_(::seccomp_init(SCMP_ACT_TRAP)) {
    if (context_ == nullptr) no_filter(ENOMEM);
  }
  Filter(const Filter&) = delete;
  Filter& operator=(const Filter&) = delete;
  ~Filter() { ::seccomp_release(context_); }

  void allow(int call) { check(::seccomp_rule_add(context_, SCMP_ACT_ALLOW, call, 0)); }
  void allow(int call, const scmp_arg_cmp& condition) {
    check(::seccomp_rule_add_array(context_, SCMP_ACT_ALLOW, call, 1, &condition));
  }
  void load() { check(::seccomp_load(context_)); }

 private:
  /// Throws for an error of the library, except -EDOM: this processor has no such call.
  static void check(int result) {
    if (result < 0 && result != -EDOM) no_filter(-result);
  }

  scmp_filter_ctx context_;
};

}  // namespace

void confine_process(int report_to) {
  report_descriptor = report_to;
  struct sigaction action {};
  action.sa_sigaction = on_refused_call;
  action.sa_flags = SA_SIGINFO;
  ::sigaction(SIGSYS, &action, nullptr);

  Filter filter;
  for (const int call : allowed_calls) filter.allow(call);
  const auto by_handler = [](unsigned argument) {
    return scmp_arg_cmp{argument, SCMP_CMP_MASKED_EQ, writing_flags | handlers_flag, handlers_flag};
  };
  filter.allow(SCMP_SYS(openat), by_handler(2));
  // A process may end itself by a signal, and ask for its limits without changing them.
  filter.allow(SCMP_SYS(tgkill), {0, SCMP_CMP_EQ, static_cast<scmp_datum_t>(::getpid()), 0});
  filter.allow(SCMP_SYS(prlimit64), {2, SCMP_CMP_EQ, 0, 0});
  filter.load();
  is_confined = true;
}

WritesToMemory::WritesToMemory() : file_(::memfd_create("suffuse", 0)) {
  if (file_ < 0 || !is_confined) throw FileError("a file in memory could not be made");
  memory_file = file_;
}

WritesToMemory::~WritesToMemory() {
  memory_file = -1;
  ::close(file_);
}

std::string WritesToMemory::path() const {
  return "/proc/self/fd/" + std::to_string(file_);
}

}  // namespace suffuse
