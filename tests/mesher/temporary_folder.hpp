#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace suffuse::test {

/// A folder of its own for one test, removed afterwards.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "suffuse-test-XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }

  [[nodiscard]] std::string file(const std::string& name) const { return (path_ / name).string(); }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(file(name), std::ios::binary) << text;
    return file(name);
  }
  [[nodiscard]] int count() const {
    return static_cast<int>(std::distance(std::filesystem::directory_iterator(path_), {}));
  }

 private:
  std::filesystem::path path_;
};

inline std::string read_file(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// A complete scene on the built-in column or the given [geometry] and [mesh], with one soil
/// "specimen" and no boundary; `more` follows.
inline std::string scene_text(const std::string& geometry, const std::string& more = "") {
  return "name = \"test\"\nformulation = \"single-point\"\n" + geometry +
         "\n[liquid]\ndensity = 1000.0\nbulk_modulus = 2.0e7\nviscosity = 1.0e-3\n"
         "[time]\nend = 1.0\nscheme = \"explicit\"\n[output]\nevery = 1.0\n"
         "[soil.specimen]\nporosity = 0.3\nskeleton_fraction = 0.6\ngrain_density = 2700.0\n"
         "conductivity = 2.0e-2\n" +
         more;
}

inline const std::string unit_column =
    "[geometry]\nshape = \"column\"\nwidth = 1.0\nheight = 1.0\n[mesh]\nsize = 0.25\n";

}  // namespace suffuse::test
