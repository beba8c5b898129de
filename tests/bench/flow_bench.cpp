/// The explicit flow: its two passes and the whole step, and the plain loops it is tested against.

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "bench/bench.hpp"
#include "explicit/explicit_nodal.hpp"
#include "explicit/stability_limit.hpp"
#include "solver/nodal_reference.hpp"
#include "verification/free_mesh.hpp"

namespace suffuse::bench {
namespace {

constexpr int points_per_element = 3;
constexpr double modulus = 2.0e7;

/// A square of the paper's soil, water running down through it.
struct FlowSquare {
  explicit FlowSquare(Mesh<2> mesh)
      : c(model::make_case(std::move(mesh), scene())),
        grid(c.mesh),
        coefficients(model::flow_coefficients(grid, 0.02)),
        op(grid, face_conditions(c, grid), Vector<2>::Zero()) {
    op.update(coefficients);
    dt = 0.5 * stability_limit(grid, coefficients, op.node_porosity(), modulus, 1.0,
                               DragIntegration::explicit_drag)
                   .step;
  }
  static Scene scene() {
    Scene scene = model::paper_scene();
    scene.boundaries = {model::pressure_on("top", 6000.0), model::pressure_on("bottom", 0.0)};
    return scene;
  }
  [[nodiscard]] ExplicitSettings settings(int threads, bool double_point) const {
    ExplicitSettings settings;
    settings.bulk_modulus = modulus;
    settings.pressure_moves_with_liquid = double_point;
    settings.threads = threads;
    return settings;
  }
  template <class Scheme>
  void start(Scheme& scheme) const {
    scheme.update(coefficients);
    for (int s = 0; s < 10; ++s) scheme.step(dt);
  }

  Case<2> c;
  Grid<2> grid;
  FlowCoefficients<2> coefficients;
  NodalOperator<2> op;
  double dt = 0.0;
};

/// `cells`: squares of two triangles, in rows; `free_mesh`: Gmsh's triangles as the mesher numbers
/// them.
enum MeshKind { cells, free_mesh };

Mesh<2> mesh_of(long elements, MeshKind kind) {
  const double side = std::sqrt(0.5 * static_cast<double>(elements));
  if (kind == cells) {
    return model::column_mesh(static_cast<int>(side), static_cast<int>(side));
  }
  return model::free_mesh(1.07 / side);
}

/// Squares with about `elements` elements; made once.
const FlowSquare& square(long elements, MeshKind kind) {
  static std::map<std::pair<long, MeshKind>, std::unique_ptr<FlowSquare>> made;
  auto& result = made[{elements, kind}];
  if (result == nullptr) result = std::make_unique<FlowSquare>(mesh_of(elements, kind));
  return *result;
}

enum Pass { nodes, faces, elements, step };

void Flow(benchmark::State& state, Pass pass, bool double_point, MeshKind kind) {
  const FlowSquare& s = square(state.range(0), kind);
  const auto threads = static_cast<int>(state.range(1));
  ExplicitNodal<2> flow(s.op, s.settings(threads, double_point));
  s.start(flow);
  for ([[maybe_unused]] const auto iteration : state) {
    if (pass == step) flow.step(s.dt);
    if (pass == nodes) flow.accelerate(s.dt);
    if (pass == faces) flow.cross_faces(s.dt);
    if (pass == elements) flow.compress(s.dt);
  }
  const double points = points_per_element * static_cast<double>(s.grid.mesh.element_count());
  report(state, points, 0.0, threads);
}

void Reference(benchmark::State& state, MeshKind kind) {
  const FlowSquare& s = square(state.range(0), kind);
  model::NodalReference<2> flow(s.op, s.settings(1, false));
  s.start(flow);
  for ([[maybe_unused]] const auto iteration : state) flow.step(s.dt);
  report(state, points_per_element * static_cast<double>(s.grid.mesh.element_count()), 0.0, 1);
}

void sizes(benchmark::internal::Benchmark* b) {
  b->ArgNames({"elements", "threads"})
      ->ArgsProduct({{3000, 30000, 100000, 333000}, {1, 2}})
      ->UseRealTime();
}

void reference_sizes(benchmark::internal::Benchmark* b) {
  b->ArgNames({"elements", "threads"})->ArgsProduct({{3000, 30000, 333000}, {1}})->UseRealTime();
}

BENCHMARK_CAPTURE(Flow, nodes, nodes, false, cells)->Apply(sizes);
BENCHMARK_CAPTURE(Flow, faces, faces, false, cells)->Apply(sizes);
BENCHMARK_CAPTURE(Flow, elements, elements, false, cells)->Apply(sizes);
BENCHMARK_CAPTURE(Flow, elements_double_point, elements, true, cells)->Apply(sizes);
BENCHMARK_CAPTURE(Flow, step, step, false, cells)->Apply(sizes);
BENCHMARK_CAPTURE(Flow, step_double_point, step, true, cells)->Apply(sizes);
BENCHMARK_CAPTURE(Flow, step_free_mesh, step, false, free_mesh)->Apply(sizes);
BENCHMARK_CAPTURE(Reference, step, cells)->Apply(reference_sizes);
BENCHMARK_CAPTURE(Reference, step_free_mesh, free_mesh)->Apply(reference_sizes);
BENCHMARK_CAPTURE(Flow, quick, step, false, cells)
    ->Name("QuickFlow")
    ->Args({3000, 1})
    ->UseRealTime();

}  // namespace
}  // namespace suffuse::bench
