/// A run whose soil fails: its message, and the results that it leaves.

#include <gtest/gtest.h>

#include "common/hdf5_io.hpp"
#include "files/layout.hpp"
#include "results/reader.hpp"
#include "solver/solver_process.hpp"

namespace suffuse {
namespace lost_equilibrium_test {

/// Water rises through sand until it floats: at a porosity of 1 - 1/1.7 = 0.41, or slightly
/// earlier, because fines make the liquid heavier.
const test::Mode heave{"heave",
                       R"(name = "heave"
formulation = "single-point"
gravity = [0.0, -9.81]
geometry = {shape = "column", width = 0.25, height = 1.0}
mesh = {size = 0.125, structure = "crossed"}
output = {every = 10.0, snapshot_every = 50.0}
liquid = {density = 1000.0, bulk_modulus = 2.0e9, viscosity = 1.0e-3}
boundary = [
  {on = "top", pressure = 0.0, concentration = 0.0},
  {on = "bottom", darcy_flux = 0.1, concentration = 0.0, fix = "both"},
  {on = "left", fix = "normal"},
  {on = "right", fix = "normal"},
]
initial.flow = "steady"
time = {scheme = "implicit", end = 200.0, failure = "stop"}
[soil.specimen]
porosity = 0.3
skeleton_fraction = 0.5
grain_density = 2700.0
conductivity = 0.1
erosion = {law = "constant", rate = 1e-3}
skeleton = {law = "mohr-coulomb", young = 1e8, poisson = 0.25, friction = 35.0, cohesion = 0.0}
)",
                       {}};

TEST(LostEquilibrium, StopsTheRunWithItsLastStateWritten) {
  const test::Workplace place;
  const std::string case_path = place.make_case(heave);
  const std::string folder = place.path("results");
  for (const bool again : {false, true}) {
    // A resumed run fails again and leaves the same results.
    const test::Outcome outcome =
        place.solve(case_path, folder,
                    again ? std::vector<std::string>{"--resume"} : std::vector<std::string>{});
    EXPECT_EQ(outcome.code, 3) << outcome.error;
    EXPECT_NE(outcome.error.find(" s: the soil has lost its equilibrium: it cannot carry"),
              std::string::npos)
        << outcome.error;
    EXPECT_NE(outcome.error.find("any longer, least at ("), std::string::npos) << outcome.error;
    EXPECT_NE(outcome.error.find("the last equilibrium in the last row and the last snapshot"),
              std::string::npos)
        << outcome.error;
    const ResultsReader results(folder);
    EXPECT_EQ(results.status(), "failed");
    const double last = results.history().column("t").back();
    EXPECT_NEAR(last, 108.0, 4.0);
    EXPECT_EQ(results.times().back(), last);
    EXPECT_EQ(results.times().size(), 4U);
    EXPECT_EQ(results.history().rows(), 12U);
  }
}

}  // namespace lost_equilibrium_test
}  // namespace suffuse
