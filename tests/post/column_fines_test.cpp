#include "values/column_fines.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "post/synthetic_results.hpp"
#include "test_paths.hpp"

namespace suffuse {
namespace column_fines_test {

using testing::ScratchFolder;

const std::string reference = test::data_folder() + "/reference/";

/// The first word of a line, and the numbers after it.
struct Line {
  std::string law;
  std::vector<double> numbers;
};

std::vector<Line> read_lines(const std::string& name) {
  std::ifstream in(reference + name);
  std::string text;
  std::getline(in, text);
  std::vector<Line> lines;
  while (std::getline(in, text)) {
    std::istringstream cells(text);
    Line line;
    std::getline(cells, line.law, ',');
    std::string cell;
    while (std::getline(cells, cell, ',')) line.numbers.push_back(std::stod(cell));
    lines.push_back(line);
  }
  return lines;
}

ColumnFlow paper_flow(const std::string& law, double rate, double flux) {
  ColumnFlow flow;
  flow.soil.porosity = 0.3;
  flow.soil.skeleton_fraction = 0.6;
  flow.soil.grain_density = 2700.0;
  flow.soil.erosion.law = law == "log" ? erosion_law("logarithmic") : erosion_law("constant");
  flow.soil.erosion.rate = rate;
  flow.soil.erosion.start = 2.0;
  flow.porosity = 0.3;
  flow.length = 1.0;
  flow.width = 1.0;
  flow.flux = flux;
  return flow;
}

// Columns: par, q, t, n_L, M_solid, M_eroded_total, M_fluidised_in, M_water_in, M_eroded_out,
// c_out.
TEST(ColumnFines, AgreesWithTheReferenceMasses) {
  const auto lines = read_lines("masses.csv");
  ASSERT_GT(lines.size(), 100U);
  for (const auto& line : lines) {
    const auto& v = line.numbers;
    const ColumnFines fines(paper_flow(line.law, v[0], v[1]), v[2]);
    EXPECT_NEAR(fines.fines(v[2]), v[6], 2e-8) << line.law << " t = " << v[2];
    EXPECT_NEAR(fines.fines_out(v[2]), v[8], 2e-8) << line.law << " t = " << v[2];
    EXPECT_NEAR(fines.concentration(1.0, v[2]), v[9], 1e-10) << line.law << " t = " << v[2];
  }
}

// Columns: par, q, t, x, n_L, n_f, c.
TEST(ColumnFines, AgreesWithTheReferenceProfiles) {
  const auto lines = read_lines("fines-profile.csv");
  ASSERT_GT(lines.size(), 100U);
  for (const auto& line : lines) {
    const auto& v = line.numbers;
    const ColumnFines fines(paper_flow(line.law, v[0], v[1]), v[2]);
    EXPECT_NEAR(fines.concentration(v[3], v[2]), v[6], 1e-10)
        << line.law << " x = " << v[3] << " t = " << v[2];
  }
}

TEST(ColumnFines, NothingMovesBeforeErosion) {
  const ColumnFines fines(paper_flow("const", 1e-3, 0.012), 10.0);
  EXPECT_EQ(fines.concentration(1.0, 1.5), 0.0);
  EXPECT_NEAR(fines.fines(1.5), 0.0, 1e-10);
  EXPECT_NEAR(fines.fines_out(2.0), 0.0, 1e-10);
}

std::optional<ColumnFlow> flow_of(const ScratchFolder& scratch, Case<2> c, const std::string& from,
                                  const std::string& to) {
  std::string text = c.document.text;
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
  c.document = parse_scene(text, "changed.toml");
  const std::string folder = scratch / (c.document.scene.name + ".results");
  std::filesystem::remove_all(folder);
  { const ResultsWriter<2> writer(folder, c); }
  return column_flow(ResultsReader(folder));
}

TEST(ColumnFlow, ComesFromTheHeadsAtBothEnds) {
  const ScratchFolder scratch;
  const Case<2> c = testing::unit_square_case();
  const auto flow = flow_of(scratch, c, "start = 2.0", "start = 3.0");
  ASSERT_TRUE(flow);
  EXPECT_NEAR(flow->flux, 2e-2 * 6000.0 / (1000.0 * 9.81), 1e-16);
  EXPECT_EQ(flow->length, 1.0);
  EXPECT_EQ(flow->soil.erosion.start, 3.0);
}

TEST(ColumnFlow, ComesFromAFluxOrAVelocityInFreeWater) {
  const ScratchFolder scratch;
  const Case<2> c = testing::double_point::column();
  auto flow = flow_of(scratch, c, "darcy_flux = 0.02", "darcy_flux = 0.03");
  ASSERT_TRUE(flow);
  EXPECT_EQ(flow->flux, 0.03);
  EXPECT_EQ(flow->length, 1.0);
  flow = flow_of(scratch, c, "darcy_flux = 0.02", "velocity = 0.12");
  ASSERT_TRUE(flow);
  EXPECT_EQ(flow->flux, 0.12);
  // Two metres of soil, half of them buffers, resist the head.
  flow = flow_of(scratch, c, "darcy_flux = 0.02", "pressure = 9810.0");
  ASSERT_TRUE(flow);
  EXPECT_NEAR(flow->flux, 2e-2 / 2.0, 1e-16);
}

TEST(ColumnFlow, OfTheFluxLawErodesAsFirstOrderAtItsFlux) {
  const ScratchFolder scratch;
  const auto flow = flow_of(scratch, testing::double_point::column(),
                            "law = \"constant\"\nrate = 0.001", "law = \"flux\"\nrate = 4.0");
  ASSERT_TRUE(flow);
  ColumnFlow first_order = *flow;
  first_order.soil.erosion.law = erosion_law("first-order");
  first_order.soil.erosion.rate = 4.0 * 0.02;
  const ColumnFines fines(*flow, 60.0);
  const ColumnFines expected(first_order, 60.0);
  for (const double t : {10.0, 30.0, 60.0}) {
    EXPECT_GT(fines.concentration(1.0, t), 0.0);
    EXPECT_NEAR(fines.concentration(1.0, t), expected.concentration(1.0, t), 1e-14) << t;
  }
}

TEST(ColumnFlow, IsThereForLevelTablesAndNotForChangingOnes) {
  const ScratchFolder scratch;
  const Case<2> c = testing::double_point::column();
  auto flow = flow_of(scratch, c, "darcy_flux = 0.02", "darcy_flux = [[0, 0.03], [9, 0.03]]");
  ASSERT_TRUE(flow);
  EXPECT_EQ(flow->flux, 0.03);
  EXPECT_FALSE(flow_of(scratch, c, "darcy_flux = 0.02", "darcy_flux = [[0, 0.0], [9, 0.03]]"));
  EXPECT_FALSE(flow_of(scratch, c, "darcy_flux = 0.02", "velocity = [[0, 0.0], [9, 0.03]]"));
  EXPECT_FALSE(flow_of(scratch, c, "darcy_flux = 0.02",
                       "darcy_flux = 0.02\nconcentration = [[0, 0.0], [9, 0.1]]"));
  const Case<2> heads = testing::unit_square_case();
  EXPECT_TRUE(flow_of(scratch, heads, "pressure = 6.0e3", "pressure = [[0, 6.0e3]]"));
  EXPECT_FALSE(flow_of(scratch, heads, "pressure = 6.0e3", "pressure = [[0, 0], [1, 6.0e3]]"));
}

TEST(ColumnFlow, IsNotThatOfHeadsWhereConductivityGrows) {
  const ScratchFolder scratch;
  const std::string conductivity = "conductivity = 2.0e-2";
  const std::string grows = conductivity + "\nconductivity_law = \"kozeny-carman\"";
  EXPECT_FALSE(flow_of(scratch, testing::unit_square_case(), conductivity, grows));
  // A prescribed flux does not depend on the conductivity.
  EXPECT_TRUE(flow_of(scratch, testing::double_point::column(), conductivity, grows));
}

TEST(ColumnFlow, IsNotThatOfHeadsWhereSoilThatOnlyDepositsClogs) {
  const ScratchFolder scratch;
  const std::string deposits = "\ndeposition = {coefficient = 20.0}";
  const std::string clogs = "\nconductivity_law = \"kozeny-carman\"";
  const auto with = [&](const std::string& inflow, const std::string& more) {
    Case<2> c = testing::double_point::column();
    std::string& text = c.document.text;
    text.replace(text.find("explicit"), 8, "implicit");
    const std::string law = "erosion.law = \"none\"";  // of the buffers
    text.replace(text.find(law), law.size(), law + more);
    return flow_of(scratch, c, "darcy_flux = 0.02", inflow);
  };
  EXPECT_TRUE(with("pressure = 9810.0", clogs));
  EXPECT_TRUE(with("pressure = 9810.0", deposits));
  EXPECT_FALSE(with("pressure = 9810.0", deposits + clogs));
  EXPECT_TRUE(with("darcy_flux = 0.02", deposits + clogs));
}

TEST(ColumnFlow, IsNotThereWhereNothingIsExact) {
  const ScratchFolder scratch;
  const Case<2> c = testing::double_point::column();
  EXPECT_FALSE(flow_of(scratch, c, "darcy_flux = 0.02", "darcy_flux = 0.02\nconcentration = 0.1"));
  EXPECT_FALSE(flow_of(scratch, c, "darcy_flux = 0.02", "darcy_flux = 0.0"));
  EXPECT_FALSE(flow_of(scratch, c, "pressure = 0.0",
                       "pressure = 0.0\n[[boundary]]\non = \"left\"\npressure = 1.0"));
  // A porosity gradient has no exact solution; in a double-point column the points would not fit
  // it.
  EXPECT_FALSE(flow_of(scratch, testing::unit_square_case(), "porosity = 0.3",
                       "porosity = 0.3\nporosity_gradient = [0, 0.01]"));
  EXPECT_FALSE(flow_of(scratch, c, "law = \"constant\"", "law = \"none\""));
}

/// The unit square in the implicit scheme, which knows every law.
Case<2> implicit_square() {
  Case<2> c = testing::unit_square_case();
  std::string& text = c.document.text;
  text.replace(text.find("explicit"), 8, "implicit");
  return c;
}

TEST(ColumnFlow, IsNotThatOfAVelocityInSoilThatDeposits) {
  const ScratchFolder scratch;
  Case<2> c = implicit_square();
  c.document.text += "[soil.base]\nlike = \"specimen\"\nerosion.law = \"none\"\n";
  c.mesh.region_names.emplace_back("base");
  c.mesh.element_region = {0, 0, 0, 0, 1, 1, 1, 1};  // below the top
  const auto with = [&](const std::string& more) {
    Case<2> changed = c;
    changed.document.text += more;
    return flow_of(scratch, changed, "pressure = 6.0e3", "velocity = 0.1");
  };
  const auto flow = with("");
  ASSERT_TRUE(flow);
  EXPECT_NEAR(flow->flux, 0.1 * 0.3, 1e-16);
  EXPECT_FALSE(with("deposition = {coefficient = 20.0}\n"));
}

TEST(ColumnFlow, CrossesTheBeddingAndIsNotThereWhereTheBeddingIsTilted) {
  const ScratchFolder scratch;
  const auto with = [&](const std::string& soil) {
    return flow_of(scratch, implicit_square(), "conductivity = 2.0e-2", soil);
  };
  const double gradient = 6000.0 / (1000.0 * 9.81);
  auto flow = with("conductivity = [2.0e-2, 5.0e-3]");
  ASSERT_TRUE(flow);
  EXPECT_NEAR(flow->flux, 5e-3 * gradient, 1e-16);
  flow = with("conductivity = [2.0e-2, 5.0e-3]\nbedding = 90.0");
  ASSERT_TRUE(flow);
  EXPECT_NEAR(flow->flux, 2e-2 * gradient, 1e-16);
  EXPECT_FALSE(with("conductivity = [2.0e-2, 5.0e-3]\nbedding = 20.0"));
}

TEST(ColumnFlow, IsNotThereWhereTheSceneDoesNotDetermineIt) {
  const ScratchFolder scratch;
  const Case<2> c = implicit_square();
  const std::string soil = "conductivity = 2.0e-2";
  EXPECT_TRUE(flow_of(scratch, c, soil, soil));
  EXPECT_FALSE(flow_of(scratch, c, soil, soil + "\nfield = {variation = 0.5, correlation = 0.3}"));
  EXPECT_FALSE(
      flow_of(scratch, c, soil, soil + "\nretention = {model = \"gardner\", alpha = 2.0}"));
  EXPECT_FALSE(flow_of(scratch, c, soil,
                       soil + "\nskeleton = {law = \"elastic\", young = 1e7, poisson = 0.3}"));
  EXPECT_FALSE(flow_of(scratch, c, "[time]", "[initial]\nfrom = \"before.results\"\n[time]"));
}

TEST(ColumnFlow, OfALiquidThatThickensComesFromAFluxAlone) {
  const ScratchFolder scratch;
  const std::string liquid = "viscosity = 1.0e-3";
  const std::string thickens = liquid + "\nviscosity_law = \"krieger-dougherty\"";
  EXPECT_FALSE(flow_of(scratch, implicit_square(), liquid, thickens));
  const auto flow = flow_of(scratch, testing::double_point::column(), liquid, thickens);
  ASSERT_TRUE(flow);
  EXPECT_EQ(flow->flux, 0.02);
}

}  // namespace column_fines_test
}  // namespace suffuse
