#include "files/folder_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "common/errors.hpp"
#include "common/regular_file.hpp"
#include "files/layout.hpp"

namespace suffuse {
namespace {

namespace fs = std::filesystem;

constexpr const char* on_host = " on ";

std::string this_host() {
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  return host.data();
}

std::string this_process() {
  return "process " + std::to_string(::getpid()) + on_host + this_host();
}

/// Takes the lock of an open file. Tries several times: readers that test the lock hold it briefly.
bool take_lock(int file) {
  constexpr int attempts = 5;
  for (int attempt = 1;; ++attempt) {
    if (::flock(file, LOCK_EX | LOCK_NB) == 0) return true;
    if (errno != EWOULDBLOCK || attempt == attempts) return false;
    ::usleep(10000);
  }
}

std::string lock_in(const std::string& folder) {
  return (fs::path(folder) / layout::lock).string();
}

bool holds_one_file(const std::string& folder) {
  std::error_code ignored;
  return std::distance(fs::directory_iterator(folder, ignored), {}) == 1;
}

/// The process that took the lock last; empty if it released the lock.
std::string holder(const std::string& path) {
  std::ifstream in = open_regular_file(path);
  std::string name;
  std::getline(in, name);
  return name;
}

std::string in_brackets(const std::string& name) {
  return name.empty() ? "" : " (" + name + ")";
}

}  // namespace

FolderLock::FolderLock(const std::string& folder) {
  std::error_code error;
  made_folder_ = fs::create_directories(folder, error);
  if (error) throw FileError(folder + ": cannot be created: " + error.message());
  folder_ = folder;
  const std::string path = lock_in(folder);
  file_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file_ < 0) throw FileError(folder + ": cannot be written to: " + std::strerror(errno));
  if (!take_lock(file_)) {
    const bool held = errno == EWOULDBLOCK;
    ::close(std::exchange(file_, -1));
    if (!held) return;
    throw FileError(folder + ": another suffuse-solver writes there" + in_brackets(holder(path)) +
                    "; wait for it, or choose another folder with -o");
  }
  // The name is only used in the error message of another solver.
  const std::string name = this_process() + "\n";
  if (::ftruncate(file_, 0) == 0) {
    [[maybe_unused]] const auto written = ::write(file_, name.data(), name.size());
  }
}

FolderLock::~FolderLock() {
  if (file_ < 0) return;
  // Only the name of a process that was killed stays in the file.
  [[maybe_unused]] const int emptied = ::ftruncate(file_, 0);
  std::error_code ignored;
  if (made_folder_ && holds_one_file(folder_)) {
    fs::remove(lock_in(folder_), ignored);
    fs::remove(folder_, ignored);
  }
  ::close(file_);
}

bool may_be_held(const std::string& folder) {
  const std::string path = lock_in(folder);
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) return errno != ENOENT;
  const bool free = ::flock(file, LOCK_SH | LOCK_NB) == 0;
  ::close(file);
  if (!free) return true;
  const std::string name = holder(path);
  return !name.empty() && !name.ends_with(on_host + this_host());
}

}  // namespace suffuse
