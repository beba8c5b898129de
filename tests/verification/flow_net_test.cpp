/// The flow net under a sheet pile, from scene to net: right angles, squares, equal discharges, and
/// a discharge that equals that of the tables and the exact one.

#include "figures/flow_net.hpp"

#include <gtest/gtest.h>
#include <Eigen/LU>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <numbers>
#include <set>

#include "common/errors.hpp"
#include "drawing/line_labels.hpp"
#include "test_paths.hpp"
#include "values/sample.hpp"

namespace suffuse {
namespace flow_net_test {

constexpr double conductivity = 1e-4;  // m/s
constexpr double fall = 2.5;           // m
constexpr double depth = 6.0;          // m
constexpr double half_length = 12.0;   // m

const std::string pile_scene = test::source_folder() + "/workflows/pictures/pile.toml";

/// Runs a scene for a second, with the changes of `changes`, and reads it.
ResultsReader pile_run(const std::string& name, const std::string& changes = "",
                       const std::string& scene = pile_scene) {
  const auto folder = std::filesystem::path(::testing::TempDir()) / "flow_net_test";
  std::filesystem::create_directories(folder);
  const std::string stem = (folder / name).string();
  std::filesystem::remove_all(stem + ".results");
  const std::string bin = test::program_folder();
  const std::string command = bin + "/suffuse-mesher " + scene +
                              " --set time.end=1.0 --set output.every=1.0 " + changes + " -o " +
                              stem + ".case.h5 > " + stem + ".log && " + bin + "/suffuse-solver " +
                              stem + ".case.h5 -o " + stem + ".results > " + stem + ".log 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  return ResultsReader(stem + ".results");
}

/// Gradients at nodes: means over the elements around, by area.
std::vector<Vector<2>> gradients(const Mesh<2>& mesh, const std::vector<double>& at_nodes) {
  std::vector<Vector<2>> sums(mesh.nodes.size(), Vector<2>::Zero());
  std::vector<double> areas(mesh.nodes.size(), 0.0);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto& [a, b, c] = mesh.elements[e];
    Eigen::Matrix2d ways;
    ways << (mesh.nodes[b] - mesh.nodes[a]).transpose(),
        (mesh.nodes[c] - mesh.nodes[a]).transpose();
    const Vector<2> gradient =
        ways.inverse() * Vector<2>(at_nodes[b] - at_nodes[a], at_nodes[c] - at_nodes[a]);
    const double area = element_volume(mesh, e);
    for (const int node : mesh.elements[e]) {
      sums[node] += area * gradient;
      areas[node] += area;
    }
  }
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] /= areas[i];
  return sums;
}

/// Largest deviation from right angles between the lines of two fields, degrees, at nodes that are
/// not on the edge and are further than `away` from the foot of the pile and the lower corners of
/// the soil.
double worst_angle(const FlowNet& net, double away) {
  const Mesh<2>& mesh = net.map.mesh;
  const auto h = gradients(mesh, net.map.head);
  const auto psi = gradients(mesh, net.stream.at_nodes);
  std::set<int> edge;
  for (const auto& nodes : outer_edges(mesh)) edge.insert(nodes.begin(), nodes.end());
  double worst = 0.0;
  for (int i = 0; i < mesh.node_count(); ++i) {
    const Vector<2>& x = mesh.nodes[i];
    bool near = edge.contains(i);
    for (const Vector<2>& corner : {Vector<2>(0.0, -0.5 * depth), Vector<2>(-half_length, -depth),
                                    Vector<2>(half_length, -depth)}) {
      near = near || (x - corner).norm() < away;
    }
    if (near) continue;
    const double cosine = std::abs(h[i].dot(psi[i])) / (h[i].norm() * psi[i].norm());
    worst = std::max(worst, std::asin(cosine) * 180.0 / std::numbers::pi);
  }
  return worst;
}

/// q / (k H) under a pile of the share s of the depth, in a layer that ends at `half_length` on
/// both sides: sn, with a small modulus, maps half of it, a rectangle, to a half-plane.
double exact_discharge(double s) {
  const double nome = std::exp(-2.0 * std::numbers::pi * half_length / depth);
  const double k = 4.0 * std::sqrt(nome) * (1.0 - 4.0 * nome);
  const double foot = std::sin(0.5 * std::numbers::pi * (1.0 - 2.0 * s));  // sn, to k^2
  const double edge = 1.0 / k;
  const double m = (foot + 1.0) * (edge - 1.0) / (2.0 * (edge - foot));
  return 0.5 * std::comp_ellint_1(std::sqrt(m)) / std::comp_ellint_1(std::sqrt(1.0 - m));
}

TEST(FlowNet, HasTheDischargeOfTheTablesAndTheExactOne) {
  const ResultsReader run = pile_run("pile");
  const FlowNet net = flow_net(run, 0.0, {});
  EXPECT_LT(net.stream.misfit, 1e-10);
  EXPECT_NEAR(net.stream.discharge / run.sections().column("discharge")[0], 1.0, 1e-10);
  for (const NamedTable& boundary : run.boundaries()) {
    EXPECT_NEAR(std::abs(boundary.table.column("discharge")[0]) / net.stream.discharge, 1.0, 1e-10);
  }
  EXPECT_NEAR(std::ranges::max(net.stream.at_nodes) / net.stream.discharge, 1.0, 1e-10);
  const double exact = exact_discharge(0.5);
  EXPECT_NEAR(exact, 0.49829, 1e-5);
  std::cout << "q / (k H) = " << net.stream.discharge / (conductivity * fall) << ", exact " << exact
            << '\n';
  EXPECT_NEAR(net.stream.discharge / (conductivity * fall) / exact, 1.0, 1e-2);
  EXPECT_EQ(net.tubes, 4);
  EXPECT_EQ(net.drops, 8);
  for (const auto& line : net.caption) std::cout << line << '\n';
}

TEST(FlowNet, HasRightAnglesAwayFromCorners) {
  // Elements of 0.4 m in a layer of 6 m, and of 0.05 m at the foot of the pile.
  const FlowNet net = flow_net(pile_run("angles"), 0.0, {});
  const double near = worst_angle(net, 0.5);
  const double far = worst_angle(net, 1.0);
  std::cout << "off right angles by " << near << " degrees 0.5 m away, " << far << " 1 m away\n";
  EXPECT_LT(near, 2.0);
  EXPECT_LT(far, 1.0);
}

TEST(FlowNet, HasEqualDischargeBetweenItsStreamlines) {
  const ResultsReader run = pile_run("tubes");
  const FlowNet net = flow_net(run, 0.0, 5);
  ASSERT_EQ(net.tubes, 5);
  EXPECT_EQ(net.drops, 10);
  // Crossings of the drawn lines with a vertical line close to the pile, and the flux of the
  // elements along it between two crossings.
  const double x = 1e-3;
  std::vector<double> crossings{-depth, -0.5 * depth};
  const std::vector<double> none;
  for (int k = 1; k < net.tubes; ++k) {
    const double level = k * net.stream.discharge / net.tubes;
    for (const Polyline& line : level_lines({net.map.mesh, net.stream.at_nodes, none}, level)) {
      for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        const double a = line[i][0] - x;
        const double b = line[i + 1][0] - x;
        if ((a < 0.0) == (b < 0.0)) continue;
        crossings.push_back((line[i] + a / (a - b) * (line[i + 1] - line[i]))[1]);
      }
    }
  }
  std::ranges::sort(crossings);
  ASSERT_EQ(crossings.size(), 6U);
  constexpr int pieces = 4000;
  for (int k = 0; k < net.tubes; ++k) {
    const double piece = (crossings[k + 1] - crossings[k]) / pieces;
    std::vector<Position> places;
    for (int i = 0; i < pieces; ++i) {
      places.push_back(Vector<2>(x, crossings[k] + (i + 0.5) * piece));
    }
    const Table flux = sample(run, {{0.0}, places, {"darcy_flux"}});
    double sum = 0.0;
    for (const double q : flux.column("darcy_flux_x")) sum += q * piece;
    EXPECT_NEAR(sum * net.tubes / net.stream.discharge, 1.0, 1e-2) << k;
  }
}

TEST(FlowNet, SaysWhatItIsNot) {
  const FlowNet layered =
      flow_net(pile_run("layered", "--set 'soil.sand.conductivity=[1e-4,2.5e-5]'"), 0.0, {});
  EXPECT_EQ(layered.caption.back(),
            "No right angles in sand, which conducts 4 times as well along its bedding as across");
  EXPECT_LT(layered.stream.misfit, 1e-10);
  const FlowNet plain = flow_net(pile_run("plain"), 0.0, 4);
  ASSERT_EQ(plain.caption.size(), 3U);
  EXPECT_EQ(plain.caption[0],
            "q = 1.24e-4 m3/s per m, N_f = 4 tubes with 3.099e-5 m3/s per m each");
  EXPECT_EQ(plain.caption[1], "H = 2.5 m, N_d = 8 drops of 0.3125 m");
  EXPECT_EQ(plain.caption[2], "Squares: k H N_f / N_d = 1.25e-4 m3/s per m");
}

std::string refusal(const auto& body) {
  try {
    body();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(FlowNet, RefusesRestAndTimesAndTubesThatCannotBe) {
  const ResultsReader rest = pile_run("rest", "--set 'boundary[1].head=3.0'");
  EXPECT_NE(refusal([&] { flow_net(rest, 0.0, {}); }).find("where the liquid is at rest"),
            std::string::npos);
  EXPECT_EQ(refusal([&] { flow_net(rest, 0.0, 0); }),
            "suffuse-post figure flownet: --tubes: got 0; expected a number from 1 to 100");
  EXPECT_EQ(refusal([&] { flow_net(rest, 1e9, {}); }),
            "suffuse-post figure flownet: --time: got 1e+09; expected a time from 0 to 1 s, the "
            "first and last snapshot");
}

TEST(FlowNet, RefusesADrainInsideTheModel) {
  const auto folder = std::filesystem::path(::testing::TempDir()) / "flow_net_test";
  std::filesystem::create_directories(folder);
  const std::string path = (folder / "drain.toml").string();
  std::ofstream(path) << "formulation = \"single-point\"\ngravity = [0.0, -9.81]\n"
                      << "geometry.file = \"" + test::data_folder() + "/geometry/sheet_pile.geo\"\n"
                      << R"(
    mesh = { size = 0.25, structure = "free" }
    liquid = { density = 1000.0, bulk_modulus = inf, viscosity = 1e-3 }
    soil.specimen = { porosity = 0.3, skeleton_fraction = 0.6, grain_density = 2700.0, conductivity = 1e-4 }
    boundary = [{ on = "left", head = 2.0, concentration = 0.0 }, { on = "right", head = 1.0 }]
    wall = [{ on = "pile" }]
    well = [{ on = "drain", head = 0.5 }]
    initial.flow = "steady"
    time.end = 1.0
    output.every = 1.0
  )";
  const ResultsReader run = pile_run("drain", "", path);
  const std::string text = refusal([&] { flow_net(run, 0.0, {}); });
  EXPECT_NE(
      text.find(" m3/s leave inside the model at \"drain\"; expected a flow through the outer "
                "edge only: around a well or drain no streamlines have equal discharge"),
      std::string::npos)
      << text;
}

TEST(FlowNet, HasSquaresOfAnyShareOfTheHead) {
  const auto expect = [](const SquareNet& net, int tubes, int drops) {
    EXPECT_EQ(net.tubes, tubes);
    EXPECT_EQ(net.drops, drops);
  };
  expect(square_net(2.0, {}), 4, 8);
  expect(square_net(2.0, 3), 3, 6);
  expect(square_net(0.5, {}), 8, 4);
  expect(square_net(1.5, {}), 6, 9);
  expect(square_net(1e-6, {}), 100, 1);
  expect(square_net(1e6, {}), 1, 200);
}

}  // namespace flow_net_test
}  // namespace suffuse
