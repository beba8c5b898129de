/// Steady flux of a column with Ergun's drag, by its pressure drop, against the roots of Ergun's
/// equation.

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "double_point_modes.hpp"
#include "reference_table.hpp"

namespace suffuse {
namespace ergun_test {

/// Flux at the start and after 3000 steps of a run, m/s.
struct Fluxes {
  double start = 0.0;
  double later = 0.0;
  double uneven = 0.0;  ///< flux in minus flux out, later
};

template <class Run>
Fluxes fluxes_of(Case<2> c) {
  Run run(std::move(c));
  Fluxes result;
  result.start = run.state().history.flux_in / 0.5;
  const auto moments = run.run({3000.0 * run.plan().flow.step});
  const HistoryRow row = moments.states[0].history;
  result.later = row.flux_in / 0.5;
  result.uneven = row.flux_out / 0.5 - result.later;
  return result;
}

Scene ergun_scene(const ReferenceRow& row) {
  Scene scene = model::paper_scene();
  // The modulus is so large that water does not expand on its way: p/K = 60 kPa / K < 1e-6.
  scene.liquid.bulk_modulus = 2e11;
  scene.soils[0].porosity = row.number("n");
  scene.soils[0].conductivity = row.number("k");
  scene.soils[0].drag = SoilDrag::ergun;
  scene.boundaries = {model::pressure_on("top", row.number("gradp")),
                      model::pressure_on("bottom", 0.0)};
  scene.boundaries[0].concentration = 0.0;
  scene.initial_flow = InitialFlow::steady;
  scene.time.end = 100.0;
  return scene;
}

TEST(ErgunFlux, IsTheRootOfErgunsEquationAndStaysThere) {
  int compared = 0;
  double worst = 0.0;
  double worst_later = 0.0;
  double worst_uneven = 0.0;
  double min_share = 1.0;
  for (const auto& row : read_reference("ergun.csv")) {
    const double expected = row.number("q_ergun");
    const Fluxes one = fluxes_of<model::ModelRun>(
        model::make_case(model::column_mesh(2, 4, 0.5), ergun_scene(row)));
    const std::string of =
        "k = " + row.text("k") + ", n = " + row.text("n") + ", grad p = " + row.text("gradp");
    EXPECT_NEAR(one.start / expected, 1.0, 1e-6) << of;
    EXPECT_NEAR(one.later / expected, 1.0, 1e-6) << of;
    worst = std::max(worst, std::abs(one.start / expected - 1.0));
    worst_later = std::max(worst_later, std::abs(one.later / expected - 1.0));
    worst_uneven = std::max(worst_uneven, std::abs(one.uneven / expected));
    min_share = std::min(min_share, expected / row.number("q_darcy"));
    ++compared;
  }
  EXPECT_GE(compared, 18);
  EXPECT_LE(min_share, 0.2) << "some were to be far from Darcy's";
  std::cout << "Ergun: " << compared << " fluxes down to " << min_share
            << " of Darcy's, largest relative error " << worst << " at the start, " << worst_later
            << " after 3000 steps, in minus out " << worst_uneven << '\n';
}

TEST(ErgunFlux, IsTheSameInTheDoublePointFormulation) {
  for (const auto& row : read_reference("ergun.csv")) {
    if (row.text("k") != "0.02" || row.text("n") != "0.3") continue;
    Scene scene = ergun_scene(row);
    scene.formulation = Formulation::double_point;
    const Fluxes two = fluxes_of<model::DoublePointRun>(
        model::make_double_point_case(model::column_mesh(2, 4, 0.5), scene));
    EXPECT_NEAR(two.start / row.number("q_ergun"), 1.0, 1e-6) << row.text("gradp");
    EXPECT_NEAR(two.later / row.number("q_ergun"), 1.0, 1e-6) << row.text("gradp");
  }
}

TEST(ErgunFlux, IsReachedFromRestByTheImplicitScheme) {
  double worst = 0.0;
  for (const auto& row : read_reference("ergun.csv")) {
    Scene scene = ergun_scene(row);
    scene.time.scheme = FlowScheme::implicit_mixed;
    scene.initial_flow = InitialFlow::rest;
    scene.time.inertia = true;
    scene.time.step = 1.0;
    model::ModelRun one(model::make_case(model::column_mesh(2, 4, 0.5), scene));
    scene.formulation = Formulation::double_point;
    model::DoublePointRun two(model::make_double_point_case(model::column_mesh(2, 4, 0.5), scene));
    const auto single = one.run({60.0});
    const auto both = two.run({60.0});
    for (const double flux :
         {single.states[0].history.flux_in / 0.5, both.states[0].history.flux_in / 0.5}) {
      EXPECT_NEAR(flux / row.number("q_ergun"), 1.0, 1e-6)
          << row.text("k") << ' ' << row.text("n") << ' ' << row.text("gradp");
      worst = std::max(worst, std::abs(flux / row.number("q_ergun") - 1.0));
    }
  }
  std::cout << "Ergun, implicit from rest: largest relative error " << worst << '\n';
}

}  // namespace ergun_test
}  // namespace suffuse
