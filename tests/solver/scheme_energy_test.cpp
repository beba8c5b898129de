/// The energy that each scheme's own equations conserve or lose, in a random sealed box.

#include "solver/scheme_energy.hpp"

#include <gtest/gtest.h>

#include <iostream>

namespace suffuse::model {
namespace scheme_energy_test {

BoxSettings box(unsigned seed, double conductivity) {
  BoxSettings settings;
  settings.seed = seed;
  settings.jitter = 0.06;
  settings.conductivity = conductivity;
  settings.mass_scaling = seed % 2 == 0 ? 1.0 : 1e4;
  settings.convects = seed % 3 == 0;
  return settings;
}

TEST(SchemeEnergy, IsConservedByTheExplicitSchemeWithoutDrag) {
  double drift = 0.0;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const EnergyChange change =
        SealedBox(box(seed, std::numeric_limits<double>::infinity())).run_explicit(0.95, 2000);
    EXPECT_TRUE(change.finite);
    drift = std::max(drift, change.drift);
  }
  std::cout << "energy drifts by " << drift << '\n';
  EXPECT_LE(drift, 1e-12);
}

TEST(SchemeEnergy, IsLostByTheExplicitSchemeWithDrag) {
  for (const auto drag : {DragIntegration::explicit_drag, DragIntegration::implicit_drag}) {
    double growth = -1.0;
    for (unsigned seed = 1; seed <= 6; ++seed) {
      for (const double k : {1e-6, 1e-2, 1e2}) {
        BoxSettings settings = box(seed, k);
        settings.drag = drag;
        const EnergyChange change = SealedBox(settings).run_explicit(0.99, 500);
        EXPECT_TRUE(change.finite);
        EXPECT_LT(change.kept, 1.0);
        growth = std::max(growth, change.growth);
      }
    }
    std::cout << "largest growth in a step " << growth << '\n';
    EXPECT_LE(growth, 1e-12);
  }
}

/// Check of the measure itself: above the limit energy grows.
TEST(SchemeEnergy, GrowsAboveTheLimit) {
  const EnergyChange change =
      SealedBox(box(2, std::numeric_limits<double>::infinity())).run_explicit(1.02, 2000);
  EXPECT_FALSE(change.drift < 1.0);
}

TEST(SchemeEnergy, IsLostByTheImplicitScheme) {
  for (const auto stepping : {TimeStepping::second_order, TimeStepping::monotone}) {
    for (unsigned seed = 1; seed <= 6; ++seed) {
      for (const bool inertia : {false, true}) {
        for (const double dt : {1e-6, 1e-3, 1.0}) {
          const EnergyChange change =
              SealedBox(box(seed, 1e-3)).run_implicit(stepping, inertia, dt, 10);
          EXPECT_TRUE(change.finite);
          EXPECT_LE(change.growth, 1e-12);
        }
      }
    }
  }
}

}  // namespace scheme_energy_test
}  // namespace suffuse::model
