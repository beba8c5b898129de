#include "values/sample.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "common/errors.hpp"
#include "post/synthetic_results.hpp"
#include "report/run_numbers.hpp"
#include "values/fields.hpp"

namespace suffuse {
namespace sample_test {

using testing::linear_porosity;
using testing::ScratchFolder;
using testing::write_synthetic_results;

class Sample : public ::testing::Test {
 protected:
  Sample() { write_synthetic_results(scratch_ / "run.results"); }
  [[nodiscard]] Table at(double t, const std::string& line, int count,
                         const std::string& fields) const {
    return sample(ResultsReader(scratch_ / "run.results"),
                  {{t}, places_on(parse_line(line), count), parse_field_names(fields)});
  }

  [[nodiscard]] ResultsReader results() const { return ResultsReader(scratch_ / "run.results"); }

 private:
  ScratchFolder scratch_;
};

TEST_F(Sample, LinearFieldIsExactInSpaceAndBetweenSnapshots) {
  for (const double t : {0.0, 10.0, 17.5, 40.0}) {
    const Table table = at(t, "0.03,0.1:0.95,0.9", 37, "porosity");
    ASSERT_EQ(table.rows(), 37U);
    ASSERT_EQ(table.names, (std::vector<std::string>{"t", "x", "y", "porosity"}));
    for (std::size_t i = 0; i < table.rows(); ++i) {
      EXPECT_NEAR(table.column("porosity")[i],
                  linear_porosity(table.column("x")[i], table.column("y")[i], t), 1e-14);
    }
  }
}

TEST_F(Sample, EndsAreIncluded) {
  const Table table = at(0.0, "0.25,0:0.25,1", 5, "porosity");
  EXPECT_EQ(table.column("y"), (std::vector<double>{0.0, 0.25, 0.5, 0.75, 1.0}));
  EXPECT_EQ(table.column("x"), (std::vector<double>(5, 0.25)));
}

// Elements 0 and 1 share the diagonal of the lower left square, 0 and 3 the edge x = 0.5.
TEST_F(Sample, AnEdgeTakesTheMeanOfItsElements) {
  EXPECT_EQ(at(0.0, "0.4,0.1:0.1,0.4", 2, "fines_fraction").column("fines_fraction"),
            (std::vector<double>{0.0, 1.0}));
  EXPECT_EQ(at(0.0, "0.25,0.25:0.5,0.2", 2, "fines_fraction").column("fines_fraction"),
            (std::vector<double>{0.5, 1.5}));
  // The node in the middle belongs to six elements, the corner to two.
  EXPECT_NEAR(at(0.0, "0.5,0.5:1,1", 2, "fines_fraction").column("fines_fraction")[0],
              (0 + 1 + 3 + 4 + 6 + 7) / 6.0, 1e-14);
  EXPECT_EQ(at(0.0, "0.5,0.5:1,1", 2, "fines_fraction").column("fines_fraction")[1], 6.5);
}

TEST_F(Sample, AnOuterEdgeTakesTheInnerValue) {
  EXPECT_EQ(at(0.0, "0.25,0:1,0.75", 2, "fines_fraction").column("fines_fraction"),
            (std::vector<double>{0.0, 6.0}));
}

TEST_F(Sample, CellMeansAndNodalVectors) {
  const Table table = at(0.0, "0.4,0.1:0.1,0.3", 2, "pressure,liquid_velocity,darcy_flux");
  EXPECT_EQ(table.names,
            (std::vector<std::string>{"t", "x", "y", "pressure", "liquid_velocity_x",
                                      "liquid_velocity_y", "darcy_flux_x", "darcy_flux_y"}));
  EXPECT_EQ(table.column("pressure"), (std::vector<double>{0.0, 1000.0}));
  EXPECT_NEAR(table.column("liquid_velocity_x")[1], 0.3, 1e-15);
  EXPECT_NEAR(table.column("liquid_velocity_y")[1], -0.1, 1e-15);
  EXPECT_EQ(table.column("darcy_flux_x")[1], 0.25);
}

TEST_F(Sample, SeveralTimesAtOnePlace) {
  const ResultsReader run = results();
  SampleRequest request{parse_times(run, "0,10,17.5"), {parse_place("0.3,0.2")}, {"porosity"}};
  const Table table = sample(run, request);
  EXPECT_EQ(table.column("t"), (std::vector<double>{0.0, 10.0, 17.5}));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(table.column("porosity")[i], linear_porosity(0.3, 0.2, table.column("t")[i]),
                1e-14);
  }
  request.change = true;
  EXPECT_NEAR(sample(run, request).column("porosity")[2], 1e-3 * 17.5 * 1.3, 1e-14);
  EXPECT_EQ(parse_times(run, "all"), run.times());
  EXPECT_THROW(parse_times(run, "0,,3"), InputError);
  EXPECT_THROW(parse_place("0.3"), InputError);
}

class DoublePointSample : public ::testing::Test {
 protected:
  DoublePointSample() { testing::double_point::write_results(scratch_ / "run.results"); }
  [[nodiscard]] Table at(const std::string& line, const std::string& fields) const {
    return sample(ResultsReader(scratch_ / "run.results"),
                  {{5.0}, places_on(parse_line(line), 2), parse_field_names(fields)});
  }

 private:
  ScratchFolder scratch_;
};

// The soil has y / 100, free water 0.5: on the surface at y = 1.5 the value of the soil counts.
TEST_F(DoublePointSample, FreeWaterCountsOnlyWhereThereIsNoSoil) {
  EXPECT_NEAR(at("0.3,1.5:0.3,1.6", "concentration").column("concentration")[0], 0.015, 1e-14);
  EXPECT_NEAR(at("0.3,1.5:0.3,1.6", "concentration").column("concentration")[1], 0.5, 1e-14);
}

TEST_F(DoublePointSample, FieldsOfPointsAreRefusedWithTheReason) {
  try {
    static_cast<void>(at("0.3,0:0.3,1", "pressure"));
    ADD_FAILURE() << "not refused";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()),
              "suffuse-post sample: --fields: got \"pressure\", which lives on the liquid points; "
              "expected a field on cell: \"concentration\", \"conductivity\", \"porosity\", "
              "\"region\", \"saturation\" "
              "or \"saturation_state\"; on node: \"concentration\" or \"liquid_velocity\" "
              "(suffuse-post render --on liquid shows it)");
  }
}

/// What is said of a run that is asked for a snapshot.
std::string refusal_of(const std::string& folder) {
  try {
    snapshot_at(ResultsReader(folder), std::nullopt);
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

TEST(Snapshots, AListThatIsLostIsNamed) {
  const ScratchFolder scratch;
  for (const std::string kind : {"mesh", "solid"}) {
    const std::string folder = scratch / (kind + ".results");
    write_synthetic_results(folder);
    const std::string list = std::string(folder).append("/").append(kind).append(".hdf.series");
    ASSERT_TRUE(std::filesystem::remove(list));
    EXPECT_EQ(refusal_of(folder), list + ": cannot be read");
    EXPECT_THROW(run_numbers(ResultsReader(folder)), FileError);
  }
  const std::string fresh = scratch / "new.results";
  { const ResultsWriter<2> writer(fresh, testing::unit_square_case()); }
  EXPECT_EQ(refusal_of(fresh), fresh + ": has no snapshot yet");
}

}  // namespace sample_test
}  // namespace suffuse
