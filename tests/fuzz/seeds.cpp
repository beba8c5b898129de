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

/// Two snapshots and a checkpoint, each with a state to go on from.
void write_stopped_run(const std::string& folder) {
  constexpr double end = 10.0;
  const Case<2> c = testing::unit_square_case();
  ResultsWriter<2> writer(folder, c);
  testing::write_rows(writer, end, [](double) { return 0.3; });
  const auto point = [&](double time, long snapshots) {
    const auto rows = static_cast<long>(time) + 1;
    return RestartPoint{time,         rows,
                        snapshots,    false,
                        digest_of(c), std::vector<std::uint8_t>(64, std::uint8_t(snapshots))};
  };
  for (const long index : {0L, 1L}) {
    const double time = 5.0 * static_cast<double>(index);
    Snapshot snapshot = testing::linear_snapshot(c, time, index);
    snapshot.restart = point(time, index + 1);
    writer.write_snapshot(std::move(snapshot));
  }
  writer.write_checkpoint(point(end, 2));
  writer.write_run_info({});
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
        {"single-point-implicit",
         case_files(single, {implicit, "gravity=[0.0,-9.81]", "initial.water_level=1.0"})}};
  }();
  return seeds;
}

const std::map<std::string, Files>& results_seeds() {
  static const std::map<std::string, Files> seeds{
      {"double-point",
       results_files([](const std::string& f) { testing::double_point::write_results(f); })},
      {"single-point",
       results_files([](const std::string& f) { testing::write_synthetic_results(f); })},
      {"stopped", results_files(write_stopped_run)}};
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
