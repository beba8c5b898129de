// Keeps the volume of water equal to its room in the implicit flow: expansion of moving water
// within a step, and the mismatch of masses after it.

#include <algorithm>
#include <cmath>
#include <sstream>

#include "common/errors.hpp"
#include "files/tables.hpp"
#include "flow/implicit_flow.hpp"
#include "grid/face_flux.hpp"
#include "mixed/implicit_thresholds.hpp"
#include "physics/liquid.hpp"
#include "results/pass_timer.hpp"

namespace suffuse {
namespace {

/// Share of an element's pores by which its water may fall below nothing where it holds air:
/// Newton's method of the flow leaves so much, and the next step flows by the air.
constexpr double most_missing = 1e-4;

/// The flow over `dt` seconds, if it stays as it is.
template <int Dim>
MixedStep<Dim> steady_step_of(const MixedFlow<Dim>& flow, double dt) {
  MixedStep<Dim> step{flow.state, flow.face_flux, flow.face_flux, flow.face_flux};
  for (double& volume : step.face_volume) volume *= dt;
  return step;
}

/// Adds sources that let out `volume` per element, m3, over `dt`.
void let_out(const std::vector<double>& volume, double dt, std::vector<double>& source) {
  source.resize(volume.size(), 0.0);
  for (std::size_t e = 0; e < volume.size(); ++e) source[e] += volume[e] / dt;
}

/// Growth of each element's water beyond the room in its pores at its pressure, m3, in a step that
/// starts from these pressures at faces and, per element, `pressure`, Pa.
template <int Dim>
std::vector<double> expansion_in(const MixedStep<Dim>& step, const Grid<Dim>& grid,
                                 const FlowCoefficients<Dim>& coefficients,
                                 const std::vector<double>& face_pressure,
                                 const std::vector<double>& pressure, double bulk_modulus,
                                 int threads) {
  const FaceVolumes volumes =
      face_volumes(grid, face_pressure, pressure, step, bulk_modulus, threads);
  const std::vector<double> end = element_pressure(grid, step.end.face_pressure, threads);
  std::vector<double> result(grid.mesh.element_count());
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    double mass = 0.0;  // over the reference density, m3
    double fines = 0.0;
    for (int k = 0; k <= Dim; ++k) {
      const int f = grid.element_face[e][k];
      const double c = coefficients.face_concentration[f];
      const double sign = grid.element_face_sign[e][k];
      mass -= sign * (1.0 - c) * (volumes.liquid[f] + volumes.density_excess[f]);
      fines += sign * c * volumes.liquid[f];
    }
    const double last = density_ratio(end[e], bulk_modulus);
    const double pressed =
        coefficients.water_volume[e] * std::expm1((end[e] - pressure[e]) / bulk_modulus);
    result[e] = mass / last - pressed - fines;
  }
  return result;
}

/// Throws NumericalError: this mass of water, kg, does not fit the element's pores.
template <int Dim>
[[noreturn]] void refuse_misfit(const Grid<Dim>& grid, std::size_t element, double time,
                                double water_mass, double fits, double pressure) {
  std::ostringstream message;
  message << element_text(grid, static_cast<int>(element)) << " holds " << water_mass
          << " kg of water at t = " << time << " s; its pores take " << fits << " kg at "
          << pressure << " Pa, and up to " << max_eos_error
          << " of what the pores hold may differ; take a smaller time.tolerance or time.step";
  throw NumericalError(message.str());
}

/// Water of each element beyond its room, m3, and the largest ratio of it to the pores' volume.
struct Mismatch {
  std::vector<double> volume;
  double of_pores = 0.0;
};

/// Time at which masses of water are compared with their room, s, and whether they have to fit.
struct Fit {
  double time;
  bool is_needed;
};

/// Mismatch of these masses, kg per element, at these pressures, Pa. Throws NumericalError on all
/// ranks where they do not fit; `refuse_dry(e)` throws for an element without water.
template <int Dim>
Mismatch mismatch_of(const Grid<Dim>& grid, const FlowCoefficients<Dim>& coefficients,
                     const LiquidProperties& liquid, const std::vector<double>& pressure,
                     const std::vector<double>& water_mass, const Fit& fit,
                     const auto& refuse_dry) {
  Mismatch result{std::vector<double>(water_mass.size()), 0.0};
  together(grid.ranks(), [&] {
    std::size_t worst = 0;
    for (std::size_t e = 0; e < water_mass.size(); ++e) {
      const double fills =
          water_mass[e] / (liquid.density * density_ratio(pressure[e], liquid.bulk_modulus));
      const double pores = coefficients.porosity[e] * grid.volume[e];
      const double least = fit.is_needed ? 0.0 : -most_missing * pores;
      if (std::isnan(fills)) {
        throw NumericalError(
            "pressures are no longer numbers; soil that dries out entirely causes "
            "this: give soil.NAME.retention a residual_saturation");
      }
      if (!(fills > least)) refuse_dry(static_cast<int>(e));
      result.volume[e] = fills - coefficients.water_volume[e];
      // Relative to the pores: where fines leave hardly any room for water, an error relative to
      // the water has no meaning.
      const double error = std::abs(result.volume[e]) / pores;
      if (error > result.of_pores) {
        result.of_pores = error;
        worst = e;
      }
    }
    if (result.of_pores <= max_eos_error) return;
    const double fits = liquid.density * coefficients.water_volume[worst] *
                        density_ratio(pressure[worst], liquid.bulk_modulus);
    refuse_misfit(grid, worst, fit.time, water_mass[worst], fits, pressure[worst]);
  });
  result.of_pores = largest_of_all(grid.ranks(), result.of_pores);
  return result;
}

}  // namespace

template <int Dim>
std::vector<double> ImplicitFlow<Dim>::excess_in(const MixedStep<Dim>& step, double dt) const {
  if (std::isinf(this->scene().liquid.bulk_modulus) || scheme_.is_nonlinear()) return {};
  if (solid_.has_inertia()) return {};  // steps are short
  const std::vector<double>& holds = this->coefficients_.water_volume;
  // Use the flux of the step itself, as a flow from rest has none at its start.
  const Ranks& ranks = this->grid().ranks();
  const double passes = largest_of_all(ranks, largest_magnitude(step.face_volume)) /
                        smallest_of_all(ranks, std::ranges::min(holds));
  if (passes < implicit_thresholds.expansion_time) return {};
  std::vector<double> excess =
      expansion_in(step, this->grid(), this->coefficients_, now_.state.face_pressure, pressure_,
                   this->scene().liquid.bulk_modulus, this->threads());
  const std::vector<double> released = relaxation_.released(dt, filling_time());
  double largest = 0.0;
  for (std::size_t e = 0; e < excess.size(); ++e) {
    if (!released.empty()) excess[e] += released[e];
    largest = std::max(largest, std::abs(excess[e]) / holds[e]);
  }
  if (largest_of_all(ranks, largest) <= implicit_thresholds.expansion) return {};
  return excess;
}

template <int Dim>
bool ImplicitFlow<Dim>::let_out_expansion(FlowStep<Dim>& step) const {
  const std::vector<double> excess = excess_in(step.found, step.dt);
  if (excess.empty()) return false;
  for (FlowForcing<Dim>& forcing : step.forcing) let_out(excess, step.dt, forcing.source);
  return true;
}

template <int Dim>
std::optional<MixedStep<Dim>> ImplicitFlow<Dim>::steady_step(double dt) {
  const PassTimer timer(reusing_);
  ++reusing_.calls;
  MixedStep<Dim> step = steady_step_of(now_, dt);
  for (int repeat = 0; repeat < implicit_thresholds.expansion_repeats; ++repeat) {
    const std::vector<double> excess = excess_in(step, dt);
    if (excess.empty()) break;
    std::vector<double> source = relaxation_.source();
    let_out(excess, dt, source);
    if (!take_steady_flow(std::move(source))) return std::nullopt;
    step = steady_step_of(now_, dt);
  }
  return step;
}

template <int Dim>
bool ImplicitFlow<Dim>::take_steady_flow(std::vector<double> source) {
  MixedStep<Dim> steady = scheme_.steady({this->coefficients_, this->conditions_, source});
  if (!reuse_.is_close(now_.face_flux, steady.face_flux, scales_.flux)) {
    // The flow changes again, so it must be solved.
    reuse_.stop();
    return false;
  }
  relaxation_.set_source(std::move(source));
  // Element pressures are updated with the next step, as the mismatch is that at the present ones.
  replace_flow(std::move(steady));
  return true;
}

template <int Dim>
void ImplicitFlow<Dim>::update_steady_flow() {
  std::vector<double> source = relaxation_.wanted_source(control_.last_step(), filling_time());
  // Relative to the present flow: the sources of a faster one would fill or drain elements in time.
  const double largest = largest_of_all(this->grid().ranks(), largest_magnitude(now_.face_flux));
  if (reuse_.needs_update(relaxation_.source(), source, largest)) {
    take_steady_flow(std::move(source));
  }
}

template <int Dim>
void ImplicitFlow<Dim>::match_masses(double time, const std::vector<double>& water_mass) {
  const LiquidProperties& liquid = this->scene().liquid;
  const bool air_fits = scheme_.soils().air_moves();
  const auto refuse = [&](int e) { this->refuse_dry(e, time); };
  Mismatch mismatch = mismatch_of(this->grid(), this->coefficients_, liquid, pressure_, water_mass,
                                  {time, !air_fits}, refuse);
  eos_error_ = mismatch.of_pores;
  // Incompressible water fits by construction, and its round-off cannot leave. Air that moves with
  // the soil makes up for the mismatch.
  if (std::isinf(liquid.bulk_modulus) || air_fits) return;
  relaxation_.observe(std::move(mismatch.volume), this->coefficients_.water_volume);
  if (reuse_.active()) update_steady_flow();
}

template bool ImplicitFlow<2>::let_out_expansion(FlowStep<2>&) const;
template std::optional<MixedStep<2>> ImplicitFlow<2>::steady_step(double);
template void ImplicitFlow<2>::match_masses(double, const std::vector<double>&);
template bool ImplicitFlow<3>::let_out_expansion(FlowStep<3>&) const;
template std::optional<MixedStep<3>> ImplicitFlow<3>::steady_step(double);
template void ImplicitFlow<3>::match_masses(double, const std::vector<double>&);

}  // namespace suffuse
