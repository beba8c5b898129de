#include "formulation/seepage_measures.hpp"

#include "grid/compensated_sum.hpp"
#include "grid/face_flux.hpp"
#include "physics/head.hpp"

namespace suffuse {
namespace {

/// Pa/m
template <int Dim>
Vector<Dim> pressure_gradient(const Grid<Dim>& grid, const FlowState<Dim>& flow, int element) {
  Vector<Dim> result = Vector<Dim>::Zero();
  for (int k = 0; k <= Dim; ++k) {
    const Vector<Dim>& shape = grid.shape_gradient[element][k];
    // The linear function that is 1 at the middle of face k and 0 at those of the others falls by
    // Dim times the gradient of the vertex opposite.
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
  Vector<Dim> upward;  // grad z
  for (int d = 0; d < Dim; ++d) {
    Vector<Dim> unit = Vector<Dim>::Zero();
    unit[d] = 1.0;
    upward[d] = height(unit, scene.gravity);
  }
  VectorField<Dim> result;
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    result.push_back(-pressure_gradient(grid, flow, e) / weight - upward);
  }
  return result;
}

template <int Dim>
SeepagePower seepage_power(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                           const FlowState<Dim>& flow, const Scene& scene) {
  const double weight = unit_weight(scene.liquid.density, scene.gravity);
  const VectorField<Dim> gradient = hydraulic_gradient(grid, flow, scene);
  CompensatedSum now;
  CompensatedSum initial;
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    if (!soils.is_soil(e)) continue;
    const Vector<Dim> flux = flux_at(grid, flow.face_flux, e, element_centroid(grid.mesh, e));
    const double relative =
        flow.relative_conductivity.empty() ? 1.0 : flow.relative_conductivity[e];
    const double conductivity = soils.soil_of_element(e).conductivity * relative;
    now.add(weight * grid.volume[e] * flux.dot(gradient[e]));
    initial.add(weight * grid.volume[e] * flux.squaredNorm() * soils.resistance_along(e, flux) /
                conductivity);
  }
  return {now.value(), initial.value()};
}

template VectorField<2> hydraulic_gradient(const Grid<2>&, const FlowState<2>&, const Scene&);
template SeepagePower seepage_power(const Grid<2>&, const SoilMap<2>&, const FlowState<2>&,
                                    const Scene&);
template VectorField<3> hydraulic_gradient(const Grid<3>&, const FlowState<3>&, const Scene&);
template SeepagePower seepage_power(const Grid<3>&, const SoilMap<3>&, const FlowState<3>&,
                                    const Scene&);

}  // namespace suffuse
