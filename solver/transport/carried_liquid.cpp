#include "transport/carried_liquid.hpp"

#include <algorithm>

#include "results/pass_timer.hpp"

namespace suffuse {
namespace {

template <int Dim, class Values>
auto interpolated(const Grid<Dim>& grid, const PointPlace<Dim>& place, const Values& at_nodes) {
  const auto& nodes = grid.mesh.elements[place.element];
  auto value = at_nodes[nodes[0]];
  value *= place.barycentric[0];
  for (int a = 1; a <= Dim; ++a) value += place.barycentric[a] * at_nodes[nodes[a]];
  return value;
}

}  // namespace

template <int Dim>
CarriedLiquid<Dim>::CarriedLiquid(const Grid<Dim>& grid, ExplicitFlow<Dim>& flow,
                                  const LagrangianTransport<Dim>& transport,
                                  LiquidDensities densities, int threads, InflowAccount& entering)
    : grid_(grid),
      flow_(flow),
      transport_(transport),
      densities_(densities),
      points_(grid, densities, threads),
      entering_(entering) {
  motion_.entered.assign(grid.face_count(), 0.0);
  flow.set_carrier(*this);
}

template <int Dim>
void CarriedLiquid<Dim>::give(double time, double dt) {
  const PassTimer timer(exchange_);
  ++exchange_.calls;
  step_begin_ = time;
  dt_ = dt;
  flow_.scheme().rewrite([this](VectorField<Dim>& velocity, std::vector<double>& pressure) {
    points_.gather(velocity, pressure);
    pressure_before_ = pressure;
  });
}

template <int Dim>
void CarriedLiquid<Dim>::find_motion(LiquidMotion<Dim>& motion) const {
  motion.duration = dt_;
  flow_.node_flux(motion.node_flux);
  for (const int f : transport_.open_faces()) motion.entered[f] = dt_ * flow_.flux_through(f);
}

template <int Dim>
void CarriedLiquid<Dim>::take() {
  const PassTimer timer(movement_);
  ++movement_.calls;
  find_motion(motion_);
  let_in();
  const auto& scheme = flow_.scheme();
  crossings_.clear();
  points_.take_and_move(
      {scheme.previous_velocity(), scheme.velocity(), pressure_before_, scheme.pressure()},
      {motion_.node_flux, porosity_, transport_.is_open()}, dt_, arriving_, crossings_);
  for (const CarriedCrossing& crossing : crossings_) {
    if (crossing.left_by < 0) continue;
    entering_.volume[crossing.left_by] +=
        liquid_volume(crossing.water_mass, crossing.fines_mass, densities_, 1.0);
  }
  on_moved(crossings_);
}

template <int Dim>
void CarriedLiquid<Dim>::let_in() {
  const auto& scheme = flow_.scheme();
  born_.clear();
  arriving_.clear();
  transport_.births(entering_, motion_, born_);
  for (const InjectedPoint<Dim>& newborn : born_) {
    const double pressure = scheme.pressure()[newborn.place.element];
    const auto [water_mass, fines_mass] = transport_.content(newborn, pressure);
    CarriedPoint<Dim> point;
    std::copy_n(newborn.place.barycentric.begin(), Dim, point.at.begin());
    point.velocity = interpolated<Dim>(grid_, newborn.place, scheme.velocity());
    point.pressure = pressure;
    point.water_mass = water_mass;
    point.fines_mass = point.fines_noted = fines_mass;
    point.id = entering_.next_id++;
    arriving_.push_back({newborn.place, point, (1.0 - newborn.share) * dt_});
  }
}

template <int Dim>
std::vector<PointCrossing> CarriedLiquid<Dim>::look(double time, bool fines_as_noted,
                                                    LiquidPoints<Dim>& points,
                                                    InflowAccount& entering) const {
  const double share = (time - step_begin_) / dt_;
  LiquidMotion<Dim> motion{{}, std::vector<double>(grid_.face_count(), 0.0), 0.0};
  find_motion(motion);
  motion.duration *= share;
  for (double& volume : motion.entered) volume *= share;

  const auto& scheme = flow_.scheme();
  points = blocks().points(fines_as_noted);
  for (int p = 0; p < points.size(); ++p) {
    const int e = points.element[p];
    const PointPlace<Dim> place = points.place(p);
    points.pressure[p] += share * (scheme.pressure()[e] - pressure_before_[e]);
    points.velocity[p] += share * (interpolated<Dim>(grid_, place, scheme.velocity()) -
                                   interpolated<Dim>(grid_, place, scheme.previous_velocity()));
  }
  return transport_.move(points, entering, motion, porosity_, scheme.pressure(), scheme.velocity());
}

template class CarriedLiquid<2>;

}  // namespace suffuse
