#pragma once

/// A file under construction: written under a temporary name in the folder of its final one, which
/// it takes only when complete. An interrupted program leaves no half-written file that looks
/// whole.

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

  /// Brings the finished file to the disk and renames it. Throws FileError.
  void commit();

 private:
  std::string path_;
  std::string temporary_path_;
  bool committed_ = false;
};

}  // namespace suffuse
