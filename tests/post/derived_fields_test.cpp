#include "values/derived_fields.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "checks/heave_safety.hpp"
#include "common/errors.hpp"
#include "post/synthetic_results.hpp"
#include "values/fields.hpp"

namespace suffuse {
namespace derived_fields_test {

using testing::ScratchFolder;
using testing::unit_square_case;

constexpr double porosity = 0.3;
constexpr double erodible = 0.14;
/// (1 - n) (rho_s / rho_w - 1) of the synthetic soil.
constexpr double critical = 0.7 * 1.7;

/// Two snapshots. Water rises with i = 0.1 (e + 1) in element e at t = 0, and half as fast at
/// t = 10 s; in element 7 it sinks.
class DerivedFields : public ::testing::Test {
 protected:
  DerivedFields() {
    const Case<2> c = unit_square_case();
    ResultsWriter<2> writer(scratch_ / "run.results", c);
    testing::write_rows(writer, 10.0, [](double) { return porosity; });
    for (const double t : {0.0, 10.0}) writer.write_snapshot(snapshot(c, t));
    RunInfo info;
    info.status = "done";
    writer.write_run_info(info);
  }

  static Snapshot snapshot(const Case<2>& c, double t) {
    Snapshot s;
    s.time = t;
    const auto same = [&](double value) {
      return std::vector<double>(c.mesh.elements.size(), value);
    };
    Field gradient{"hydraulic_gradient", "1", 2, {}};
    Field flux{"darcy_flux", "m/s", 2, {}};
    for (int e = 0; e < c.mesh.element_count(); ++e) {
      const double up = (e == 7 ? -1.0 : 0.1 * (e + 1)) * (t > 0.0 ? 0.5 : 1.0);
      gradient.values.insert(gradient.values.end(), {0.0, up});
      flux.values.insert(flux.values.end(), {0.0, 2e-3 * up});
    }
    s.cell = {{"porosity", "1", 1, same(porosity)},
              {"erodible_fraction", "1", 1, same(t > 0.0 ? 0.25 * erodible : erodible)},
              {"pressure", "Pa", 1, same(981.0)},
              gradient,
              flux};
    s.node = {{"pressure", "Pa", 1, std::vector<double>(c.mesh.nodes.size(), 1962.0 + t)}};
    return s;
  }

  [[nodiscard]] ResultsReader results() const { return ResultsReader(scratch_ / "run.results"); }

 private:
  ScratchFolder scratch_;
};

TEST_F(DerivedFields, FollowFromStoredOnes) {
  const ResultsReader run = results();
  // Without gravity a head is p / (rho_w 9.81 m/s2).
  EXPECT_NEAR(any_field(run, 0, "cell", "head").values[3], 0.1, 1e-15);
  EXPECT_NEAR(any_field(run, 0, "node", "head").values[3], 0.2, 1e-15);
  EXPECT_EQ(any_field(run, 0, "cell", "saturation").values, std::vector<double>(8, 1.0));
  EXPECT_NEAR(any_field(run, 0, "cell", "fines_content").values[0], 0.2, 1e-15);
  EXPECT_EQ(any_field(run, 0, "cell", "fines_left").values, std::vector<double>(8, 1.0));
  EXPECT_EQ(any_field(run, 1, "cell", "fines_left").values, std::vector<double>(8, 0.25));
  const std::vector<double> safety = any_field(run, 0, "cell", "safety").values;
  EXPECT_NEAR(safety[3], critical / 0.4, 1e-12);
  EXPECT_TRUE(std::isinf(safety[7]));
}

/// Half of the fines of the scene are left at the start of a stage; one region never had any.
TEST(FinesLeft, OfALaterStageCountFromBeforeTheFirst) {
  const ScratchFolder scratch;
  Case<2> c = unit_square_case();
  c.document =
      parse_scene(c.document.text +
                      "[soil.base]\nlike = \"specimen\"\nporosity = 0.4\n"
                      "porosity_gradient = [0.0, 0.0]\n",
                  "stage.toml",
                  {"initial.from=before.results", "soil.specimen.porosity_gradient=[0.01, 0.05]"});
  c.mesh.region_names.emplace_back("base");
  c.mesh.element_region = {0, 1, 0, 1, 0, 0, 0, 0};
  Field half{"erodible_fraction", "1", 1, {}};
  for (int e = 0; e < c.mesh.element_count(); ++e) {
    const Soil& soil = c.document.scene.soils[c.mesh.element_region[e]];
    half.values.push_back(0.5 * (0.4 - soil.initial_porosity(element_centroid(c.mesh, e))));
  }
  Snapshot s;
  s.cell = s.solid = {half};  // points lie in the middle of elements
  {
    ResultsWriter<2> writer(scratch / "stage.results", c);
    writer.write_snapshot(s);
  }
  const ResultsReader run(scratch / "stage.results");
  for (const auto* where : {"cell", "solid"}) {
    const std::vector<double> left = any_field(run, 0, where, "fines_left").values;
    for (int e = 0; e < c.mesh.element_count(); ++e) {
      if (c.mesh.element_region[e] == 1) {
        EXPECT_TRUE(std::isnan(left[e])) << where << " " << e;
      } else {
        EXPECT_NEAR(left[e], 0.5, 1e-14) << where << " " << e;
      }
    }
  }
}

TEST_F(DerivedFields, AreListedWithTheOthers) {
  const auto find = [&](const std::string& name, const std::string& on) {
    return find_field(results(), 0, name, on, "test").where;
  };
  EXPECT_EQ(find("safety", ""), "cell");
  EXPECT_EQ(find("head", "node"), "node");
  EXPECT_THROW(find("safety", "node"), InputError);
  // This field is not stored on solid points.
  EXPECT_THROW(find("fines_content", "solid"), InputError);
}

TEST_F(DerivedFields, ChangeIsSinceTheFirstSnapshot) {
  FieldPlace place = find_field(results(), 1, "pressure", "node", "test");
  place.change = true;
  const ScalarField change = read_scalar(results(), 1, place);
  EXPECT_NEAR(change.values[4], 10.0, 1e-12);
  EXPECT_EQ(field_label(place, change), "change of pressure p (Pa)");
}

/// Two snapshots of soil that moves, whose points are sorted anew by element.
/// \param has_numbers  points have a field `id`
void write_moving_points(const std::string& folder, bool has_numbers,
                         const std::vector<double>& last_id) {
  const Case<2> c = testing::open_above_case(1.0);
  ResultsWriter<2> writer(folder, c);
  for (const double t : {0.0, 10.0}) {
    Snapshot s;
    s.time = t;
    const std::vector<double> id = t > 0.0 ? last_id : std::vector<double>{0.0, 1.0, 2.0, 3.0};
    Field pores{"porosity", "1", 1, {}};
    Field displacement{"displacement", "m", 2, {}};
    for (const double number : id) {
      pores.values.push_back(0.1 * number + 1e-3 * t);
      displacement.values.insert(displacement.values.end(), {number, t * number});
      s.solid_positions.insert(s.solid_positions.end(), {0.1 * number, 0.25, 0.0});
    }
    s.solid = {pores, displacement};
    if (has_numbers) s.solid.push_back({"id", "1", 1, id, true});
    writer.write_snapshot(s);
  }
  RunInfo info;
  info.status = "done";
  writer.write_run_info(info);
}

TEST(ChangeOfMovingPoints, IsThatOfTheSamePoint) {
  const ScratchFolder scratch;
  const std::string folder = scratch / "moving.results";
  write_moving_points(folder, true, {2.0, 0.0, 3.0, 1.0});
  const ResultsReader results(folder);
  for (const double change : read_field(results, 1, {"porosity", "solid", true}).values) {
    EXPECT_NEAR(change, 0.01, 1e-15);
  }
  EXPECT_EQ(read_field(results, 1, {"displacement", "solid", true}).values,
            (std::vector<double>{0.0, 20.0, 0.0, 0.0, 0.0, 30.0, 0.0, 10.0}));
}

TEST(ChangeOfMovingPoints, IsRefusedWithoutTheirNumbersOrWithOthers) {
  const ScratchFolder scratch;
  write_moving_points(scratch / "old.results", false, {2.0, 0.0, 3.0, 1.0});
  write_moving_points(scratch / "new.results", true, {2.0, 0.0, 4.0, 1.0});
  const auto refusal = [&](const std::string& name) -> std::string {
    try {
      read_field(ResultsReader(scratch / name), 1, {"porosity", "solid", true});
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const std::string expected =
      "suffuse-post: --change: got \"porosity\" on solid; expected a field of places that stay: ";
  EXPECT_EQ(refusal("old.results"), expected + "points move, and these have no field \"id\"");
  EXPECT_EQ(refusal("new.results"), expected + "a point was not there at the start");
}

TEST_F(DerivedFields, LeastSafetyIsThatOfAllTimes) {
  const auto parts = safety_of(results());
  ASSERT_EQ(parts.size(), 3U);
  EXPECT_EQ(parts[0].name, "all soil");
  EXPECT_NEAR(parts[0].least->safety, critical / 0.7, 1e-12);
  EXPECT_EQ(parts[0].least->time, 0.0);
  // The top has elements 5 and 7: water leaves through the first and enters through the other.
  const auto top = std::ranges::find(parts, "top", &PartSafety::name);
  EXPECT_NEAR(top->least->safety, critical / 0.6, 1e-12);
  EXPECT_EQ(top->least->place[1], 1.0);
  EXPECT_EQ(*top->discharge, -0.004);  // of the boundary table
  // All water enters at the bottom.
  const auto bottom = std::ranges::find(parts, "bottom", &PartSafety::name);
  EXPECT_FALSE(bottom->least);
  EXPECT_NO_THROW(check_safety(parts, 1.69));
  EXPECT_THROW(check_safety(parts, 1.71), NumericalError);
  EXPECT_NE(safety_text(results(), parts).find("water rises nowhere"), std::string::npos);
}

}  // namespace derived_fields_test
}  // namespace suffuse
