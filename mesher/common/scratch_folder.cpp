#include "common/scratch_folder.hpp"

#include <cstdlib>

#include "common/errors.hpp"

namespace suffuse {

namespace fs = std::filesystem;

ScratchFolder::ScratchFolder(const std::string& prefix) {
  std::error_code error;
  const fs::path parent = fs::temp_directory_path(error);
  // mkdtemp replaces the X by letters of its own.
  std::string pattern = (parent / (prefix + "-XXXXXX")).string();
  if (error || ::mkdtemp(pattern.data()) == nullptr) {
    throw FileError(pattern + ": cannot be created; is there room for temporary files?");
  }
  path_ = pattern;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace suffuse
