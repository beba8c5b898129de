#pragma once

/// The specimen of a run, which figures and tables describe: all soil that erodes, or all soil
/// where none does. Its masses over time, computed and exact.

#include <functional>
#include <string>
#include <vector>

#include "results/reader.hpp"

namespace suffuse {

/// Part of the specimen with one soil and one initial porosity.
struct Portion {
  Soil soil;
  double volume = 0.0;  ///< m3 (per metre of thickness in 2D)
  double initial_porosity = 0.0;
};

/// The regions and portions of the specimen.
struct Specimen {
  std::vector<int> regions;  ///< numbers as in regions.csv
  std::vector<Portion> portions;
  double volume = 0.0;       ///< m3 (per metre of thickness in 2D)
  bool has_all_soil = true;  ///< false when some other soil does not erode
  /// Whether the porosity at the start is the scene's, and not that of an earlier run.
  bool starts_from_scene = true;
  /// Whether `porosity_mean` of history.csv is the mean over the specimen alone; false where other
  /// soil deposits fines.
  bool has_mean_of_history = true;
};

/// The specimen of a run. Throws FileError.
Specimen specimen(const ResultsReader& run);

/// How titles name the specimen: "the soil" when it has all soil, otherwise "the soil that erodes".
std::string specimen_name(bool has_all_soil);

/// Integral over the specimen of `density`, a function of (soil, initial porosity, exact porosity
/// at time t).
double integrate(const Specimen& specimen, double t,
                 const std::function<double(const Soil&, double, double)>& density);

/// Whether the scene alone determines the porosity of the specimen: every soil starts from the
/// scene's porosity, is rigid, and erodes in a way that does not depend on the flow. Otherwise the
/// exact quantities below are NaN or wrong.
bool has_exact_porosity(const Specimen& specimen);

/// Volume mean of the exact porosity.
double exact_mean_porosity(const Specimen& specimen, double t);

/// Time at which the last portion has lost all its erodible grains, s; infinity for laws that never
/// reach that.
double exact_exhaustion(const Specimen& specimen);

/// Masses of the specimen at one time, kg (per metre of thickness in 2D).
struct Masses {
  double t = 0.0;
  double solid = 0.0;
  double erodible = 0.0;
  double eroded = 0.0;
  double liquid = 0.0;   ///< closed accounting: in the soil, plus what left, minus what entered
  double fines = 0.0;    ///< fluidised grains in the soil
  double pending = 0.0;  ///< eroded grains that no liquid point carries yet
  double water_out = 0.0;
  double fines_out = 0.0;
  double fines_in = 0.0;

  [[nodiscard]] double total() const { return solid + liquid + pending; }
};

/// Masses of a run: the ledgers of the regions summed over the specimen, in the order of time.
/// Throws FileError when regions.csv has fewer than two times.
std::vector<Masses> computed_masses(const ResultsReader& run, const Specimen& specimen);

/// Exact masses at time t, as far as they do not depend on the flow: solid, erodible, eroded, and
/// liquid in closed accounting, which is NaN where air can enter the pores; the others are zero.
/// `water_density` in kg/m3.
Masses exact_masses(const Specimen& specimen, double water_density, double t);

/// Throws FileError when a table has fewer than two times, too few for a curve.
void require_curve(const ResultsReader& run, const Table& table, const std::string& name);

}  // namespace suffuse
