#pragma once

/// A lock, so that only one solver writes into a results folder.

#include <string>
#include <utility>

namespace suffuse {

/// Holds the lock (flock) until it is destroyed or the process ends. It has no effect on file
/// systems without locks. The destructor removes a folder that it has made if it holds only the
/// lock.
class FolderLock {
 public:
  FolderLock() = default;
  /// Makes the folder if necessary. Throws FileError that names the process that holds the lock.
  explicit FolderLock(const std::string& folder);
  FolderLock(FolderLock&& other) noexcept { *this = std::move(other); }
  FolderLock& operator=(FolderLock&& other) noexcept {
    std::swap(file_, other.file_);
    std::swap(folder_, other.folder_);
    std::swap(made_folder_, other.made_folder_);
    return *this;
  }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock();

 private:
  int file_ = -1;
  std::string folder_;
  bool made_folder_ = false;
};

/// Whether a solver may be writing into the folder: it holds the lock, or that is unknown. It is
/// unknown without file locks, and if a solver on another host left its name, because not every
/// file system shares locks between hosts.
[[nodiscard]] bool may_be_held(const std::string& folder);

}  // namespace suffuse
