#include "files/text_output.hpp"

#include <fstream>
#include <iostream>

#include "common/errors.hpp"

namespace suffuse {

TextOutput::TextOutput(const std::string& path) : path_(path) {
  if (path != "-") file_.emplace(path);
}

void TextOutput::write(const std::string& text) {
  if (!file_) {
    std::cout << text << std::flush;
    if (!std::cout) throw FileError("standard output: cannot be written");
    return;
  }
  std::ofstream file(file_->temporary_path(), std::ios::binary);
  file << text;
  file.close();
  if (!file) throw FileError(path_ + ": cannot be written; is the disk full?");
  file_->commit();
}

}  // namespace suffuse
