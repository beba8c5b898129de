#include "results/earlier_run.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "common/errors.hpp"
#include "common/regular_file.hpp"
#include "files/layout.hpp"
#include "results/restart_point.hpp"
#include "scene/scene_difference.hpp"

namespace suffuse {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// Number of differences that a message lists.
constexpr std::size_t most_differences = 10;

/// run.json of a folder; null if it holds no results.
Json run_info_in(const std::string& folder) {
  std::ifstream in = open_regular_file(layout::in_folder(folder, layout::run_info));
  const Json json = Json::parse(in, nullptr, false);
  return json.is_object() && json.value("format", Json()) == layout::format ? json : Json();
}

/// Whether no solver has started there, or one was stopped immediately after its start.
bool nothing_but_a_lock(const std::string& folder) {
  return std::ranges::all_of(fs::directory_iterator(folder), [](const fs::directory_entry& entry) {
    const std::string name = entry.path().filename().string();
    return name == layout::lock || name == std::string(layout::run_info) + ".tmp";
  });
}

/// The scene's text, overrides and files in run.json. Throws Json::exception.
SceneDocument scene_in(const Json& info) {
  const Json& scene = info.at("scene");
  SceneDocument document;
  document.text = scene.at("text").get<std::string>();
  document.overrides = scene.at("overrides").get<std::vector<std::string>>();
  document.files = scene.value("files", std::map<std::string, std::string>{});
  return document;
}

[[noreturn]] void refuse(const std::string& folder, const std::string& what,
                         const std::string& end = "") {
  throw InputError(folder + ": holds results of " + what +
                   "; not touched: choose another folder with -o, or replace them with --force" +
                   end);
}

}  // namespace

void check_results_folder(const std::string& folder, const std::string& scene, Replace replace) {
  try {
    if (!fs::exists(folder)) return;
    if (!fs::is_directory(folder)) {
      throw FileError(folder + ": is a file; expected a folder for the results");
    }
    if (nothing_but_a_lock(folder)) return;
    const Json info = run_info_in(folder);
    if (info.is_null()) {
      throw FileError(folder +
                      ": is not empty and holds no results of suffuse-solver; "
                      "not touched: choose another folder or empty it");
    }
    if (replace == Replace::any) return;
    // A run that has just started may not have written its scene.
    const Json about = info.value("scene", Json());
    const Json there = about.is_object() ? about.value("name", Json()) : about;
    if (!there.is_string() || there == scene) return;
    refuse(folder, "scene " + there.dump(-1, ' ', true, Json::error_handler_t::replace) +
                       ", not of \"" + scene + "\"");
  } catch (const fs::filesystem_error& error) {
    throw FileError(folder + ": " + error.code().message());
  }
}

template <int Dim>
std::vector<std::string> differences_from_run(const std::string& folder, const Case<Dim>& c) {
  const Json info = run_info_in(folder);
  if (info.is_null()) return {};
  try {
    std::vector<std::string> result = scene_differences(scene_in(info), c.document);
    if (info.value("model", Json()) != digest_of_model(c)) {
      result.emplace_back("the mesh or the points");
    }
    return result;
  } catch (const Json::exception&) {
    return {"the scene: " + std::string(layout::run_info) + " there does not have it"};
  }
}

std::string listed_differences(const std::vector<std::string>& differences) {
  std::string text = "What differs:";
  for (std::size_t i = 0; i < std::min(differences.size(), most_differences); ++i) {
    text += "\n  " + differences[i];
  }
  if (differences.size() > most_differences) {
    text += "\n  and " + std::to_string(differences.size() - most_differences) + " more";
  }
  return text;
}

template <int Dim>
FolderLock lock_for_results(const std::string& folder, const Case<Dim>& c, Replace replace) {
  const std::string& name = c.document.scene.name;
  check_results_folder(folder, name, replace);
  if (replace == Replace::same_case) {
    const std::vector<std::string> differences = differences_from_run(folder, c);
    if (!differences.empty()) {
      refuse(folder, "another scene of the name \"" + name + "\"",
             ". " + listed_differences(differences));
    }
  }
  return FolderLock(folder);
}

template std::vector<std::string> differences_from_run(const std::string&, const Case<2>&);
template std::vector<std::string> differences_from_run(const std::string&, const Case<3>&);
template FolderLock lock_for_results(const std::string&, const Case<2>&, Replace);
template FolderLock lock_for_results(const std::string&, const Case<3>&, Replace);

}  // namespace suffuse
