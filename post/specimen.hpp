#pragma once

/// The soil that figures and tables are about: what erodes, or all soil where nothing does.

#include <functional>
#include <string>
#include <vector>

#include "results/reader.hpp"

namespace suffuse {

/// Soil of one initial porosity.
struct Portion {
  Soil soil;
  double volume = 0.0;  ///< m3 (per metre of thickness in 2D)
  double initial_porosity = 0.0;
};

/// The specimen, as the solver's own `porosity_mean` counts it.
struct Specimen {
  std::vector<int> regions;  ///< as regions.csv numbers them
  std::vector<Portion> portions;
  double volume = 0.0;
  bool is_all = true;  ///< of the soil; else what does not erode is left out
};

Specimen specimen(const ResultsReader& run);

/// "the soil", or "the soil that erodes" when some is left out.
std::string soil_named(bool all);

/// Sum over the specimen of volume times a function of (soil, initial porosity, exact porosity at
/// time `t`).
double integrate(const Specimen& specimen, double t,
                 const std::function<double(const Soil&, double, double)>& density);

/// Whether the porosity of all of it is exact whatever the flow; else the exact quantities below
/// are not numbers.
bool has_exact_porosity(const Specimen& specimen);

/// Volume mean of the exact porosity.
double exact_mean_porosity(const Specimen& specimen, double t);

/// When the last portion has lost all its fines, s: infinity for laws that only approach it.
double exact_exhaustion(const Specimen& specimen);

/// Masses of the specimen at one time, kg (per metre of thickness in 2D).
struct Masses {
  double t = 0.0;
  double solid = 0.0;
  double erodible = 0.0;
  double eroded = 0.0;
  double liquid = 0.0;   ///< closed accounting: in the soil, plus what left, less what entered
  double fines = 0.0;    ///< fluidised grains in the soil
  double pending = 0.0;  ///< eroded grains that no liquid point carries yet
  double water_out = 0.0;
  double fines_out = 0.0;
  double fines_in = 0.0;

  [[nodiscard]] double total() const { return solid + liquid + pending; }
};

/// The region ledgers added up over the specimen, ascending in time. Throws FileError when
/// regions.csv has no two times.
std::vector<Masses> computed_masses(const ResultsReader& run, const Specimen& specimen);

/// What is exact of them whatever the flow: solid, erodible, eroded, and the liquid in closed
/// accounting.
Masses exact_masses(const Specimen& specimen, double water_density, double t);

/// Throws FileError when a table has no two times to draw a curve through.
void require_curve(const ResultsReader& run, const Table& table, const std::string& name);

}  // namespace suffuse
