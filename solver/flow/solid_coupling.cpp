#include "flow/solid_coupling.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "flow/mixed_flow.hpp"
#include "flow/moved_air.hpp"
#include "grid/parallel.hpp"
#include "linear/anderson_mixing.hpp"

namespace suffuse {
namespace {

/// Of the compressibility of soil that cannot move sideways: with less, the iteration of undrained
/// soil does not always end; with more it is slower (docs/theory.md, "Flow and motion").
constexpr double held_storage = 1.5;
constexpr int max_iterations = 25;
/// Of water that hardly leaves, over the stiffness of soil that cannot move sideways.
constexpr double undrained_stiffness = 300.0;
constexpr int memory = 8;
/// The last step says how pressures change in the next, but for one that is so much longer.
constexpr double longest_growth = 10.0;
/// Pressures agree when they differ by this share of the largest change in the step ...
constexpr double accuracy = 1e-7;
/// ... or by this share of the largest pressure, or by the stress of the stiffest soil at such a
/// strain: to that the solid is in equilibrium (`NewtonLimits`, `Equilibrium::least_strain`).
constexpr double round_off = 1e-7;
constexpr double round_off_strain = 1e-12;
/// Of soil that fails, relative to both: its pressures swing by more with each step.
constexpr double accuracy_in_motion = 1e-4;
/// Of the time in which soil falls through an element: in equilibrium a shorter step is too short.
constexpr double short_step = 1e-2;

double largest(const Eigen::VectorXd& values) {
  return values.size() > 0 ? values.template lpNorm<Eigen::Infinity>() : 0.0;
}

}  // namespace

template <int Dim>
MixedStep<Dim> SolidCoupling<Dim>::step(ImplicitMixed<Dim>& scheme, const MixedState<Dim>& start,
                                        const std::vector<double>& pressure,
                                        std::vector<double> porosity, double end, double dt,
                                        FlowForcing<Dim> forcing) {
  const int elements = grid_.mesh.element_count();
  const Eigen::Map<const Eigen::VectorXd> before(pressure.data(), elements);
  const std::vector<double> own = forcing.source;
  const FlowCoefficients<Dim> at_start = forcing.coefficients;
  const double floor = round_off_strain * solid_.stiffness();
  forcing.mean_storage = held_by_soil(scheme.soils(), start.air, forcing, pressure, dt);
  MotionForcing motion_forcing{
      end, dt, {}, liquid_mass(grid_, forcing.coefficients, start.air), std::move(porosity)};
  AndersonMixing mixing(memory);
  Eigen::VectorXd rise = Eigen::VectorXd::Zero(elements);
  if (!rise_rate_.empty() && dt <= longest_growth * rise_time_) {
    rise = dt * Eigen::Map<const Eigen::VectorXd>(rise_rate_.data(), elements);
  }
  int failed = 0;
  for (int iteration = 1; iteration <= max_iterations; ++iteration) {
    ++iterations_;
    std::vector<double> tried(elements);
    for (int e = 0; e < elements; ++e) tried[e] = pressure[e] + rise[e];
    motion_forcing.pressure = pressure_on_solid(grid_, scheme.soils(), std::move(tried),
                                                forcing.coefficients.porosity, start.air);
    const SolidMotion& motion = solid_.try_motion(motion_forcing);
    if (!motion.converged) {
      ++failed;
      const bool guessed = iteration == 1 && rise.squaredNorm() > 0.0;
      if (guessed) {
        rise.setZero();
      } else {
        rise = undrained_rise(motion_forcing, rise);
      }
      mixing = AndersonMixing(memory);
      continue;
    }
    const std::vector<double> moved = scheme.soils().soil_share.empty()
                                          ? motion.face_volume
                                          : without_air(motion, start.air, at_start, forcing);
    forcing.source = source_of(moved, own, forcing.mean_storage, rise, dt);
    MixedStep<Dim> step = scheme.step(start, dt, {&forcing});
    const std::vector<double> found = element_pressure(grid_, step.end.face_pressure, threads_);
    Eigen::VectorXd new_rise = Eigen::Map<const Eigen::VectorXd>(found.data(), elements) - before;
    // The pressure of free water and of soil that cannot move does not act on the motion.
    for (int e = 0; e < elements; ++e) {
      if (forcing.mean_storage[e] == 0.0) new_rise[e] = 0.0;
    }
    if (largest(new_rise - rise) <= allowed(largest(new_rise), largest(before), floor)) {
      rise_rate_.assign(new_rise.data(), new_rise.data() + elements);
      for (double& rate : rise_rate_) rate /= dt;
      rise_time_ = dt;
      return step;
    }
    rise = mixing.next(rise, new_rise);
  }
  const std::string count = std::to_string(max_iterations) + " iterations";
  if (failed > 0) throw NoEquilibrium("the soil has found no equilibrium in " + count);
  throw NotConverged("flow and motion of the soil do not agree in " + count);
}

template <int Dim>
std::vector<double> SolidCoupling<Dim>::held_by_soil(const FlowSoils<Dim>& soils,
                                                     const ElementField<Dim>& air,
                                                     const FlowForcing<Dim>& forcing,
                                                     const std::vector<double>& pressure,
                                                     double dt) const {
  std::vector<double> result = solid_.compressibility(dt);
  for (double& storage : result) storage *= held_storage;
  const std::vector<double> saturation = saturation_of(grid_, air, forcing.coefficients.porosity);
  for (std::size_t e = 0; e < saturation.size(); ++e) {
    // Suction acts on the soil, and the soil on the water, as far as pores are filled.
    if (pressure[e] >= 0.0 || soils.soil_share.empty()) continue;
    const double filled = soils.effective_saturation(static_cast<int>(e), saturation[e]);
    result[e] *= filled * filled;
  }
  return result;
}

template <int Dim>
double SolidCoupling<Dim>::allowed(double rise, double pressure, double floor) const {
  if (solid_.has_inertia()) return accuracy_in_motion * (rise + pressure);
  return accuracy * rise + round_off * pressure + floor;
}

template <int Dim>
void SolidCoupling<Dim>::watch_steps(double time, double next_step) {
  if (next_step >= short_step * solid_.time_of_fall()) {
    long_steps_ = true;
  } else if (long_steps_ && solid_.let_fail(time)) {
    long_steps_ = false;
  }
}

template <int Dim>
void SolidCoupling<Dim>::refuse_unsolved(double time, const NotConverged& error) const {
  if (!solid_.moves()) throw NumericalError(error.what());
  std::ostringstream message;
  message << "t = " << time << " s: ";
  if (solid_.has_inertia()) {
    message << error.what() << ": the motion of the soil that fails has no solution";
  } else if (dynamic_cast<const NoEquilibrium*>(&error) != nullptr) {
    message << "the soil has lost its equilibrium: it cannot carry its weight, its loads and the "
               "pressure of the water any longer (to follow it: time.failure = \"follow\")";
  } else {
    message << error.what()
            << ", however short the step is: soil that yields is about to lose its equilibrium";
  }
  throw EquilibriumLost(message.str());
}

template <int Dim>
Eigen::VectorXd SolidCoupling<Dim>::undrained_rise(MotionForcing forcing,
                                                   Eigen::VectorXd rise) const {
  const std::vector<double> compressibility = solid_.compressibility(forcing.duration);
  forcing.stiffness.resize(compressibility.size());
  for (std::size_t e = 0; e < compressibility.size(); ++e) {
    if (compressibility[e] == 0.0) continue;
    forcing.stiffness[e] = undrained_stiffness * grid_.volume[e] / compressibility[e];
  }
  const SolidMotion& motion = solid_.try_motion(forcing);
  if (!motion.converged) throw NoEquilibrium("the soil has found no equilibrium");
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    double growth = 0.0;
    for (int k = 0; k <= Dim; ++k) {
      growth += grid_.element_face_sign[e][k] * motion.face_volume[grid_.element_face[e][k]];
    }
    rise[e] -= forcing.stiffness[e] * growth / grid_.volume[e];
  }
  return rise;
}

template <int Dim>
std::vector<double> SolidCoupling<Dim>::without_air(const SolidMotion& motion,
                                                    const ElementField<Dim>& air,
                                                    const FlowCoefficients<Dim>& start,
                                                    FlowForcing<Dim>& forcing) const {
  const MovedAir<Dim> moved(grid_, air, start.porosity, motion.face_volume);
  std::vector<double> result(grid_.face_count());
  for (int f = 0; f < grid_.face_count(); ++f) result[f] = moved.without_air(f);
  FlowCoefficients<Dim>& c = forcing.coefficients;
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    c.porosity[e] = start.porosity[e] + moved.pores_gained(e) / grid_.volume[e];
    c.drag[e] = start.drag[e] * c.porosity[e] / start.porosity[e];  // the conductivity stays
  }
  return result;
}

template <int Dim>
std::vector<double> SolidCoupling<Dim>::source_of(const std::vector<double>& moved,
                                                  const std::vector<double>& own,
                                                  const std::vector<double>& storage,
                                                  const Eigen::VectorXd& rise, double dt) const {
  std::vector<double> source(grid_.mesh.element_count());
  for_each_index(grid_.mesh.element_count(), threads_, [&](int e) {
    // What the element stores beside is that of pressures other than those tried.
    source[e] = (own.empty() ? 0.0 : own[e]) + storage[e] * rise[e] / dt;
    // Pores that open with the soil take liquid in.
    for (int k = 0; k <= Dim; ++k) {
      source[e] -= grid_.element_face_sign[e][k] * moved[grid_.element_face[e][k]] / dt;
    }
  });
  return source;
}

template <int Dim>
std::vector<double> liquid_mass(const Grid<Dim>& grid, const FlowCoefficients<Dim>& coefficients,
                                const ElementField<Dim>& air) {
  std::vector<double> result(grid.mesh.elements.size());
  for (std::size_t e = 0; e < result.size(); ++e) {
    const double empty = air.empty() ? 0.0 : element_sum<Dim>(air[e]) / grid.volume[e];
    result[e] = (coefficients.porosity[e] - empty) * coefficients.mixture_density[e];
  }
  return result;
}

template <int Dim>
std::vector<double> pressure_on_solid(const Grid<Dim>& grid, const FlowSoils<Dim>& soils,
                                      std::vector<double> pressure,
                                      const std::vector<double>& porosity,
                                      const ElementField<Dim>& air) {
  const std::vector<double> saturation = saturation_of(grid, air, porosity);
  for (std::size_t e = 0; e < air.size(); ++e) {
    if (pressure[e] < 0.0)
      pressure[e] *= soils.effective_saturation(static_cast<int>(e), saturation[e]);
  }
  return pressure;
}

template class SolidCoupling<2>;
template class SolidCoupling<3>;
template std::vector<double> liquid_mass(const Grid<2>&, const FlowCoefficients<2>&,
                                         const ElementField<2>&);
template std::vector<double> liquid_mass(const Grid<3>&, const FlowCoefficients<3>&,
                                         const ElementField<3>&);
template std::vector<double> pressure_on_solid(const Grid<2>&, const FlowSoils<2>&,
                                               std::vector<double>, const std::vector<double>&,
                                               const ElementField<2>&);
template std::vector<double> pressure_on_solid(const Grid<3>&, const FlowSoils<3>&,
                                               std::vector<double>, const std::vector<double>&,
                                               const ElementField<3>&);

}  // namespace suffuse
