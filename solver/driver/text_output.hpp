#pragma once

#include <optional>
#include <string>

#include "common/pending_file.hpp"

namespace suffuse {

/// A file that gets a text, whole or not at all; standard output where its path is `-`.
class TextOutput {
 public:
  /// Throws FileError where the folder is missing: before there is anything to lose.
  explicit TextOutput(const std::string& path);
  /// Throws FileError.
  void write(const std::string& text);

 private:
  std::string path_;
  std::optional<PendingFile> file_;
};

}  // namespace suffuse
