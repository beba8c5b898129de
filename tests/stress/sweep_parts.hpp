#pragma once

/// What the sweeps of columns have in common: words of scenes, and how scenarios are collected.

#include <string>
#include <utility>
#include <vector>

#include "stress/scenario.hpp"
#include "stress/stress_mesh.hpp"

namespace suffuse::stress {

inline constexpr unsigned seeds = 20;
inline const std::vector<Scheme> every(all_schemes.begin(), all_schemes.end());
inline const std::vector<Scheme> explicit_ones{Scheme::sp_explicit, Scheme::dp_mixed,
                                               Scheme::dp_material_point};
inline const std::vector<Scheme> implicit_ones{Scheme::sp_implicit, Scheme::sp_monotone,
                                               Scheme::dp_implicit, Scheme::dp_monotone};
inline const std::vector<Scheme> double_point_ones{Scheme::dp_mixed, Scheme::dp_material_point,
                                                   Scheme::dp_implicit, Scheme::dp_monotone};

inline const std::string specimen = "soil.specimen.";
inline const std::string gravity = "gravity=[0, -9.81]";
/// The column is 1 m high: at rest p = 0 at its top.
inline const std::string rest_level = "initial.water_level=1.0";
inline const std::string top_flux = "boundary[0]={on=\"top\", darcy_flux=";

/// The number with 17 digits.
std::string number(double value);
/// The number with four digits.
std::string shown(double value);
/// `key=value`.
std::string set(const std::string& key, double value);
/// Pairs [t, value] of a boundary that changes.
std::string pairs(const std::vector<std::pair<double, double>>& values);
Changes joined(Changes first, const Changes& second);
/// A law whose rate erodes most of a tenth of the volume within the run.
Changes erosion(const std::string& law, const Span& span);
/// Discharge of the 0.5 m wide column under 6 kPa, through layers of equal height.
double layered_discharge(const std::vector<double>& conductivities);

class SweepMaker {
 public:
  SweepMaker(std::string name, std::string what) : sweep_{std::move(name), std::move(what), {}} {}

  template <class Make>
  void add(const std::vector<Scheme>& schemes, const std::string& parameters, const Make& make,
           unsigned seed = 0) {
    for (const Scheme scheme : schemes) {
      Scenario scenario;
      scenario.scheme = scheme;
      scenario.parameters = parameters;
      scenario.seed = seed;
      scenario.mesh = plain_column;
      make(scenario);
      sweep_.scenarios.push_back(std::move(scenario));
    }
  }
  /// Adds a scene whose changes do not depend on the run.
  void add(const std::vector<Scheme>& schemes, const std::string& parameters, Changes changes) {
    add(schemes, parameters,
        [&](Scenario& s) { s.changes = [changes](const Span&) { return changes; }; });
  }
  void add_refused(const std::vector<Scheme>& schemes, const std::string& parameters,
                   Changes changes) {
    add(schemes, parameters, [&](Scenario& s) {
      s.changes = [changes](const Span&) { return changes; };
      s.expected = Expected::refused;
    });
  }
  Sweep done() { return std::move(sweep_); }

 private:
  Sweep sweep_;
};

/// Conductivities, moduli, scaling and steps of the flow.
std::vector<Sweep> flow_sweeps();
/// Porosities, meshes and points.
std::vector<Sweep> mesh_sweeps();
/// Liquid that weighs, turns, and carries fines from boundaries and soils.
std::vector<Sweep> transport_sweeps();
/// The classes of input that the scenes of tests/cases represent, for water and for soil that
/// moves.
std::vector<Sweep> water_case_sweeps();
std::vector<Sweep> soil_case_sweeps();

}  // namespace suffuse::stress
