#include "seeds.hpp"

#include <filesystem>

#include "box_mesh.hpp"
#include "bytes.hpp"
#include "case/case_file.hpp"
#include "common/scratch_folder.hpp"
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

template <int Dim>
Files case_files(Case<Dim> c, const std::vector<std::string>& overrides) {
  const ScratchFolder scratch("suffuse-seed");
  c.document = parse_scene(c.document.text, c.document.path, overrides);
  complete_for_mesh(c.document, Dim);
  write_case((scratch.path() / case_file).string(), c);
  return contents(scratch.path());
}

template <class Write>
Files results_files(const Write& write) {
  const ScratchFolder scratch("suffuse-seed");
  write((scratch.path() / "r").string());
  return contents(scratch.path() / "r");
}

/// Changes that turn a plane scene into one of a box.
std::vector<std::string> in_space(Formulation formulation) {
  const bool both = formulation == Formulation::double_point;
  return {std::string(R"(geometry={shape="box", width=1, depth=1, height=1)") +
              (both ? ", layers={inflow=1, above=1, below=1, outflow=1}}" : "}"),
          R"(time={end=10.0, scheme="implicit"})"};
}

/// The column of `testing::double_point`, or one of soil alone, of tetrahedra.
Case<3> box_case(Formulation formulation) {
  const bool both = formulation == Formulation::double_point;
  const Case<2> plane = both ? testing::double_point::column() : testing::unit_square_case();
  Case<3> c;
  c.document = parse_scene(plane.document.text, "box.toml", in_space(formulation));
  c.mesh = both ? layered_box() : model::box_mesh({1, 1, 1});
  const MaterialPoints<3> centres = model::gauss_points(c.mesh, 1);
  for (int e = 0; e < c.mesh.element_count(); ++e) {
    const std::string& region = c.mesh.region_names[c.mesh.element_region[e]];
    const bool soil = region == "specimen" || region == "buffer";
    const double volume = centres.volume[e];
    if (soil) {
      c.solid_points.element.push_back(e);
      c.solid_points.barycentric.push_back(centres.barycentric[e]);
      c.solid_points.volume.push_back(volume);
    }
    if (!both) continue;
    c.liquid_points.element.push_back(e);
    c.liquid_points.barycentric.push_back(centres.barycentric[e]);
    c.liquid_points.volume.push_back(soil ? 0.3 * volume : volume);
  }
  return c;
}

Files box_files(Formulation formulation) {
  return case_files(box_case(formulation), in_space(formulation));
}

/// Arbitrary values on every kind of place.
Snapshot space_snapshot(const Case<3>& c, double time, long step) {
  const auto field = [](const char* name, int components, std::size_t count) {
    return Field{name, "1", components,
                 std::vector<double>(static_cast<std::size_t>(components) * count, 0.3)};
  };
  Snapshot result;
  result.time = time;
  result.step = step;
  result.cell = {field("porosity", 1, c.mesh.elements.size()),
                 field("darcy_flux", 3, c.mesh.elements.size())};
  result.node = {field("liquid_velocity", 3, c.mesh.nodes.size())};
  result.element_vertex = {field("porosity", 4, c.mesh.elements.size())};
  result.solid = {field("porosity", 1, c.solid_points.element.size())};
  for (int p = 0; p < c.liquid_points.size(); ++p) {
    const Vector<3> x = c.liquid_points.position(c.mesh, p);
    result.liquid_positions.insert(result.liquid_positions.end(), {x[0], x[1], x[2]});
  }
  result.liquid = {field("concentration", 1, c.liquid_points.element.size())};
  return result;
}

/// Two snapshots and a checkpoint, each with a state to resume from.
template <int Dim, class MakeSnapshot>
void write_stopped_run(const std::string& folder, const Case<Dim>& c, const MakeSnapshot& make) {
  constexpr double end = 10.0;
  ResultsWriter<Dim> writer(folder, c);
  testing::write_rows(writer, end, [](double) { return 0.3; });
  const auto point = [&](double time, long snapshots) {
    const auto rows = static_cast<long>(time) + 1;
    return RestartPoint{time,         rows,
                        snapshots,    false,
                        digest_of(c), std::vector<std::uint8_t>(64, std::uint8_t(snapshots))};
  };
  for (const long index : {0L, 1L}) {
    const double time = 5.0 * static_cast<double>(index);
    Snapshot snapshot = make(c, time, index);
    snapshot.restart = point(time, index + 1);
    writer.write_snapshot(std::move(snapshot));
  }
  writer.write_checkpoint(point(end, 2));
  writer.write_run_info({});
}

}  // namespace

Mesh<3> layered_box() {
  constexpr std::array<int, 6> region_of_row{0, 1, 2, 2, 1, 3};
  Mesh<3> mesh = model::box_mesh({1, 1, 6}, {1.0, 1.0, 3.0}, [](const Vector<3>& x) {
    return Vector<3>(x[0], x[1], x[2] - 1.0);
  });
  mesh.region_names = {"outflow", "buffer", "specimen", "inflow"};
  for (int e = 0; e < mesh.element_count(); ++e) {
    mesh.element_region[e] =
        region_of_row.at(static_cast<std::size_t>(2.0 * (element_centroid(mesh, e)[2] + 1.0)));
  }
  for (BoundarySet<3>& boundary : mesh.boundaries) {
    if (boundary.name == "top") boundary.name = "inflow";
    if (boundary.name == "bottom") boundary.name = "outflow";
  }
  return mesh;
}

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
        {"double-point-in-space", box_files(Formulation::double_point)},
        {"single-point", case_files(single, {soon})},
        {"single-point-implicit",
         case_files(single, {implicit, "gravity=[0.0,-9.81]", "initial.water_level=1.0"})},
        {"single-point-in-space", box_files(Formulation::single_point)}};
  }();
  return seeds;
}

const std::map<std::string, Files>& results_seeds() {
  static const std::map<std::string, Files> seeds{
      {"double-point",
       results_files([](const std::string& f) { testing::double_point::write_results(f); })},
      {"single-point",
       results_files([](const std::string& f) { testing::write_synthetic_results(f); })},
      {"stopped", results_files([](const std::string& f) {
         write_stopped_run(f, testing::unit_square_case(), testing::linear_snapshot);
       })},
      {"stopped-in-space", results_files([](const std::string& f) {
         write_stopped_run(f, box_case(Formulation::double_point), space_snapshot);
       })}};
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
