#include "coupling/flow_and_motion.hpp"

#include <algorithm>
#include <cmath>

#include "coupling/moved_air.hpp"
#include "grid/face_flux.hpp"
#include "grid/parallel.hpp"
#include "linear/anderson_mixing.hpp"
#include "mixed/mixed_flow.hpp"
#include "physics/numbers.hpp"

namespace suffuse {
namespace {

/// Fixed-stress storage over the compressibility of soil that cannot move sideways. With less, the
/// iteration of undrained soil may not converge; with more it is slower
/// (docs/theory/moving-soil.md, "Flow and motion").
constexpr double held_storage = 1.5;
/// Share of this storage that remains where soil with inertia has a mobility instead: it fixes the
/// level of the pressure.
constexpr double share_with_mobility = 1e-3;
/// Elements whose suction acts on the soil by a smaller share have no such storage.
constexpr double least_suction_share = 1e-3;
constexpr int max_coupling_iterations = 40;
/// The iteration is given up when the difference has not fallen by a tenth in this many iterations:
/// a shorter step takes less time. Near to agreement Anderson's mixing may have much to learn
/// before the difference falls.
constexpr int patience = 8;
constexpr int patience_near_agreement = 16;
constexpr double nearer = 0.9;
/// Stiffness of confined water over the oedometer modulus of the soil.
constexpr double undrained_stiffness = 300.0;
constexpr int memory = 20;
/// The last step predicts the pressures of the next one, unless this is longer by this factor or
/// the soil has inertia.
constexpr double longest_growth = 10.0;
/// Pressures agree if they differ by less than this share of the largest change in the step and of
/// the error that the step may have ...
constexpr double share_of_rise = 1e-3;
constexpr double share_of_tolerance = 0.03;
/// ... plus this share of the largest pressure, plus this share of a stress: the largest one plus
/// that of the stiffest soil at `Equilibrium::least_strain`. The forces of the solid balance to a
/// hundredth of that (`NewtonLimits::tolerance`). At a loose surface the pressure has a larger
/// error than these forces.
constexpr double accuracy_of_pressure = 1e-7;
constexpr double accuracy_of_stress = 1e-8;
/// Accuracy with inertia, relative to the largest change plus the largest pressure: pressures of
/// failing soil oscillate more from step to step.
constexpr double accuracy_in_motion = 1e-4;
/// Until pressures differ by less than this many times what is allowed, each iteration reduces the
/// residuals of flow and motion by this factor only: more exact ones would answer to pressures that
/// still change (inexact Newton methods: Dembo, Eisenstat and Steihaug, SIAM J. Numer. Anal. 19
/// (1982) 400).
constexpr double near_agreement = 10.0;
constexpr double reduction = 0.05;

double largest(const Eigen::VectorXd& values) {
  return values.size() > 0 ? values.template lpNorm<Eigen::Infinity>() : 0.0;
}

/// Largest absolute pressure in elements that act on the motion, Pa.
double largest_of_soil(const std::vector<double>& pressure, const std::vector<double>& storage) {
  double result = 0.0;
  for (std::size_t e = 0; e < pressure.size(); ++e) {
    if (storage[e] != 0.0) result = std::max(result, std::abs(pressure[e]));
  }
  return result;
}

/// Largest stress at a point, nearly: that of its elastic strain by Young's modulus, Pa.
template <int Dim>
double largest_stress(const MovingSkeleton<Dim>& solid) {
  const SolidPoints<Dim>& points = solid.points();
  double result = 0.0;
  for (int p = 0; p < points.size(); ++p) {
    const SkeletonModel& skeleton = solid.soils().soil_of_point(p).skeleton;
    if (!skeleton.moves()) continue;
    const Eigen::Matrix3d strain =
        0.5 * (points.skeleton[p].elastic_b - Eigen::Matrix3d::Identity());
    result = std::max(result, skeleton.at(1.0).young * strain.norm());
  }
  return result;
}

std::vector<double> risen(std::vector<double> pressure, const Eigen::VectorXd& rise) {
  for (std::size_t e = 0; e < pressure.size(); ++e) pressure[e] += rise[e];
  return pressure;
}

Unsolved no_equilibrium(const std::string& where, int worst_node) {
  return {"the soil has found no equilibrium" + where, true, worst_node};
}

/// How near the iterations of a step have come to agreement.
struct Approach {
  bool is_near = false;           ///< they have been near: residuals are exact since
  bool agrees = false;            ///< see `take`
  bool goes_on = true;            ///< see `take`
  double nearest = infinity;      ///< smallest difference of pressures, Pa
  int nearest_at = 0;             ///< iteration that had it
  int iteration = 0;              ///< the present one, from 1
  int worst_element = 0;          ///< where pressures differ most
  std::optional<int> worst_node;  ///< of the last motion, if it had no equilibrium

  /// Begins an iteration, unless all have been made.
  bool begins() {
    if (iteration == max_coupling_iterations) return false;
    ++iteration;
    return true;
  }
  /// Whether this rise is a guess from the last step.
  [[nodiscard]] bool guesses(const Eigen::VectorXd& rise) const {
    return iteration == 1 && rise.squaredNorm() > 0.0;
  }
  /// Takes the difference of the pressures after an iteration, Pa, and what agreement allows. Sets
  /// whether they agree and whether to go on.
  void take(double off, double allowed, double tolerated) {
    if (off < nearer * nearest) {
      nearest = off;
      nearest_at = iteration;
    }
    const bool was_exact = is_near;
    is_near = is_near || off <= std::max(near_agreement * allowed, tolerated);
    goes_on = iteration < std::min(nearest_at + (is_near ? patience_near_agreement : patience),
                                   max_coupling_iterations);
    agrees = was_exact && off <= (goes_on ? allowed : std::max(allowed, tolerated));
  }
  /// After the last iteration.
  template <int Dim>
  [[nodiscard]] Unsolved not_found(const Grid<Dim>& grid) const {
    const std::string count = std::to_string(iteration) + " iterations";
    if (worst_node) return no_equilibrium(" in " + count, *worst_node);
    return {"flow and motion of the soil do not agree in " + count + ", least in " +
            element_text(grid, worst_element)};
  }
};

Eigen::VectorXd rise_between(const std::vector<double>& before, const std::vector<double>& after) {
  using Map = Eigen::Map<const Eigen::VectorXd>;
  const auto count = static_cast<Eigen::Index>(before.size());
  return Map(after.data(), count) - Map(before.data(), count);
}

std::vector<double> as_std_vector(const Eigen::VectorXd& values) {
  return {values.data(), values.data() + values.size()};
}

PressureRise rise_of(const Eigen::VectorXd& rose, double dt) {
  PressureRise result{as_std_vector(rose), dt};
  for (double& rate : result.rate) rate /= dt;
  return result;
}

}  // namespace

template <int Dim>
std::optional<Unsolved> FlowAndMotion<Dim>::solve(ImplicitMixed<Dim>& scheme,
                                                  const FlowStart<Dim>& start, MotionForcing given,
                                                  CoupledStep<Dim>& step) const try {
  given.liquid_mass = liquid_mass(grid_, step.flow.forcing.back().coefficients, start.state.air);
  step.motion = solid_.start_step(std::move(given), std::move(step.motion));
  if (solid_.rests() && solve_at_rest(scheme, start, step)) return std::nullopt;
  return iterate(scheme, start, step);
} catch (const NotConverged& error) {
  return Unsolved{error.what()};
}

template <int Dim>
std::optional<Unsolved> FlowAndMotion<Dim>::iterate(ImplicitMixed<Dim>& scheme,
                                                    const FlowStart<Dim>& start,
                                                    CoupledStep<Dim>& step) const {
  const double dt = step.flow.dt;
  const std::vector<double>& pressure = start.pressure;
  const ElementField<Dim>& air = start.state.air;
  const FlowSoils<Dim>& soils = scheme.soils();
  FlowForcing<Dim> forcing = step.flow.forcing.back();
  const std::vector<double> own = forcing.source;
  const FlowCoefficients<Dim> at_start = forcing.coefficients;
  if (at_start.quadratic_drag.empty()) forcing.mean_mobility = solid_.inertial_mobility(dt);
  const Eigen::VectorXd acts = acting_shares(soils, air, at_start.porosity, pressure);
  forcing.mean_storage = held_by_soil(acts, forcing.mean_mobility, dt);
  AndersonMixing mixing(memory);
  Eigen::VectorXd rise = expected_rise(step.rise, dt);
  const Agreement agreement = agreement_at(
      largest_of_soil(pressure_on_solid(grid_, soils, pressure, at_start.porosity, air),
                      forcing.mean_storage),
      start.tolerance);
  Eigen::VectorXd elsewhere = Eigen::VectorXd::Zero(rise.size());  // rise at faces without soil
  Approach approach;
  while (approach.begins()) {
    ++step.iterations;
    step.motion->reduction = forcing.reduction = approach.is_near ? 0.0 : reduction;
    const Eigen::VectorXd of_elements = at_elements(rise, forcing.mean_storage);
    const std::vector<double> acting =
        pressure_on_solid(grid_, soils, risen(pressure, of_elements), at_start.porosity, air);
    const SolidMotion& motion = solid_.solve(*step.motion, acting);
    if (!motion.converged) {
      approach.worst_node = motion.worst_node;
      std::optional<Eigen::VectorXd> other = Eigen::VectorXd::Zero(pressure.size());
      if (!approach.guesses(rise)) other = undrained_rise(*step.motion, acting, of_elements);
      if (!other) return no_equilibrium("", step.motion->motion.worst_node);
      rise = at_faces(*other, forcing.mean_storage);
      mixing = AndersonMixing(memory);
      continue;
    }
    approach.worst_node.reset();
    const std::vector<double> moved =
        !soils.air_moves() ? motion.face_volume
                           : without_air(motion, start.state, at_start, soils, forcing);
    forcing.source = source_of(moved, own, dt);
    forcing.known_rise = as_std_vector(of_elements);
    forcing.expected_rise = as_std_vector(rise + elsewhere);
    MixedStep<Dim> found = scheme.step(start.state, dt, {&forcing});
    const Eigen::VectorXd all = rise_between(start.state.face_pressure, found.end.face_pressure);
    const Eigen::VectorXd rose = at_soil(all, forcing.mean_storage);
    elsewhere = all - rose;
    const Eigen::VectorXd new_of_elements = at_elements(rose, forcing.mean_storage);
    const Eigen::VectorXd differs = acts.cwiseProduct(new_of_elements - of_elements).cwiseAbs();
    const double off = differs.maxCoeff(&approach.worst_element);
    const double allowed = agreement.allowed(largest(acts.cwiseProduct(new_of_elements)));
    approach.take(off, allowed, agreement.tolerated());
    if (approach.agrees) {
      step.rise = rise_of(rose, dt);
      step.flow.found = std::move(found);
      return std::nullopt;
    }
    if (!approach.goes_on) break;
    rise = mixing.next(rise, rose);
  }
  return approach.not_found(grid_);
}

template <int Dim>
bool FlowAndMotion<Dim>::solve_at_rest(ImplicitMixed<Dim>& scheme, const FlowStart<Dim>& start,
                                       CoupledStep<Dim>& step) const {
  ++step.iterations;
  const FlowForcing<Dim>& forcing = step.flow.forcing.back();
  MixedStep<Dim> found = scheme.step(start.state, step.flow.dt, {&forcing});
  const std::vector<double> pressure = element_pressure(grid_, found.end.face_pressure, threads_);
  if (!solid_.stays(*step.motion,
                    pressure_on_solid(grid_, scheme.soils(), pressure,
                                      forcing.coefficients.porosity, start.state.air))) {
    return false;
  }
  step.rise = {};
  step.flow.found = std::move(found);
  return true;
}

template <int Dim>
std::vector<double> FlowAndMotion<Dim>::held_by_soil(const Eigen::VectorXd& acts,
                                                     const std::vector<double>& mean_mobility,
                                                     double dt) const {
  std::vector<double> result = solid_.compressibility(dt);
  for (double& storage : result) storage *= held_storage;
  for (std::size_t e = 0; e < mean_mobility.size(); ++e) {
    if (mean_mobility[e] > 0.0) result[e] *= share_with_mobility;
  }
  for (std::size_t e = 0; e < result.size(); ++e) {
    // Suction acts on the soil, and the soil on the water, by the filled share of the pores.
    const double share = acts[static_cast<Eigen::Index>(e)];
    result[e] *= share < least_suction_share ? 0.0 : share * share;
  }
  return result;
}

template <int Dim>
Eigen::VectorXd FlowAndMotion<Dim>::acting_shares(const FlowSoils<Dim>& soils,
                                                  const ElementField<Dim>& air,
                                                  const std::vector<double>& porosity,
                                                  const std::vector<double>& pressure) const {
  Eigen::VectorXd result = Eigen::VectorXd::Ones(grid_.mesh.element_count());
  if (!soils.air_moves()) return result;
  const std::vector<double> saturation = saturation_of(grid_, air, porosity);
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    if (pressure[e] < 0.0) result[e] = soils.suction_share(e, saturation[e]);
  }
  return result;
}

template <int Dim>
Eigen::VectorXd FlowAndMotion<Dim>::expected_rise(const PressureRise& last, double dt) const {
  // Pressures of soil that falls go up and down from step to step.
  if (last.rate.empty() || dt > longest_growth * last.time || solid_.has_inertia()) {
    return Eigen::VectorXd::Zero(grid_.face_count());
  }
  return dt * Eigen::Map<const Eigen::VectorXd>(last.rate.data(), grid_.face_count());
}

template <int Dim>
Eigen::VectorXd FlowAndMotion<Dim>::at_elements(const Eigen::VectorXd& of_faces,
                                                const std::vector<double>& storage) const {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(grid_.mesh.element_count());
  for_each_index(grid_.mesh.element_count(), threads_, [&](int e) {
    if (storage[e] == 0.0) return;
    for (const int f : grid_.element_face[e]) result[e] += of_faces[f] / (Dim + 1);
  });
  return result;
}

template <int Dim>
Eigen::VectorXd FlowAndMotion<Dim>::at_faces(const Eigen::VectorXd& of_elements,
                                             const std::vector<double>& storage) const {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(grid_.face_count());
  for_each_index(grid_.face_count(), threads_, [&](int f) {
    int around = 0;
    for (const int e : {grid_.face_left[f], grid_.face_right[f]}) {
      if (e < 0 || storage[e] == 0.0) continue;
      result[f] += of_elements[e];
      ++around;
    }
    if (around > 0) result[f] /= around;
  });
  return result;
}

template <int Dim>
Eigen::VectorXd FlowAndMotion<Dim>::at_soil(const Eigen::VectorXd& of_faces,
                                            const std::vector<double>& storage) const {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(grid_.face_count());
  for_each_index(grid_.face_count(), threads_, [&](int f) {
    const int right = grid_.face_right[f];
    if (storage[grid_.face_left[f]] != 0.0 || (right >= 0 && storage[right] != 0.0)) {
      result[f] = of_faces[f];
    }
  });
  return result;
}

template <int Dim>
Agreement FlowAndMotion<Dim>::agreement_at(double pressure, double tolerance) const {
  if (solid_.has_inertia()) {
    return {
        .share = accuracy_in_motion, .most = infinity, .round_off = accuracy_in_motion * pressure};
  }
  const double stress =
      largest_stress(solid_) + Equilibrium<Dim>::least_strain * solid_.stiffness();
  return {.share = share_of_rise,
          .most = share_of_tolerance * tolerance,
          .round_off = accuracy_of_pressure * pressure + accuracy_of_stress * stress};
}

template <int Dim>
std::optional<Eigen::VectorXd> FlowAndMotion<Dim>::undrained_rise(
    MotionStep<Dim>& step, const std::vector<double>& pressure, Eigen::VectorXd rise) const {
  const std::vector<double> compressibility = solid_.compressibility(step.forcing.duration);
  std::vector<double> stiffness(compressibility.size());
  for (std::size_t e = 0; e < compressibility.size(); ++e) {
    if (compressibility[e] == 0.0) continue;
    stiffness[e] = undrained_stiffness * grid_.volume[e] / compressibility[e];
  }
  const SolidMotion& motion = solid_.solve(step, pressure, stiffness);
  if (!motion.converged) return std::nullopt;
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    const double growth = outflow(grid_, e, motion.face_volume);
    rise[e] -= stiffness[e] * growth / grid_.volume[e];
  }
  return rise;
}

template <int Dim>
std::vector<double> FlowAndMotion<Dim>::without_air(const SolidMotion& motion,
                                                    const MixedState<Dim>& state,
                                                    const FlowCoefficients<Dim>& start,
                                                    const FlowSoils<Dim>& soils,
                                                    FlowForcing<Dim>& forcing) const {
  const MovedAir<Dim> moved(
      grid_, forcing.conditions, state,
      element_pores(grid_, solid_.element_porosity(), start.porosity, soils.soil_share),
      motion.face_volume);
  std::vector<double> result(grid_.face_count());
  for (int f = 0; f < grid_.face_count(); ++f) result[f] = moved.without_air(f);
  FlowCoefficients<Dim>& c = forcing.coefficients;
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    c.porosity[e] = start.porosity[e] + moved.pores_gained(e) / grid_.volume[e];
    c.drag[e] = start.drag[e] * c.porosity[e] / start.porosity[e];  // same conductivity
  }
  return result;
}

template <int Dim>
std::vector<double> FlowAndMotion<Dim>::source_of(const std::vector<double>& moved,
                                                  const std::vector<double>& own, double dt) const {
  std::vector<double> source(grid_.mesh.element_count());
  for_each_index(grid_.mesh.element_count(), threads_, [&](int e) {
    source[e] = own.empty() ? 0.0 : own[e];
    // Liquid enters the pores that open as the soil moves.
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
    if (pressure[e] < 0.0) pressure[e] *= soils.suction_share(static_cast<int>(e), saturation[e]);
  }
  return pressure;
}

template class FlowAndMotion<2>;
template class FlowAndMotion<3>;
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
