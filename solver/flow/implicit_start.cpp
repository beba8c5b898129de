/// How the implicit flow starts: at rest, in a steady flow, or as another run left it.

#include <algorithm>
#include <cmath>

#include "coupling/moved_air.hpp"
#include "flow/implicit_flow.hpp"
#include "flow/implicit_thresholds.hpp"
#include "grid/face_flux.hpp"

namespace suffuse {
namespace {

/// The first step of soil that falls from the start, over the time in which it falls through an
/// element.
constexpr double first_step_of_fall = 1e-2;

}  // namespace

template <int Dim>
void ImplicitFlow<Dim>::start() {
  start_with(flow_at_rest(this->grid(), this->conditions_, this->pressure_at_rest()), nullptr);
}

template <int Dim>
void ImplicitFlow<Dim>::start_from(const EarlierFlow<Dim>& earlier) {
  const Grid<Dim>& grid = this->grid();
  MixedFlow<Dim> flow = flow_at_rest(grid, this->conditions_, earlier.face_pressure(grid));
  flow.face_flux = flow.flux_through = earlier.state.face_flux;
  flow.state.velocity = element_flux(grid, flow.face_flux);
  for (std::size_t e = 0; e < flow.state.velocity.size(); ++e) {
    flow.state.velocity[e] /= this->coefficients_.porosity[e];
  }
  start_with(std::move(flow), &earlier.air);
}

template <int Dim>
void ImplicitFlow<Dim>::start_with(MixedFlow<Dim> flow, const ElementField<Dim>* air) {
  const Grid<Dim>& grid = this->grid();
  const Scene& scene = this->scene();
  now_ = std::move(flow);
  const FlowForcing<Dim> forcing{this->coefficients_, this->conditions_, {}};
  scales_ = find_scales(scheme_, forcing, this->boundary_values(), scene.time.end, has_gravity_);
  // Water without compressibility and inertia has no start-up: it flows at once.
  const bool at_once =
      std::isinf(scene.liquid.bulk_modulus) && !options_.inertia && !scheme_.has_retention();
  const bool at_rest = scene.initial_flow != InitialFlow::steady && !at_once;
  if (!at_rest) now_ = end_of(scheme_.steady(forcing));
  now_.state.air =
      air ? *air : scheme_.air_at(now_.state.face_pressure, this->coefficients_.porosity);
  pressure_ = element_pressure_now();
  if (!at_once) scales_.include_in_bounds(now_.state.face_pressure);
  scales_.include(now_.state.face_pressure, now_.face_flux);
  raise_over_round_off(scales_, grid, this->coefficients_, scene.liquid, scene.time.end);
  if (solid_.moves()) {
    scales_.include_loads(solid_.largest_load_change(), solid_.stiffness());
    solid_.start_motion(
        {.pressure = pressure_on_solid(grid, scheme_.soils(), pressure_,
                                       this->coefficients_.porosity, now_.state.air),
         .liquid_mass = liquid_mass(grid, this->coefficients_, now_.state.air)});
  }
  // Loads may come at once, and the pressures with them.
  const bool smooth = !at_rest && !solid_.moves();
  const double of_run = implicit_thresholds.first_step * scene.time.end;
  const double of_liquid = shortest_change({});
  // In a step of the whole run no inertia holds the soil.
  const double shortest =
      solid_.moves() ? shortest_change(solid_.compressibility(scene.time.end)) : of_liquid;
  const double of_fall = solid_.has_inertia() ? first_step_of_fall * solid_.time_of_fall() : 0.0;
  const double of_change = of_fall > 0.0 ? of_fall : at_rest ? of_liquid : shortest;
  const double first = smooth ? of_run : std::min(of_run, of_change);
  control_.start(first, smooth, shortest);
}

template <int Dim>
double ImplicitFlow<Dim>::shortest_change(const std::vector<double>& soil_storage) const {
  return implicit_thresholds.first_step / fastest_rate(this->grid(), this->coefficients_,
                                                       this->scene().liquid.bulk_modulus,
                                                       options_.inertia, soil_storage);
}

template void ImplicitFlow<2>::start();
template void ImplicitFlow<2>::start_from(const EarlierFlow<2>&);
template void ImplicitFlow<3>::start();
template void ImplicitFlow<3>::start_from(const EarlierFlow<3>&);

}  // namespace suffuse
