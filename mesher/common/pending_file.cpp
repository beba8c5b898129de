#include "common/pending_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

#include "common/errors.hpp"

namespace suffuse {

namespace fs = std::filesystem;

namespace {

/// Waits until the file or folder is on the disk. A file system that cannot do this (EINVAL) is no
/// error.
void synchronise(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) throw FileError(path + ": cannot be opened: " + std::strerror(errno));
  const bool failed = ::fsync(descriptor) != 0 && errno != EINVAL;
  const std::string reason = failed ? std::strerror(errno) : "";
  ::close(descriptor);
  if (failed) throw FileError(path + ": could not be written whole: " + reason);
}

bool is_special(const fs::path& path) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

}  // namespace

PendingFile::PendingFile(std::string path)
    : path_(std::move(path)), is_special_(is_special(path_)) {
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
  temporary_path_ = ((is_special_ ? fs::temp_directory_path() : folder) / name).string();
}

PendingFile::~PendingFile() {
  if (committed_) return;
  std::error_code ignored;
  fs::remove(temporary_path_, ignored);
}

void PendingFile::pass_on() const {
  std::ifstream contents(temporary_path_, std::ios::binary);
  std::ofstream target(path_, std::ios::binary | std::ios::app);
  target << contents.rdbuf() << std::flush;
  if (!contents || !target) throw FileError(path_ + ": could not be written whole");
}

void PendingFile::commit() {
  if (is_special_) {
    pass_on();
    return;  // the destructor removes the file
  }
  synchronise(temporary_path_);
  std::error_code error;
  fs::rename(temporary_path_, path_, error);
  if (error) throw FileError(path_ + ": cannot be created: " + error.message());
  committed_ = true;
  synchronise(folder_of(path_).string());
}

}  // namespace suffuse
