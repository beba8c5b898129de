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
