/// Closed solutions in three dimensions: discharges into a well, from a sphere and from a flooded
/// disc; infiltration and deposition in a column of tetrahedra.

#include <cmath>
#include <functional>
#include <iostream>
#include <limits>
#include <numbers>
#include <vector>

#include "mixed/implicit_mixed.hpp"
#include "reference_table.hpp"
#include "scene_run.hpp"
#include "solver/flow_model.hpp"
#include "test_paths.hpp"

namespace suffuse {
namespace space_references_test {

using model::SceneRun;
using std::numbers::pi;

Mesh<3> mesh_of(const std::string& file, double size) {
  const SceneDocument document = parse_scene(R"(
formulation = "single-point"
[geometry]
file = ")" + test::data_folder() + "/geometry/" + file +
                                                 R"("
[mesh]
size = )" + std::to_string(size) + R"(
[liquid]
density = 1000.0
bulk_modulus = inf
viscosity = 1.0e-3
[soil.specimen]
porosity = 0.3
skeleton_fraction = 0.6
grain_density = 2700.0
conductivity = 0.02
[time]
end = 1.0
[output]
every = 1.0
)",
                                             "scene.toml");
  return build_geometry_of<3>(document).mesh;
}

/// Steady flow with the pressure `value` of the place, Pa, on the boundaries that are `open`.
struct Flow {
  Flow(const std::string& file, double size, const std::vector<std::string>& open,
       const std::function<double(const Vector<3>&)>& value)
      : model(mesh_of(file, size)) {
    for (const auto& boundary : model.mesh.boundaries) {
      if (std::ranges::find(open, boundary.name) == open.end()) continue;
      for (const auto& nodes : boundary.faces) {
        const int f = model.grid.find_face(nodes);
        model.forcing.conditions[f] = {.kind = FaceKind::pressure,
                                       .value = value(model.grid.face_centre(f))};
      }
    }
    ImplicitMixed<3> scheme(
        model.grid, {std::numeric_limits<double>::infinity(), false, TimeStepping::second_order},
        Vector<3>::Zero());
    step = scheme.steady(model.forcing);
  }
  /// Discharge through a boundary, m3/s, over k times a difference of 1 Pa as a head, m2/s.
  [[nodiscard]] double discharge(const std::string& name) const {
    double sum = 0.0;
    for (const auto& boundary : model.mesh.boundaries) {
      if (boundary.name != name) continue;
      for (const auto& nodes : boundary.faces) sum -= step.face_flux[model.grid.find_face(nodes)];
    }
    return std::abs(sum) * 9810.0 / 0.02;
  }
  /// Root mean square of the errors of pressures at faces, Pa.
  [[nodiscard]] double error(const std::function<double(const Vector<3>&)>& exact) const {
    double sum = 0.0;
    for (int f = 0; f < model.grid.face_count(); ++f) {
      sum += std::pow(step.end.face_pressure[f] - exact(model.grid.face_centre(f)), 2);
    }
    return std::sqrt(sum / model.grid.face_count());
  }

  model::FlowModelOf<3> model;
  MixedStep<3> step;
};

struct Errors {
  double discharge;  ///< relative
  double pressure;   ///< root mean square, relative to 1 Pa
};

void expect_order(const char* name, const std::function<Errors(double)>& errors_at, double size,
                  double discharge_order, double pressure_order, double limit) {
  const Errors coarse = errors_at(size);
  const Errors fine = errors_at(0.5 * size);
  std::cout << name << ": discharge off by " << coarse.discharge << ", " << fine.discharge
            << "; pressure by " << coarse.pressure << ", " << fine.pressure << '\n';
  EXPECT_GT(std::log2(std::abs(coarse.discharge / fine.discharge)), discharge_order - 0.3);
  EXPECT_GT(std::log2(coarse.pressure / fine.pressure), pressure_order - 0.3);
  EXPECT_LT(std::abs(fine.discharge), limit);
}

TEST(ExactInSpace, WellInACylinder) {
  const auto exact = [](const Vector<3>& x) {
    return std::log(std::hypot(x[0], x[1]) / 0.2) / std::log(5.0);
  };
  const auto errors = [&](double size) {
    const Flow flow("cylinder.geo", size, {"inside", "outside"},
                    [](const Vector<3>& x) { return std::hypot(x[0], x[1]) > 0.5 ? 1.0 : 0.0; });
    const double thiem = 0.5 * pi * 0.3 / std::log(5.0);
    return Errors{flow.discharge("inside") / thiem - 1.0, flow.error(exact)};
  };
  expect_order("well", errors, 0.05, 2.0, 2.0, 0.002);
}

TEST(ExactInSpace, SourceInASphere) {
  const auto exact = [](const Vector<3>& x) { return (1.0 / x.norm() - 1.0) / (1.0 / 0.3 - 1.0); };
  const auto errors = [&](double size) {
    const Flow flow("sphere.geo", size, {"inside", "outside"},
                    [](const Vector<3>& x) { return x.norm() < 0.6 ? 1.0 : 0.0; });
    const double closed = 0.5 * pi / (1.0 / 0.3 - 1.0);
    return Errors{flow.discharge("inside") / closed - 1.0, flow.error(exact)};
  };
  expect_order("sphere", errors, 0.06, 2.0, 2.0, 0.005);
}

/// Weber's disc: the flux is unbounded at its edge, as at the corner of a dam.
TEST(ExactInSpace, FloodedDiscInSealedGround) {
  constexpr double a = 0.5;
  const auto exact = [](const Vector<3>& x) {
    const double r = std::hypot(x[0], x[1]);
    return 2.0 / pi * std::asin(2.0 * a / (std::hypot(r - a, x[2]) + std::hypot(r + a, x[2])));
  };
  const auto errors = [&](double size) {
    const Flow flow("disc.geo", size, {"disc", "far"}, exact);
    return Errors{flow.discharge("disc") / a - 1.0, flow.error(exact)};
  };
  expect_order("disc", errors, 0.07, 1.0, 1.0, 0.025);
}

/// A column of tetrahedra, 1 m high.
const std::string column = R"(
formulation = "single-point"
[geometry]
shape = "box"
height = 1.0
[liquid]
density = 1000.0
bulk_modulus = inf
viscosity = 1.0e-3
[initial]
flow = "steady"
)";

std::vector<std::string> column_of(int cells) {
  const std::string size = std::to_string(1.0 / cells);
  return {"geometry.width=" + size, "geometry.depth=" + size, "mesh.size=" + size};
}

/// Largest error against the profiles of Srivastava and Yeh, relative to their range.
double error_of_infiltration(int cells) {
  std::vector<std::string> overrides = column_of(cells);
  const std::string middle = std::to_string(0.5 / cells);
  std::string probes;
  for (int i = 0; i <= 10; ++i) {
    probes += "{at=[" + middle + ", " + middle + ", " + std::to_string(0.1 * i) + "]}, ";
  }
  overrides.push_back("output.probe=[" + probes + "]");
  overrides.emplace_back("gravity=[0.0, 0.0, -9.81]");
  SceneRun<3> run(column + R"(
[soil.specimen]
porosity = 0.4
skeleton_fraction = 0.6
grain_density = 2700.0
conductivity = 1e-5
[soil.specimen.retention]
model = "gardner"
alpha = 1.0
residual_saturation = 0.15
[[boundary]]
on = "top"
darcy_flux = [[0.0, 1e-6], [1e-9, 9e-6]]
concentration = 0.0
[[boundary]]
on = "bottom"
pressure = 0.0
[time]
end = 36000.0
[output]
every = 36000.0
)",
                  overrides);
  double worst = 0.0;
  double lowest = 0.0;
  for (const double time : {1800.0, 3600.0, 7200.0, 14400.0, 36000.0}) {
    run.run_to(time);
    const std::vector<double> pressure = run.probed();
    for (const ReferenceRow& row : read_reference("infiltration-gardner.csv")) {
      if (row.number("t") != time) continue;
      const double psi = pressure[std::lround(10.0 * row.number("z"))] / 9810.0;
      worst = std::max(worst, std::abs(psi - row.number("psi")));
      lowest = std::min(lowest, row.number("psi"));
    }
  }
  EXPECT_LT(run.worst_residual(), 1e-12);
  std::cout << cells << " cells: suction off by " << worst << " m of " << -lowest << " m\n";
  return worst / -lowest;
}

TEST(ExactInSpace, InfiltrationIntoAColumn) {
  EXPECT_LT(error_of_infiltration(40), 0.015);
}

/// A suspension of which soil catches a part; the table has the porosity from top to bottom.
struct Deposition {
  const char* table;
  double concentration;
  std::vector<std::string> overrides;
};

/// Largest error of the mean porosity, relative to its change, over the times of the table.
double error_of_deposition(const Deposition& deposition, const std::string& formulation,
                           int cells) {
  std::vector<std::string> overrides = column_of(cells);
  overrides.push_back("formulation=" + formulation);
  overrides.push_back("boundary[0].concentration=" + std::to_string(deposition.concentration));
  overrides.insert(overrides.end(), deposition.overrides.begin(), deposition.overrides.end());
  SceneRun<3> run(column + R"(
[soil.specimen]
porosity = 0.35
skeleton_fraction = 0.45
grain_density = 2700.0
conductivity = 0.02
[[boundary]]
on = "top"
darcy_flux = 1e-3
concentration = 0.0
[[boundary]]
on = "bottom"
pressure = 0.0
[time]
end = 1800.0
[output]
every = 1800.0
)",
                  overrides);
  double worst = 0.0;
  for (const double time : {450.0, 900.0, 1800.0}) {
    run.run_to(time);
    double exact = 0.0;
    double last = 0.0;
    double place = 0.0;
    for (const ReferenceRow& row : read_reference(deposition.table)) {
      if (row.number("t") != time) continue;
      const double here = row.number("n_L");
      exact += 0.5 * (here + last) * (row.number("x") - place);
      last = here;
      place = row.number("x");
    }
    if (place == 0.0) continue;  // not in this table
    const double error = (run.history().porosity_mean - exact) / (0.35 - exact);
    worst = std::max(worst, std::abs(error));
  }
  EXPECT_LT(run.worst_residual(), 1e-12);
  std::cout << deposition.table << ", " << formulation << ", " << cells << " cells: off by "
            << worst << " of the deposit\n";
  return worst;
}

TEST(ExactInSpace, DepositInAColumn) {
  const Deposition first_order{
      "deposition-first-order.csv", 0.02, {"soil.specimen.deposition.coefficient=2.0"}};
  const Deposition blocking{
      "deposition-blocking.csv",
      0.05,
      {"soil.specimen.deposition.coefficient=3.0", "soil.specimen.deposition.porosity_min=0.30"}};
  for (const Deposition& deposition : {first_order, blocking}) {
    for (const std::string formulation : {"single-point", "double-point"}) {
      EXPECT_LT(error_of_deposition(deposition, formulation, 20), 0.01);
    }
  }
}

}  // namespace space_references_test
}  // namespace suffuse
