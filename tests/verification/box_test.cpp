/// Scenes in a box of tetrahedra, from their text to the ledger: the paper's column, and scenes
/// that are equivalent in two and three dimensions.

#include <cmath>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "reference_table.hpp"
#include "scene_run.hpp"

namespace suffuse {
namespace box_test {

using model::SceneRun;

/// Clean water enters from above at 0.012 m/s; the soil erodes at a constant rate from 2 s on, as
/// in the tables of tests/data/reference.
const std::string column = R"(
formulation = "single-point"
[geometry]
shape = "box"
width = 0.125
depth = 0.125
height = 1.0
[mesh]
size = 0.0625
[liquid]
density = 1000.0
bulk_modulus = 2.0e9
viscosity = 1.0e-3
[soil.specimen]
porosity = 0.3
skeleton_fraction = 0.6
grain_density = 2700.0
conductivity = 0.02
erosion.law = "constant"
erosion.rate = 1e-3
erosion.start = 2.0
[[boundary]]
on = "top"
darcy_flux = 0.012
concentration = 0.0
[[boundary]]
on = "bottom"
pressure = 0.0
[initial]
flow = "steady"
[time]
end = 52.0
[output]
every = 1.0
)";
constexpr double area = 0.125 * 0.125;

struct ColumnCase {
  const char* name;
  std::vector<std::string> overrides;
  double fines;  ///< error of the fines that left, relative to all eroded fines
};

class ColumnOfTetrahedra : public ::testing::TestWithParam<ColumnCase> {};

/// Clean water enters from above at 0.012 m/s all the time.
TEST(ProbesInSpace, HaveTheirHeightAndTheFluxUpwards) {
  SceneRun<3> run(column, {"liquid.bulk_modulus=inf",
                           "output.probe=[{at=[0.05, 0.1, 0.9]}, {at=[0.1, 0.02, 0.35]}]"});
  run.run_to(1.0);
  const std::vector<ProbeRow> probes = run.probes();
  ASSERT_EQ(probes.size(), 2U);
  EXPECT_EQ(probes[0].z, 0.9);
  EXPECT_EQ(probes[1].z, 0.35);
  for (const ProbeRow& probe : probes) {
    EXPECT_NEAR(probe.flux_z, -0.012, 1e-12);
    EXPECT_NEAR(probe.flux_x, 0.0, 1e-12);
    EXPECT_NEAR(probe.flux_y, 0.0, 1e-12);
  }
}

TEST_P(ColumnOfTetrahedra, HasThePorosityAndTheMassesOfTheTables) {
  SceneRun<3> run(column, GetParam().overrides);
  const double initial = run.ledger().points;
  int compared = 0;
  for (const auto& row : read_reference("masses.csv")) {
    const double t = row.number("t");
    if (row.text("law") != "const" || row.number("par") != 1e-3 || row.number("q") != 0.012 ||
        t > 52.0 || t == 0.0) {
      continue;
    }
    run.run_to(t);
    const LedgerRow ledger = run.ledger();
    const double porosity = 0.3 + 1e-3 * std::max(0.0, t - 2.0);
    EXPECT_NEAR(run.history().porosity_mean, porosity, 1e-12);
    EXPECT_NEAR(ledger.solid / area, row.number("M_solid"), 1e-7);
    EXPECT_NEAR(ledger.eroded / area, row.number("M_eroded_total"), 1e-7);
    const double out = row.number("M_eroded_out");
    const double eroded = row.number("M_eroded_total");
    EXPECT_NEAR(ledger.fines_out / area, out, GetParam().fines * eroded) << t;
    std::cout << GetParam().name << ", t = " << t << " s: fines out off by "
              << (out > 0.0 ? (ledger.fines_out / area - out) / eroded : 0.0) << '\n';
    ++compared;
  }
  EXPECT_GE(compared, 4);
  EXPECT_LE(run.worst_residual(), 1e-12);
  const LedgerRow end = run.ledger();
  EXPECT_EQ(initial + end.points_in - end.points_out - end.points, 0.0);
}

INSTANTIATE_TEST_SUITE_P(
    Formulations, ColumnOfTetrahedra,
    ::testing::Values(
        ColumnCase{"SinglePoint", {}, 1e-3}, ColumnCase{"Free", {"mesh.structure=free"}, 1e-3},
        ColumnCase{"DoublePoint", {"formulation=double-point"}, 0.01},
        ColumnCase{"FreeDoublePoint", {"formulation=double-point", "mesh.structure=free"}, 0.01},
        // One point per element erodes the same mass, but its fines leave earlier or later.
        ColumnCase{"OnePoint", {"formulation=double-point", "points.liquid_per_element=1"}, 0.02}),
    [](const auto& param_info) { return std::string(param_info.param.name); });

TEST(ColumnOfTetrahedra, HasItsFreeWaterAndBuffers) {
  SceneRun<3> run(column,
                  {"formulation=double-point", "boundary[0].on=inflow", "boundary[1].on=outflow",
                   "geometry.layers={inflow=2, above=2, below=2, outflow=2}",
                   "soil.buffer={like=\"specimen\", erosion.law=\"none\"}"});
  run.run_to(22.0);
  EXPECT_NEAR(run.ledger().eroded, 2700.0 * 0.02 * area, 1e-12);
  EXPECT_LE(run.worst_residual(), 1e-12);
}

/// Water turns from the top to the right side through soil that erodes by the flux: nothing is
/// uniform. The scene is run in the plane, and in space between two impervious sides.
const std::string corner = R"(
formulation = "single-point"
[geometry]
shape = "column"
width = 1.0
height = 1.0
[mesh]
size = 0.125
[liquid]
density = 1000.0
bulk_modulus = inf
viscosity = 1.0e-3
[soil.specimen]
porosity = 0.3
skeleton_fraction = 0.6
grain_density = 2700.0
conductivity = 0.02
conductivity_law = "kozeny-carman"
erosion.law = "flux"
erosion.rate = 0.5
[[boundary]]
on = "top"
darcy_flux = 0.012
concentration = 0.0
[[boundary]]
on = "right"
pressure = 0.0
[initial]
flow = "steady"
[time]
end = 20.0
step = 1.0
[output]
every = 20.0
)";

std::vector<std::string> sized(int cells, std::vector<std::string> overrides) {
  overrides.push_back("mesh.size=" + std::to_string(1.0 / cells));
  return overrides;
}

/// Results of the run at its end, per metre of depth.
template <int Dim>
std::vector<double> ends(int cells, const std::vector<std::string>& changes) {
  const double depth = Dim == 2 ? 1.0 : 1.0 / cells;
  std::vector<std::string> overrides = sized(cells, changes);
  if (Dim == 2) {
    overrides.emplace_back("output.probe=[{at=[0.2, 0.3]}, {at=[0.5, 0.5]}, {at=[0.3, 0.8]}]");
  } else {
    const std::string y = std::to_string(0.5 * depth);
    overrides.emplace_back("geometry.shape=box");
    overrides.push_back("geometry.depth=" + std::to_string(depth));
    overrides.push_back("output.probe=[{at=[0.2, " + y + ", 0.3]}, {at=[0.5, " + y +
                        ", 0.5]}, {at=[0.3, " + y + ", 0.8]}]");
  }
  SceneRun<Dim> run(corner, overrides);
  run.run_to(20.0);
  EXPECT_LE(run.worst_residual(), 1e-12);
  std::vector<double> result = run.probed();
  const LedgerRow ledger = run.ledger();
  for (const double mass : {ledger.eroded, ledger.fines_out, ledger.fines, ledger.solid}) {
    result.push_back(mass / depth);
  }
  return result;
}

struct Extrusion {
  const char* name;
  std::vector<std::string> changes;
  double difference;  ///< largest at the finest mesh, relative
};

class ExtrudedScene : public ::testing::TestWithParam<Extrusion> {};

TEST_P(ExtrudedScene, TendsToTheSameAsThePlaneOne) {
  std::vector<double> worst;
  for (const int cells : {8, 16, 32}) {
    const std::vector<double> plane = ends<2>(cells, GetParam().changes);
    const std::vector<double> box = ends<3>(cells, GetParam().changes);
    worst.push_back(0.0);
    std::cout << GetParam().name << ", " << cells << " cells:";
    for (std::size_t i = 0; i < plane.size(); ++i) {
      worst.back() = std::max(worst.back(), std::abs(box[i] / plane[i] - 1.0));
      std::cout << ' ' << box[i] / plane[i] - 1.0;
    }
    std::cout << '\n';
  }
  EXPECT_LE(worst[2], GetParam().difference);
  EXPECT_LE(worst[2], 0.6 * worst[0]);
}

const std::string eroding_with_length =
    "soil.specimen.erosion={law=\"first-order\", drive=\"flux\", rate=5.0, length=0.25}";
INSTANTIATE_TEST_SUITE_P(
    Formulations, ExtrudedScene,
    // In double-point the fines leave with whole points.
    ::testing::Values(Extrusion{"SinglePoint", {}, 1e-3},
                      Extrusion{"DoublePoint", {"formulation=double-point"}, 1e-3},
                      Extrusion{"SinglePointWithLength", {eroding_with_length}, 1e-3},
                      Extrusion{"DoublePointWithLength",
                                {eroding_with_length, "formulation=double-point"},
                                1.5e-3}),
    [](const auto& param_info) { return std::string(param_info.param.name); });

}  // namespace box_test
}  // namespace suffuse
