#include "motion/moving_skeleton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "boundary/free_water.hpp"
#include "grid/parallel.hpp"
#include "motion/element_gains.hpp"
#include "motion/element_stiffness.hpp"
#include "motion/point_motion.hpp"
#include "motion/point_spacing.hpp"
#include "motion/start_stress.hpp"
#include "physics/head.hpp"
#include "solid/hole_filling.hpp"
#include "solid/pores.hpp"

namespace suffuse {
namespace {

template <int Dim>
SolidPoints<Dim> points_of(const Mesh<Dim>& mesh, const MaterialPoints<Dim>& points) {
  std::vector<PointPlace<Dim>> places;
  places.reserve(points.size());
  for (int p = 0; p < points.size(); ++p) {
    places.push_back({points.element[p], points.barycentric[p]});
  }
  return {mesh, places, points.volume};
}

/// Volume that points lose as their porosity changes to `later`, m3; empty if `later` is.
std::vector<double> losses(const std::vector<double>& volume, const std::vector<double>& porosity,
                           const std::vector<double>& later) {
  std::vector<double> loss(later.size());
  for (std::size_t p = 0; p < loss.size(); ++p) loss[p] = volume[p] * (later[p] - porosity[p]);
  return loss;
}

/// Whether points move too far in a step: farther than allowed, or, with inertia, farther than at
/// their velocities by more than a fifth of an element. The forces at the end of such a step are
/// not those on the way.
template <int Dim>
bool is_too_far(const Grid<Dim>& grid, const SolidPoints<Dim>& points,
                const MotionStep<Dim>& step) {
  constexpr double max_gain = 0.2;
  if (step.motion.travel > step.forcing.longest_travel) return true;
  if (!step.has_inertia) return false;
  NodeVectors<Dim> gained = step.equilibrium->displacement();
  for (std::size_t i = 0; i < gained.size(); ++i) {
    gained[i] -= step.forcing.duration * step.nodes.velocity[i];
  }
  return largest_travel(grid, points, gained) > max_gain;
}

/// Pressures of confined water magnify the residual.
constexpr NewtonLimits in_equilibrium{.goal = 1e-12};
constexpr NewtonLimits in_motion{.max_iterations = 12, .tolerance = 1e-5, .goal = 1e-6};

/// Time in which soil falls through an element of mean size, s; 0 without gravity.
template <int Dim>
double fall_through_element(const Mesh<Dim>& mesh, const Scene& scene) {
  const double g = acceleration(scene.gravity);
  return g > 0.0 ? std::sqrt(2.0 * mean_size(mesh) / g) : 0.0;
}

}  // namespace

template <int Dim>
MovingSkeleton<Dim>::MovingSkeleton(const Grid<Dim>& grid, SoilMap<Dim>& soils,
                                    const TimeSpan& span, int threads)
    : ErodingSkeleton<Dim>(grid, soils, span, threads),
      movable_soils_(soils),
      has_free_water_(has_free_water(grid, soils)),
      points_(points_of(grid.mesh, soils.points())),
      start_(points_.position),
      id_(points_.size()),
      initial_erodible_(this->state_.erodible_volume),
      supports_(scene_supports(grid, soils)),
      boundary_loads_(grid, soils, PointsByElement(grid.mesh.element_count(), points_.element)),
      solid_(grid.volume),
      region_gain_(grid.mesh.region_names.size()),
      pressure_(grid.mesh.element_count(), 0.0),
      time_of_fall_(fall_through_element(grid.mesh, soils.scene())),
      solid_flux_(grid) {
  std::iota(id_.begin(), id_.end(), 0);
  for (int p = 0; p < points_.size(); ++p) region_.push_back(soils.region_of_point(p));
  const ElementField<Dim> pores = initial_pore_volume(grid, soils);
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    solid_[e] = soils.is_soil(e) ? solid_[e] - element_sum<Dim>(pores[e]) : 0.0;
  }
  find_filling();
}

template <int Dim>
std::vector<double> MovingSkeleton<Dim>::element_porosity() const {
  std::vector<double> result(solid_.size());
  for (std::size_t e = 0; e < solid_.size(); ++e)
    result[e] = 1.0 - solid_[e] / this->grid_.volume[e];
  return result;
}

// ------------------------------------------------------------------------------ exchange of fines

template <int Dim>
void MovingSkeleton<Dim>::add_to_elements(const std::vector<double>& volume, double factor) {
  for (std::size_t p = 0; p < volume.size(); ++p) solid_[points_.element[p]] += factor * volume[p];
}

template <int Dim>
void MovingSkeleton<Dim>::exchange(double from, double to, const PointFlows& flows,
                                   const std::vector<char>& excluded,
                                   std::vector<double>& exchange) {
  ErodingSkeleton<Dim>::exchange(from, to, flows, excluded, exchange);
  add_to_elements(exchange, -1.0);
}

template <int Dim>
void MovingSkeleton<Dim>::apply(const std::vector<Exchange>& change,
                                std::vector<double>& exchange) {
  ErodingSkeleton<Dim>::apply(change, exchange);
  add_to_elements(exchange, -1.0);
}

template <int Dim>
void MovingSkeleton<Dim>::deposit(const std::vector<double>& volume) {
  ErodingSkeleton<Dim>::deposit(volume);
  add_to_elements(volume);
}

template <int Dim>
void MovingSkeleton<Dim>::start_from(const SolidState& state) {
  add_to_elements(this->state_.solid_volumes(), -1.0);
  ErodingSkeleton<Dim>::start_from(state);
  add_to_elements(this->state_.solid_volumes());
}

template <int Dim>
double MovingSkeleton<Dim>::fines_left(int point) const {
  return share_left(point, this->state_.erodible_volume[point]);
}

template <int Dim>
double MovingSkeleton<Dim>::share_left(int point, double erodible_volume) const {
  const double start = initial_erodible_[point];
  return start > 0.0 ? erodible_volume / start : 1.0;
}

// ----------------------------------------------------------------------------------- equilibrium

template <int Dim>
PointSkeleton MovingSkeleton<Dim>::skeleton_of(int point, double fines_left) const {
  return skeleton_at(this->soils().soil_of_point(point).skeleton, fines_left);
}

template <int Dim>
std::vector<PointSkeleton> MovingSkeleton<Dim>::skeletons(const std::vector<double>& loss) const {
  std::vector<PointSkeleton> result;
  result.reserve(points_.size());
  for (int p = 0; p < points_.size(); ++p) {
    const double left = this->state_.erodible_volume[p] - (loss.empty() ? 0.0 : loss[p]);
    result.push_back(skeleton_of(p, share_left(p, left)));
  }
  return result;
}

template <int Dim>
Eigen::Matrix3d MovingSkeleton<Dim>::effective_stress(int point) const {
  const PointSkeleton skeleton = skeleton_of(point, fines_left(point));
  const auto response =
      skeleton_response<Dim>(*skeleton.law, skeleton.parameters, points_.skeleton[point],
                             Eigen::Matrix<double, Dim, Dim>::Identity());
  return response.stress * points_.reference_volume[point] / points_.volume[point];
}

template <int Dim>
double MovingSkeleton<Dim>::stiffness() const {
  const std::vector<double> modulus = oedometer_moduli(this->soils(), skeletons({}));
  return modulus.empty() ? 0.0 : std::ranges::max(modulus);
}

template <int Dim>
std::vector<double> MovingSkeleton<Dim>::drained_compressibility() const {
  const std::vector<double> modulus = oedometer_moduli(this->soils(), skeletons({}));
  return suffuse::drained_compressibility(this->grid_, points_, modulus, has_free_water_);
}

template <int Dim>
std::vector<double> MovingSkeleton<Dim>::solid_masses(const std::vector<double>& loss) const {
  std::vector<double> mass = this->state_.solid_volumes();
  for (int p = 0; p < points_.size(); ++p) {
    if (!loss.empty()) mass[p] -= loss[p];
    mass[p] *= this->soils().soil_of_point(p).grain_density;
  }
  return mass;
}

/// Weight of solid and liquid, loads of boundaries, and the pressure of free water.
template <int Dim>
SoilLoads<Dim> MovingSkeleton<Dim>::loads(const MotionForcing& forcing,
                                          const std::vector<double>& solid_mass,
                                          const std::vector<double>& pressure,
                                          const PointsByElement& sorted,
                                          const ElementClasses& classes) const {
  const SoilMap<Dim>& soils = this->soils();
  const SoilMass mass{.solid = solid_mass, .liquid = forcing.liquid_mass};
  NodalLoads<Dim> result(this->grid_);
  const std::vector<double> volume = soil_volumes(points_, sorted, classes);
  add_weight(this->grid_, points_, volume, mass, soils.scene().gravity, result);
  boundary_loads_.add(sorted, volume, forcing.end, result);
  construction_.add(forcing.end, result.forces());
  if (has_free_water_) {
    add_free_water(this->grid_, sorted, volume, pressure, forcing.liquid_mass,
                   soils.scene().gravity, result);
  }
  return {std::move(result.forces()), unit_weights(points_, volume, mass, soils.scene().gravity)};
}

template <int Dim>
StartStress MovingSkeleton<Dim>::start_motion(const std::vector<double>& pressure,
                                              const std::vector<double>& liquid_mass) {
  const PointsByElement sorted(this->grid_.mesh.element_count(), points_.element);
  const ElementClasses classes(this->grid_, points_, sorted);
  const Scene& scene = this->soils().scene();
  const MotionForcing at_rest{.liquid_mass = liquid_mass};
  pressure_ = pressure;
  SoilLoads<Dim> found = loads(at_rest, solid_masses({}), pressure, sorted, classes);
  return find_start_stress(this->grid_, skeletons({}), supports_,
                           {.forces = std::move(found.forces),
                            .weight = std::move(found.weight),
                            .pressure = pressure,
                            .gravity = scene.gravity,
                            .earth_pressure = scene.earth_pressure},
                           points_, this->threads_);
}

template <int Dim>
MotionStep<Dim> MovingSkeleton<Dim>::start_step(MotionForcing forcing,
                                                std::optional<MotionStep<Dim>> last) const {
  std::vector<double> loss = losses(points_.volume, this->porosity_, forcing.porosity);
  // Without inertia the length enters only through the soft stiffness, kept from the first try.
  const bool continues = last && last->has_inertia == inertia_.acts() && last->loss == loss &&
                         (!last->has_inertia || last->forcing.duration == forcing.duration);
  if (continues) {
    last->forcing = std::move(forcing);
    return *std::move(last);
  }
  MotionStep<Dim> step;
  step.forcing = std::move(forcing);
  step.loss = std::move(loss);
  step.iterations = last ? last->iterations : 0;
  prepare(step);
  return step;
}

template <int Dim>
void MovingSkeleton<Dim>::prepare(MotionStep<Dim>& step) const {
  const double duration = step.forcing.duration;
  step.has_inertia = inertia_.acts();
  step.equilibrium = std::make_unique<StepEquilibrium<Dim>>(
      this->grid_, points_, skeletons(step.loss), supports_, this->threads_,
      step.has_inertia ? in_motion : in_equilibrium,
      step.has_inertia ? soft_with_inertia() : crossing_forces_.soft_stiffness(duration), kept_);
  if (!step.has_inertia) {
    step.bubbles = std::make_unique<FaceBubbles<Dim>>(this->grid_, *step.equilibrium);
    return;
  }
  step.mass = moved_masses(step);
  step.bubbles = std::make_unique<FaceBubbles<Dim>>(
      this->grid_, *step.equilibrium,
      sums_in_elements(this->grid_, points_, step.mass, 1.0 / (duration * duration)));
  step.nodes = inertia_.nodes(this->grid_, points_, step.mass);
  NodalMotion<Dim> nodes = step.nodes;
  if (has_free_water_)
    add_free_water_mass(this->grid_, step.equilibrium->sorted(),
                        step.equilibrium->equilibrium().soil_volumes(), step.forcing.liquid_mass,
                        nodes.mass);
  step.equilibrium->set_inertia(nodes, duration);
}

template <int Dim>
void MovingSkeleton<Dim>::load(MotionStep<Dim>& step, const std::vector<double>& pressure) const {
  step.pressure = pressure;
  SoilLoads<Dim> found = loads(step.forcing, solid_masses(step.loss), pressure,
                               step.equilibrium->sorted(), step.equilibrium->classes());
  step.loads = std::move(found.forces);
  step.equilibrium->set_weight(found.weight);
  step.motion = {};
}

template <int Dim>
bool MovingSkeleton<Dim>::stays(MotionStep<Dim>& step, const std::vector<double>& pressure) const {
  load(step, pressure);
  const double most = held_share_ * norm<Dim>(step.loads);
  crossing_forces_.add(step.forcing.duration, step.loads);
  step.motion.face_volume.assign(this->grid_.face_count(), 0.0);
  step.stays = step.equilibrium->stay(step.loads, pressure) <= most;
  return step.stays;
}

template <int Dim>
const SolidMotion& MovingSkeleton<Dim>::solve(MotionStep<Dim>& step,
                                              const std::vector<double>& pressure,
                                              std::vector<double> stiffness) const {
  StepEquilibrium<Dim>& equilibrium = *step.equilibrium;
  load(step, pressure);
  if (!step.has_inertia) crossing_forces_.add(step.forcing.duration, step.loads);
  SolidMotion& motion = step.motion;
  motion.converged = equilibrium.solve(step.loads, pressure, std::move(stiffness), step.reduction);
  if (!motion.converged) motion.worst_node = equilibrium.worst_node();
  motion.iterations = equilibrium.iterations();
  step.iterations += motion.iterations;
  motion.travel = largest_travel(this->grid_, points_, equilibrium.displacement());
  motion.converged = motion.converged && !is_too_far(this->grid_, points_, step);
  motion.face_volume = swept_volumes(this->grid_, equilibrium.sorted(), equilibrium.displacement());
  std::vector<double> change = pressure;
  for (std::size_t e = 0; e < change.size(); ++e) change[e] -= pressure_[e];
  step.bubbles->add(change, motion.face_volume);
  return motion;
}

// ----------------------------------------------------------------------------------------- motion

template <int Dim>
std::pair<SolidMotion, SoilKinetics> MovingSkeleton<Dim>::commit(MotionStep<Dim> step) {
  if (!step.motion.converged) throw std::logic_error("there is no motion to commit");
  const StepEquilibrium<Dim>& equilibrium = *step.equilibrium;
  const std::vector<double> volume = this->state_.solid_volumes();
  const std::vector<double> before = smooth(volume);
  boundary_loads_.move(equilibrium.sorted(), equilibrium.displacement());
  const std::vector<int> element = points_.element;
  const std::vector<Vector<Dim>> place = points_.position;
  move_points(this->grid_, equilibrium.skeleton(), equilibrium.displacement(),
              equilibrium.law_increments(), points_, this->threads_);
  const SoilKinetics found = inertia_.acts() ? SoilKinetics() : kinetics(step, place);
  if (inertia_.acts()) space_points(this->grid_, supports_, equilibrium.displacement(), points_);
  if (!step.stays) fill_holes(this->grid_, supports_, points_, start_);
  if (!inertia_.acts()) {
    if (!step.stays) find_crossing_forces(step);
    if (step.has_inertia) crossing_forces_.keep();  // the soil has come to rest
    if (!step.has_inertia && !step.stays) held_share_ = 0.0;
  }
  region_gain_.book(this->grid_.mesh.element_region, element, points_.element, volume);
  SolidMotion motion = std::move(step.motion);
  carry_solid(before, motion);
  correction_ = motion.solid_correction;
  newton_iterations_ += step.iterations;
  pressure_ = step.pressure;
  sort_points(step.forcing.end);
  return {std::move(motion), found};
}

template <int Dim>
void MovingSkeleton<Dim>::find_crossing_forces(const MotionStep<Dim>& step) {
  const PointsByElement sorted(this->grid_.mesh.element_count(), points_.element);
  const ElementClasses classes(this->grid_, points_, sorted);
  Equilibrium<Dim> moved({this->grid_, points_, sorted, step.equilibrium->skeleton(), classes},
                         supports_, this->threads_);
  std::vector<double> porosity = this->state_.solid_volumes();
  for (int p = 0; p < points_.size(); ++p) porosity[p] = 1.0 - porosity[p] / points_.volume[p];
  const SoilLoads<Dim> found =
      loads(step.forcing, solid_masses(step.loss), step.pressure, sorted, classes);
  moved.set_weight(found.weight);
  moved.set_pressure(step.pressure);
  moved.displace(NodeVectors<Dim>(this->grid_.mesh.node_count(), Vector<Dim>::Zero()), false);
  crossing_forces_.find(this->grid_, sorted, moved, found.forces,
                        diffusivity(this->grid_, this->soils(), sorted, drained_compressibility(),
                                    this->initial_porosity_, porosity));
}

template <int Dim>
void MovingSkeleton<Dim>::carry_solid(const std::vector<double>& smooth_before,
                                      SolidMotion& motion) {
  const std::vector<double> smooth_after = smooth(this->state_.solid_volumes());
  std::vector<char> has_solid(solid_.size());
  for (std::size_t e = 0; e < solid_.size(); ++e) {
    if (supports_.is_rigid(static_cast<int>(e))) continue;  // its solid does not move
    has_solid[e] = smooth_before[e] > 0.0 || smooth_after[e] > 0.0 || solid_[e] != 0.0 ? 1 : 0;
  }
  solid_flux_.follow(has_solid);
  motion.solid_gain =
      element_gains({smooth_before, smooth_after, solid_, this->grid_.volume, motion.travel,
                     solid_flux_.piece(), solid_flux_.piece_count()});
  motion.solid_face_volume = solid_flux_.carried(motion.face_volume, solid_);
  motion.solid_correction = solid_flux_.balance(motion.solid_gain, motion.solid_face_volume);
  for (std::size_t e = 0; e < solid_.size(); ++e) solid_[e] += motion.solid_gain[e];
}

template <int Dim>
void MovingSkeleton<Dim>::archive(StateArchive& archive) {
  ErodingSkeleton<Dim>::archive(archive);
  archive(points_, start_, id_, region_, initial_erodible_, this->initial_porosity_,
          boundary_loads_, crossing_forces_, construction_, inertia_, held_share_, solid_,
          region_gain_, pressure_, filling_, correction_, newton_iterations_);
  kept_->archive(archive, this->grid_.mesh, supports_);
  if (archive.restores()) show_points();
}

template class MovingSkeleton<2>;
template class MovingSkeleton<3>;

}  // namespace suffuse
