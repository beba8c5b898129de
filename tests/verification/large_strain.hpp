#pragma once

/// A column that settles by a third of its height as it consolidates.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <numeric>
#include <string>

#include "motion/moving_skeleton.hpp"
#include "moving_soil.hpp"
#include "reference_table.hpp"

namespace suffuse::model {

/// Largest deviations of a column from an exact solution.
struct Deviation {
  double settlement = 0.0;  ///< of the highest point, which lies below the surface
  double surface = 0.0;     ///< settlement of the surface, by the volume of the soil
  double height = 0.0;      ///< of the soil, by its volume, at the end
  double pressure = 0.0;
  long steps = 0;
};

inline double volume_of_soil(ModelRun& run) {
  const auto& solid = dynamic_cast<const MovingSkeleton<2>&>(run.model().solid());
  return std::reduce(solid.points().volume.begin(), solid.points().volume.end());
}

/// A load of half its modulus compresses a column to two thirds of its height, on a mesh that stays
/// in place. Returns the largest errors, from a time on, of the settlement over the height and of
/// the pressure at the base over the load, and the error of the height of the drained soil.
inline Deviation deviation_at_large_strain(const std::string& law, int rows, double from) {
  const double width = 2.0 / rows;
  constexpr double modulus = 1e6;
  constexpr double load = 0.5 * modulus;
  constexpr double conductivity = 1e-6;                                // m/s
  constexpr double second = 1000.0 * 9.81 / (conductivity * modulus);  // of T = 1
  Scene scene = paper_scene();
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.time.end = 1.5 * second;
  scene.liquid.bulk_modulus = std::numeric_limits<double>::infinity();
  Soil& soil = scene.soils[0];
  soil.porosity = 0.5;
  soil.skeleton_fraction = 0.5;
  soil.conductivity = conductivity;
  soil.conductivity_law = conductivity_law(law);
  soil.skeleton.law = skeleton_law("elastic");
  soil.skeleton.young = modulus;
  BoundaryCondition top = pressure_on("top", 0.0);
  top.concentration = 0.0;
  top.traction = sudden_traction({0.0, -load}, scene.time.end);
  scene.boundaries = {top, fixed_on("bottom", Fixing::both), fixed_on("left", Fixing::normal),
                      fixed_on("right", Fixing::normal)};
  ModelRun run(make_case(crossed_mesh(2, rows, width, 1.0), scene));
  Deviation worst;
  for (const ReferenceRow& row : read_reference("consolidation-large-strain.csv")) {
    const double T = row.number("T");
    if ((row.text("conductivity_law") == "kc") != (law == "kozeny-carman")) continue;
    const auto moments = run.run({T * second});
    if (T < from) continue;
    const double settlement = moments.states.back().history.settlement_max;
    const double height = volume_of_soil(run) / width;
    const double base = pressure_at(run, 0.0) / load;
    worst.settlement =
        std::max(worst.settlement, std::abs(settlement - row.number("settlement_over_H")));
    worst.surface =
        std::max(worst.surface, std::abs(1.0 - height - row.number("settlement_over_H")));
    worst.height = std::abs(height - (1.0 - row.number("settlement_over_H")));
    worst.pressure =
        std::max(worst.pressure, std::abs(base - row.number("base_pressure_over_load")));
    std::cout << law << " " << rows << " T " << T << " s " << settlement << " "
              << row.number("settlement_over_H") << " height " << height << " p " << base << " "
              << row.number("base_pressure_over_load") << "\n";
  }
  EXPECT_LT(run.worst_residual(), 1e-12);
  worst.steps = run.steps();
  std::cout << worst.steps << " steps, " << run.model().coupled_flow().iterations() << "\n";
  return worst;
}

}  // namespace suffuse::model
