/// Columns in which the exchange of fines depends on the concentration of the liquid, against exact
/// profiles: a suspension that is caught, with unlimited and with limited room; erosion that
/// fluidised fines cause; erosion and deposition at once. In both formulations.

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <functional>
#include <iostream>

#include "grid/element_field.hpp"
#include "model_run.hpp"
#include "reference_table.hpp"

namespace suffuse {
namespace exchange_profiles_test {

struct ExchangeCase {
  const char* name;
  const char* table;
  std::function<void(Scene&)> set;
  double flux;
  double concentration;  ///< of the inflow
};

Scene column_scene(const ExchangeCase& c, Formulation formulation, FlowScheme scheme, double end) {
  Scene scene = model::paper_scene();
  scene.formulation = formulation;
  scene.soils[0].porosity = 0.35;
  scene.soils[0].skeleton_fraction = 0.45;
  c.set(scene);
  scene.boundaries = {model::flux_on("top", c.flux), model::pressure_on("bottom", 0.0)};
  scene.boundaries[0].concentration = c.concentration;
  scene.initial_flow = InitialFlow::steady;
  scene.time.scheme = scheme;
  scene.time.end = end;
  scene.output.every = scene.output.snapshot_every = end;
  if (scheme == FlowScheme::implicit_mixed) {
    scene.liquid.bulk_modulus = std::numeric_limits<double>::infinity();
  }
  return scene;
}

const ExchangeCase first_order{"caught", "deposition-first-order.csv",
                               [](Scene& s) { s.soils[0].deposition.coefficient = 2.0; }, 1e-3,
                               0.02};
const ExchangeCase blocking{"caught_with_room", "deposition-blocking.csv",
                            [](Scene& s) {
                              s.soils[0].deposition.coefficient = 3.0;
                              s.soils[0].deposition.porosity_min = 0.30;
                            },
                            1e-3, 0.05};
const ExchangeCase autocatalytic{"autocatalytic", "erosion-autocatalytic.csv",
                                 [](Scene& s) {
                                   s.soils[0].erosion.law = erosion_law("autocatalytic");
                                   s.soils[0].erosion.drive = drive_law("flux");
                                   s.soils[0].erosion.rate = 8.0;
                                 },
                                 1e-3, 0.05};

/// Exact n_L and c at a depth and time, linear between the rows of the table.
class Exact {
 public:
  Exact(const std::string& table, double time) {
    for (const ReferenceRow& row : read_reference(table)) {
      lowest_porosity_ = std::min(lowest_porosity_, row.number("n_L"));
      highest_porosity_ = std::max(highest_porosity_, row.number("n_L"));
      highest_concentration_ = std::max(highest_concentration_, row.number("c"));
      if (row.number("t") != time) continue;
      x_.push_back(row.number("x"));
      porosity_.push_back(row.number("n_L"));
      concentration_.push_back(row.number("c"));
    }
  }
  [[nodiscard]] std::size_t size() const { return x_.size(); }
  [[nodiscard]] double x(std::size_t k) const { return x_[k]; }
  [[nodiscard]] double porosity(std::size_t k) const { return porosity_[k]; }
  [[nodiscard]] double concentration(std::size_t k) const { return concentration_[k]; }
  /// Range over all places and times of the table.
  [[nodiscard]] double range_of_porosity() const { return highest_porosity_ - lowest_porosity_; }
  [[nodiscard]] double range_of_concentration() const { return highest_concentration_; }

 private:
  double lowest_porosity_ = 1.0;
  double highest_porosity_ = 0.0;
  double highest_concentration_ = 0.0;
  std::vector<double> x_;
  std::vector<double> porosity_;
  std::vector<double> concentration_;
};

struct Profile {
  double porosity;
  double concentration;
};

/// Means over the width of a thin slice at a depth, from element-wise linear fields of a snapshot.
class Slices {
 public:
  Slices(const Mesh<2>& mesh, const Snapshot& snapshot) : mesh_(mesh) {
    for (const Field& field : snapshot.element_vertex) {
      if (field.name == "porosity") porosity_ = &field.values;
      if (field.name == "concentration") concentration_ = &field.values;
    }
  }
  /// Values at depth x below the top, on the vertical through the middle of the column.
  [[nodiscard]] Profile at(double x) const {
    double n = 0.0;
    double c = 0.0;
    int count = 0;
    for (int e = 0; e < mesh_.element_count(); ++e) {
      const auto& nodes = mesh_.elements[e];
      double low = 1e9;
      double high = -1e9;
      for (const int i : nodes) {
        low = std::min(low, mesh_.nodes[i][1]);
        high = std::max(high, mesh_.nodes[i][1]);
      }
      const double y = std::clamp(1.0 - x, 1e-9, 1.0 - 1e-9);
      if (y < low - 1e-12 || y > high + 1e-12) continue;
      // The place at this height on the vertical through the centroid.
      const Vector<2> place(element_centroid(mesh_, e)[0], y);
      Eigen::Matrix3d a;
      for (int k = 0; k < 3; ++k) {
        a.col(k) = Eigen::Vector3d(1.0, mesh_.nodes[nodes[k]][0], mesh_.nodes[nodes[k]][1]);
      }
      const Eigen::Vector3d lambda = a.inverse() * Eigen::Vector3d(1.0, place[0], place[1]);
      for (int k = 0; k < 3; ++k) {
        n += lambda[k] * (*porosity_)[3 * e + k];
        c += lambda[k] * (*concentration_)[3 * e + k];
      }
      ++count;
    }
    return {n / count, c / count};
  }

 private:
  const Mesh<2>& mesh_;
  const std::vector<double>* porosity_ = nullptr;
  const std::vector<double>* concentration_ = nullptr;
};

struct Errors {
  double porosity = 0.0;
  double concentration = 0.0;
};

/// Mean errors at the places of the table, relative to the range of the exact values. The ends are
/// left out, and so are places within `margin` of the front of the suspension, where c falls to
/// zero.
template <class Run>
Errors errors(Run& run, const ExchangeCase& c, double time, double margin) {
  const Exact exact(c.table, time);
  EXPECT_GE(exact.size(), 15U);
  const auto moments = run.run({time}, true);
  const Slices slices(run.input().mesh, moments.snapshots[0]);
  double front = 2.0;
  for (std::size_t k = 0; k < exact.size(); ++k) {
    if (front > 1.0 && exact.concentration(k) == 0.0) front = exact.x(k);
  }
  Errors sum;
  int count = 0;
  for (std::size_t k = 0; k < exact.size(); ++k) {
    // The ends are single vertices, which have no weight in L1.
    const bool end = exact.x(k) == 0.0 || exact.x(k) == 1.0;
    if (end || std::abs(exact.x(k) - front) < margin) continue;
    const Profile found = slices.at(exact.x(k));
    sum.porosity += std::abs(found.porosity - exact.porosity(k)) / exact.range_of_porosity();
    sum.concentration +=
        std::abs(found.concentration - exact.concentration(k)) / exact.range_of_concentration();
    ++count;
  }
  return {sum.porosity / count, sum.concentration / count};
}

Mesh<2> strip(int cells) {
  const int across = std::max(2, cells / 8);
  return model::column_mesh(across, cells, static_cast<double>(across) / cells, 1.0);
}

class ExchangeProfiles : public ::testing::TestWithParam<std::tuple<ExchangeCase, FlowScheme>> {};

TEST_P(ExchangeProfiles, SinglePointFollowsThem) {
  const auto& [c, scheme] = GetParam();
  for (const double time : {450.0, 900.0}) {
    std::vector<Errors> found;
    for (const int cells : {16, 32, 64}) {
      model::ModelRun run(
          model::make_case(strip(cells), column_scene(c, Formulation::single_point, scheme, time)));
      found.push_back(errors(run, c, time, 0.2));
      EXPECT_LE(run.worst_residual(), 1e-12);
    }
    std::cout << c.name << " t " << time << ": n " << found[0].porosity << " -> "
              << found[1].porosity << " -> " << found[2].porosity << ", c "
              << found[0].concentration << " -> " << found[1].concentration << " -> "
              << found[2].concentration << '\n';
    EXPECT_LT(found[1].porosity, 0.01);
    EXPECT_LT(found[1].concentration, 0.01);
    EXPECT_GT(0.5 * std::log2(found[0].porosity / found[2].porosity), 1.5);
    EXPECT_GT(0.5 * std::log2(found[0].concentration / found[2].concentration), 1.5);
  }
}

TEST_P(ExchangeProfiles, DoublePointFollowsThem) {
  const auto& [c, scheme] = GetParam();
  for (const double time : {450.0, 900.0}) {
    Scene scene = column_scene(c, Formulation::double_point, scheme, time);
    scene.points.liquid_per_element = 12;
    model::DoublePointRun run(model::make_double_point_case(strip(32), scene));
    const Errors found = errors(run, c, time, 0.1);
    EXPECT_LE(run.worst_residual(), 1e-12);
    std::cout << c.name << " t " << time << ": n " << found.porosity << ", c "
              << found.concentration << '\n';
    EXPECT_LT(found.porosity, 0.01);
    EXPECT_LT(found.concentration, 0.01);
  }
}

/// Behind the front the concentration is constant, and porosity changes at the rate of the table.
/// `accuracy`: double-point porosity follows from elements, with an error of a share of an element.
template <class Run>
void expect_balance_of_both(Run& run, double accuracy = 0.01) {
  const std::vector<double> times{600.0, 1000.0};
  const auto moments = run.run(times, true);
  const Slices before(run.input().mesh, moments.snapshots[0]);
  const Slices after(run.input().mesh, moments.snapshots[1]);
  double concentration = 0.0;
  double rate = 0.0;
  double highest = 0.0;
  int count = 0;
  for (const ReferenceRow& row : read_reference("erosion-and-deposition.csv")) {
    const double x = row.number("x");
    const double growth = (after.at(x).porosity - before.at(x).porosity) / 400.0;
    concentration += std::abs(after.at(x).concentration - row.number("c"));
    rate += std::abs(growth - row.number("dn_dt")) / 2e-5;
    highest = std::max(highest, row.number("c"));
    ++count;
  }
  std::cout << "c " << concentration / highest / count << ", dn/dt " << rate / count << '\n';
  EXPECT_GE(count, 20);
  EXPECT_LT(concentration / highest / count, 0.01);
  EXPECT_LT(rate / count, accuracy);
  EXPECT_LE(run.worst_residual(), 1e-12);
}

const ExchangeCase both{"both", "",
                        [](Scene& s) {
                          s.soils[0].erosion.law = erosion_law("constant");
                          s.soils[0].erosion.rate = 2e-5;
                          s.soils[0].deposition.coefficient = 2.0;
                        },
                        1e-3, 0.0};

TEST(ErosionAndDeposition, BalanceInSinglePoint) {
  for (const FlowScheme scheme : {FlowScheme::implicit_mixed, FlowScheme::explicit_nodal}) {
    Scene scene = column_scene(both, Formulation::single_point, scheme, 1000.0);
    model::ModelRun run(model::make_case(strip(12), scene));
    expect_balance_of_both(run);
  }
}

TEST(ErosionAndDeposition, BalanceInDoublePoint) {
  for (const auto integration : {PressureIntegration::mixed, PressureIntegration::material_point}) {
    const bool mixed = integration == PressureIntegration::mixed;
    Scene scene =
        column_scene(both, Formulation::double_point,
                     mixed ? FlowScheme::implicit_mixed : FlowScheme::explicit_nodal, 1000.0);
    scene.flow.integration = integration;
    model::DoublePointRun run(model::make_double_point_case(strip(mixed ? 32 : 8), scene));
    expect_balance_of_both(run, mixed ? 0.01 : 0.04);
  }
}

/// In steps of any length, a point keeps the share of fines that its path determines.
TEST(ErosionAndDeposition, PointsAreExactAlongTheirPaths) {
  Scene scene =
      column_scene(first_order, Formulation::double_point, FlowScheme::implicit_mixed, 900.0);
  model::DoublePointRun run(model::make_double_point_case(strip(8), scene));
  const auto moments = run.run({900.0});
  const LiquidPoints<2>& points = moments.states[0].liquid;
  const double entered = 0.02 * 2700.0 / (0.98 * 1000.0);
  int count = 0;
  for (int p = 0; p < points.size(); ++p) {
    const double y = points.place(p).position(run.input().mesh)[1];
    const double expected = entered * std::exp(-2.0 * (1.0 - y));
    EXPECT_NEAR(points.fines_mass[p] / points.water_mass[p], expected, 1e-10) << y;
    ++count;
  }
  EXPECT_GT(count, 100);
}

INSTANTIATE_TEST_SUITE_P(Cases, ExchangeProfiles,
                         ::testing::Combine(::testing::Values(first_order, blocking, autocatalytic),
                                            ::testing::Values(FlowScheme::implicit_mixed)),
                         [](const auto& param_info) { return std::get<0>(param_info.param).name; });

}  // namespace exchange_profiles_test
}  // namespace suffuse
