#include "deformation/moving_skeleton.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "deformation/element_gains.hpp"
#include "deformation/point_motion.hpp"
#include "deformation/start_stress.hpp"
#include "grid/parallel.hpp"
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

/// Entries in another order: the one that was at order[k] comes to k.
template <class Value>
void reorder(const std::vector<int>& order, std::vector<Value>& values) {
  if (values.empty()) return;
  std::vector<Value> sorted;
  sorted.reserve(values.size());
  for (const int p : order) sorted.push_back(values[p]);
  values = std::move(sorted);
}

}  // namespace

template <int Dim>
MovingSkeleton<Dim>::MovingSkeleton(const Grid<Dim>& grid, SoilMap<Dim>& soils,
                                    const TimeSpan& span, int threads)
    : ErodingSkeleton<Dim>(grid, soils, span, threads),
      movable_soils_(soils),
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
std::vector<double> MovingSkeleton<Dim>::compressibility() const {
  std::vector<double> stiffness(solid_.size(), 0.0);
  std::vector<double> volume(solid_.size(), 0.0);
  for (int p = 0; p < points_.size(); ++p) {
    if (!this->soils().soil_of_point(p).skeleton.moves()) continue;
    const int e = points_.element[p];
    stiffness[e] +=
        points_.volume[p] * skeleton_of(p, fines_left(p)).parameters.oedometer_modulus();
    volume[e] += points_.volume[p];
  }
  for (std::size_t e = 0; e < solid_.size(); ++e) {
    if (volume[e] > 0.0) volume[e] = this->grid_.volume[e] * volume[e] / stiffness[e];
  }
  return volume;
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

/// Weight of the solid at its points; of the liquid, and what loads the boundaries.
template <int Dim>
NodeVectors<Dim> MovingSkeleton<Dim>::loads(const MotionForcing& forcing,
                                            const PointsByElement& sorted,
                                            const ElementClasses& classes) const {
  const SoilMap<Dim>& soils = this->soils();
  SoilMass mass{.solid = solid_volumes(), .liquid = forcing.liquid_mass};
  for (int p = 0; p < points_.size(); ++p) {
    mass.solid[p] = (mass.solid[p] - loss_of(p)) * soils.soil_of_point(p).grain_density;
  }
  NodeVectors<Dim> result(this->grid_.mesh.node_count(), Vector<Dim>::Zero());
  add_weight(this->grid_, points_, sorted, classes, mass, soils.scene().gravity, result);
  boundary_loads_.add(sorted, forcing.end, result);
  return result;
}

template <int Dim>
void MovingSkeleton<Dim>::start_motion(const MotionForcing& forcing) {
  const PointsByElement sorted(this->grid_.mesh.element_count(), points_.element);
  const ElementClasses classes(this->grid_, points_, sorted);
  const Scene& scene = this->soils().scene();
  find_start_stress(this->grid_, skeletons(), supports_,
                    {.forces = loads(forcing, sorted, classes),
                     .pressure = forcing.pressure,
                     .gravity = scene.gravity,
                     .earth_pressure = scene.earth_pressure},
                    points_, this->threads_);
  pressure_ = forcing.pressure;
  step_.reset();
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
const SolidMotion& MovingSkeleton<Dim>::try_motion(const MotionForcing& forcing) {
  expect_losses(forcing.porosity);
  if (!step_) {
    // Pressures of water that hardly leaves magnify what is out of balance.
    constexpr NewtonLimits limits{.goal = 1e-12};
    step_ = std::make_unique<StepEquilibrium<Dim>>(this->grid_, points_, skeletons(), supports_,
                                                   this->threads_, limits);
    bubbles_ = std::make_unique<FaceBubbles<Dim>>(this->grid_, *step_);
  }
  tried_ = forcing;
  motion_ = {};
  NodeVectors<Dim> forces = loads(forcing, step_->sorted(), step_->classes());
  crossing_forces_.add(forcing.duration, forces);
  motion_.converged = step_->solve(forces, forcing.pressure, forcing.stiffness);
  motion_.iterations = step_->iterations();
  step_iterations_ += motion_.iterations;
  motion_.travel = largest_travel(this->grid_, step_->sorted(), step_->displacement());
  motion_.converged = motion_.converged && motion_.travel <= max_travel;
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
  const std::vector<double> before = smooth_volumes(this->grid_, points_, solid_volumes());
  boundary_loads_.move(step_->sorted(), step_->displacement());
  const std::vector<int> element = points_.element;
  move_points(this->grid_, step_->skeleton(), step_->displacement(), points_, this->threads_);
  find_crossing_forces();
  book_regions(element);
  carry_solid(before, motion_.travel);
  correction_ = motion_.solid_correction;
  newton_iterations_ += step_iterations_;
  step_iterations_ = 0;
  step_.reset();
  bubbles_.reset();
  loss_.clear();
  pressure_ = tried_.pressure;
  face_rate_ = motion_.solid_face_volume;
  for (double& v : face_rate_) v /= tried_.duration;
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
  std::vector<double> result = compressibility();
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
  const std::vector<double> smooth_after = smooth_volumes(this->grid_, points_, solid_volumes());
  std::vector<char> has_solid(solid_.size());
  for (std::size_t e = 0; e < solid_.size(); ++e) {
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
void MovingSkeleton<Dim>::sort_points() {
  if (!std::ranges::is_sorted(points_.element)) {
    const PointsByElement sorted(this->grid_.mesh.element_count(), points_.element);
    std::vector<int> order;
    order.reserve(points_.size());
    for (int e = 0; e < this->grid_.mesh.element_count(); ++e) {
      order.insert(order.end(), sorted.of(e).begin(), sorted.of(e).end());
    }
    const auto all = [&](auto&... values) { (reorder(order, values), ...); };
    all(start_, points_.position, points_.element, points_.reference_volume, points_.volume,
        points_.elastic_b, points_.plastic_strain, this->state_.skeleton_volume,
        this->state_.erodible_volume, this->state_.deposited_volume, this->initial_porosity_, id_,
        region_, initial_erodible_);
  }
  show_points();
  find_filling();
}

template <int Dim>
void MovingSkeleton<Dim>::show_points() {
  MaterialPoints<Dim> shown{points_.element, {}, points_.volume};
  shown.barycentric.resize(points_.size());
  for_each_index(points_.size(), this->threads_, [&](int p) {
    shown.barycentric[p] = barycentric(this->grid_.mesh, points_.element[p], points_.position[p]);
  });
  movable_soils_.move_points(std::move(shown), region_);
  this->porosity_max_.resize(points_.size());
  for (int p = 0; p < points_.size(); ++p) {
    this->porosity_max_[p] = 1.0 - this->state_.skeleton_volume[p] / points_.volume[p];
  }
  this->update_porosity();
}

template <int Dim>
void MovingSkeleton<Dim>::find_filling() {
  const PointsByElement sorted(this->grid_.mesh.element_count(), points_.element);
  const ElementClasses classes(this->grid_, points_, sorted);
  // Carried to nodes and back: the points in an element would make the drag jump as they leave it.
  const std::vector<double> volume = smooth_volumes(this->grid_, points_, points_.volume);
  const std::vector<double> solid = smooth_volumes(this->grid_, points_, solid_volumes());
  filling_.assign(solid_.size(), {});
  for (std::size_t e = 0; e < solid_.size(); ++e) {
    if (classes.full[e] == 1.0) continue;
    const double share = std::min(1.0, volume[e] / this->grid_.volume[e]);
    filling_[e] = {std::lerp(share, 1.0, classes.full[e]),
                   volume[e] > 0.0 ? 1.0 - solid[e] / volume[e] : 1.0};
  }
}

// ---------------------------------------------------------------------------------------- results

template <int Dim>
void MovingSkeleton<Dim>::describe(HistoryRow& row) const {
  const Scene& scene = movable_soils_.scene();
  Vector<Dim> down = -Vector<Dim>::UnitY();
  if (has_gravity(scene.gravity)) {
    down = Eigen::Map<const Vector<Dim>>(scene.gravity.data()).normalized();
  }
  for (int p = 0; p < points_.size(); ++p) {
    const Vector<Dim> displacement = points_.position[p] - start_[p];
    row.settlement_max = std::max(row.settlement_max, displacement.dot(down));
    row.displacement_max = std::max(row.displacement_max, displacement.norm());
  }
  row.solid_correction = correction_;
  row.newton_iterations = static_cast<double>(newton_iterations_);
}

template <int Dim>
void MovingSkeleton<Dim>::describe(Snapshot& snapshot) const {
  Field displacement{"displacement", "m", Dim, {}};
  Field stress{"effective_stress", "Pa", Dim == 2 ? 4 : 6, {}};
  Field plastic{"plastic_strain", "1", 1, points_.plastic_strain};
  Field fines{"fines_left", "1", 1, {}};
  Field volume{"volume", Dim == 2 ? "m3/m" : "m3", 1, points_.volume};
  Field element{"element", "1", 1, {points_.element.begin(), points_.element.end()}, true};
  Field id{"id", "1", 1, {id_.begin(), id_.end()}, true};
  const auto add = [](std::vector<double>& values, const auto& more) {
    values.insert(values.end(), more.begin(), more.end());
  };
  for (int p = 0; p < points_.size(); ++p) {
    add(displacement.values, Vector<Dim>(points_.position[p] - start_[p]));
    const Eigen::Matrix3d s = effective_stress(p);
    add(stress.values, std::array{s(0, 0), s(1, 1), s(2, 2), s(0, 1)});
    if (Dim == 3) add(stress.values, std::array{s(1, 2), s(0, 2)});
    fines.values.push_back(fines_left(p));
    for (int d = 0; d < 3; ++d) {
      snapshot.solid_positions.push_back(d < Dim ? points_.position[p][d] : 0.0);
    }
  }
  for (Field* field : {&displacement, &stress, &plastic, &fines, &volume, &element, &id}) {
    snapshot.solid.push_back(std::move(*field));
  }
}

template <int Dim>
void MovingSkeleton<Dim>::archive(StateArchive& archive) {
  ErodingSkeleton<Dim>::archive(archive);
  archive(points_, start_, id_, region_, initial_erodible_, this->initial_porosity_,
          boundary_loads_, crossing_forces_, solid_, region_gain_, pressure_, face_rate_, filling_,
          correction_, newton_iterations_);
  if (!archive.restores()) return;
  step_.reset();
  show_points();
}

template class MovingSkeleton<2>;
template class MovingSkeleton<3>;

}  // namespace suffuse
