#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "results/reader.hpp"
#include "test_paths.hpp"

namespace suffuse {
namespace exact_solution_test {

const std::string reference = test::data_folder() + "/reference/";

Soil paper_soil(const ErosionLaw* law, double rate) {
  Soil soil;
  soil.skeleton_fraction = 0.6;
  soil.grain_density = 2700.0;
  soil.erosion.law = law;
  soil.erosion.rate = rate;
  soil.erosion.start = 2.0;
  return soil;
}

double porosity_of(const Soil& soil, double initial, double time) {
  return exact_porosity(soil.erosion_model(), initial, time, unset);
}

TEST(ExactSolution, AgreesWithTheReferencePorosity) {
  const Table table = read_table(reference + "porosity.csv");
  const std::map<std::string, Soil> soils{
      {"n_const_alpha1e-3", paper_soil(erosion_law("constant"), 1e-3)},
      {"n_const_alpha5e-3", paper_soil(erosion_law("constant"), 5e-3)},
      {"n_log_beta1e-2", paper_soil(erosion_law("logarithmic"), 1e-2)}};
  ASSERT_GT(table.rows(), 10U);
  for (const auto& [column, soil] : soils) {
    for (std::size_t row = 0; row < table.rows(); ++row) {
      const double t = table.column("t")[row];
      EXPECT_NEAR(porosity_of(soil, 0.3, t), table.column(column)[row], 1e-10)
          << column << " at t = " << t;
    }
  }
}

TEST(ExactSolution, AgreesWithTheReferenceMasses) {
  std::ifstream in(reference + "masses.csv");
  std::string line;
  std::getline(in, line);
  int rows = 0;
  while (std::getline(in, line)) {
    std::istringstream cells(line);
    std::string law;
    std::string cell;
    std::getline(cells, law, ',');
    std::vector<double> numbers;
    while (std::getline(cells, cell, ',')) numbers.push_back(std::stod(cell));
    const Soil soil =
        paper_soil(law == "log" ? erosion_law("logarithmic") : erosion_law("constant"), numbers[0]);
    const double porosity = porosity_of(soil, 0.3, numbers[2]);
    EXPECT_NEAR(porosity, numbers[3], 1e-10) << line;
    EXPECT_NEAR((1.0 - porosity) * 2700.0, numbers[4], 1e-10 * 2700.0) << line;
    EXPECT_NEAR((porosity - 0.3) * 2700.0, numbers[5], 1e-10 * 2700.0) << line;
    ++rows;
  }
  EXPECT_EQ(rows, 132);
}

TEST(ExactSolution, LogarithmicLawSolvesItsEquation) {
  const Soil soil = paper_soil(erosion_law("logarithmic"), 1e-2);
  for (const double t : {2.1, 5.0, 50.0, 400.0}) {
    const double h = 1e-4 * (t - 2.0);
    const double slope =
        (porosity_of(soil, 0.3, t + h) - porosity_of(soil, 0.3, t - h)) / (2.0 * h);
    const double rate = -1e-2 * std::log(porosity_of(soil, 0.3, t) / 0.4);
    EXPECT_NEAR(slope, rate, 1e-6 * rate) << t;
  }
}

TEST(ExactSolution, LogarithmicLawNearsItsCapWithoutEnd) {
  const Soil soil = paper_soil(erosion_law("logarithmic"), 1e-2);
  EXPECT_LE(porosity_of(soil, 0.3, 1e6), 0.4);
  EXPECT_NEAR(porosity_of(soil, 0.3, 1e6), 0.4, 1e-12);
  EXPECT_EQ(porosity_of(soil, 0.4, 50.0), 0.4);
}

TEST(ExactSolution, FirstOrderLawDecaysExponentially) {
  const Soil soil = paper_soil(erosion_law("first-order"), 0.05);
  EXPECT_EQ(porosity_of(soil, 0.3, 1.0), 0.3);
  EXPECT_NEAR(porosity_of(soil, 0.3, 2.0 + std::log(2.0) / 0.05), 0.35, 1e-15);
}

TEST(ExactSolution, FluxLawIsNotExactWithoutTheFlow) {
  const Soil soil = paper_soil(erosion_law("flux"), 4.0);
  EXPECT_FALSE(has_exact_porosity(soil.erosion_model()));
  EXPECT_TRUE(std::isnan(porosity_of(soil, 0.3, 10.0)));
  EXPECT_EQ(porosity_of(soil, 0.3, 2.0), 0.3);
  EXPECT_EQ(porosity_of(soil, 0.4, 10.0), 0.4);
  EXPECT_TRUE(has_exact_porosity(paper_soil(erosion_law("first-order"), 4.0).erosion_model()));
}

TEST(ExactSolution, WithoutALawNothingErodes) {
  EXPECT_EQ(porosity_of(paper_soil(erosion_law("none"), 1.0), 0.3, 100.0), 0.3);
}

}  // namespace exact_solution_test
}  // namespace suffuse
