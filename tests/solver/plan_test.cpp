#include "driver/plan.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "common/errors.hpp"
#include "solver/double_point_case.hpp"
#include "solver/solid_model.hpp"

namespace suffuse {
namespace plan_test {

Scene fluxes(double top, double bottom) {
  Scene scene = model::paper_scene();
  scene.boundaries = {model::flux_on("top", top), model::flux_on("bottom", bottom)};
  scene.boundaries[1].concentration.reset();
  scene.initial_flow = InitialFlow::steady;
  return scene;
}

TEST(Plan, SteadyFlowNeedsFluxesThatAddUp) {
  EXPECT_NO_THROW(make_plan(model::make_case(model::column_mesh(4, 4), fluxes(0.01, -0.01)), {}));
  try {
    make_plan(model::make_case(model::column_mesh(4, 4), fluxes(0.015, 0.0)), {});
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(
        error.what(),
        "model.toml: initial.flow: got \"steady\" with boundaries that bring in 0.015 m3/s "
        "more than they take out; expected prescribed fluxes that add up to zero, or a "
        "boundary with a pressure");
  }
}

/// With incompressible water such a flow is impossible at any time: it is refused before the run.
TEST(Plan, StiffWaterNeedsFluxesThatAddUpAtAllTimes) {
  Scene scene = fluxes(0.01, -0.01);
  scene.initial_flow = InitialFlow::rest;
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.liquid.bulk_modulus = std::numeric_limits<double>::infinity();
  const auto refusal = [&]() -> std::string {
    try {
      make_plan(model::make_case(model::column_mesh(4, 4), scene), {});
    } catch (const InputError& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_EQ(refusal(), "none");
  scene.boundaries[0].darcy_flux = TimeFunction({{0.0, 0.01}, {10.0, 0.01}, {20.0, 0.03}});
  EXPECT_NE(refusal().find("liquid.bulk_modulus: got inf with boundaries that bring in 0.02 m3/s "
                           "more than they take out at t = 20 s"),
            std::string::npos)
      << refusal();
  scene.boundaries[1] = model::pressure_on("bottom", 0.0);
  EXPECT_EQ(refusal(), "none");
}

/// The outflow of a seepage face and the storage of unsaturated soil are free, so fluxes may
/// differ.
TEST(Plan, StiffWaterMayLeaveThroughASeepageFaceOrFillPores) {
  Scene scene = fluxes(0.01, 0.0);
  scene.boundaries.pop_back();
  scene.initial_flow = InitialFlow::rest;
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.liquid.bulk_modulus = std::numeric_limits<double>::infinity();
  const auto plan = [&] { make_plan(model::make_case(model::column_mesh(4, 4), scene), {}); };
  EXPECT_THROW(plan(), InputError);
  scene.boundaries.push_back(model::seepage_on("bottom"));
  EXPECT_NO_THROW(plan());
  scene.boundaries.pop_back();
  scene.soils[0].retention = model::gardner(2.0);
  EXPECT_NO_THROW(plan());
}

/// The iteration over switching faces does not support drag that is quadratic in the flux.
TEST(Plan, ErgunsDragNeedsFacesThatStayAsTheyAre) {
  Scene scene = model::paper_scene();
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.gravity = {0.0, -9.81, 0.0};
  scene.water_level = 1.0;
  scene.soils[0].drag = SoilDrag::ergun;
  scene.boundaries = {BoundaryCondition{}, model::seepage_on("right")};
  scene.boundaries[0].on = "left";
  scene.boundaries[0].key = "boundary[0]";
  scene.boundaries[1].key = "boundary[1]";
  scene.boundaries[0].head = TimeFunction(1.5);
  const auto refusal = [&]() -> std::string {
    try {
      make_plan(model::make_case(model::column_mesh(4, 4), scene), {});
    } catch (const InputError& error) {
      return error.what();
    }
    return "none";
  };
  const auto beside = [](const std::string& key) {
    return "model.toml: soil.specimen.drag: got \"ergun\" with " + key +
           "; expected \"darcy\": where faces open, close or fall dry, drag is linear";
  };
  EXPECT_EQ(refusal(), beside("boundary[1].seepage_face"));
  scene.boundaries[1].seepage_face = false;
  scene.boundaries[1].rain = TimeFunction(1e-6);
  EXPECT_EQ(refusal(), beside("boundary[1].rain"));
  scene.boundaries.pop_back();
  EXPECT_EQ(refusal(), "none");
  scene.boundaries[0].head = TimeFunction({{0.0, 1.5}, {10.0, 0.5}});
  EXPECT_EQ(refusal(), beside("boundary[0].head"));
  scene.boundaries[0].dry = DryPart::suction;
  EXPECT_EQ(refusal(), "none");
  scene.boundaries[0].dry = DryPart::impervious;
  scene.soils[0].drag = SoilDrag::darcy;
  EXPECT_EQ(refusal(), "none");
}

std::string slope_warnings(const Scene& scene) {
  std::string found;
  for (const auto& text :
       make_plan(model::make_case(model::column_mesh(2, 4), scene), {}).warnings) {
    if (text.find("all over") != std::string::npos) found += text + '\n';
  }
  return found;
}

/// 20 kPa over a side of 1 m under 10 m/s2 is a head of 2.5 m, 2 m above mid-height.
TEST(Plan, WarnsOfOnePressureOnABoundaryThatRises) {
  Scene scene = model::paper_scene();
  scene.gravity = {0.0, -10.0, 0.0};
  scene.boundaries = {model::pressure_on("left", 2e4), model::pressure_on("top", 0.0)};
  scene.boundaries[0].key = "boundary[0]";
  EXPECT_EQ(
      slope_warnings(scene),
      "boundary[0].pressure: 20000 Pa all over \"left\", which rises from z = 0 m to 1 m: "
      "water that stands there has one head, not one pressure; head = 2.5 has this pressure at "
      "mid-height, z = 0.5 m\n");
  scene.gravity = {-10.0, 0.0, 0.0};  // then the left side is level, and the top is not
  scene.boundaries[1].key = "boundary[1]";
  EXPECT_EQ(slope_warnings(scene),
            "boundary[1].pressure: 0 Pa all over \"top\", which rises from z = 0 m to 1 m: water "
            "that stands there has one head, not one pressure; head = 0.5 has this pressure at "
            "mid-height, z = 0.5 m\n");
  scene.gravity = {};
  EXPECT_EQ(slope_warnings(scene), "");
}

/// A point on a corner makes the field at the other two corners lose pores, more than the point
/// gains.
TEST(Plan, PointsOnCornersMustLeavePoresElsewhere) {
  Scene scene = fluxes(0.01, -0.01);
  scene.points.solid_per_element = 1;
  scene.soils[0].erosion = {erosion_law("constant"), 1e-3, 0.0, false};
  Case<2> c = model::make_case(model::column_mesh(4, 4), scene);
  c.solid_points.barycentric[7] = {0.0, 0.0, 1.0};
  EXPECT_NO_THROW(make_plan(c, {})) << "of 0.3 it takes a third of 0.1";
  Soil& soil = c.document.scene.soils[0];
  soil.porosity = 0.05;
  soil.skeleton_fraction = 0.1;
  try {
    make_plan(c, {});
    FAIL() << "accepted";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("solid points so near the corners of element 7 at ("), std::string::npos)
        << message;
  }
  c.document.scene.formulation = Formulation::double_point;
  EXPECT_NO_THROW(make_plan(c, {})) << "no fields there";
}

TEST(Plan, SkipsWhatTheSceneDoesNotNeed) {
  Scene scene = fluxes(0.01, -0.01);
  const auto plan_of = [&](const SolverOptions& options) {
    return make_plan(model::make_case(model::column_mesh(4, 4), scene), options);
  };
  EXPECT_FALSE(plan_of({}).transport);
  EXPECT_TRUE(plan_of({.threads = 1, .no_skip = true}).transport);
  scene.boundaries[0].concentration = 0.1;
  EXPECT_TRUE(plan_of({}).transport);
  EXPECT_FALSE(plan_of({}).erosion);
  scene.soils[0].erosion = {erosion_law("constant"), 1e-3, 0.0, false};
  EXPECT_TRUE(plan_of({}).erosion);
}

/// The sentences of the plan from that on erosion on, if they are about fines and soil.
std::vector<std::string> sentences_of_exchange(const Scene& scene, bool no_skip = false) {
  const Plan plan = make_plan(model::make_case(model::column_mesh(4, 4), scene),
                              {.threads = 1, .no_skip = no_skip});
  std::vector<std::string> found;
  for (const std::string& sentence : plan.sentences) {
    for (const char* pass : {": erosion", ": deposition", ": viscosity", ": conductivity"}) {
      if (sentence.find(pass) <= 4) found.push_back(sentence);
    }
  }
  return found;
}

using Sentences = std::vector<std::string>;

TEST(Plan, SaysWhatFinesDo) {
  Scene scene = fluxes(0.01, -0.01);
  EXPECT_EQ(sentences_of_exchange(scene),
            (Sentences{"skip: erosion, no soil erodes", "skip: deposition, no soil catches fines",
                       "skip: viscosity of the suspension, it is that of the water",
                       "skip: conductivity that follows pores, no soil has it and changes"}));
  EXPECT_EQ(sentences_of_exchange(scene, true)[0], "run: erosion (--no-skip)");

  // Keys of soils that have no effect here.
  scene.soils[0].deposition.coefficient = 2.0;
  scene.soils[0].conductivity_law = conductivity_law("kozeny-carman");
  scene.liquid.viscosity_model.law = viscosity_laws()[1];
  EXPECT_EQ(
      sentences_of_exchange(scene),
      (Sentences{"skip: erosion, no soil erodes", "skip: deposition, no fines get into the liquid",
                 "skip: viscosity of the suspension, no grains get into the liquid",
                 "skip: conductivity that follows pores, no soil has it and changes"}));

  scene.boundaries[0].concentration = 0.1;
  EXPECT_EQ(sentences_of_exchange(scene),
            (Sentences{"skip: erosion, no soil erodes", "run: deposition, soil specimen",
                       "run: viscosity of the suspension, by the law krieger-dougherty",
                       "run: conductivity that follows pores, soil specimen"}));
}

TEST(Plan, SaysWhichDriveErodesWhichSoil) {
  Scene scene = fluxes(0.01, -0.01);
  const auto erode = [](Soil& soil, const char* law, const char* drive, double rate) {
    soil.erosion.law = erosion_law(law);
    soil.erosion.drive = drive_law(drive);
    soil.erosion.rate = rate;
  };
  for (const char* name : {"base", "core", "filter", "still"}) {
    scene.soils.push_back(scene.soils[0]);
    scene.soils.back().region = name;
  }
  erode(scene.soils[0], "constant", "power", 1e-6);
  erode(scene.soils[1], "flux", "time", 2.0);  // this law has its own drive
  erode(scene.soils[2], "first-order", "power", 1e-6);
  erode(scene.soils[3], "first-order", "time", 1e-3);
  erode(scene.soils[4], "first-order", "gradient", 0.0);
  scene.soils[2].deposition.coefficient = 1.0;
  scene.soils[3].conductivity_law = conductivity_law("kozeny-carman");
  scene.soils[4].conductivity_law = conductivity_law("kozeny-carman");
  EXPECT_EQ(
      sentences_of_exchange(scene),
      (Sentences{"run: erosion by time, soil filter", "run: erosion by flux, soil base",
                 "run: erosion by power, soils specimen and core", "run: deposition, soil core",
                 "skip: viscosity of the suspension, it is that of the water",
                 "run: conductivity that follows pores, soil filter"}));
}

TEST(Plan, WarnsOfMassScalingThatDistortsTheFlow) {
  Scene scene = fluxes(0.01, -0.01);
  scene.time.mass_scaling = 1e4;  // settles in 68 s in a run of 120 s
  EXPECT_EQ(make_plan(model::make_case(model::column_mesh(4, 4), scene), {}).warnings.size(), 1U);
  scene.time.mass_scaling = 100.0;  // settles in 0.68 s
  EXPECT_TRUE(make_plan(model::make_case(model::column_mesh(4, 4), scene), {}).warnings.empty());
}

TEST(Plan, RepeatsTheWarningsOfTheMesher) {
  Scene scene = fluxes(0.01, -0.01);
  scene.liquid.density = 1.0;
  const Plan plan = make_plan(model::make_case(model::column_mesh(4, 3), scene), {});
  EXPECT_EQ(plan.warnings,
            (Sentences{"model.toml: liquid.density: 1 kg/m3; 500 to 2000 are usual, water has 1000",
                       "model.toml: geometry: the mesh has fewer than 4 elements across the region "
                       "\"specimen\", from where water enters it to where it leaves; 4 or more are "
                       "usual"}));
}

TEST(Plan, KnowsTheSpeedThatDragFollows) {
  Scene scene = fluxes(0.01, -0.01);
  const auto speed = [&] {
    return make_plan(model::make_case(model::column_mesh(4, 4), scene), {})
        .row_limits.speed_that_drag_follows;
  };
  // sqrt(2) m in 2e-2 / (0.3 * 9.81) s
  EXPECT_NEAR(speed(), std::sqrt(2.0) * 0.3 * 9.81 / 2e-2, 1e-9);
  scene.time.scheme = FlowScheme::implicit_mixed;
  EXPECT_TRUE(std::isinf(speed())) << "inertia is left out";
  scene.time.inertia = true;
  EXPECT_FALSE(std::isinf(speed()));
}

TEST(Plan, WatchesTheMotionOfSoilThatCanYield) {
  Scene scene = fluxes(0.01, -0.01);
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.gravity = {0.0, -9.81, 0.0};
  const auto watched = [&](double lower) {
    Case<2> c = model::make_case(model::column_mesh(4, 4), scene);
    for (Vector<2>& x : c.mesh.nodes) x *= lower;
    return make_plan(c, {}).row_limits.watched_motion;
  };
  EXPECT_TRUE(std::isinf(watched(1.0))) << "rigid";
  scene.soils[0].skeleton.law = skeleton_law("elastic");
  EXPECT_TRUE(std::isinf(watched(1.0)));
  scene.soils[0].skeleton.law = skeleton_law("mohr-coulomb");
  EXPECT_NEAR(watched(1.0), 0.01, 1e-15);
  EXPECT_NEAR(watched(0.5), 0.005, 1e-15);
}

TEST(Plan, TakesNineTenthsOfTheLimitWithoutAStep) {
  const Plan plan = make_plan(model::make_case(model::column_mesh(4, 4), fluxes(0.01, -0.01)), {});
  EXPECT_DOUBLE_EQ(plan.flow.step, 0.9 * plan.limit.step);
}

TEST(Plan, SaysTheStepsThatOutputsLeave) {
  Scene scene = fluxes(0.01, -0.01);
  scene.time.step = 0.0851;
  scene.time.mass_scaling = 1e4;
  const Plan plan = make_plan(model::make_case(model::column_mesh(4, 4), scene), {});
  EXPECT_EQ(plan.sentences.front().find("run: flow, explicit nodal scheme, about 1440 steps of "
                                        "0.08333 s (stability limit "),
            0U)
      << plan.sentences.front();
}

TEST(Plan, KeepsInertiaWhereItsTimeWouldBeNoticed) {
  Scene scene = fluxes(0.01, -0.01);
  scene.time.scheme = FlowScheme::implicit_mixed;
  const auto keeps = [&] {
    return make_plan(model::make_case(model::column_mesh(4, 4), scene), {}).flow.inertia;
  };
  // Drag stops the liquid within 7 to 9 ms.
  scene.time.end = 120.0;
  EXPECT_FALSE(keeps());
  scene.time.end = 1.0;
  EXPECT_TRUE(keeps());
  // Inertia of moving soil includes that of its liquid.
  scene.soils[0].skeleton = model::elastic_soil(1e7, 0.3);
  EXPECT_FALSE(keeps());
  scene.soils[0].skeleton = {};
  scene.time.inertia = false;
  EXPECT_FALSE(keeps());
  scene.time.inertia.reset();
  scene.time.step = 1.0;
  EXPECT_FALSE(keeps());
  scene.time.step = 0.1;
  EXPECT_TRUE(keeps());
}

TEST(Plan, WarnsOfInertiaInFreeWater) {
  LayerSettings layers;
  layers.inflow = layers.outflow = 2;
  Scene scene = model::double_point_scene(0.012, 5e-3);
  scene.time.scheme = FlowScheme::implicit_mixed;
  const auto warnings = [&](const LayerSettings& rows) {
    return make_plan(model::make_double_point_case(model::layered_mesh(4, rows), scene), {})
        .warnings.size();
  };
  EXPECT_EQ(warnings(layers), 0U);
  scene.time.inertia = true;
  EXPECT_EQ(warnings(layers), 1U);
  EXPECT_EQ(warnings({}), 0U);
}

}  // namespace plan_test
}  // namespace suffuse
