/// Start of the implicit flow: at rest, steady, or from another run.

#include <algorithm>
#include <cmath>

#include "flow/implicit_flow.hpp"
#include "flow/implicit_thresholds.hpp"
#include "grid/face_flux.hpp"

namespace suffuse {
namespace {

/// First step of soil that falls from the start, over its time of fall through an element.
constexpr double first_step_of_fall = 1e-2;

/// The last flow of another run.
template <int Dim>
MixedFlow<Dim> flow_of(const EarlierFlow<Dim>& earlier, const Grid<Dim>& grid,
                       const std::vector<FaceCondition>& conditions,
                       const std::vector<double>& porosity) {
  MixedFlow<Dim> flow = flow_at_rest(grid, conditions, earlier.face_pressure(grid));
  flow.face_flux = flow.flux_through = earlier.state.face_flux;
  flow.state.velocity = element_flux(grid, flow.face_flux);
  for (std::size_t e = 0; e < flow.state.velocity.size(); ++e) {
    flow.state.velocity[e] /= porosity[e];
  }
  return flow;
}

}  // namespace

template <int Dim>
void ImplicitFlow<Dim>::start() {
  start_with(flow_at_rest(this->grid(), this->conditions_, this->pressure_at_rest()), nullptr);
}

template <int Dim>
void ImplicitFlow<Dim>::start_from(const EarlierFlow<Dim>& earlier) {
  start_with(flow_of(earlier, this->grid(), this->conditions_, this->coefficients_.porosity),
             &earlier.air);
}

template <int Dim>
bool ImplicitFlow<Dim>::flows_at_once() const {
  return std::isinf(this->scene().liquid.bulk_modulus) && !options_.inertia &&
         !scheme_.has_retention();
}

template <int Dim>
bool ImplicitFlow<Dim>::starts_at_rest() const {
  return this->scene().initial_flow != InitialFlow::steady && !flows_at_once();
}

template <int Dim>
void ImplicitFlow<Dim>::start_with(MixedFlow<Dim> flow, const ElementField<Dim>* air) {
  const Grid<Dim>& grid = this->grid();
  const Scene& scene = this->scene();
  now_ = std::move(flow);
  const FlowForcing<Dim> forcing{this->coefficients_, this->conditions_, {}};
  scales_ = find_scales(scheme_, forcing, this->boundary_values(), scene.time.end, has_gravity_);
  const bool at_rest = starts_at_rest();
  if (!at_rest) now_ = end_of(scheme_.steady(forcing));
  now_.state.air =
      air ? *air : scheme_.air_at(now_.state.face_pressure, this->coefficients_.porosity);
  pressure_ = element_pressure_now();
  if (!flows_at_once()) scales_.include_in_bounds(now_.state.face_pressure);
  scales_.include(now_.state.face_pressure, now_.face_flux);
  raise_over_round_off(scales_, grid, this->coefficients_, scene.liquid, scene.time.end);
  const double of_run = implicit_thresholds.first_step * scene.time.end;
  const double of_liquid = shortest_change({});
  const double first = at_rest ? std::min(of_run, of_liquid) : of_run;
  control_.start(first, !at_rest, of_liquid);
}

template <int Dim>
void ImplicitFlow<Dim>::start_steps(const MovingSolid& solid) {
  scales_.include_loads(solid.load_change, solid.stiffness);
  const double of_run = implicit_thresholds.first_step * this->scene().time.end;
  const double of_liquid = shortest_change({});
  const double shortest = shortest_change(solid.compressibility);
  const double of_fall = first_step_of_fall * solid.time_of_fall;
  const double of_change = of_fall > 0.0 ? of_fall : starts_at_rest() ? of_liquid : shortest;
  // Loads, and with them pressures, may change suddenly.
  control_.start(std::min(of_run, of_change), false, shortest);
}

template <int Dim>
double ImplicitFlow<Dim>::shortest_change(const std::vector<double>& soil_storage) const {
  return implicit_thresholds.first_step / fastest_rate(this->grid(), this->coefficients_,
                                                       this->scene().liquid.bulk_modulus,
                                                       options_.inertia, soil_storage);
}

template void ImplicitFlow<2>::start();
template void ImplicitFlow<2>::start_from(const EarlierFlow<2>&);
template void ImplicitFlow<2>::start_steps(const MovingSolid&);
template void ImplicitFlow<3>::start();
template void ImplicitFlow<3>::start_from(const EarlierFlow<3>&);
template void ImplicitFlow<3>::start_steps(const MovingSolid&);

}  // namespace suffuse
