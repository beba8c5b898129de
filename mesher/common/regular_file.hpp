#pragma once

#include <filesystem>
#include <fstream>
#include <string>

namespace suffuse {

/// To read. Not opened where there is anything but a file: to read a folder throws, of a pipe one
/// could wait for ever.
inline std::ifstream open_regular_file(const std::string& path) {
  std::error_code ignored;
  std::ifstream in;
  if (std::filesystem::is_regular_file(path, ignored)) in.open(path, std::ios::binary);
  return in;
}

}  // namespace suffuse
