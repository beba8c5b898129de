#pragma once

/// A place for files that are needed for a moment.

#include <filesystem>
#include <string>

namespace suffuse {

/// A folder for files that are gone with the object. Throws FileError.
class TemporaryFolder {
 public:
  TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();
  [[nodiscard]] std::string operator/(const std::string& name) const {
    return (path_ / name).string();
  }

 private:
  std::filesystem::path path_;
};

}  // namespace suffuse
