#include "drawing/temporary_folder.hpp"

#include <cstdlib>

#include "case/errors.hpp"

namespace suffuse {

TemporaryFolder::TemporaryFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "suffuse-post-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) throw FileError(name + ": cannot be created");
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace suffuse
