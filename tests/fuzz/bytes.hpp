#pragma once

/// Whole files at once.

#include <fstream>
#include <iterator>
#include <string>

namespace suffuse::fuzz {

inline std::string file_bytes(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline void write_bytes(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
}

}  // namespace suffuse::fuzz
