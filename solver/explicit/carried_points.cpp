#include "explicit/carried_points.hpp"

#include <algorithm>
#include <utility>

namespace suffuse {
namespace {

/// Number of elements that one thread handles together.
constexpr int elements_together = 64;
/// Points are fetched from memory this number of elements before they move.
constexpr int elements_ahead = 4;
/// A loop over fewer elements ends before other threads are awake.
constexpr int worth_threads_of_points = 512;

}  // namespace

template <int Dim>
CarriedPoints<Dim>::CarriedPoints(const Grid<Dim>& grid, LiquidDensities densities, int threads)
    : grid_(grid),
      densities_(densities),
      threads_(threads),
      corners_(grid.mesh.elements.size() * (Dim + 1)),
      departures_((grid.mesh.elements.size() + elements_together - 1) / elements_together + 1) {
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
    for (int e = 0; e < elements; ++e) points_to_corners(e, pressure[e]);
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

/// Sums over the points of an element, p: m_p N_a(x_p) and m_p N_a(x_p) v_p for each node a,
/// V_p and V_p p_p for the element.
template <int Dim>
void CarriedPoints<Dim>::points_to_corners(int element, double& pressure) {
  std::array<Corner, Dim + 1> corners;
  for (Corner& corner : corners) corner = {0.0, Vector<Dim>::Zero()};
  double volume = 0.0;
  double work = 0.0;
  const double water_volume = 1.0 / densities_.water;
  const double grain_volume = 1.0 / densities_.grain;
  for (const CarriedPoint<Dim>& point : std::as_const(blocks_).of(element)) {
    const std::array<double, Dim + 1> at = all_coordinates<Dim>(point.at);
    const double mass = point.water_mass + point.fines_mass;
    for (int a = 0; a <= Dim; ++a) {
      corners[a].mass += at[a] * mass;
      corners[a].momentum += at[a] * mass * point.velocity;
    }
    const double v = point.water_mass * water_volume + point.fines_mass * grain_volume;
    volume += v;
    work += v * point.pressure;
  }
  std::copy(corners.begin(), corners.end(), &corners_[element * (Dim + 1)]);
  if (volume > 0.0) pressure = work / volume;
}

template <int Dim>
auto CarriedPoints<Dim>::element_step(int element, const FlowChange<Dim>& change,
                                      const WalkField<Dim>& field, double duration) const
    -> ElementStep {
  ElementStep step;
  const auto& nodes = grid_.mesh.elements[element];
  const auto& gradient = grid_.shape_gradient[element];
  // A point's velocity u is linear in space, and so is its way at the velocity of its midpoint, t u
  // + t^2/2 (grad u) u.
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
void CarriedPoints<Dim>::move_points(int element, const ElementStep& step,
                                     const WalkField<Dim>& field, double duration,
                                     Departures& departures) {
  // From the last one on: the slot of a point that leaves goes to one that has moved already.
  for (int slot = blocks_.count(element) - 1; slot >= 0; --slot) {
    CarriedPoint<Dim>& point = blocks_.of(element)[slot];
    const std::array<double, Dim + 1> before = all_coordinates<Dim>(point.at);
    std::array<double, Dim> after = point.at;
    for (int b = 0; b <= Dim; ++b) {
      point.velocity += before[b] * step.gain[b];
      for (int a = 0; a < Dim; ++a) after[a] += before[b] * step.drift[a][b];
    }
    point.pressure += step.pressure_gain;
    const bool leaves = std::ranges::min(all_coordinates<Dim>(after)) <= 0.0;
    if (leaves) {
      send({element, before}, blocks_.remove(element, slot),
           {grid_.mesh.element_region[element], -1}, field, duration, departures);
    } else {
      point.at = after;
    }
  }
}

template <int Dim>
void CarriedPoints<Dim>::send(PointPlace<Dim> place, CarriedPoint<Dim> point, Origin origin,
                              const WalkField<Dim>& field, double time,
                              Departures& departures) const {
  const int left_by = walk(grid_, field, place, time, point.id);
  const int to_region = left_by >= 0 ? -1 : grid_.mesh.element_region[place.element];
  if (origin.region != to_region || left_by >= 0) {
    // A point that enters and leaves at once counts in both directions.
    departures.crossings.push_back(
        {origin.region, to_region, origin.entered_by, left_by, point.water_mass, point.fines_mass});
  }
  if (left_by >= 0) return;
  std::copy_n(place.barycentric.begin(), Dim, point.at.begin());
  departures.travellers.push_back({place.element, point});
}

template <int Dim>
void CarriedPoints<Dim>::grid_to_points(const FlowChange<Dim>& change, const WalkField<Dim>& field,
                                        double duration,
                                        const std::vector<ArrivingPoint<Dim>>& arriving,
                                        std::vector<PointCrossing>& crossings) {
  const int elements = grid_.mesh.element_count();
  const auto together = static_cast<int>(departures_.size()) - 1;
#pragma omp parallel for schedule(static) \
    num_threads(threads_) if (elements > worth_threads_of_points)
  for (int k = 0; k < together; ++k) {
    Departures& departures = departures_[k];
    departures.travellers.clear();
    departures.crossings.clear();
    try {
      const int end = std::min(elements, (k + 1) * elements_together);
      for (int e = k * elements_together; e < end; ++e) {
        blocks_.prefetch(e + elements_ahead);
        if (blocks_.count(e) == 0) continue;
        move_points(e, element_step(e, change, field, duration), field, duration, departures);
      }
    } catch (...) {
      departures.failure = std::current_exception();
    }
  }
  Departures& from_outside = departures_.back();
  from_outside.travellers.clear();
  from_outside.crossings.clear();
  for (const ArrivingPoint<Dim>& newcomer : arriving) {
    send(newcomer.place, newcomer.point, {-1, newcomer.face}, field, newcomer.time, from_outside);
  }
  for (const Departures& departures : departures_) {
    if (departures.failure) std::rethrow_exception(departures.failure);
    crossings.insert(crossings.end(), departures.crossings.begin(), departures.crossings.end());
  }
  put_into_elements();
}

template <int Dim>
void CarriedPoints<Dim>::put_into_elements() {
  // Each thread fills elements of its own, in the order of the lists.
  const long elements = grid_.mesh.element_count();
#pragma omp parallel for schedule(static) \
    num_threads(threads_) if (elements > worth_threads_of_points)
  for (int thread = 0; thread < threads_; ++thread) {
    const auto begin = static_cast<int>(elements * thread / threads_);
    const auto end = static_cast<int>(elements * (thread + 1) / threads_);
    for (const Departures& departures : departures_) {
      for (const Traveller& traveller : departures.travellers) {
        if (traveller.to >= begin && traveller.to < end) {
          blocks_.add(traveller.to, traveller.point);
        }
      }
    }
  }
}

template class CarriedPoints<2>;

}  // namespace suffuse
