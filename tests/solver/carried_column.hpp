#pragma once

/// A column whose liquid points carry the flow, without erosion: for tests and benchmarks.

#include <cmath>
#include <map>

#include "driver/plan.hpp"
#include "grid/compensated_sum.hpp"
#include "solver/double_point_case.hpp"
#include "transport/carried_liquid.hpp"

namespace suffuse::model {

/// The paper's column with layers, nodes off their places, water of c = 0.1 entering so fast that a
/// point crosses about a seventh of an element in a step, or of that the share `speed`.
inline Case<2> fast_column(int columns, double speed = 1.0) {
  Scene scene = double_point_scene(0.12, 5e-3);
  scene.boundaries = {flux_on("inflow", 0.12), pressure_on("outflow", 0.0)};
  scene.boundaries[0].concentration = 0.1;
  scene.flow.integration = PressureIntegration::material_point;
  scene.time.mass_scaling = 1e4 * speed * speed;
  LayerSettings layers;
  layers.inflow = layers.outflow = layers.above = layers.below = 1;
  Mesh<2> mesh = layered_mesh(columns, layers);
  // Nodes off their places, those at the boundary along it at most.
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

/// A flow with its liquid, as the double-point model has it, without erosion.
class Column {
 public:
  explicit Column(const Case<2>& c, int threads = 1)
      : case_(c),
        plan_(make_plan(c, {.threads = threads, .no_skip = false})),
        grid_(c.mesh),
        skeleton_(c, grid_),
        flow_(c, grid_, skeleton_, plan_.flow),
        transport_(grid_, flow_.conditions(), births(), densities_,
                   c.document.scene.liquid.bulk_modulus, threads),
        entering_(transport_.nothing_entered(c.liquid_points.size())),
        liquid_(grid_, flow_, transport_, densities_, threads, entering_) {
    PoreState pores;
    for (const auto& volume : skeleton_.initial_pore_volume()) {
      pores.water_volume.push_back(element_sum<2>(volume));
    }
    for (int e = 0; e < c.mesh.element_count(); ++e) {
      pores.porosity.push_back(pores.water_volume[e] / grid_.volume[e]);
    }
    pores.concentration.assign(c.mesh.element_count(), 0.0);
    flow_.update(0.0, pores, std::vector<double>(grid_.face_count(), 0.0));
    flow_.start();
    dt = plan_.flow.step;
    porosity_ = pores.porosity;
    liquid_.set_porosity(pores.porosity);
    liquid_.on_moved = [this](const std::vector<CarriedCrossing>& crossings) {
      for (const CarriedCrossing& c1 : crossings) {
        crossed[{c1.from, c1.to}] += c1.water_mass;
        if (c1.from < 0) fines_in.add(c1.fines_mass);
        if (c1.to < 0) fines_in.add(-c1.fines_mass);
        ++count;
      }
    };
    LiquidPoints<2> points;
    const MaterialPoints<2>& seeds = c.liquid_points;
    points.element = seeds.element;
    points.barycentric = seeds.barycentric;
    for (int p = 0; p < seeds.size(); ++p) {
      points.id.push_back(p);
      points.water_mass.push_back(1000.0 * seeds.volume[p]);
      points.fines_mass.push_back(p % 5 * seeds.volume[p]);
      // What neither node nor element sees belongs to it too.
      const int e = seeds.element[p];
      Vector<2> velocity = Vector<2>::Zero();
      for (int a = 0; a < 3; ++a) {
        velocity += seeds.barycentric[p][a] * flow_.scheme().velocity()[c.mesh.elements[e][a]];
      }
      points.pressure.push_back(flow_.pressure()[e] + 10.0 * std::sin(p));
      points.velocity.emplace_back((1.0 + 0.1 * std::sin(2.0 * p)) * velocity);
    }
    liquid_.blocks().fill(points, c.mesh.element_count());
  }

  void give() { liquid_.give(0.0, dt); }
  void step() { flow_.scheme().step(dt); }
  void take() { liquid_.take(); }

  void move() {
    give();
    step();
    take();
  }

  [[nodiscard]] LiquidPoints<2> points() const { return liquid_.blocks().points(false); }
  [[nodiscard]] const Grid<2>& grid() const { return grid_; }
  [[nodiscard]] ExplicitFlow<2>& flow() { return flow_; }
  [[nodiscard]] const LagrangianTransport<2>& transport() const { return transport_; }
  [[nodiscard]] const std::vector<double>& porosity() const { return porosity_; }
  [[nodiscard]] const InflowAccount& entering() const { return entering_; }
  [[nodiscard]] const CarriedLiquid<2>& liquid() const { return liquid_; }

  static constexpr LiquidDensities densities_{1000.0, 2700.0};
  double dt = 0.0;                                ///< s
  std::map<std::pair<int, int>, double> crossed;  ///< water, by regions
  CompensatedSum fines_in;                        ///< less those that left, kg
  long count = 0;

 private:
  [[nodiscard]] InjectionSettings births() const {
    std::vector<double> volume(grid_.mesh.element_count(), 0.0);
    std::vector<int> points(grid_.mesh.element_count(), 0);
    for (int p = 0; p < case_.liquid_points.size(); ++p) {
      volume[case_.liquid_points.element[p]] += case_.liquid_points.volume[p];
      ++points[case_.liquid_points.element[p]];
    }
    InjectionSettings result;
    for (const int e : grid_.face_left) {
      result.point_volume.push_back(volume[e] / points[e]);
      result.points_per_element.push_back(points[e]);
    }
    return result;
  }

  const Case<2>& case_;
  Plan plan_;
  Grid<2> grid_;
  RigidSkeleton<2> skeleton_;
  ExplicitFlow<2> flow_;
  LagrangianTransport<2> transport_;
  InflowAccount entering_;
  CarriedLiquid<2> liquid_;
  std::vector<double> porosity_;
};

}  // namespace suffuse::model
