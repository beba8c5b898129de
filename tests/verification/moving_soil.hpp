#pragma once

/// Whole runs with moving soil: boundaries, and results of a run.

#include <cmath>

#include "model_run.hpp"
#include "solver/solid_model.hpp"

namespace suffuse::model {

inline BoundaryCondition fixed_on(const std::string& name, Fixing fix) {
  BoundaryCondition b;
  b.on = name;
  b.fix = fix;
  return b;
}

/// Elements whose centroid fulfils `holds` are soil, the others free water.
template <int Dim>
Mesh<Dim> under_water(Mesh<Dim> mesh, const auto& holds) {
  mesh.region_names = {"specimen", "free_above"};
  for (int e = 0; e < mesh.element_count(); ++e) {
    mesh.element_region[e] = holds(element_centroid(mesh, e)) ? 0 : 1;
  }
  return mesh;
}

/// A boundary at a pressure, Pa; an inflow through it is clean.
inline BoundaryCondition clean_pressure_on(const std::string& name, double pressure) {
  BoundaryCondition b = pressure_on(name, pressure);
  b.concentration = 0.0;
  return b;
}

/// Fines missing in the balance, kg: initially erodible fines are still erodible, in the liquid, or
/// have left with it.
inline double missing_fines(const LedgerRow& now, double erodible_at_start) {
  return now.erodible + now.fines + now.fines_out - now.fines_in - erodible_at_start;
}

/// A traction, Pa, that is applied at once and stays.
inline VectorFunction sudden_traction(const Vector<2>& traction, double end) {
  return VectorFunction{{{0.0, {0.0, 0.0, 0.0}}, {1e-12 * end, {traction[0], traction[1], 0.0}}}};
}

/// Mean pressure of the nodes where `at` holds, Pa.
template <class Run, class Place>
double mean_pressure(Run& run, const Place& at) {
  const Grid<2>& grid = run.model().grid();
  const FlowState<2> flow = run.model().flow_state();
  double sum = 0.0;
  int count = 0;
  for (int i = 0; i < grid.mesh.node_count(); ++i) {
    if (!at(grid.mesh.nodes[i])) continue;
    sum += flow.node_pressure[i];
    ++count;
  }
  return sum / count;
}

/// Pressure at a height, Pa.
template <class Run>
double pressure_at(Run& run, double y) {
  return mean_pressure(run, [y](const Vector<2>& x) { return std::abs(x[1] - y) < 1e-9; });
}

}  // namespace suffuse::model
