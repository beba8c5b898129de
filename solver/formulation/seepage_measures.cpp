#include "formulation/seepage_measures.hpp"

#include "grid/face_flux.hpp"
#include "physics/head.hpp"
#include "ranks/exact_sum.hpp"

namespace suffuse {
namespace {

/// Share of the weight of fluidised fines in the power that drives the flow (boundaries and
/// gravity); negative if the flow lifts the fines, 0 for liquid at rest.
template <int Dim>
double fines_weight_share(const Grid<Dim>& grid, const FlowCoefficients<Dim>& coefficients,
                          const FlowState<Dim>& state, const Scene& scene) {
  if (!has_gravity(scene.gravity)) return 0.0;
  const Vector<Dim> gravity = Eigen::Map<const Vector<Dim>>(scene.gravity.data());
  const std::vector<Vector<Dim>> flux = element_flux(grid, state.face_flux);
  ExactSum weight;  // W
  ExactSum spent;   // W, by drag
  for (const int e : grid.own_elements()) {
    const double excess = coefficients.mixture_density[e] - scene.liquid.density;
    double resistance = coefficients.drag[e] / coefficients.porosity[e];
    if (!state.relative_conductivity.empty()) resistance /= state.relative_conductivity[e];
    if (!coefficients.quadratic_drag.empty())
      resistance += coefficients.quadratic_drag[e] * flux[e].norm();
    weight.add(grid.volume[e] * excess * gravity.dot(flux[e]));
    spent.add(grid.volume[e] * resistance * flux[e].squaredNorm());
  }
  grid.ranks().sum({&weight, &spent});
  return spent.value() > 0.0 ? weight.value() / spent.value() : 0.0;
}

/// Pressure gradient in an element, Pa/m.
template <int Dim>
Vector<Dim> pressure_gradient(const Grid<Dim>& grid, const FlowState<Dim>& flow, int element) {
  Vector<Dim> result = Vector<Dim>::Zero();
  for (int k = 0; k <= Dim; ++k) {
    const Vector<Dim>& shape = grid.shape_gradient[element][k];
    // The linear function that is 1 at the centre of face k and 0 at those of the others has the
    // gradient -Dim times that of the opposite vertex.
    if (flow.face_pressure.empty()) {
      result += flow.node_pressure[grid.mesh.elements[element][k]] * shape;
    } else {
      result -= Dim * flow.face_pressure[grid.element_face[element][k]] * shape;
    }
  }
  return result;
}

}  // namespace

template <int Dim>
VectorField<Dim> hydraulic_gradient(const Grid<Dim>& grid, const FlowState<Dim>& flow,
                                    const Scene& scene) {
  const double weight = unit_weight(scene.liquid.density, scene.gravity);
  const Vector<Dim> grad_z = Vector<Dim>::NullaryExpr(
      [&](auto d) { return height(Vector<Dim>(Vector<Dim>::Unit(d)), scene.gravity); });
  VectorField<Dim> result;
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    result.push_back(-pressure_gradient(grid, flow, e) / weight - grad_z);
  }
  return result;
}

template <int Dim>
SeepagePower seepage_power(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                           const std::vector<double>& mixture_density, const FlowState<Dim>& flow,
                           const Scene& scene) {
  const Vector<Dim> gravity = Eigen::Map<const Vector<Dim>>(scene.gravity.data());
  const double weight = unit_weight(scene.liquid.density, scene.gravity);
  const VectorField<Dim> gradient = hydraulic_gradient(grid, flow, scene);
  ExactSum now;
  ExactSum saturated;
  ExactSum initial;
  for (const int e : grid.own_elements()) {
    if (!soils.is_soil(e)) continue;
    const Vector<Dim> flux = flux_at(grid, flow.face_flux, e, element_centroid(grid.mesh, e));
    const double excess = mixture_density[e] - scene.liquid.density;
    const double power = grid.volume[e] * flux.dot(weight * gradient[e] + excess * gravity);
    now.add(power);
    if (!flow.relative_conductivity.empty() && flow.relative_conductivity[e] < 1.0) continue;
    if (flux.norm() <= soils.still_flux(e)) continue;
    saturated.add(power);
    initial.add(scene.liquid.density * conductivity_gravity * grid.volume[e] * flux.squaredNorm() *
                soils.resistance_along(e, flux) /
                (soils.conductivity_factor(e) * soils.soil_of_element(e).conductivity));
  }
  grid.ranks().sum({&now, &saturated, &initial});
  return {now.value(), saturated.value(), initial.value()};
}

template <int Dim>
void describe_flow(const Grid<Dim>& grid, const FlowCoefficients<Dim>& coefficients,
                   const FlowState<Dim>& state, const Scene& scene, HistoryRow& row) {
  row.dt = state.dt;
  row.eos_error = state.eos_error;
  row.pressure_overshoot = state.pressure_overshoot;
  row.fines_weight_share = fines_weight_share(grid, coefficients, state, scene);
  ExactSum in;
  ExactSum out;
  for (const int f : grid.own_faces()) {
    if (!grid.is_border(f)) continue;
    const double flux = state.face_flux[f];
    (flux < 0.0 ? in : out).add(std::abs(flux));
  }
  // Uses node pressures, because element pressures may contain patterns without force.
  const std::vector<double>& pressure = state.node_pressure;
  ExactSum square;
  ExactSum volume;
  for (const int e : grid.own_elements()) {
    double off = state.pressure[e];
    for (const int i : grid.mesh.elements[e]) off -= pressure[i] / (Dim + 1);
    square.add(grid.volume[e] * off * off);
    volume.add(grid.volume[e]);
  }
  grid.ranks().sum({&in, &out, &square, &volume});
  row.flux_in = in.value();
  row.flux_out = out.value();
  row.pressure_scatter = std::sqrt(square.value() / volume.value());
  const auto [low, high] = std::minmax_element(pressure.begin(), pressure.end());
  std::array<double, 3> largest{-*low, *high, 0.0};
  for (const Vector<Dim>& v : state.velocity) largest[2] = std::max(largest[2], v.norm());
  grid.ranks().largest(largest);
  row.pressure_min = -largest[0];
  row.pressure_max = largest[1];
  row.speed_max = largest[2];
}

template VectorField<2> hydraulic_gradient(const Grid<2>&, const FlowState<2>&, const Scene&);
template SeepagePower seepage_power(const Grid<2>&, const SoilMap<2>&, const std::vector<double>&,
                                    const FlowState<2>&, const Scene&);
template VectorField<3> hydraulic_gradient(const Grid<3>&, const FlowState<3>&, const Scene&);
template SeepagePower seepage_power(const Grid<3>&, const SoilMap<3>&, const std::vector<double>&,
                                    const FlowState<3>&, const Scene&);
template void describe_flow(const Grid<2>&, const FlowCoefficients<2>&, const FlowState<2>&,
                            const Scene&, HistoryRow&);
template void describe_flow(const Grid<3>&, const FlowCoefficients<3>&, const FlowState<3>&,
                            const Scene&, HistoryRow&);

}  // namespace suffuse
