#include "tables/reference_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "common/errors.hpp"
#include "post/synthetic_results.hpp"

namespace suffuse {
namespace reference_error_test {

using testing::linear_porosity;
using testing::ScratchFolder;
using testing::write_synthetic_results;

class ReferenceErrors : public ::testing::Test {
 protected:
  ReferenceErrors() { write_synthetic_results(scratch_ / "run.results"); }

  [[nodiscard]] std::vector<ReferenceError> of(const std::string& table) const {
    const std::string path = scratch_ / "known.csv";
    std::ofstream(path) << table;
    return reference_errors(ResultsReader(scratch_ / "run.results"), read_reference_table(path));
  }
  void expect_refusal(const std::string& table, const std::string& message) const {
    try {
      static_cast<void>(of(table));
      ADD_FAILURE() << "not refused: " << table;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()),
                "suffuse-post error: " + (scratch_ / "known.csv") + message);
    }
  }

 private:
  ScratchFolder scratch_;
};

std::string row(double t, double x, double y, double value) {
  std::ostringstream text;
  text.precision(17);
  text << t << ',' << x << ',' << y << ',' << value << '\n';
  return text.str();
}

// The run's porosity is linear in space and between snapshots, so distances from it are those that
// the table has been given.
TEST_F(ReferenceErrors, NormsOfAFieldAtPlaces) {
  const std::vector<std::array<double, 3>> places{{0, 0.1, 0.2}, {17.5, 0.7, 0.6}, {40, 0.3, 0.9}};
  const std::vector<double> distances{0.01, -0.02, 0.04};
  std::string table = "t,x,y,porosity\n";
  double size = 0.0;
  double squares = 0.0;
  double largest = 0.0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto& [t, x, y] = places[i];
    const double value = linear_porosity(x, y, t) + distances[i];
    table += row(t, x, y, value);
    size += value;
    squares += value * value;
    largest = std::max(largest, value);
  }
  const auto errors = of(table);
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_EQ(errors[0].quantity, "porosity");
  EXPECT_EQ(errors[0].values, 3U);
  EXPECT_NEAR(errors[0].l1, 0.07 / size, 1e-14);
  EXPECT_NEAR(errors[0].l2, std::sqrt(0.0021 / squares), 1e-14);
  EXPECT_NEAR(errors[0].max, 0.04 / largest, 1e-14);
}

TEST_F(ReferenceErrors, NothingWhereTheRunIsExact) {
  const auto errors = of("t,x,y,porosity\n" + row(10, 0.4, 0.1, linear_porosity(0.4, 0.1, 10)));
  EXPECT_LE(errors[0].l1, 1e-15);
}

// The places are in elements 0 and 3; the flux of element e is (0.25 e, -1).
TEST_F(ReferenceErrors, ComponentsOfAVectorAndSeveralColumns) {
  const auto errors = of("darcy_flux_y,t,darcy_flux_x,x,y\n-2,0,0.5,0.4,0.1\n-1,0,1,0.7,0.4\n");
  ASSERT_EQ(errors.size(), 2U);
  EXPECT_EQ(errors[0].quantity, "darcy_flux_y");
  EXPECT_NEAR(errors[0].l1, 1.0 / 3.0, 1e-15);
  EXPECT_EQ(errors[1].quantity, "darcy_flux_x");
  EXPECT_NEAR(errors[1].max, 0.5, 1e-15);
}

// Rows are 1 s apart: porosity 0.308 at 10 s, 0.3085 at 10.5 s.
TEST_F(ReferenceErrors, HistoryAndLedgerBetweenRows) {
  EXPECT_NEAR(of("t,porosity_mean\n10.5,0.3085\n")[0].l1, 0.0, 1e-14);
  EXPECT_NEAR(of("t,porosity_mean\n10.5,0.617\n120,0.4\n")[0].l1, 0.3085 / 1.017, 1e-14);
  EXPECT_NEAR(of("t,water_in\n3.25,26\n")[0].max, 0.5, 1e-14);
}

// Eight equal elements with a flux of (0.25 e, -1) have a mean of 0.875. Porosity is that at the
// middle.
TEST_F(ReferenceErrors, MeansOverTheModelBetweenSnapshots) {
  EXPECT_NEAR(of("t,mean_darcy_flux_x\n5,0.875\n")[0].l1, 0.0, 1e-14);
  EXPECT_NEAR(of("t,mean_darcy_flux_y\n5,-2\n")[0].l1, 0.5, 1e-14);
  EXPECT_NEAR(of("t,mean_porosity\n25,1\n")[0].l1, 1.0 - linear_porosity(0.5, 0.5, 25), 1e-14);
}

TEST_F(ReferenceErrors, ATableThatIsNoneIsRefused) {
  expect_refusal("x,y,porosity\n0,0,1\n", ": got no column \"t\"; expected times in s");
  expect_refusal("t,x,porosity\n0,0,1\n",
                 ": got one column of places; expected both \"x\" and \"y\", or neither");
  expect_refusal("t,x,y\n0,0,1\n", ": got no column of values; expected at least one");
  expect_refusal("t,porosity_mean\n", ": got no row; expected at least one");
  expect_refusal("t,porosity_mean\n0,nan\n", ": porosity_mean: got nan; expected finite numbers");
  expect_refusal("t,porosity_mean\n0,0\n",
                 ": porosity_mean: got zeros alone; expected a value that differences can be "
                 "relative to");
}

TEST_F(ReferenceErrors, WhatTheRunDoesNotHaveIsRefused) {
  expect_refusal("t,x,y,porosity\n41,0,0,1\n",
                 ": t: got 41; expected a time from 0 to 40 s, the first and last snapshot");
  expect_refusal("t,x,y,porosity\n0,0,2,1\n",
                 ": x, y: got the point (0, 2); expected points inside the model");
  expect_refusal("t,porosity_mean\n121,1\n",
                 ": t: got 121; expected a time from 0 to 120 s, which the run has");
  expect_refusal("t,x,y,darcy_flux\n0,0,0,1\n",
                 ": got \"darcy_flux\"; expected \"darcy_flux_x\" or \"darcy_flux_y\"; did you "
                 "mean darcy_flux_x?");
  for (const std::string name : {"porosity_men", "mean_darcy_flux", "mean_liquid_velocity_x"}) {
    EXPECT_THROW(static_cast<void>(of("t," + name + "\n0,1\n")), InputError) << name;
  }
  EXPECT_THROW(static_cast<void>(of("t,x,y,porosty\n0,0,0,1\n")), InputError);
}

TEST(ReferenceErrorText, ReadsBack) {
  const ScratchFolder scratch;
  const std::vector<ReferenceError> errors{{"porosity", 3, 0.125, 0.25, 0.5}};
  write_errors(scratch / "errors.csv", errors);
  EXPECT_EQ(testing::file_text(scratch / "errors.csv"),
            "quantity,values,l1,l2,max\nporosity,3,0.125,0.25,0.5\n");
  EXPECT_EQ(error_text(errors), "porosity: L1 0.125, L2 0.25, largest 0.5 of 3 values\n");
}

// Spreadsheets write a byte order mark, and editors leave blank lines.
TEST_F(ReferenceErrors, MarksAndBlankLinesAreLeftOut) {
  const auto errors = of("\xEF\xBB\xBFt,x,y,porosity\r\n\r\n" + row(10, 0.5, 0.5, 0.4) + " \t\n\n");
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_EQ(errors.front().values, 1U);
}

TEST_F(ReferenceErrors, AColumnIsThereOnce) {
  try {
    static_cast<void>(of("t,x,y,porosity,porosity [-]\n10,0.5,0.5,0.4,0.3\n"));
    ADD_FAILURE() << "not refused";
  } catch (const InputError& error) {
    EXPECT_TRUE(
        std::string(error.what())
            .ends_with("known.csv:1: got several columns \"porosity\"; expected each column once"))
        << error.what();
  }
}

}  // namespace reference_error_test
}  // namespace suffuse
