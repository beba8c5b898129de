#include "motion/held_by_inertia.hpp"

namespace suffuse {
namespace {

/// Inertia governs if it leaves less than this share of the compressibility of drained soil.
constexpr double share_of_inertia = 0.9;

}  // namespace

template <int Dim>
std::vector<double> held_compressibility(const Grid<Dim>& grid, std::vector<double> drained,
                                         const std::vector<double>& node_mass, double duration) {
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    if (drained[e] == 0.0) continue;
    double free = 0.0;
    for (int a = 0; a <= Dim; ++a) {
      const double mass = node_mass[grid.mesh.elements[e][a]];
      if (mass == 0.0) continue;
      free += (grid.volume[e] * grid.shape_gradient[e][a]).squaredNorm() / mass;
    }
    free *= duration * duration;
    drained[e] *= free / (free + drained[e]);
  }
  return drained;
}

template <int Dim>
std::vector<double> held_mobility(const Grid<Dim>& grid, const std::vector<double>& drained,
                                  const std::vector<double>& node_mass, double duration) {
  const Mesh<Dim>& mesh = grid.mesh;
  const std::vector<double> held = held_compressibility(grid, drained, node_mass, duration);
  std::vector<double> result(drained.size(), 0.0);
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (!(held[e] < share_of_inertia * drained[e])) continue;
    for (const int i : mesh.elements[e]) {
      if (node_mass[i] > 0.0)
        result[e] += duration * grid.node_volume[i] / node_mass[i] / (Dim + 1);
    }
  }
  return result;
}

template std::vector<double> held_compressibility(const Grid<2>&, std::vector<double>,
                                                  const std::vector<double>&, double);
template std::vector<double> held_compressibility(const Grid<3>&, std::vector<double>,
                                                  const std::vector<double>&, double);
template std::vector<double> held_mobility(const Grid<2>&, const std::vector<double>&,
                                           const std::vector<double>&, double);
template std::vector<double> held_mobility(const Grid<3>&, const std::vector<double>&,
                                           const std::vector<double>&, double);

}  // namespace suffuse
