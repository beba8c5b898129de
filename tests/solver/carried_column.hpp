#pragma once

/// A column whose liquid points carry the flow, without erosion: for tests and benchmarks.

#include <cmath>
#include <map>

#include "driver/plan.hpp"
#include "explicit/carried_points.hpp"
#include "explicit/explicit_flow.hpp"
#include "points/point_injection.hpp"
#include "ranks/exact_sum.hpp"
#include "solid/rigid_skeleton.hpp"
#include "solver/double_point_case.hpp"

namespace suffuse::model {

/// The paper's column with layers and displaced nodes. Water of c = 0.1 enters so fast that a point
/// crosses about a seventh of an element in a step, times `speed`.
inline Case<2> fast_column(int columns, double speed = 1.0) {
  Scene scene = double_point_scene(0.12, 5e-3);
  scene.boundaries = {flux_on("inflow", 0.12), pressure_on("outflow", 0.0)};
  scene.boundaries[0].concentration = 0.1;
  scene.flow.integration = PressureIntegration::material_point;
  scene.time.mass_scaling = 1e4 * speed * speed;
  LayerSettings layers;
  layers.inflow = layers.outflow = layers.above = layers.below = 1;
  Mesh<2> mesh = layered_mesh(columns, layers);
  // Nodes are displaced, those at the boundary only along it.
  const double size = 1.0 / columns;
  auto jitter = jittered(0.2 * size, 3);
  const double low = -2.0 * size;
  const double high = 1.0 + 2.0 * size;
  for (Vector<2>& node : mesh.nodes) {
    const Vector<2> unit(node[0], (node[1] - low) / (high - low));
    const bool inside = unit[1] > 1e-9 && unit[1] < 1.0 - 1e-9;
    const Vector<2> moved = jitter(inside ? Vector<2>(node[0], 0.5) : Vector<2>(node[0], 0.0));
    node[0] = moved[0];
    if (inside) node[1] += moved[1] - 0.5;
  }
  return make_double_point_case(std::move(mesh), scene);
}

/// A flow with the points that carry it, step by step, without erosion.
class Column {
 public:
  explicit Column(const Case<2>& c, int threads = 1)
      : case_(c),
        plan_(make_plan(c, {.threads = threads, .no_skip = false})),
        grid_(c.mesh),
        soils_(c),
        solid_(grid_, soils_, TimeSpan::never(), threads),
        porosity_(solid_.element_porosity()),
        flow_(c, grid_, solid_, plan_.flow),
        injection_(grid_, flow_.conditions(), injection_settings(c, grid_), densities_,
                   c.document.scene.liquid.bulk_modulus),
        inflow_(injection_.initial_account(c.liquid_points.size())),
        points_(grid_, densities_, threads),
        entered_(grid_.face_count(), 0.0) {
    PoreState pores;
    pores.porosity = porosity_;
    for (std::size_t e = 0; e < porosity_.size(); ++e) {
      pores.water_volume.push_back(porosity_[e] * grid_.volume[e]);
    }
    pores.concentration.assign(c.mesh.element_count(), 0.0);
    flow_.update(0.0, pores, std::vector<double>(grid_.face_count(), 0.0));
    flow_.start();
    dt = plan_.flow.step;
    LiquidPoints<2> points;
    const MaterialPoints<2>& seeds = c.liquid_points;
    points.element = seeds.element;
    points.barycentric = seeds.barycentric;
    for (int p = 0; p < seeds.size(); ++p) {
      points.id.push_back(p);
      points.water_mass.push_back(1000.0 * seeds.volume[p]);
      points.fines_mass.push_back(p % 5 * seeds.volume[p]);
      // Points also have parts that nodes and elements cannot represent.
      const Vector<2> velocity =
          interpolate(grid_, {seeds.element[p], seeds.barycentric[p]}, flow_.scheme().velocity());
      points.pressure.push_back(flow_.pressure()[seeds.element[p]] + 10.0 * std::sin(p));
      points.velocity.emplace_back((1.0 + 0.1 * std::sin(2.0 * p)) * velocity);
    }
    points_.blocks().fill(points, c.mesh.element_count());
  }

  void points_to_grid() {
    flow_.scheme().rewrite([this](VectorField<2>& velocity, std::vector<double>& pressure) {
      points_.points_to_grid(velocity, pressure);
      pressure_before_ = pressure;
    });
  }
  void step() { flow_.scheme().step(dt); }
  void grid_to_points() {
    const auto& scheme = flow_.scheme();
    flow_.node_flux(node_flux_);
    const std::vector<ArrivingPoint<2>> arriving = inject(inflow_);
    crossings_.clear();
    points_.grid_to_points(
        {scheme.previous_velocity(), scheme.velocity(), pressure_before_, scheme.pressure()},
        walk_field(), dt, arriving, crossings_);
    for (const PointCrossing& point : crossings_) {
      crossed[{point.from, point.to}] += point.water_mass;
      if (point.from < 0) fines_in.add(point.fines_mass);
      if (point.to < 0) fines_in.add(-point.fines_mass);
      if (point.left_by >= 0) account_for(point, inflow_);
      ++count;
    }
  }
  void move() {
    points_to_grid();
    step();
    grid_to_points();
  }

  /// Points that enter in the last step of the flow; called after `grid_to_points` or by it.
  std::vector<ArrivingPoint<2>> inject(InflowAccount& inflow) {
    for (const int f : injection_.open_faces()) entered_[f] = dt * flow_.flux_through(f);
    std::vector<InjectedPoint<2>> injected;
    injection_.inject(inflow, entered_, node_flux_, injected);
    std::vector<ArrivingPoint<2>> arriving;
    for (const InjectedPoint<2>& in : injected) {
      const double pressure = flow_.pressure()[in.place.element];
      const auto [water_mass, fines_mass] = injection_.content(in, pressure);
      arriving.push_back({in.place,
                          {{in.place.barycentric[0], in.place.barycentric[1]},
                           interpolate(grid_, in.place, flow_.scheme().velocity()),
                           pressure,
                           water_mass,
                           fines_mass,
                           inflow.next_id++},
                          (1.0 - in.share) * dt,
                          in.face});
    }
    return arriving;
  }
  /// Books the volume of a point that left through an outer face.
  static void account_for(const PointCrossing& point, InflowAccount& inflow) {
    inflow.volume[point.left_by] +=
        liquid_volume(point.water_mass, point.fines_mass, densities_, 1.0);
  }
  /// The field in which points move in the last step of the flow.
  [[nodiscard]] WalkField<2> walk_field() const {
    return {node_flux_, porosity_, injection_.is_open()};
  }

  [[nodiscard]] LiquidPoints<2> points() const { return points_.blocks().points(); }
  [[nodiscard]] const CarriedPoints<2>& carried() const { return points_; }
  [[nodiscard]] const Grid<2>& grid() const { return grid_; }
  [[nodiscard]] ExplicitFlow<2>& flow() { return flow_; }
  [[nodiscard]] const InflowAccount& inflow() const { return inflow_; }

  static constexpr LiquidDensities densities_{1000.0, 2700.0};
  double dt = 0.0;                                ///< s
  std::map<std::pair<int, int>, double> crossed;  ///< water mass, by pairs of regions
  ExactSum fines_in;                              ///< net mass of fines that entered, kg
  long count = 0;

 private:
  const Case<2>& case_;
  Plan plan_;
  Grid<2> grid_;
  SoilMap<2> soils_;
  RigidSkeleton<2> solid_;
  std::vector<double> porosity_;
  ExplicitFlow<2> flow_;
  PointInjection<2> injection_;
  InflowAccount inflow_;
  CarriedPoints<2> points_;
  std::vector<double> entered_;
  std::vector<double> pressure_before_;
  VectorField<2> node_flux_;
  std::vector<PointCrossing> crossings_;
};

}  // namespace suffuse::model
