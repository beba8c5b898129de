#include "motion/moving_skeleton.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "equilibrium/free_water.hpp"
#include "equilibrium/start_stress.hpp"
#include "grid/parallel.hpp"
#include "motion/element_gains.hpp"
#include "motion/point_motion.hpp"
#include "physics/head.hpp"
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
      solid_flux_(grid) {
  std::iota(id_.begin(), id_.end(), 0);
  for (int p = 0; p < points_.size(); ++p) region_.push_back(soils.region_of_point(p));
  const ElementField<Dim> pores = initial_pore_volume(grid, soils);
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    solid_[e] = soils.is_soil(e) ? solid_[e] - element_sum<Dim>(pores[e]) : 0.0;
  }
}

template <int Dim>
std::vector<double> MovingSkeleton<Dim>::element_porosity() const {
  std::vector<double> result(solid_.size());
  for (std::size_t e = 0; e < solid_.size(); ++e) {
    result[e] = 1.0 - solid_[e] / this->grid_.volume[e];
  }
  return result;
}

// ------------------------------------------------------------------------------ exchange of fines

template <int Dim>
void MovingSkeleton<Dim>::add_to_elements(const std::vector<double>& gain) {
  for (std::size_t p = 0; p < gain.size(); ++p) solid_[points_.element[p]] += gain[p];
  step_.reset();  // weights and stiffness have changed
}

template <int Dim>
void MovingSkeleton<Dim>::exchange(double from, double to, const PointFlows& flows,
                                   const std::vector<char>& waiting,
                                   std::vector<double>& exchange) {
  ErodingSkeleton<Dim>::exchange(from, to, flows, waiting, exchange);
  std::vector<double> gain = exchange;
  for (double& v : gain) v = -v;
  add_to_elements(gain);
}

template <int Dim>
void MovingSkeleton<Dim>::apply(const std::vector<Exchange>& change,
                                std::vector<double>& exchange) {
  ErodingSkeleton<Dim>::apply(change, exchange);
  std::vector<double> gain = exchange;
  for (double& v : gain) v = -v;
  add_to_elements(gain);
}

template <int Dim>
void MovingSkeleton<Dim>::deposit(const std::vector<double>& volume) {
  ErodingSkeleton<Dim>::deposit(volume);
  add_to_elements(volume);
}

template <int Dim>
void MovingSkeleton<Dim>::start_from(const SolidState& state) {
  std::vector<double> gain = solid_volumes();
  ErodingSkeleton<Dim>::start_from(state);
  const std::vector<double> now = solid_volumes();
  for (std::size_t p = 0; p < gain.size(); ++p) gain[p] = now[p] - gain[p];
  add_to_elements(gain);
}

template <int Dim>
std::vector<double> MovingSkeleton<Dim>::solid_volumes() const {
  std::vector<double> result(points_.size());
  for (int p = 0; p < points_.size(); ++p) result[p] = this->state_.solid_volume(p);
  return result;
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
std::vector<PointSkeleton> MovingSkeleton<Dim>::skeletons() const {
  std::vector<PointSkeleton> result;
  result.reserve(points_.size());
  for (int p = 0; p < points_.size(); ++p) {
    const double left = this->state_.erodible_volume[p] - loss_of(p);
    result.push_back(skeleton_of(p, share_left(p, left)));
  }
  return result;
}

template <int Dim>
Eigen::Matrix3d MovingSkeleton<Dim>::effective_stress(int point) const {
  const PointSkeleton skeleton = skeleton_of(point, fines_left(point));
  const auto response =
      skeleton_response<Dim>(*skeleton.law, skeleton.parameters, points_.elastic_b[point],
                             Eigen::Matrix<double, Dim, Dim>::Identity());
  return response.stress * points_.reference_volume[point] / points_.volume[point];
}

template <int Dim>
std::vector<double> MovingSkeleton<Dim>::drained_compressibility() const {
  const Mesh<Dim>& mesh = this->grid_.mesh;
  std::vector<double> stiffness(solid_.size(), 0.0);
  std::vector<double> volume(solid_.size(), 0.0);
  std::vector<char> at_soil(mesh.node_count(), 0);
  double softest = std::numeric_limits<double>::infinity();
  for (int p = 0; p < points_.size(); ++p) {
    if (!this->soils().soil_of_point(p).skeleton.moves()) continue;
    const int e = points_.element[p];
    const double modulus = skeleton_of(p, fines_left(p)).parameters.oedometer_modulus();
    softest = std::min(softest, modulus);
    stiffness[e] += points_.volume[p] * modulus;
    volume[e] += points_.volume[p];
    for (const int i : mesh.elements[e]) at_soil[i] = 1;
  }
  std::vector<double> result(solid_.size(), 0.0);
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (volume[e] > 0.0) {
      result[e] = this->grid_.volume[e] * volume[e] / stiffness[e];
    } else if (has_free_water_ &&
               std::ranges::any_of(mesh.elements[e], [&](int i) { return at_soil[i] != 0; })) {
      result[e] = this->grid_.volume[e] / softest;
    }
  }
  return result;
}

template <int Dim>
double MovingSkeleton<Dim>::stiffness() const {
  double largest = 0.0;
  for (int p = 0; p < points_.size(); ++p) {
    if (!this->soils().soil_of_point(p).skeleton.moves()) continue;
    largest = std::max(largest, skeleton_of(p, fines_left(p)).parameters.oedometer_modulus());
  }
  return largest;
}

template <int Dim>
std::vector<double> MovingSkeleton<Dim>::solid_masses() const {
  std::vector<double> mass = solid_volumes();
  for (int p = 0; p < points_.size(); ++p) {
    mass[p] = (mass[p] - loss_of(p)) * this->soils().soil_of_point(p).grain_density;
  }
  return mass;
}

/// Weight of the solid at its points; of the liquid, and what loads the boundaries.
template <int Dim>
NodeVectors<Dim> MovingSkeleton<Dim>::loads(const MotionForcing& forcing,
                                            const PointsByElement& sorted,
                                            const ElementClasses& classes) const {
  const SoilMap<Dim>& soils = this->soils();
  const SoilMass mass{.solid = solid_masses(), .liquid = forcing.liquid_mass};
  NodeVectors<Dim> result(this->grid_.mesh.node_count(), Vector<Dim>::Zero());
  add_weight(this->grid_, points_, sorted, classes, mass, soils.scene().gravity, result);
  boundary_loads_.add(sorted, forcing.end, result);
  if (has_free_water_) {
    add_free_water(this->grid_, sorted, soil_volumes(points_, sorted, classes), forcing.pressure,
                   forcing.liquid_mass, soils.scene().gravity, result);
  }
  return result;
}

template <int Dim>
void MovingSkeleton<Dim>::start_motion(const MotionForcing& forcing) {
  const PointsByElement sorted(this->grid_.mesh.element_count(), points_.element);
  const ElementClasses classes(this->grid_, points_, sorted);
  const Scene& scene = this->soils().scene();
  const StartStress start = find_start_stress(this->grid_, skeletons(), supports_,
                                              {.forces = loads(forcing, sorted, classes),
                                               .pressure = forcing.pressure,
                                               .gravity = scene.gravity,
                                               .earth_pressure = scene.earth_pressure},
                                              points_, this->threads_);
  pressure_ = forcing.pressure;
  step_.reset();
  if (start.stands || let_fail(0.0)) return;
  const std::string place =
      start.worst_node < 0 ? "" : ", least " + node_text(this->grid_, start.worst_node);
  throw NumericalError(
      "the soil has no equilibrium at the start: it cannot carry its weight and the loads at "
      "t = 0 s" +
      place +
      "; give it more strength or stiffness, fix a boundary that it leans on, or let it move "
      "(time.failure = \"follow\")");
}

template <int Dim>
void MovingSkeleton<Dim>::expect_losses(const std::vector<double>& porosity) {
  std::vector<double> loss(porosity.size());
  for (std::size_t p = 0; p < loss.size(); ++p) {
    loss[p] = points_.volume[p] * (porosity[p] - this->porosity_[p]);
  }
  if (loss == loss_) return;
  loss_ = std::move(loss);
  step_.reset();
}

template <int Dim>
void MovingSkeleton<Dim>::prepare_step(const MotionForcing& forcing) {
  const bool with_inertia = inertia_.acts();
  if (with_inertia && forcing.duration != tried_.duration) step_.reset();
  if (step_) return;
  // Pressures of water that hardly leaves magnify what is out of balance.
  constexpr NewtonLimits in_equilibrium{.goal = 1e-12};
  constexpr NewtonLimits in_motion{.max_iterations = 12, .tolerance = 1e-6, .goal = 1e-7};
  // Inertia holds a piece of soil that hangs by one node.
  step_ = std::make_unique<StepEquilibrium<Dim>>(
      this->grid_, points_, skeletons(), supports_, this->threads_,
      with_inertia ? in_motion : in_equilibrium, with_inertia ? 0.0 : soft_share);
  if (!with_inertia) {
    bubbles_ = std::make_unique<FaceBubbles<Dim>>(this->grid_, *step_);
    return;
  }
  std::vector<double> mass = moved_masses(forcing);
  std::vector<double> of_element(this->grid_.mesh.element_count(), 0.0);
  for (int p = 0; p < points_.size(); ++p) {
    of_element[points_.element[p]] += mass[p] / (forcing.duration * forcing.duration);
  }
  bubbles_ = std::make_unique<FaceBubbles<Dim>>(this->grid_, *step_, of_element);
  inertia_.start_step(this->grid_, points_, std::move(mass));
  step_->set_inertia(inertia_.nodes(), forcing.duration);
}

template <int Dim>
const SolidMotion& MovingSkeleton<Dim>::try_motion(const MotionForcing& forcing) {
  if (inertia_.acts()) {
    repeated_failure_.refuse_creep(forcing.end - forcing.duration, points_.position);
  }
  expect_losses(forcing.porosity);
  prepare_step(forcing);
  tried_ = forcing;
  motion_ = {};
  forces_ = loads(forcing, step_->sorted(), step_->classes());
  if (!inertia_.acts()) crossing_forces_.add(forcing.duration, forces_);
  motion_.converged = step_->solve(forces_, forcing.pressure, forcing.stiffness);
  if (!motion_.converged) motion_.worst_node = step_->worst_node();
  motion_.iterations = step_->iterations();
  step_iterations_ += motion_.iterations;
  motion_.travel = largest_travel(this->grid_, step_->sorted(), step_->displacement());
  const double allowed = watches_failure() ? watched_travel : max_travel;
  motion_.converged = motion_.converged && motion_.travel <= allowed;
  motion_.face_volume = swept_volumes(this->grid_, step_->sorted(), step_->displacement());
  std::vector<double> change = forcing.pressure;
  for (std::size_t e = 0; e < change.size(); ++e) change[e] -= pressure_[e];
  bubbles_->add(change, motion_.face_volume);
  return motion_;
}

// ----------------------------------------------------------------------------------------- motion

template <int Dim>
const SolidMotion& MovingSkeleton<Dim>::accept_motion() {
  if (!step_ || !motion_.converged) throw std::logic_error("there is no motion to accept");
  check_pores();
  const std::vector<double> before = smooth(solid_volumes());
  boundary_loads_.move(step_->sorted(), step_->displacement());
  const std::vector<int> element = points_.element;
  if (inertia_.acts()) take_velocities();
  const bool watched = watches_failure();
  const std::vector<Vector<Dim>> place = watched ? points_.position : std::vector<Vector<Dim>>();
  move_points(this->grid_, step_->skeleton(), step_->displacement(), points_, this->threads_);
  slides_ = watched && has_slid(place);
  if (!inertia_.acts()) find_crossing_forces();
  book_regions(element);
  carry_solid(before, motion_.travel);
  correction_ = motion_.solid_correction;
  newton_iterations_ += step_iterations_;
  step_iterations_ = 0;
  step_.reset();
  bubbles_.reset();
  loss_.clear();
  pressure_ = tried_.pressure;
  sort_points();
  return motion_;
}

template <int Dim>
void MovingSkeleton<Dim>::find_crossing_forces() {
  const PointsByElement sorted(this->grid_.mesh.element_count(), points_.element);
  const ElementClasses classes(this->grid_, points_, sorted);
  Equilibrium<Dim> moved({this->grid_, points_, sorted, step_->skeleton(), classes}, supports_,
                         this->threads_);
  moved.set_pressure(tried_.pressure);
  moved.displace(NodeVectors<Dim>(this->grid_.mesh.node_count(), Vector<Dim>::Zero()), false);
  crossing_forces_.find(this->grid_, sorted, moved, loads(tried_, sorted, classes),
                        diffusivity(sorted));
}

/// c_v = k E_oed / gamma_w per element, with the least k of its points, m2/s; 0 without soil that
/// moves.
template <int Dim>
std::vector<double> MovingSkeleton<Dim>::diffusivity(const PointsByElement& sorted) const {
  const Scene& scene = this->soils().scene();
  std::vector<double> result = drained_compressibility();
  for (int e = 0; e < this->grid_.mesh.element_count(); ++e) {
    if (result[e] == 0.0) continue;
    const double modulus = this->grid_.volume[e] / result[e];
    double conductivity = std::numeric_limits<double>::infinity();
    for (const int p : sorted.of(e)) {
      const Soil& soil = this->soils().soil_of_point(p);
      const double porosity = 1.0 - this->state_.solid_volume(p) / points_.volume[p];
      const double along = soil.conductivity_model().at(this->initial_porosity_[p], porosity);
      conductivity = std::min({conductivity, along, along * soil.anisotropy()});
    }
    result[e] = conductivity * modulus / unit_weight(scene.liquid.density, scene.gravity);
  }
  return result;
}

template <int Dim>
void MovingSkeleton<Dim>::carry_solid(const std::vector<double>& smooth_before, double travel) {
  const std::vector<double> smooth_after = smooth(solid_volumes());
  std::vector<char> has_solid(solid_.size());
  for (std::size_t e = 0; e < solid_.size(); ++e) {
    if (supports_.is_rigid(static_cast<int>(e))) continue;  // its solid stays
    has_solid[e] = smooth_before[e] > 0.0 || smooth_after[e] > 0.0 || solid_[e] != 0.0 ? 1 : 0;
  }
  solid_flux_.follow(has_solid);
  motion_.solid_gain = element_gains({smooth_before, smooth_after, solid_, this->grid_.volume,
                                      travel, solid_flux_.piece(), solid_flux_.piece_count()});
  motion_.solid_face_volume = solid_flux_.carried(motion_.face_volume, solid_);
  motion_.solid_correction = solid_flux_.balance(motion_.solid_gain, motion_.solid_face_volume);
  for (std::size_t e = 0; e < solid_.size(); ++e) solid_[e] += motion_.solid_gain[e];
}

template <int Dim>
void MovingSkeleton<Dim>::book_regions(const std::vector<int>& element) {
  const std::vector<int>& region = this->grid_.mesh.element_region;
  for (int p = 0; p < points_.size(); ++p) {
    const int from = region[element[p]];
    const int to = region[points_.element[p]];
    if (from == to) continue;
    region_gain_[from].add(-this->state_.solid_volume(p));
    region_gain_[to].add(this->state_.solid_volume(p));
  }
}

template <int Dim>
std::vector<double> MovingSkeleton<Dim>::region_gain() const {
  std::vector<double> result;
  for (const CompensatedSum& sum : region_gain_) result.push_back(sum.value());
  return result;
}

template <int Dim>
void MovingSkeleton<Dim>::archive(StateArchive& archive) {
  ErodingSkeleton<Dim>::archive(archive);
  archive(points_, start_, id_, region_, initial_erodible_, this->initial_porosity_,
          boundary_loads_, crossing_forces_, inertia_, repeated_failure_, failure_time_, solid_,
          region_gain_, pressure_, filling_, correction_, newton_iterations_);
  if (!archive.restores()) return;
  step_.reset();
  show_points();
}

template class MovingSkeleton<2>;
template class MovingSkeleton<3>;

}  // namespace suffuse
