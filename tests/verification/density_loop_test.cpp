/// Heavy liquid drives light: two columns of different concentrations, joined above and below by
/// gravel, carry q = k (rho_1 - rho_2) / rho_w H / (L_1 + L_2).

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "flow/implicit_mixed.hpp"
#include "grid/face_flux.hpp"
#include "physics/liquid.hpp"
#include "solver/flow_model.hpp"

namespace suffuse {
namespace {

constexpr int columns = 5;
constexpr int rows = 12;

/// A ring of cells: the columns at both sides, the rows above and below.
Mesh<2> ring() {
  Mesh<2> whole = model::column_mesh(columns, rows, 0.5, 1.2);
  Mesh<2> mesh = whole;
  mesh.elements.clear();
  for (int e = 0; e < whole.element_count(); ++e) {
    const Vector<2> x = element_centroid(whole, e);
    const bool inside = x[0] > 0.1 && x[0] < 0.4 && x[1] > 0.1 && x[1] < 1.1;
    if (!inside) mesh.elements.push_back(whole.elements[e]);
  }
  mesh.element_region.assign(mesh.elements.size(), 0);
  return mesh;
}

TEST(DensityLoop, OfTwoColumns) {
  model::FlowModel m(ring());
  const auto is_column = [](const Vector<2>& x) { return x[1] > 0.1 && x[1] < 1.1; };
  m.set_conductivity([&](const Vector<2>& x) { return is_column(x) ? 1e-4 : 1.0; });
  const double heavy = mixture_density(0.03, 1000.0, 2650.0);
  const double light = mixture_density(0.01, 1000.0, 2650.0);
  for (int e = 0; e < m.mesh.element_count(); ++e) {
    const Vector<2> x = element_centroid(m.mesh, e);
    m.forcing.coefficients.mixture_density[e] = !is_column(x) ? 1000.0
                                                : x[0] < 0.25 ? heavy
                                                              : light;
  }
  ImplicitMixed<2> flow(m.grid, {}, Vector<2>(0.0, -9.81));
  const MixedStep<2> steady = flow.steady(m.forcing);
  const std::vector<Vector<2>> flux = element_flux(m.grid, steady.face_flux);
  const double exact = 1e-4 * (heavy - light) / 1000.0 * 1.0 / 2.0;
  double down = 0.0;
  double up = 0.0;
  double volume = 0.0;
  for (int e = 0; e < m.mesh.element_count(); ++e) {
    const Vector<2> x = element_centroid(m.mesh, e);
    if (!is_column(x)) continue;
    (x[0] < 0.25 ? down : up) += m.grid.volume[e] * flux[e][1];
    volume += 0.5 * m.grid.volume[e];
  }
  EXPECT_NEAR(-down / volume, exact, 1e-3 * exact);
  EXPECT_NEAR(up / volume, exact, 1e-3 * exact);
}

}  // namespace
}  // namespace suffuse
