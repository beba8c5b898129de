#pragma once

/// Small results folders made with ResultsWriter, of known content.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "case/case_file.hpp"
#include "results/writer.hpp"

namespace suffuse::testing {

/// A folder of this test alone, removed afterwards.
class ScratchFolder {
 public:
  ScratchFolder() {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ =
        std::filesystem::temp_directory_path() / ("suffuse-" + std::to_string(::getpid()) + "-" +
                                                  info->test_suite_name() + "-" + info->name());
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() { std::filesystem::remove_all(path_); }
  [[nodiscard]] std::string operator/(const std::string& name) const {
    return (path_ / name).string();
  }

 private:
  std::filesystem::path path_;
};

inline std::string file_text(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

inline std::string scene_text(const std::string& name, const std::string& law, double rate) {
  std::ostringstream text;
  text << "name = \"" << name << "\"\nformulation = \"single-point\"\n"
       << "[geometry]\nshape = \"column\"\nwidth = 1.0\nheight = 1.0\n[mesh]\nsize = 0.5\n"
       << "[points]\nsolid_per_element = 1\n"
       << "[liquid]\ndensity = 1000.0\nbulk_modulus = 2.0e7\nviscosity = 1.0e-3\n"
       << "[soil.specimen]\nporosity = 0.3\nskeleton_fraction = 0.6\ngrain_density = 2700.0\n"
       << "conductivity = 2.0e-2\n[soil.specimen.erosion]\nlaw = \"" << law << "\"\nrate = " << rate
       << "\nstart = 2.0\n[[boundary]]\non = \"top\"\npressure = 6.0e3\nconcentration = 0.0\n"
       << "[[boundary]]\non = \"bottom\"\npressure = 0.0\n"
       << "[time]\nend = 120.0\nscheme = \"explicit\"\n[output]\nevery = 1.0\n";
  return text.str();
}

/// The unit square of two by two squares, two triangles each, one point in the middle of each.
inline Case<2> unit_square_case(const std::string& name = "synthetic",
                                const std::string& law = "constant", double rate = 1e-3) {
  Case<2> c;
  c.document = parse_scene(scene_text(name, law, rate), name + ".toml");
  constexpr int n = 2;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) c.mesh.nodes.emplace_back(double(i) / n, double(j) / n);
  }
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i;
      c.mesh.elements.push_back({a, a + 1, a + n + 2});
      c.mesh.elements.push_back({a, a + n + 2, a + n + 1});
    }
  }
  c.mesh.region_names = {"specimen"};
  c.mesh.element_region.assign(c.mesh.elements.size(), 0);
  c.mesh.boundaries = {{"bottom", {{0, 1}, {1, 2}}}, {"top", {{8, 7}, {7, 6}}}};
  for (int e = 0; e < c.mesh.element_count(); ++e) {
    c.solid_points.element.push_back(e);
    c.solid_points.barycentric.push_back({1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0});
    c.solid_points.volume.push_back(1.0 / 8.0);
  }
  return c;
}

/// Linear in space and time, so that interpolation must be exact.
inline double linear_porosity(double x, double y, double t) {
  return 0.3 + 0.01 * x + 0.02 * y + 1e-3 * t * (1.0 + x);
}

/// porosity: linear; fines_fraction: the element's number, so it jumps at every edge; pressure:
/// cell means only; liquid_velocity: nodal vector (y, -x); darcy_flux: cell vector.
inline Snapshot linear_snapshot(const Case<2>& c, double t, long step) {
  Snapshot s;
  s.time = t;
  s.step = step;
  Field porosity{"porosity", "-", 3, {}};
  Field fines{"fines_fraction", "-", 3, {}};
  Field cell_porosity{"porosity", "-", 1, {}};
  Field pressure{"pressure", "Pa", 1, {}};
  Field flux{"darcy_flux", "m/s", 2, {}};
  for (int e = 0; e < c.mesh.element_count(); ++e) {
    for (const int node : c.mesh.elements[e]) {
      const auto& x = c.mesh.nodes[node];
      porosity.values.push_back(linear_porosity(x[0], x[1], t));
      fines.values.push_back(e);
    }
    const auto middle = element_centroid(c.mesh, e);
    cell_porosity.values.push_back(linear_porosity(middle[0], middle[1], t));
    pressure.values.push_back(1000.0 * e);
    flux.values.insert(flux.values.end(), {0.25 * e, -1.0});
  }
  Field velocity{"liquid_velocity", "m/s", 2, {}};
  for (const auto& x : c.mesh.nodes) {
    velocity.values.insert(velocity.values.end(), {x[1], -x[0]});
  }
  Field point_porosity{"porosity", "-", 1, {}};
  for (int p = 0; p < c.solid_points.size(); ++p) point_porosity.values.push_back(0.1 * p + t);
  s.cell = {cell_porosity, pressure, flux};
  s.node = {velocity};
  s.solid = {point_porosity};
  s.element_vertex = {porosity, fines};
  s.restart = {{"nodal_speed", "m/s", 1, {1.0, 2.0, 3.0}}};
  return s;
}

/// Rows of a run that keeps to `porosity_at`, losing its fines at once through the outlet.
template <class PorosityAt>
void write_rows(ResultsWriter<2>& writer, double end, const PorosityAt& porosity_at) {
  for (double t = 0.0; t <= end; t += 1.0) {
    const double porosity = porosity_at(t);
    HistoryRow history;
    history.t = t;
    history.dt = 0.0851;
    history.porosity_mean = porosity;
    LedgerRow row;
    row.t = t;
    row.solid = (1.0 - porosity) * 2700.0;
    row.erodible = (0.4 - porosity) * 2700.0;
    row.eroded = (porosity - 0.3) * 2700.0;
    row.fines_out = row.eroded;
    row.water_in = 4.0 * t;
    row.water_out = 4.0 * t;
    row.water = 300.0;
    writer.append_history(history);
    writer.append_ledger(row);
    const RegionRow region{0, porosity, row};
    writer.append_regions(std::span(&region, 1));
  }
}

/// A whole run: rows to t = 120 s with Eq. 6's porosity, snapshots at 0, 10 and 40 s.
inline void write_synthetic_results(const std::string& folder,
                                    const std::string& name = "synthetic", double rate = 1e-3) {
  const Case<2> c = unit_square_case(name, "constant", rate);
  ResultsWriter<2> writer(folder, c);
  write_rows(writer, 120.0,
             [&](double t) { return std::min(0.4, 0.3 + rate * std::max(0.0, t - 2.0)); });
  long step = 0;
  for (const double t : {0.0, 10.0, 40.0}) writer.write_snapshot(linear_snapshot(c, t, step++));
  RunInfo info;
  info.status = "done";
  info.steps = 3;
  info.elements = 8;
  info.solid_points = 8;
  info.wall_seconds = 0.5;
  info.passes = {{"flow", 3, 0.25}};
  info.plan = {"no gravity"};
  info.warnings = {"mass scaling 1e4 is large"};
  writer.write_run_info(info);
}

}  // namespace suffuse::testing
