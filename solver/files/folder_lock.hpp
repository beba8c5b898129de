#pragma once

/// One solver at a time writes into a results folder.

#include <string>
#include <utility>

namespace suffuse {

/// Holds the lock (flock) until destroyed or until the process ends, however that happens. Where
/// the file system knows no locks no other solver is kept out. A folder that it made and that has
/// got nothing else is removed again.
class FolderLock {
 public:
  FolderLock() = default;
  /// Makes the folder if need be. Throws FileError, which names the process that holds the lock.
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

/// Whether a solver may still be writing into the folder: it holds the lock, or nobody can tell.
/// That is so where the file system knows no locks, and where a solver on another host left its
/// name, as not every file system passes locks on from host to host.
[[nodiscard]] bool may_be_held(const std::string& folder);

}  // namespace suffuse
