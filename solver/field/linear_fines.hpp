#pragma once

/// A concentration that is linear in each element: its values at vertices, and the gain of fines of
/// an element by transport.

#include <algorithm>
#include <array>
#include <sstream>
#include <vector>

#include "common/errors.hpp"
#include "field/element_sides.hpp"
#include "grid/parallel.hpp"

namespace suffuse {

/// Concentration at the vertices of an element, written to `c`.
template <int Dim>
void find_concentration(const ElementValues<Dim>& fines, const ElementValues<Dim>& pores,
                        double* c) {
  double sum = 0.0;
  ElementValues<Dim> at_nodes;
  for (int j = 0; j <= Dim; ++j) sum += at_nodes[j] = fines[j] / pores[j];
  for (int k = 0; k <= Dim; ++k) c[k] = FieldNodes<Dim>::at_vertex(at_nodes[k], sum);
}

/// Sum of the values at a side's nodes, with the same bits for both elements at the side: three
/// values are added in the order of their size.
template <int Dim>
[[gnu::always_inline]] inline double side_sum(const std::array<double, Dim>& values) {
  if constexpr (Dim == 2) {
    return values[0] + values[1];
  } else {
    static_assert(Dim == 3);
    const double low = std::min(values[0], values[1]);
    const double high = std::max(values[0], values[1]);
    const double lowest = std::min(low, values[2]);
    const double highest = std::max(high, values[2]);
    const double middle = std::max(low, std::min(high, values[2]));
    return (lowest + middle) + highest;
  }
}

/// Gain of fines of an element by transport, per field node, m3. `c`: concentration at its
/// vertices; `upwind`: places of that at the nodes of its sides in `at_vertices`; `outflow`:
/// through them, m3. Adds the share `share` of the fines that leave through each side to `out`.
template <int Dim>
[[gnu::always_inline]] inline ElementValues<Dim> gain(const double* c,
                                                      const ElementValues<Dim>& outflow,
                                                      const std::vector<double>& at_vertices,
                                                      const UpwindPlaces<Dim>& upwind, double share,
                                                      ElementValues<Dim>& out) {
  // Integrals times Dim (Dim + 1): of c q over each side with the linear functions of its vertices,
  // and of c q inside with the gradients of these functions, q being the Raviart-Thomas field. The
  // geometry cancels.
  ElementValues<Dim> load{};
  double net_outflow = 0.0;
  double sum = 0.0;
  for (int k = 0; k <= Dim; ++k) {
    sum += c[k];
    net_outflow += outflow[k];
  }
  for (int k = 0; k <= Dim; ++k) {
    std::array<double, Dim> crossing;
    for (int a = 0; a < Dim; ++a) crossing[a] = at_vertices[upwind[k][a]];
    const double all = side_sum<Dim>(crossing);
    out[k] += share * (outflow[k] * (all / Dim));
    for (int a = 0; a < Dim; ++a) {
      load[side_vertex<Dim>(k, a)] -= outflow[k] * (all + crossing[a]);
    }
    load[k] += net_outflow * ((sum + c[k]) / (Dim + 2)) - outflow[k] * sum;
  }
  // The functions of field nodes are orthogonalised: their map is that of the values.
  constexpr double scale = 1.0 / (Dim * (Dim + 1));
  const double whole = element_sum<Dim>(load);
  ElementValues<Dim> result;
  for (int j = 0; j <= Dim; ++j) result[j] = scale * FieldNodes<Dim>::at_vertex(load[j], whole);
  return result;
}

/// Throws NumericalError if the mean concentration `mean(e)` of an element e leaves [0, 1). All
/// ranks have to call it.
template <int Dim, class Mean>
void refuse_impossible_concentrations(const Grid<Dim>& grid, const Mean& mean, int threads) {
  // Allows for round-off in an element without fines.
  constexpr double round_off = 1e-13;
  const auto possible = [](double c) { return c >= -round_off && c < 1.0; };
  const int elements = grid.mesh.element_count();
  together(grid.ranks(), [&] {
    const double wrong =
        largest_of(elements, threads, 0.0, [&](int e) { return possible(mean(e)) ? 0.0 : 1.0; });
    if (wrong == 0.0) return;
    for (int e = 0; e < elements; ++e) {
      if (possible(mean(e))) continue;
      std::ostringstream message;
      message << "concentration of fluidised grains left [0, 1): " << mean(e) << " in "
              << element_text(grid, e);
      throw NumericalError(message.str());
    }
  });
}

}  // namespace suffuse
