#include "transport/carried_points.hpp"

#include <algorithm>
#include <utility>

namespace suffuse {
namespace {

/// Elements that one thread passes over at a time.
constexpr int passed_together = 64;
/// Elements between the one whose points are handled and the one whose points are fetched: blocks
/// that moved are where no processor expects them.
constexpr int looked_ahead = 4;
/// Below this many elements a pass is over before other threads are awake.
constexpr int worth_threads_of_points = 512;

double sum(const SimdDouble4& lanes) {
  return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
}

/// Not returned: without registers that long, compilers would have it pass in different ways.
void lower(SimdDouble4& lowest, const SimdDouble4& values) {
  lowest = values < lowest ? values : lowest;
}

bool any_at_or_below_zero(const SimdDouble4& lanes) {
  return std::min(std::min(lanes[0], lanes[1]), std::min(lanes[2], lanes[3])) <= 0.0;
}

/// All Dim + 1 barycentric coordinates of four points.
template <int Dim>
std::array<SimdDouble4, Dim + 1> coordinates(const std::array<SimdDouble4, Dim>& at) {
  std::array<SimdDouble4, Dim + 1> result;
  result[Dim] = SimdDouble4{} + 1.0;
  for (int a = 0; a < Dim; ++a) {
    result[a] = at[a];
    result[Dim] -= at[a];
  }
  return result;
}

}  // namespace

template <int Dim>
CarriedPoints<Dim>::CarriedPoints(const Grid<Dim>& grid, LiquidDensities densities, int threads)
    : grid_(grid),
      densities_(densities),
      threads_(threads),
      corners_(grid.mesh.elements.size() * (Dim + 1)),
      departures_((grid.mesh.elements.size() + passed_together - 1) / passed_together + 1),
      without_room_(threads) {
  node_corner_.reserve(corners_.size());
  for (int i = 0; i < grid.mesh.node_count(); ++i) {
    for (int k = grid.node_element_begin[i]; k < grid.node_element_begin[i + 1]; ++k) {
      const int e = grid.node_element[k];
      for (int a = 0; a <= Dim; ++a) {
        if (grid.mesh.elements[e][a] == i) node_corner_.push_back(e * (Dim + 1) + a);
      }
    }
  }
}

template <int Dim>
long CarriedPoints<Dim>::travelled() const {
  std::size_t sum = 0;
  for (const Departures& departures : departures_) sum += departures.travellers.size();
  return static_cast<long>(sum);
}

template <int Dim>
void CarriedPoints<Dim>::points_to_grid(VectorField<Dim>& velocity, std::vector<double>& pressure) {
  const int elements = grid_.mesh.element_count();
  const int nodes = grid_.mesh.node_count();
#pragma omp parallel num_threads(threads_) if (elements > worth_threads_of_points)
  {
#pragma omp for schedule(static)
    for (int e = 0; e < elements; ++e) {
      blocks_.prefetch(e + looked_ahead);
      element_to_corners(e, pressure[e]);
    }
    // Each node adds up its corners in their order, whichever thread made them.
#pragma omp for schedule(static)
    for (int i = 0; i < nodes; ++i) {
      double mass = 0.0;
      Vector<Dim> momentum = Vector<Dim>::Zero();
      for (int k = grid_.node_element_begin[i]; k < grid_.node_element_begin[i + 1]; ++k) {
        const Corner& corner = corners_[node_corner_[k]];
        mass += corner.mass;
        momentum += corner.momentum;
      }
      if (mass > 0.0) velocity[i] = momentum / mass;
    }
  }
}

template <int Dim>
void CarriedPoints<Dim>::element_to_corners(int element, double& pressure) {
  std::array<SimdDouble4, Dim + 1> mass{};
  std::array<std::array<SimdDouble4, Dim>, Dim + 1> momentum{};
  SimdDouble4 volume{};
  SimdDouble4 work{};
  const double water_volume = 1.0 / densities_.water;
  const double grain_volume = 1.0 / densities_.grain;
  for (const PointQuad<Dim>& quad : std::as_const(blocks_).quads(element)) {
    const std::array<SimdDouble4, Dim + 1> at = coordinates<Dim>(quad.at);
    for (int a = 0; a <= Dim; ++a) {
      const SimdDouble4 share = at[a] * (quad.water_mass + quad.fines_mass);
      mass[a] += share;
      for (int d = 0; d < Dim; ++d) momentum[a][d] += share * quad.velocity[d];
    }
    const SimdDouble4 v = quad.water_mass * water_volume + quad.fines_mass * grain_volume;
    volume += v;
    work += v * quad.pressure;
  }
  for (int a = 0; a <= Dim; ++a) {
    Corner& corner = corners_[element * (Dim + 1) + a];
    corner.mass = sum(mass[a]);
    for (int d = 0; d < Dim; ++d) corner.momentum[d] = sum(momentum[a][d]);
  }
  const double all = sum(volume);
  if (all > 0.0) pressure = sum(work) / all;
}

template <int Dim>
auto CarriedPoints<Dim>::element_step(int element, const FlowChange<Dim>& change,
                                      const WalkField<Dim>& field, double duration) const
    -> ElementStep {
  ElementStep step;
  const auto& nodes = grid_.mesh.elements[element];
  const auto& gradient = grid_.shape_gradient[element];
  // A point's velocity u is linear in its place, and so is the way it goes at the velocity of its
  // midpoint, t u + t^2/2 (grad u) u.
  std::array<Vector<Dim>, Dim + 1> velocity;
  Eigen::Matrix<double, Dim, Dim> velocity_gradient = Eigen::Matrix<double, Dim, Dim>::Zero();
  for (int b = 0; b <= Dim; ++b) {
    const int i = nodes[b];
    step.gain[b] = change.velocity[i] - change.velocity_before[i];
    velocity[b] = field.node_flux[i] / field.porosity[element];
    velocity_gradient += velocity[b] * gradient[b].transpose();
  }
  step.pressure_gain = change.pressure[element] - change.pressure_before[element];
  for (int b = 0; b <= Dim; ++b) {
    const Vector<Dim> way =
        duration * (velocity[b] + 0.5 * duration * velocity_gradient * velocity[b]);
    for (int a = 0; a < Dim; ++a) step.drift[a][b] = gradient[a].dot(way);
  }
  return step;
}

template <int Dim>
void CarriedPoints<Dim>::move_element(int element, const ElementStep& step,
                                      const WalkField<Dim>& field, double duration,
                                      Departures& departures) {
  departures.leaving.clear();
  int slot = 0;
  for (PointQuad<Dim>& quad : blocks_.quads(element)) {
    const std::array<SimdDouble4, Dim> before = quad.at;
    const std::array<SimdDouble4, Dim + 1> at = coordinates<Dim>(before);
    for (int b = 0; b <= Dim; ++b) {
      for (int d = 0; d < Dim; ++d) {
        quad.velocity[d] += at[b] * step.gain[b][d];
        quad.at[d] += at[b] * step.drift[d][b];
      }
    }
    quad.pressure += step.pressure_gain;
    SimdDouble4 lowest = coordinates<Dim>(quad.at)[Dim];
    for (const SimdDouble4& coordinate : quad.at) lower(lowest, coordinate);
    if (any_at_or_below_zero(lowest)) {
      for (int lane = 0; lane < simd_width; ++lane) {
        if (lowest[lane] <= 0.0) departures.leaving.push_back({slot + lane, before});
      }
    }
    slot += simd_width;
  }
  // From the last on: no point that stays takes the slot of one that is still to leave.
  for (auto gone = departures.leaving.rbegin(); gone != departures.leaving.rend(); ++gone) {
    if (gone->slot >= blocks_.count(element)) continue;
    CarriedPoint<Dim> point = blocks_.remove(element, gone->slot);
    for (int a = 0; a < Dim; ++a) point.at[a] = gone->before[a][gone->slot % simd_width];
    send({element, all_coordinates<Dim>(point.at)}, point, grid_.mesh.element_region[element],
         field, duration, departures);
  }
  blocks_.recentre_empty(element);
}

template <int Dim>
void CarriedPoints<Dim>::send(PointPlace<Dim> place, CarriedPoint<Dim> point, int from_region,
                              const WalkField<Dim>& field, double time,
                              Departures& departures) const {
  const int left_by = walk(grid_, field, place, time, point.id);
  const int to_region = left_by >= 0 ? -1 : grid_.mesh.element_region[place.element];
  if (from_region != to_region || left_by >= 0) {
    // A point that enters and leaves at once counts in both directions.
    departures.crossings.push_back(
        {from_region, to_region, left_by, point.water_mass, point.fines_mass});
  }
  if (left_by >= 0) return;
  std::copy_n(place.barycentric.begin(), Dim, point.at.begin());
  departures.travellers.push_back({place.element, point});
}

template <int Dim>
void CarriedPoints<Dim>::grid_to_points(const FlowChange<Dim>& change, const WalkField<Dim>& field,
                                        double duration,
                                        const std::vector<ArrivingPoint<Dim>>& arriving,
                                        std::vector<CarriedCrossing>& crossings) {
  const int elements = grid_.mesh.element_count();
  const auto together = static_cast<int>(departures_.size()) - 1;
#pragma omp parallel for schedule(static) \
    num_threads(threads_) if (elements > worth_threads_of_points)
  for (int k = 0; k < together; ++k) {
    Departures& departures = departures_[k];
    departures.travellers.clear();
    departures.crossings.clear();
    try {
      const int end = std::min(elements, (k + 1) * passed_together);
      for (int e = k * passed_together; e < end; ++e) {
        blocks_.prefetch(e + looked_ahead);
        if (blocks_.count(e) == 0) continue;
        move_element(e, element_step(e, change, field, duration), field, duration, departures);
      }
    } catch (...) {
      departures.failure = std::current_exception();
    }
  }
  Departures& from_outside = departures_.back();
  from_outside.travellers.clear();
  from_outside.crossings.clear();
  for (const ArrivingPoint<Dim>& newcomer : arriving) {
    send(newcomer.place, newcomer.point, -1, field, newcomer.time, from_outside);
  }
  for (const Departures& departures : departures_) {
    if (departures.failure) std::rethrow_exception(departures.failure);
    crossings.insert(crossings.end(), departures.crossings.begin(), departures.crossings.end());
  }
  let_in();
}

template <int Dim>
void CarriedPoints<Dim>::let_in() {
  // Each thread fills elements of its own, in the order of the lists.
  const long elements = grid_.mesh.element_count();
#pragma omp parallel for schedule(static) \
    num_threads(threads_) if (elements > worth_threads_of_points)
  for (int thread = 0; thread < threads_; ++thread) {
    const auto begin = static_cast<int>(elements * thread / threads_);
    const auto end = static_cast<int>(elements * (thread + 1) / threads_);
    without_room_[thread].clear();
    for (const Departures& departures : departures_) {
      for (const Traveller& traveller : departures.travellers) {
        if (traveller.to < begin || traveller.to >= end) continue;
        if (!blocks_.add(traveller.to, traveller.point)) {
          without_room_[thread].push_back(traveller);
        }
      }
    }
  }
  for (const std::vector<Traveller>& travellers : without_room_) {
    for (const Traveller& traveller : travellers) {
      blocks_.add_growing(traveller.to, traveller.point);
    }
  }
}

template class CarriedPoints<2>;

}  // namespace suffuse
