#pragma once

/// A file under construction. It is written under a temporary name in its final folder, and renamed
/// only when complete: an interrupted program leaves no incomplete file that looks complete. A
/// terminal or a pipe receives the contents when they are complete.

#include <filesystem>
#include <string>

namespace suffuse {

class PendingFile {
 public:
  /// The temporary name ends in the extension of `path`. Throws FileError when the folder is
  /// missing.
  explicit PendingFile(std::string path);
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;
  /// Removes the temporary file unless it was committed.
  ~PendingFile();

  /// Where to write.
  [[nodiscard]] const std::string& temporary_path() const { return temporary_path_; }

  /// Synchronises the finished file to the disk and renames it. Throws FileError.
  void commit();

 private:
  void pass_on() const;

  std::string path_;
  std::string temporary_path_;
  bool is_special_;  ///< a terminal or pipe, never replaced by a file
  bool committed_ = false;
};

}  // namespace suffuse
