#include <sys/stat.h>

#include <filesystem>
#include <set>
#include <string>

#include "bytes.hpp"
#include "common/scratch_folder.hpp"
#include "geometry.hpp"
#include "mesher/temporary_folder.hpp"
#include "refusal.hpp"
#include "targets.hpp"

namespace suffuse::fuzz {
namespace {

namespace fs = std::filesystem;

/// Names of all files in the folders that a command of a geometry would change.
std::set<std::string> listing(const fs::path& folder) {
  std::set<std::string> names;
  for (const fs::path& place : {folder, fs::current_path()}) {
    for (const auto& entry : fs::directory_iterator(place)) names.insert(entry.path().string());
  }
  return names;
}

/// The folder of the input, with the targets of attacks: a canary, a file of commands, a pipe.
const fs::path& folder() {
  static const ScratchFolder scratch("suffuse-geometry");
  static const bool laid_out = [] {
    write_bytes((scratch.path() / "canary").string(), "alive");
    write_bytes((scratch.path() / "evil.txt").string(),
                "SystemCall \"touch " + (scratch.path() / "trace").string() + "\";\n");
    return ::mkfifo((scratch.path() / "fifo").c_str(), 0600) == 0;
  }();
  require(laid_out, "no pipe can be made");
  return scratch.path();
}

/// A name whose suffix tells Gmsh how to read the input.
std::string file_name(const std::string& input) {
  if (input.starts_with("$")) return "a.msh";
  return input.starts_with("ISO-") ? "a.step" : "a.geo";
}

}  // namespace

void try_geometry(const std::string& input) {
  constexpr double seconds = 1.0;
  std::string text = input;
  for (std::size_t at = text.find('@'); at != std::string::npos; at = text.find('@', at)) {
    text.replace(at, 1, folder().string());
  }
  const std::string name = file_name(input);
  write_bytes((folder() / name).string(), text);
  const std::set<std::string> before = listing(folder());
  const bool is_mesh = name.ends_with(".msh");
  static_cast<void>(is_taken([&] {
    const SceneDocument document =
        parse_scene(test::scene_text("[geometry]\nfile = \"" + name + "\"\n" +
                                     (is_mesh ? "" : "[mesh]\nsize = 0.5\n")),
                    (folder() / "scene.toml").string());
    static_cast<void>(build_geometry({document, seconds}));
  }));
  require(file_bytes((folder() / "canary").string()) == "alive", "a geometry wrote to the canary");
  require(listing(folder()) == before, "a geometry made or removed a file");
  fs::remove(folder() / name);
}

}  // namespace suffuse::fuzz
