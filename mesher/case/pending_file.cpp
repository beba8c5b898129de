#include "case/pending_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "case/errors.hpp"

namespace suffuse {

namespace fs = std::filesystem;

namespace {

/// Waits until the disk has it. A file system that cannot (EINVAL) is not a failure.
void synchronise(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) throw FileError(path + ": cannot be opened: " + std::strerror(errno));
  const bool failed = ::fsync(descriptor) != 0 && errno != EINVAL;
  const std::string reason = failed ? std::strerror(errno) : "";
  ::close(descriptor);
  if (failed) throw FileError(path + ": could not be written whole: " + reason);
}

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

}  // namespace

PendingFile::PendingFile(std::string path) : path_(std::move(path)) {
  const fs::path final_path(path_);
  const fs::path folder = folder_of(final_path);
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) {
    throw FileError(path_ + ": cannot be created: there is no folder " + folder.string());
  }
  if (fs::is_directory(final_path, ignored)) {
    throw FileError(path_ + ": cannot be created: a folder has this name");
  }
  const std::string name = "." + final_path.stem().string() + "." + std::to_string(::getpid()) +
                           ".part" + final_path.extension().string();
  temporary_path_ = (folder / name).string();
}

PendingFile::~PendingFile() {
  if (committed_) return;
  std::error_code ignored;
  fs::remove(temporary_path_, ignored);
}

void PendingFile::commit() {
  synchronise(temporary_path_);
  std::error_code error;
  fs::rename(temporary_path_, path_, error);
  if (error) throw FileError(path_ + ": cannot be created: " + error.message());
  committed_ = true;
  synchronise(folder_of(path_).string());
}

}  // namespace suffuse
