#include "seeds.hpp"

#include <filesystem>

#include "bytes.hpp"
#include "case/case_file.hpp"
#include "case/scratch_folder.hpp"
#include "post/synthetic_results.hpp"

namespace suffuse::fuzz {
namespace {

namespace fs = std::filesystem;

Files contents(const fs::path& folder) {
  Files files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    files[entry.path().lexically_relative(folder).string()] = file_bytes(entry.path().string());
  }
  return files;
}

Files case_files(Case<2> c, const std::vector<std::string>& overrides) {
  const ScratchFolder scratch("suffuse-seed");
  c.document = parse_scene(c.document.text, c.document.path, overrides);
  write_case((scratch.path() / case_file).string(), c);
  return contents(scratch.path());
}

template <class Write>
Files results_files(const Write& write) {
  const ScratchFolder scratch("suffuse-seed");
  write((scratch.path() / "r").string());
  return contents(scratch.path() / "r");
}

}  // namespace

const std::map<std::string, Files>& case_seeds() {
  static const std::map<std::string, Files> seeds = [] {
    const Case<2> single = testing::unit_square_case();
    const Case<2> both = testing::double_point::column();
    const std::string implicit = R"(time={end=10.0,scheme="implicit"})";
    const std::string soon = "time.end=10.0";
    return std::map<std::string, Files>{
        {"double-point", case_files(both, {soon})},
        {"double-point-carried", case_files(both, {soon, "flow.integration=material-point"})},
        {"double-point-implicit", case_files(both, {implicit})},
        {"single-point", case_files(single, {soon})},
        {"single-point-implicit", case_files(single, {implicit, "gravity=[0.0,-9.81]"})}};
  }();
  return seeds;
}

const std::map<std::string, Files>& results_seeds() {
  static const std::map<std::string, Files> seeds{
      {"double-point",
       results_files([](const std::string& f) { testing::double_point::write_results(f); })},
      {"single-point",
       results_files([](const std::string& f) { testing::write_synthetic_results(f); })}};
  return seeds;
}

std::vector<std::string> names(const std::map<std::string, Files>& seeds) {
  std::vector<std::string> all;
  for (const auto& [name, files] : seeds) all.push_back(name);
  return all;
}

void lay_out(const Files& files, const std::string& folder) {
  for (const auto& entry : fs::directory_iterator(folder)) fs::remove_all(entry.path());
  for (const auto& [name, bytes] : files) {
    const fs::path path = fs::path(folder) / name;
    fs::create_directories(path.parent_path());
    write_bytes(path.string(), bytes);
  }
}

}  // namespace suffuse::fuzz
