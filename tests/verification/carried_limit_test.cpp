/// The longest step of material-point integration: a flow that points carry becomes unstable at
/// steps that are stable in mixed integration.

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "common/errors.hpp"
#include "model_run.hpp"

namespace suffuse {
namespace carried_limit_test {

Scene carried_scene(int points_per_element) {
  Scene scene = model::paper_scene();
  scene.formulation = Formulation::double_point;
  scene.flow.integration = PressureIntegration::material_point;
  scene.boundaries = {model::pressure_on("top", 6000.0), model::pressure_on("bottom", 0.0)};
  scene.soils.front().erosion = {erosion_law("constant"), 0.1, 0.1, false};
  scene.points.liquid_per_element = points_per_element;
  scene.time.end = 1.0;
  return scene;
}

double fastest(Mesh<2> mesh, const Scene& scene) {
  model::DoublePointRun run(model::make_double_point_case(std::move(mesh), scene));
  const auto moments = run.run({0.25, 0.5, 0.75, 1.0});
  double speed = 0.0;
  for (const FlowState<2>& flow : moments.flows) {
    for (const Vector<2>& v : flow.velocity) speed = std::max(speed, v.norm());
  }
  return speed;
}

/// The steady flow has k i / n = 0.041 m/s; with the porosities at the end it has 0.031 m/s.
TEST(CarriedLimit, HoldsForFewPointsAndMany) {
  for (const int count : {1, 3, 6, 12}) {
    for (const double jitter : {0.0, 0.02}) {
      Scene scene = carried_scene(count);
      const auto mesh = [&] {
        return model::column_mesh(
            4, 8, 0.5, 1.0, [&, move = model::jittered(jitter, 5)](const Vector<2>& x) mutable {
              return x[0] < 0.5 ? move(x) : x;
            });
      };
      const Plan plan = make_plan(model::make_double_point_case(mesh(), scene), {});
      scene.time.step = 0.999 * plan.limit.step;
      const double speed = fastest(mesh(), scene);
      std::cout << count << " points per element, jitter " << jitter << ": " << speed << " m/s\n";
      EXPECT_LT(speed, 0.06);
      scene.time.step = 1.001 * plan.limit.step;
      EXPECT_THROW(make_plan(model::make_double_point_case(mesh(), scene), {}), InputError);
    }
  }
}

/// The limit is that of mixed integration over sqrt(7/4), and not smaller.
TEST(CarriedLimit, IsThatOfMixedIntegrationLessWhatPointsPassOnLate) {
  Scene scene = carried_scene(6);
  const auto limit = [&] {
    try {
      scene.time.step = 1.0;
      make_plan(model::make_double_point_case(model::column_mesh(4, 8, 0.5, 1.0), scene), {});
    } catch (const InputError& error) {
      const std::string text = error.what();
      return std::stod(text.substr(text.find("at most ") + 8));
    }
    return 0.0;
  };
  const double carried = limit();
  scene.flow.integration = PressureIntegration::mixed;
  EXPECT_NEAR(limit() / carried, std::sqrt(1.75), 0.01) << "drag takes a little from both";
}

}  // namespace carried_limit_test
}  // namespace suffuse
