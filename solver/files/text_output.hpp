#pragma once

#include <optional>
#include <string>

#include "common/pending_file.hpp"

namespace suffuse {

/// A file for a text, written completely or not at all; `-` is standard output.
class TextOutput {
 public:
  /// Throws FileError if the folder is missing, before the text is computed.
  explicit TextOutput(const std::string& path);
  /// Throws FileError.
  void write(const std::string& text);

 private:
  std::string path_;
  std::optional<PendingFile> file_;
};

}  // namespace suffuse
