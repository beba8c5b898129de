#pragma once

/// Small results folders made with ResultsWriter, of known content.

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
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

/// Soil that moves and retains in the lower half, with a region of no soil above.
/// \param water_level  at the start, m
inline Case<2> open_above_case(double water_level) {
  Case<2> c = unit_square_case();
  c.document =
      parse_scene("gravity = [0.0, -9.81]\n" + c.document.text, "open.toml",
                  {"time.scheme=implicit", "soil.specimen.retention.model=gardner",
                   "soil.specimen.retention.alpha=2", "soil.specimen.skeleton.law=elastic",
                   "soil.specimen.skeleton.young=1e7", "soil.specimen.skeleton.poisson=0.3",
                   "initial.water_level=" + std::to_string(water_level)});
  c.mesh.region_names.emplace_back("free_above");
  c.mesh.element_region = {0, 0, 0, 0, 1, 1, 1, 1};
  c.solid_points.element.resize(4);
  c.solid_points.barycentric.resize(4);
  c.solid_points.volume.resize(4);
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
  return s;
}

/// Rows of a run with the porosity `porosity_at`, whose fines leave through the outlet at once.
template <int Dim, class PorosityAt>
void write_rows(ResultsWriter<Dim>& writer, double end, const PorosityAt& porosity_at) {
  for (double t = 0.0; t <= end; t += 1.0) {
    const double porosity = porosity_at(t);
    HistoryRow history;
    history.t = t;
    history.dt = 0.0851;
    history.porosity_mean = porosity;
    history.conductivity_ratio = porosity > 0.3 ? porosity / 0.3 : 0.0;
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
    const double fines = row.fines_out / 2700.0;
    const std::array<BoundaryRow, 2> boundaries{
        {{t, "top", row.water_in, 0.0, 0.0, 0.0, 0.004 * t, 0.0, -0.004},
         {t, "bottom", 0.0, row.water_out, 0.0, row.fines_out, 0.0, 0.004 * t + fines, 0.005}}};
    writer.append_boundaries(boundaries);
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

/// A double-point column of 1 m by 1 m between buffers and free water, for which the outflow is
/// exact in closed form while it erodes: constant law, uniform Darcy flux.
namespace double_point {

inline constexpr double rate = 1e-3;
inline constexpr double flux = 0.02;
inline constexpr double start = 2.0;
inline constexpr double grain_density = 2700.0;
/// Share of the eroded mass that is pending at nodes.
inline constexpr double pending_share = 0.01;
inline constexpr double end = 100.0;

inline double porosity(double t) {
  return 0.3 + rate * std::max(0.0, t - start);
}

/// Time at which the liquid that entered as erosion began has crossed the specimen.
inline double front_time() {
  return start + 0.3 * std::expm1(rate / flux) / rate;
}

/// c of the outflow: 1 - n_0 / n before the front arrives, 1 - exp(-alpha L / q) behind it.
inline double concentration_out(double t) {
  return t < front_time() ? 1.0 - 0.3 / porosity(t) : -std::expm1(-rate / flux);
}

/// Integral of q c_out, in kg.
inline double fines_out(double t) {
  const auto before = [](double s) { return s - start - 0.3 / rate * std::log(porosity(s) / 0.3); };
  if (t <= start) return 0.0;
  const double volume = t < front_time()
                            ? before(t)
                            : before(front_time()) + concentration_out(t) * (t - front_time());
  return grain_density * flux * volume;
}

inline std::string scene() {
  std::ostringstream text;
  text << "name = \"two-phase\"\nformulation = \"double-point\"\n"
       << "[geometry]\nshape = \"column\"\nwidth = 1.0\nheight = 1.0\n"
       << "[geometry.layers]\ninflow = 1\nabove = 1\nbelow = 1\noutflow = 1\n"
       << "[mesh]\nsize = 0.5\n[points]\nsolid_per_element = 1\nliquid_per_element = 3\n"
       << "[liquid]\ndensity = 1000.0\nbulk_modulus = 2.0e7\nviscosity = 1.0e-3\n"
       << "[soil.specimen]\nporosity = 0.3\nskeleton_fraction = 0.6\ngrain_density = "
       << grain_density << "\nconductivity = 2.0e-2\n[soil.specimen.erosion]\n"
       << "law = \"constant\"\nrate = " << rate << "\nstart = " << start
       << "\nempty_elements = \"dry\"\n[soil.buffer]\nlike = \"specimen\"\n"
       << "erosion.law = \"none\"\n[[boundary]]\non = \"inflow\"\ndarcy_flux = " << flux
       << "\n[[boundary]]\non = \"outflow\"\npressure = 0.0\n[time]\nend = " << end
       << "\nscheme = \"explicit\"\n[output]\nevery = 1.0\n";
  return text.str();
}

/// Regions by row of elements, from y = -1 to y = 2 m in steps of 0.5 m: two squares of two
/// triangles each. Elements 4 r .. 4 r + 3 are row r.
inline Case<2> column() {
  constexpr std::array<int, 6> region_of_row{0, 1, 2, 2, 1, 3};
  Case<2> c;
  c.document = parse_scene(scene(), "two-phase.toml");
  for (int j = 0; j <= 6; ++j) {
    for (int i = 0; i <= 2; ++i) c.mesh.nodes.emplace_back(0.5 * i, -1.0 + 0.5 * j);
  }
  for (int j = 0; j < 6; ++j) {
    for (int i = 0; i < 2; ++i) {
      const int a = 3 * j + i;
      c.mesh.elements.push_back({a, a + 1, a + 4});
      c.mesh.elements.push_back({a, a + 4, a + 3});
      c.mesh.element_region.insert(c.mesh.element_region.end(), 2, region_of_row.at(j));
    }
  }
  c.mesh.region_names = {"outflow", "buffer", "specimen", "inflow"};
  BoundarySet<2> left{"left", {}};
  BoundarySet<2> right{"right", {}};
  for (int j = 0; j < 6; ++j) {
    left.faces.push_back({3 * j + 3, 3 * j});
    right.faces.push_back({3 * j + 2, 3 * j + 5});
  }
  c.mesh.boundaries = {
      {"outflow", {{0, 1}, {1, 2}}}, {"inflow", {{20, 19}, {19, 18}}}, left, right};
  for (int e = 0; e < c.mesh.element_count(); ++e) {
    const bool soil = c.mesh.element_region[e] == 1 || c.mesh.element_region[e] == 2;
    const double third = 1.0 / 3.0;
    if (soil) {
      c.solid_points.element.push_back(e);
      c.solid_points.barycentric.push_back({third, third, third});
      c.solid_points.volume.push_back(0.125);
    }
    for (int a = 0; a < 3; ++a) {
      std::array<double, 3> b{1.0 / 6.0, 1.0 / 6.0, 1.0 / 6.0};
      b.at(a) = 2.0 / 3.0;
      c.liquid_points.element.push_back(e);
      c.liquid_points.barycentric.push_back(b);
      c.liquid_points.volume.push_back(0.125 * (soil ? 0.3 : 1.0) / 3.0);
    }
  }
  return c;
}

/// Element 8 (the specimen's first) is dry soil and element 23 (in the inflow) empty: no liquid
/// points there. concentration: the y of an element or point, in units of 100 m; pressure of liquid
/// points: their number.
inline Snapshot snapshot(const Case<2>& c, double t, long step) {
  Snapshot s;
  s.time = t;
  s.step = step;
  Field state{"saturation_state", "1", 1, {}};
  Field cell_concentration{"concentration", "1", 1, {}};
  Field vertex_concentration{"concentration", "1", 3, {}};
  Field porosity_field{"porosity", "1", 1, {}};
  for (int e = 0; e < c.mesh.element_count(); ++e) {
    const int r = c.mesh.element_region[e];
    const bool soil = r == 1 || r == 2;
    double value = soil ? 1.0 : 2.0;
    if (e == 8) value = 0.0;
    if (e == 23) value = 3.0;
    state.values.push_back(value);
    cell_concentration.values.push_back(element_centroid(c.mesh, e)[1] / 100.0);
    porosity_field.values.push_back(soil ? (r == 2 ? porosity(t) : 0.3) : 1.0);
    for (const int node : c.mesh.elements[e]) {
      // Free water has another value: a point on the surface of the soil takes the soil's.
      vertex_concentration.values.push_back(soil ? c.mesh.nodes[node][1] / 100.0 : 0.5);
    }
  }
  Field pressure{"pressure", "Pa", 1, {}};
  Field velocity{"liquid_velocity", "m/s", 2, {}};
  Field concentration{"concentration", "1", 1, {}};
  for (int p = 0; p < c.liquid_points.size(); ++p) {
    const int e = c.liquid_points.element[p];
    if (e == 8 || e == 23) continue;
    const auto x = c.liquid_points.position(c.mesh, p);
    s.liquid_positions.insert(s.liquid_positions.end(), {x[0], x[1], 0.0});
    pressure.values.push_back(p);
    velocity.values.insert(velocity.values.end(), {3e-3, -4e-3});
    concentration.values.push_back(x[1] / 100.0);
  }
  Field rate_field{"erosion_rate", "1/s", 1, std::vector(c.solid_points.element.size(), rate)};
  Field nodal{"liquid_velocity", "m/s", 2, std::vector(2 * c.mesh.nodes.size(), 0.01)};
  s.cell = {state, cell_concentration, porosity_field};
  s.node = {nodal};
  s.solid = {rate_field};
  s.liquid = {concentration, pressure, velocity};
  s.element_vertex = {vertex_concentration};
  return s;
}

/// `delay`: time from the end of the specimen to the end of the region of the row, s.
inline LedgerRow ledger_at(double t, double delay) {
  LedgerRow row;
  row.t = t;
  row.solid = (1.0 - porosity(t)) * grain_density;
  row.erodible = (0.4 - porosity(t)) * grain_density;
  row.eroded = (porosity(t) - 0.3) * grain_density;
  row.pending = pending_share * row.eroded;
  row.fines_out = fines_out(t - delay);
  row.fines = row.eroded - row.pending - row.fines_out;
  row.water_in = 1000.0 * flux * t;
  row.water_out = row.water_in - row.fines_out * 1000.0 / grain_density;
  row.water = 300.0 + row.water_in - row.water_out;
  row.points = 72.0;
  row.points_in = 3.0 * t;
  row.points_out = 3.0 * t;
  return row;
}

/// A whole run: rows to t = 100 s of the exact solution of the specimen, with one in a hundred
/// grains pending; snapshots at 0, 10 and 40 s.
inline void write_results(const std::string& folder) {
  const Case<2> c = column();
  ResultsWriter<2> writer(folder, c);
  for (double t = 0.0; t <= end; t += 1.0) {
    HistoryRow history;
    history.t = t;
    history.dt = 0.05;
    history.porosity_mean = porosity(t);
    history.flux_in = flux;
    history.flux_out = flux;
    history.liquid_points = 72.0;
    history.empty_elements = 2.0;
    history.empty_elements_total = 2.0 * t;
    history.volume_defect = 0.2 - 1e-3 * t;
    writer.append_history(history);
    writer.append_ledger(ledger_at(t, 5.0));
    LedgerRow still;
    still.t = t;
    const std::array<RegionRow, 4> rows{
        {{0, 1.0, still}, {1, 0.3, still}, {2, porosity(t), ledger_at(t, 0.0)}, {3, 1.0, still}}};
    writer.append_regions(rows);
    const LedgerRow all = ledger_at(t, 5.0);
    const std::array<BoundaryRow, 2> boundaries{
        {{t, "inflow", all.water_in, 0.0, 0.0, 0.0, flux * t, 0.0, -flux},
         {t, "outflow", 0.0, all.water_out, 0.0, all.fines_out, 0.0, flux * t, flux}}};
    writer.append_boundaries(boundaries);
  }
  long step = 0;
  for (const double t : {0.0, 10.0, 40.0}) writer.write_snapshot(snapshot(c, t, step++));
  RunInfo info;
  info.status = "done";
  info.steps = 2000;
  info.elements = 24;
  info.solid_points = 16;
  info.liquid_points = 72;
  info.wall_seconds = 1.5;
  writer.write_run_info(info);
}

}  // namespace double_point

}  // namespace suffuse::testing
