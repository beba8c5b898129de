#pragma once

#include <filesystem>
#include <fstream>
#include <string>

namespace suffuse {

/// Opens a regular file for reading. Others stay closed: reading a folder throws, and a pipe may
/// block the program.
inline std::ifstream open_regular_file(const std::string& path) {
  std::error_code ignored;
  std::ifstream in;
  if (std::filesystem::is_regular_file(path, ignored)) in.open(path, std::ios::binary);
  return in;
}

}  // namespace suffuse
