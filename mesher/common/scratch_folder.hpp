#pragma once

#include <filesystem>
#include <string>

namespace suffuse {

/// A new folder for temporary files (in TMPDIR), removed with its contents.
class ScratchFolder {
 public:
  /// The folder's name begins with `prefix`. Throws FileError if it cannot be made.
  explicit ScratchFolder(const std::string& prefix);
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder();
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace suffuse
