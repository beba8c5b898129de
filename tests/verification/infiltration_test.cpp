/// Unsaturated flow against exact profiles: infiltration above a water table (Srivastava and Yeh
/// 1991, Gardner's soil) and horizontal absorption (Bruce and Klute 1956, van Genuchten's).

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>

#include "model_run.hpp"
#include "reference_table.hpp"

namespace suffuse {
namespace {

constexpr double stiff = std::numeric_limits<double>::infinity();

RetentionModel gardner(double alpha, double residual) {
  RetentionModel model;
  model.law = retention_law("gardner");
  model.residual_saturation = residual;
  model.parameters.alpha = alpha;
  return model;
}

Scene column_scene() {
  Scene scene = model::paper_scene();
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.time.stepping = TimeStepping::monotone;
  scene.liquid.bulk_modulus = stiff;
  scene.gravity = {0.0, -9.81, 0.0};
  scene.soils[0].porosity = 0.4;
  scene.soils[0].skeleton_fraction = 0.6;
  scene.soils[0].conductivity = 1e-5;
  return scene;
}

/// Theta 0.06 to 0.40, K 1e-5, alpha 1; steady under 0.1 K, then 0.9 K.
Scene infiltration_scene() {
  Scene scene = column_scene();
  scene.soils[0].retention = gardner(1.0, 0.15);
  scene.initial_flow = InitialFlow::steady;
  scene.time.end = 72000.0;
  BoundaryCondition top = model::flux_on("top", 0.0);
  top.darcy_flux = TimeFunction({{0.0, 1e-6}, {1e-9, 9e-6}});
  scene.boundaries = {top, model::pressure_on("bottom", 0.0)};
  return scene;
}

TEST(Infiltration, FollowsSrivastavaAndYeh) {
  const auto rows = read_reference("infiltration-gardner.csv");
  for (const int cells : {25, 50, 100}) {
    Scene scene = infiltration_scene();
    model::ModelRun run(model::make_case(model::column_mesh(1, cells, 1.0 / cells, 1.0), scene));
    double worst = 0.0;
    double last = 0.0;
    for (const double time : {1800.0, 3600.0, 7200.0, 14400.0, 36000.0, 72000.0}) {
      const auto moments = run.run({time});
      const FlowState<2>& flow = moments.flows.back();
      for (const auto& row : rows) {
        if (row.number("t") != time) continue;
        const int node = 2 * static_cast<int>(std::lround(row.number("z") * cells));
        const double psi = flow.node_pressure[node] / 9810.0;
        worst = std::max(worst, std::abs(psi - row.number("psi")));
      }
      last = time;
    }
    std::cout << cells << " cells: " << worst << " m, " << run.steps() << " steps, residual "
              << run.worst_residual() << " at " << last << "\n";
    for (const auto& p : run.model().passes())
      std::cout << "  " << p.name << ' ' << p.calls << '\n';
  }
}

RetentionModel van_genuchten(double alpha, double n, double residual) {
  RetentionModel model;
  model.law = retention_law("van-genuchten");
  model.residual_saturation = residual;
  model.parameters = {alpha, n};
  return model;
}

TEST(Absorption, FollowsBruceAndKlute) {
  const auto rows = read_reference("absorption-van-genuchten.csv");
  for (const int cells : {50, 100, 200}) {
    Scene scene = column_scene();
    scene.gravity = {};
    scene.soils[0].retention = van_genuchten(3.0, 2.0, 0.15);
    const double psi_wet = -std::pow(std::pow(0.95, -2.0) - 1.0, 0.5) / 3.0;
    const double psi_dry = -std::pow(std::pow(0.30, -2.0) - 1.0, 0.5) / 3.0;
    scene.water_level = psi_dry;
    scene.time.end = 20000.0;
    scene.boundaries = {model::pressure_on("left", psi_wet * 9810.0)};
    model::ModelRun run(model::make_case(model::column_mesh(cells, 1, 1.0, 1.0 / cells), scene));
    const auto moments = run.run({20000.0});
    const FlowState<2>& flow = moments.flows.back();
    double worst = 0.0;
    for (const auto& row : rows) {
      const double x = row.number("phi") * std::sqrt(20000.0) * cells;
      if (x > cells - 1) continue;
      const int i = static_cast<int>(x);
      const auto effective = [&](int node) {
        return scene.soils[0].retention.law->saturation(scene.soils[0].retention.parameters,
                                                        flow.node_pressure[node] / 9810.0);
      };
      const double found = std::lerp(effective(i), effective(i + 1), x - i);
      worst = std::max(worst, std::abs(found - row.number("S_e")));
    }
    double entered = 0.0;
    const LedgerRow ledger = run.model().ledger();
    entered = (ledger.water_in - ledger.water_out) / 1000.0 * cells;
    std::cout << cells << " cells: " << worst << ", sorptivity "
              << entered / std::sqrt(20000.0) / 4.75403e-4 - 1.0 << ", " << run.steps()
              << " steps\n";
  }
}

TEST(Ponding, OfDrySand) {
  for (const int cells : {10, 50, 100}) {
    Scene scene = column_scene();
    scene.soils[0].retention = van_genuchten(14.5, 2.68, 0.10);
    scene.soils[0].conductivity = 8.25e-5;
    scene.water_level = -10.0;
    scene.time.end = 3600.0;
    scene.boundaries = {model::pressure_on("top", 981.0)};
    model::ModelRun run(model::make_case(model::column_mesh(1, cells, 1.0 / cells, 1.0), scene));
    const auto moments = run.run({3600.0});
    std::cout << cells << " cells: " << run.steps() << " steps\n";
    for (const auto& p : run.model().passes()) std::cout << "  " << p.name << ' ' << p.calls << '\n';
  }
}

}  // namespace
}  // namespace suffuse
