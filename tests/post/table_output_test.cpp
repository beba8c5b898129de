#include "tables/table_output.hpp"

#include <gtest/gtest.h>

#include "common/errors.hpp"
#include "post/synthetic_results.hpp"
#include "values/name_words.hpp"

namespace suffuse {
namespace table_output_test {

using testing::file_text;
using testing::ScratchFolder;

TEST(TableOutput, HasUnitsAndTheTimeOfChoice) {
  const Table table{{"t", "solid", "porosity_mean", "mine"},
                    {{0.0, 86400.0}, {1.0, 2.0}, {0.3, 0.4}, {5.0, 6.0}}};
  const ScratchFolder scratch;
  const std::string path = scratch / "a.csv";
  write_table(path, with_units(table, 2, parse_time_unit("d", "test")));
  EXPECT_EQ(file_text(path), "t [d],solid [kg/m],porosity_mean [-],mine\n0,1,0.3,5\n1,2,0.4,6\n");
  EXPECT_EQ(with_units(table, 3, {}).units[1], "kg");
}

TEST(TableOutput, ReadsBackWithTimesInSeconds) {
  const ScratchFolder scratch;
  const std::string path = scratch / "a.csv";
  std::ofstream(path) << "t [min],head [m]\n2,0.5\n";
  const Table table = with_seconds(read_table(path), path);
  EXPECT_EQ(table.names, (std::vector<std::string>{"t", "head"}));
  EXPECT_EQ(table.column("t")[0], 120.0);
  EXPECT_EQ(table.column("head")[0], 0.5);
  std::ofstream(path) << "t [weeks]\n2\n";
  EXPECT_THROW(with_seconds(read_table(path), path), InputError);
}

TEST(TableOutput, KnowsTheUnitsOfAllColumns) {
  for (const auto& column : history_columns) {
    EXPECT_NE(column_unit(std::string(column.name), 2), "") << column.name;
  }
  EXPECT_EQ(column_unit("discharge", 2), "m3/s/m");
  EXPECT_EQ(column_unit("discharge", 3), "m3/s");
  EXPECT_EQ(column_unit("energy", 2), "J/m");
  EXPECT_EQ(column_unit("no such column", 2), "");
}

/// No chart has the raw name of a column: an underscore is in no words.
TEST(TableOutput, ColumnsHaveWords) {
  const auto expect_words = [](const auto& columns) {
    for (const auto& column : columns) {
      EXPECT_EQ(column_words(std::string(column.name)).find('_'), std::string::npos) << column.name;
    }
  };
  expect_words(history_columns);
  expect_words(ledger_columns);
  expect_words(boundary_columns);
  expect_words(probe_columns);
  expect_words(section_columns);
  EXPECT_EQ(column_words("flux_x"), "Darcy flux along x");
  EXPECT_EQ(column_words("fines_out"), "fines that left");
  EXPECT_EQ(field_words("fines_left"), "fines left");
}

TEST(TableOutput, CoordinatesOfRoundOffAreZero) {
  EXPECT_EQ(place_text({20.0, -5.551e-17}), "(20, 0)");
  EXPECT_EQ(place_text({1.065e-15, 1e-6}), "(0, 1e-06)");
}

TEST(TableOutput, RefusesAnUnknownUnitOfTime) {
  try {
    parse_time_unit("days", "suffuse-post history");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "suffuse-post history: --time-unit: got \"days\"; expected \"s\", \"min\", "
                 "\"h\", \"d\" or \"a\"");
  }
}

}  // namespace table_output_test
}  // namespace suffuse
