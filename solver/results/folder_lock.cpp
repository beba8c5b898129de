#include "results/folder_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "case/errors.hpp"
#include "results/layout.hpp"

namespace suffuse {
namespace {

namespace fs = std::filesystem;

std::string this_process() {
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  return "process " + std::to_string(::getpid()) + " on " + host.data();
}

std::string holder(const std::string& path) {
  std::ifstream in(path);
  std::string name;
  std::getline(in, name);
  return name.empty() ? "" : " (" + name + ")";
}

}  // namespace

FolderLock::FolderLock(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw FileError(folder + ": cannot be created: " + error.message());
  const std::string path = (fs::path(folder) / layout::lock).string();
  file_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file_ < 0) throw FileError(folder + ": cannot be written to: " + std::strerror(errno));
  if (::flock(file_, LOCK_EX | LOCK_NB) != 0) {
    const bool held = errno == EWOULDBLOCK;
    ::close(std::exchange(file_, -1));
    if (!held) return;
    throw FileError(folder + ": another suffuse-solver writes there" + holder(path) +
                    "; wait for it, or choose another folder with -o");
  }
  // For the message of the one that comes too late; nothing depends on it.
  const std::string name = this_process() + "\n";
  if (::ftruncate(file_, 0) == 0) {
    [[maybe_unused]] const auto written = ::write(file_, name.data(), name.size());
  }
}

FolderLock::~FolderLock() {
  if (file_ >= 0) ::close(file_);
}

}  // namespace suffuse
