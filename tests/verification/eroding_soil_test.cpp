/// Soil that erodes and moves, in whole runs, with the flow that carries its fines away.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <iostream>
#include <limits>

#include "moving_soil.hpp"

namespace suffuse {
namespace eroding_soil_test {

using model::clean_pressure_on;
using model::fixed_on;
using model::missing_fines;

/// Smooth walls on both sides.
std::vector<BoundaryCondition> smooth_walls() {
  return {fixed_on("left", Fixing::normal), fixed_on("right", Fixing::normal)};
}

// --------------------------------------------------------------------------------- stiff skeletons

/// The paper's column: water passes from above under a head, fines erode by the first-order law,
/// and the soil conducts better as it loses them.
Scene paper_column(double young) {
  Scene scene = model::paper_scene();
  scene.liquid.bulk_modulus = std::numeric_limits<double>::infinity();
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.time.stepping = TimeStepping::monotone;
  scene.time.step = 1.0;
  scene.time.inertia = false;
  scene.time.end = 20.0;
  scene.initial_flow = InitialFlow::steady;
  Soil& soil = scene.soils[0];
  soil.conductivity_law = conductivity_law("kozeny-carman");
  soil.erosion.law = erosion_law("first-order");
  soil.porosity_gradient = {0.0, 0.05, 0.0};
  soil.erosion.rate = 0.05;
  soil.erosion.start = 2.0;
  scene.boundaries = smooth_walls();
  scene.boundaries.push_back(clean_pressure_on("top", 5886.0));
  BoundaryCondition bottom = model::pressure_on("bottom", 0.0);
  bottom.fix = Fixing::both;
  scene.boundaries.push_back(bottom);
  if (std::isfinite(young)) {
    soil.skeleton = model::elastic_soil(young, 0.2);
    soil.skeleton.young = FinesFunction({{1.0, young}, {0.0, 0.5 * young}});
  } else {
    for (BoundaryCondition& b : scene.boundaries) b.fix = Fixing::none;
    std::erase_if(scene.boundaries, [](const BoundaryCondition& b) { return !b.pressure; });
  }
  return scene;
}

struct ColumnEnd {
  std::vector<double> porosity;
  std::vector<double> pressure;
  LedgerRow ledger;
};

ColumnEnd column_end(double young) {
  model::ModelRun run(model::make_case(model::column_mesh(4, 8, 0.5, 1.0), paper_column(young)));
  const auto moments = run.run({10.0, 20.0});
  EXPECT_LE(run.worst_residual(), 1e-12);
  return {moments.states.back().porosity, moments.flows.back().pressure,
          moments.states.back().ledger};
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  EXPECT_EQ(a.size(), b.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

TEST(StiffSoil, DiffersFromRigidSoilByItsCompressibility) {
  const ColumnEnd rigid = column_end(std::numeric_limits<double>::infinity());
  constexpr std::array<double, 3> moduli{1e9, 1e10, 1e11};
  std::array<std::array<double, 4>, 3> off{};
  for (std::size_t k = 0; k < moduli.size(); ++k) {
    const ColumnEnd end = column_end(moduli[k]);
    off[k] = {largest_difference(end.porosity, rigid.porosity),
              largest_difference(end.pressure, rigid.pressure) / 5886.0,
              std::abs(end.ledger.water / rigid.ledger.water - 1.0),
              std::abs(end.ledger.fines_out / rigid.ledger.fines_out - 1.0)};
    // The law depends on the fines left at a point, not on the motion of the soil.
    EXPECT_NEAR(end.ledger.erodible, rigid.ledger.erodible, 1e-13 * rigid.ledger.erodible);
    std::cout << "E " << moduli[k] << " Pa: porosity off by " << off[k][0] << ", pressure by "
              << off[k][1] << ", water by " << off[k][2] << ", fines that left by " << off[k][3]
              << "\n";
  }
  for (std::size_t quantity = 0; quantity < off[0].size(); ++quantity) {
    for (std::size_t k = 1; k < moduli.size(); ++k) {
      const double rate = std::log10(off[k - 1][quantity] / off[k][quantity]);
      EXPECT_NEAR(rate, 1.0, 0.05) << "quantity " << quantity << " from E " << moduli[k - 1];
    }
  }
}

// ------------------------------------------------------------------------- fines that stay in
// place

/// Means over the points of each row of elements: height, and vertical effective stress, Pa.
std::vector<std::pair<double, double>> vertical_stress(const Snapshot& snapshot, int rows) {
  const auto stress = std::ranges::find(snapshot.solid, "effective_stress", &Field::name);
  std::vector<std::pair<double, double>> result(rows);
  std::vector<int> count(rows, 0);
  const auto points = static_cast<int>(snapshot.solid_positions.size() / 3);
  for (int p = 0; p < points; ++p) {
    const double y = snapshot.solid_positions[3 * p + 1];
    const int row = std::clamp(static_cast<int>(y * rows), 0, rows - 1);
    result[row].first += y;
    result[row].second += stress->values[4 * p + 1];
    ++count[row];
  }
  for (int row = 0; row < rows; ++row) {
    result[row].first /= count[row];
    result[row].second /= count[row];
  }
  return result;
}

template <class Run>
void expect_weight_of_what_is_there() {
  constexpr double rate = 1e-3;
  constexpr int rows = 16;
  Scene scene = model::paper_scene();
  scene.formulation = Run::formulation;
  scene.gravity = {0.0, -9.81, 0.0};
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.time.end = 81.0;
  Soil& soil = scene.soils[0];
  soil.skeleton = model::elastic_soil(1e8, 0.25);
  soil.erosion.law = erosion_law("constant");
  soil.erosion.rate = rate;
  soil.erosion.start = 1.0;
  // Under the lid the pressure is that of the air: a tight lid would hold the soil by suction as it
  // becomes lighter.
  scene.boundaries = smooth_walls();
  scene.boundaries.push_back(clean_pressure_on("top", 0.0));
  scene.boundaries.push_back(fixed_on("bottom", Fixing::both));
  Run run(model::make_case(model::crossed_mesh(2, rows, 2.0 / rows, 1.0), scene));
  const double erodible = run.model().ledger().erodible;
  for (const double time : {1.0, 41.0, 81.0}) {
    const auto moments = run.run({time}, true);
    const double n = 0.3 + rate * (time - 1.0);
    const double c = (n - 0.3) / n;
    const double liquid = 1000.0 * (1.0 - c) + 2700.0 * c;
    double worst = 0.0;
    for (const auto& [y, stress] : vertical_stress(moments.snapshots.back(), rows)) {
      const double exact = -(1.0 - n) * (2700.0 - liquid) * 9.81 * (1.0 - y);
      worst = std::max(worst, std::abs(stress / exact - 1.0));
    }
    const LedgerRow& ledger = moments.states.back().ledger;
    std::cout << "t " << time << ": stress off by " << worst << ", fines missing "
              << missing_fines(ledger, erodible) / erodible << "\n";
    EXPECT_LT(worst, 5e-3);
    EXPECT_NEAR(missing_fines(ledger, erodible), 0.0, 1e-12 * erodible);
  }
  EXPECT_LT(run.worst_residual(), 1e-12);
}

TEST(SealedBox, FinesThatGoIntoTheLiquidMakeTheSoilLighterAndTheLiquidHeavier) {
  expect_weight_of_what_is_there<model::ModelRun>();
}

TEST(SealedBox, TheSameWithLiquidPoints) {
  expect_weight_of_what_is_there<model::DoublePointRun>();
}

// ---------------------------------------------------------------- points in the region of another

/// Soft soil that erodes above soft soil that does not: when both are compressed, the upper soil
/// moves into elements of the lower region.
void check_two_soils(TransportScheme transport) {
  Mesh<2> mesh = model::crossed_mesh(2, 8, 0.25, 1.0);
  mesh.region_names = {"base", "specimen"};
  for (int e = 0; e < mesh.element_count(); ++e) {
    mesh.element_region[e] = element_centroid(mesh, e)[1] > 0.5 ? 1 : 0;
  }
  Scene scene = model::paper_scene();
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.time.transport = transport;
  scene.time.end = 120.0;
  scene.time.step = 1.0;  // points that change their element cause jumps of pressure
  scene.soils[0].skeleton = model::elastic_soil(1e6, 0.0);
  scene.soils.push_back(scene.soils[0]);
  scene.soils[1].region = "base";
  scene.soils[0].erosion.law = erosion_law("constant");
  scene.soils[0].erosion.rate = 1e-3;
  scene.soils[0].erosion.start = 1.0;
  BoundaryCondition top = clean_pressure_on("top", 0.0);
  top.traction = VectorFunction{{{0.0, {0.0, 0.0, 0.0}}, {100.0, {0.0, -3e5, 0.0}}}};
  BoundaryCondition bottom = model::flux_on("bottom", 1e-3);
  bottom.fix = Fixing::both;
  scene.boundaries = smooth_walls();
  scene.boundaries.push_back(top);
  scene.boundaries.push_back(bottom);
  model::ModelRun run(model::make_case(std::move(mesh), scene));
  const LedgerRow first = run.model().ledger();
  for (const double time : {20.0, 40.0, 60.0, 80.0}) {
    const auto moments = run.run({time});
    const Skeleton<2>& solid = run.model().solid();
    const SoilMap<2>& soils = solid.soils();
    int strangers = 0;
    double erodible = 0.0;
    double volume = 0.0;
    double pores = 0.0;
    for (int p = 0; p < soils.points().size(); ++p) {
      const bool is_base = soils.soil_of_point(p).region == "base";
      strangers += is_base == (run.input().mesh.element_region[soils.points().element[p]] == 1);
      erodible += solid.state().erodible_volume[p] * 2700.0;
      if (is_base) {
        EXPECT_DOUBLE_EQ(solid.state().erodible_volume[p] / solid.state().skeleton_volume[p],
                         1.0 / 6.0);
        continue;
      }
      EXPECT_LT(solid.state().erodible_volume[p] / solid.state().skeleton_volume[p], 0.165);
      volume += soils.points().volume[p];
      pores += soils.points().volume[p] * solid.porosity()[p];
    }
    const auto& state = moments.states.back();
    std::cout << "t " << time << ": " << strangers << " points in the other region\n";
    EXPECT_GE(strangers, time > 50.0 ? 1 : 0);
    EXPECT_NEAR(state.ledger.eroded, first.erodible - erodible, 1e-12 * first.erodible);
    EXPECT_NEAR(missing_fines(state.ledger, first.erodible), 0.0, 1e-12 * first.erodible);
    EXPECT_NEAR(state.history.porosity_mean, pores / volume, 1e-14);
    for (const RegionRow& row : state.regions) {
      EXPECT_LT(std::abs(row.ledger.residual_grains), 1e-12);
      EXPECT_LT(std::abs(row.ledger.residual_water), 1e-12);
    }
  }
  EXPECT_LT(run.worst_residual(), 1e-12);
}

TEST(TwoSoils, KeepTheirLawsWhenTheirPointsCrossElements) {
  check_two_soils(TransportScheme::explicit_steps);
}

TEST(TwoSoils, KeepTheirLawsInImplicitTransport) {
  check_two_soils(TransportScheme::implicit_sweeps);
}

}  // namespace eroding_soil_test
}  // namespace suffuse
