/// Equilibrium of the solid on material points, dry and quasi-static, against exact solutions: a
/// column under its own weight, an oedometer at large strain, a block that is moved and rotated.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>

#include "box_mesh.hpp"
#include "grid/section_line.hpp"
#include "reference_table.hpp"
#include "solver/solid_model.hpp"

namespace suffuse {
namespace solid_equilibrium_test {

using model::PlaneModel;

enum class MeshKind { regular, crossed, irregular };

std::string name_of(MeshKind kind) {
  return kind == MeshKind::regular   ? "regular"
         : kind == MeshKind::crossed ? "crossed"
                                     : "irregular";
}

/// A column of cells of size h, `soil_rows` of soil and `rows` in all. In an irregular column inner
/// nodes move at random by up to a fifth of h, those at the soil's surface only along it.
Mesh<2> column_of_cells(MeshKind kind, int columns, int soil_rows, int rows, double h) {
  if (kind == MeshKind::crossed) return model::crossed_mesh(columns, rows, columns * h, rows * h);
  Mesh<2> mesh = model::column_mesh(columns, rows, columns * h, rows * h);
  if (kind == MeshKind::regular) return mesh;
  std::mt19937_64 random(7);
  const auto some = [&] {
    return 0.2 * h * (2.0 * static_cast<double>(random() >> 11) * 0x1p-53 - 1.0);
  };
  const auto is_between = [&](double x, double low, double high) {
    return x > low + 0.5 * h && x < high - 0.5 * h;
  };
  for (Vector<2>& x : mesh.nodes) {
    const Vector<2> move(some(), some());
    if (is_between(x[0], 0.0, columns * h)) x[0] += move[0];
    const double surface = soil_rows * h;
    if (is_between(x[1], 0.0, surface) || is_between(x[1], surface, rows * h)) x[1] += move[1];
  }
  return mesh;
}

void stand_between_smooth_walls(PlaneModel& m) {
  for (const char* side : {"bottom", "left", "right"}) m.support(side, Support::normal);
}

// ------------------------------------------------------------------ a column under its own weight

struct ColumnCase {
  MeshKind mesh = MeshKind::regular;
  int points = 4;
  int rows = 64;
  int steps = 10;
};

struct ColumnResult {
  double length_error = 0.0;   ///< relative
  double stress_error = 0.0;   ///< mean of |sigma_yy - exact| over the largest stress
  double mean_tangents = 0.0;  ///< iterations that need a tangent, per step
  int max_tangents = 0;
  int max_iterations = 0;  ///< in addition those with the elastic stiffness
};

/// `exact`: a row of the reference table. The weight is applied in equal steps.
ColumnResult column_under_weight(const ReferenceRow& exact, const ColumnCase& c) {
  const double length = exact.number("l0");
  const double gamma = exact.number("gamma");
  const double h = length / c.rows;
  const int columns = c.mesh == MeshKind::irregular ? 4 : 1;
  PlaneModel m(column_of_cells(c.mesh, columns, c.rows, c.rows + 2, h), c.points,
               model::elastic_soil(exact.number("E_oed"), 0.0),
               [&](const Vector<2>& x) { return x[1] < length; });
  stand_between_smooth_walls(m);
  const double volume = m.soil_volume();
  ColumnResult result;
  for (int step = 1; step <= c.steps; ++step) {
    const NewtonSolution<2> solution = m.step(m.weight(gamma * step / c.steps));
    if (!solution.converged) throw NumericalError("Newton's method did not converge");
    result.mean_tangents += static_cast<double>(solution.tangents()) / c.steps;
    result.max_tangents = std::max(result.max_tangents, solution.tangents());
    result.max_iterations = std::max(result.max_iterations, solution.iterations());
  }
  result.length_error = m.soil_volume() / volume * length / exact.number("length") - 1.0;
  for (int p = 0; p < m.points.size(); ++p) {
    const double depth = length - m.start[p][1];
    result.stress_error += std::abs(m.stress(p)(1, 1) + gamma * depth) *
                           m.points.reference_volume[p] / volume / (gamma * length);
  }
  std::cout << name_of(c.mesh) << ", " << c.points << " points, " << c.rows << " rows, gamma l/E "
            << gamma * length / exact.number("E_oed") << ": length " << 100.0 * result.length_error
            << " %, stress " << 100.0 * result.stress_error << " %, tangents "
            << result.mean_tangents << ", iterations at most " << result.max_iterations << "\n";
  return result;
}

/// Number of steps for the load of a row: fewer if the soil is stiff.
int steps_for(const ReferenceRow& row) {
  return row.number("gamma") * row.number("l0") / row.number("E_oed") > 1.0 ? 40 : 10;
}

TEST(ColumnUnderItsWeight, HasItsLengthInThreeTangentsAStep) {
  for (const ReferenceRow& row : read_reference("self-weight-column.csv")) {
    const ColumnResult r = column_under_weight(row, {.steps = steps_for(row)});
    EXPECT_LE(std::abs(r.length_error), 1e-3);
    EXPECT_LE(r.mean_tangents, 3.3);
    EXPECT_LE(r.max_tangents, 4);
    EXPECT_LE(r.max_iterations, 8);
  }
}

TEST(ColumnUnderItsWeight, HasItsStressToFirstOrder) {
  for (const ReferenceRow& row : read_reference("self-weight-column.csv")) {
    const auto error = [&](int rows) {
      return column_under_weight(row, {.rows = rows, .steps = steps_for(row)}).stress_error;
    };
    const double order = std::log2(error(16) / error(128)) / 3.0;
    std::cout << "order of the stress " << order << "\n";
    EXPECT_GE(order, 0.95);
  }
}

TEST(ColumnUnderItsWeight, HasItsLengthOnCrossedAndIrregularMeshes) {
  const auto rows = read_reference("self-weight-column.csv");
  for (const MeshKind mesh : {MeshKind::crossed, MeshKind::irregular}) {
    for (std::size_t k = 0; k < 2; ++k) {
      const int steps = steps_for(rows[k]);
      const ColumnResult r = column_under_weight(rows[k], {.mesh = mesh, .steps = steps});
      EXPECT_LE(std::abs(r.length_error), 1e-3);
      EXPECT_LE(r.mean_tangents, 3.3);
    }
  }
}

TEST(ColumnUnderItsWeight, WithOtherNumbersOfPoints) {
  const auto rows = read_reference("self-weight-column.csv");
  for (const MeshKind mesh : {MeshKind::regular, MeshKind::crossed, MeshKind::irregular}) {
    for (const int points : {3, 4, 6, 12}) {
      for (const int cells : {32, 64}) {
        const ColumnResult r = column_under_weight(
            rows[1], {.mesh = mesh, .points = points, .rows = cells, .steps = 40});
        if (cells == 64) {
          EXPECT_LE(std::abs(r.length_error), 1e-3);
        }
      }
    }
  }
  // With one point per element, elements become empty where the soil is sheared or compressed; on a
  // regular mesh this works.
  EXPECT_LE(std::abs(column_under_weight(rows[1], {.points = 1, .steps = 40}).length_error), 5e-3);
}

TEST(ColumnUnderItsWeight, HasItsLengthInThreeDimensions) {
  // Points move from tetrahedron to tetrahedron.
  const ReferenceRow exact = read_reference("self-weight-column.csv")[1];
  const double length = exact.number("l0");
  const int rows = 32;
  const double h = length / rows;
  const Vector<3> size(2.0 * h, 2.0 * h, length + 2.0 * h);
  model::SolidModel<3> m(model::box_mesh({2, 2, rows + 2}, size), model::places_in_tetrahedron(),
                         model::elastic_soil(exact.number("E_oed"), 0.0),
                         [&](const Vector<3>& x) { return x[2] < length; });
  for (const char* side : {"bottom", "left", "right", "front", "back"}) {
    m.support(side, Support::normal);
  }
  const double volume = m.soil_volume();
  double iterations = 0.0;
  for (int step = 1; step <= 40; ++step) {
    const auto solution = m.step(m.weight(exact.number("gamma") * step / 40));
    ASSERT_TRUE(solution.converged);
    iterations += solution.iterations() / 40.0;
  }
  const double error = m.soil_volume() / volume * length / exact.number("length") - 1.0;
  std::cout << "three dimensions, 4 points, 32 rows: length " << 100.0 * error << " %, iterations "
            << iterations << "\n";
  EXPECT_LE(std::abs(error), 2e-3);
}

// ------------------------------------------------------------------------------- the oedometer

/// 2 W(1/2), the ratio of heights of soil without lateral strain (nu 0) under a load of half its
/// modulus: ln s = -s/2.
double oedometer_stretch() {
  double s = 0.7;
  for (int k = 0; k < 20; ++k) s -= (std::log(s) + 0.5 * s) / (1.0 / s + 0.5);
  return s;
}

TEST(Oedometer, HasTheValueOfTheTable) {
  EXPECT_NEAR(oedometer_stretch(), 0.7034674225, 1e-10);
}

/// Soil that fills its mesh, [0, 2/rows] x [0, 1], loaded on its top.
struct OedometerModel : PlaneModel {
  OedometerModel(MeshKind kind, int rows, int points_per_element)
      : PlaneModel(column_of_cells(kind, 2, rows, rows, 1.0 / rows), points_per_element,
                   model::elastic_soil(1e6, 0.0)) {
    stand_between_smooth_walls(*this);
    surface = LoadedSurface<2>(grid, sorted, faces_of("top"));
  }
};

TEST(Oedometer, IsExactWhileTheMeshEndsWithTheSoil) {
  for (const MeshKind kind : {MeshKind::regular, MeshKind::crossed, MeshKind::irregular}) {
    for (const int points : {1, 3, 4, 12}) {
      OedometerModel m(kind, 4, points);
      NodalLoads<2> loads(m.grid);
      m.surface.add_traction(m.grid, m.sorted, Vector<2>(0.0, -5e5), loads);
      const NewtonSolution<2> solution = m.step(loads.forces());
      ASSERT_TRUE(solution.converged);
      for (int p = 0; p < m.points.size(); ++p) {
        const double stretch = m.points.volume[p] / m.points.reference_volume[p];
        EXPECT_NEAR(stretch, oedometer_stretch(), 1e-8);
        EXPECT_NEAR(m.stress(p)(1, 1), -5e5, 1e-8 * 5e5);
        EXPECT_NEAR(m.points.position[p][1], stretch * m.start[p][1], 1e-8);
      }
      for (const Vector<2>& x : m.surface.places()) EXPECT_NEAR(x[1], oedometer_stretch(), 1e-8);
    }
  }
}

TEST(Oedometer, IsExactUnderAPlateThatMovesDown) {
  OedometerModel m(MeshKind::irregular, 4, 3);
  m.support("top", Support::normal);
  NodeVectors<2> down;
  for (const Vector<2>& x : m.mesh.nodes) {
    down.emplace_back(0.0, (oedometer_stretch() - 1.0) * x[1] * x[1]);
  }
  ASSERT_TRUE(m.step(m.no_loads(), down).converged);
  for (int p = 0; p < m.points.size(); ++p) EXPECT_NEAR(m.stress(p)(1, 1), -5e5, 1e-8 * 5e5);
}

TEST(Oedometer, KeepsItsHeightWhileTheSurfaceSinksThroughElements) {
  for (const MeshKind kind : {MeshKind::regular, MeshKind::crossed}) {
    for (const int rows : {16, 32, 64}) {
      for (const int steps : {5, 20}) {
        OedometerModel m(kind, rows, 4);
        const double volume = m.soil_volume();
        for (int step = 1; step <= steps; ++step) {
          NodalLoads<2> loads(m.grid);
          m.surface.add_traction(m.grid, m.sorted, Vector<2>(0.0, -5e5 * step / steps), loads);
          ASSERT_TRUE(m.step(loads.forces()).converged);
        }
        const double error = m.soil_volume() / volume / oedometer_stretch() - 1.0;
        std::cout << name_of(kind) << ", " << rows << " rows, " << steps << " steps: " << error
                  << "\n";
        if (rows >= 32) {
          EXPECT_LE(std::abs(error), 1e-3);
        }
      }
    }
  }
}

TEST(Oedometer, IsExactInThreeDimensions) {
  model::SolidModel<3> m(model::box_mesh({2, 2, 3}, Vector<3>::Ones(), model::disturbed(0.05)),
                         model::places_in_tetrahedron(), model::elastic_soil(1e6, 0.0));
  for (const char* side : {"bottom", "left", "right", "front", "back"}) {
    m.support(side, Support::normal);
  }
  m.surface = LoadedSurface<3>(m.grid, m.sorted, m.faces_of("top"));
  NodalLoads<3> loads(m.grid);
  m.surface.add_pressures(
      m.grid, m.sorted, [](const Vector<3>&) { return 5e5; }, loads);
  ASSERT_TRUE(m.step(loads.forces()).converged);
  for (int p = 0; p < m.points.size(); ++p) {
    EXPECT_NEAR(m.points.volume[p] / m.points.reference_volume[p], oedometer_stretch(), 1e-8);
    EXPECT_NEAR(m.points.position[p][2], oedometer_stretch() * m.start[p][2], 1e-8);
  }
}

// ------------------------------------------------------------------------ a block that is carried

/// A step of a motion that rotates a block about its middle and translates it.
struct RigidMotion {
  double angle;  ///< rad per step
  Vector<2> centre;

  [[nodiscard]] Vector<2> displacement(const Vector<2>& x, const Vector<2>& shift) const {
    Eigen::Matrix2d turn;
    turn << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
    return shift + turn * (x - centre) - (x - centre);
  }
};

TEST(CarriedBlock, HasNoStressAndItsVolumeAfterManyTurns) {
  const int cells = 20;
  for (const MeshKind kind : {MeshKind::regular, MeshKind::crossed, MeshKind::irregular}) {
    PlaneModel m(column_of_cells(kind, cells, cells, cells, 1.0 / cells), 4,
                 model::elastic_soil(1e6, 0.3), [](const Vector<2>& x) {
                   return std::abs(x[0] - 0.5) < 0.15 && std::abs(x[1] - 0.4) < 0.15;
                 });
    const int steps = 360;  // ten turns of ten degrees a step
    RigidMotion motion{std::numbers::pi / 18.0, Vector<2>(0.5, 0.4)};
    const double volume = m.soil_volume();
    for (int step = 0; step < steps; ++step) {
      const double at = 2.0 * std::numbers::pi * step / 90.0;
      const Vector<2> shift = 0.006 * Vector<2>(std::cos(at), std::sin(at));
      NodeVectors<2> displacement;
      for (const Vector<2>& x : m.mesh.nodes) {
        displacement.push_back(motion.displacement(x, shift));
      }
      move_points(m.grid, m.skeleton, displacement, increments_of(m.grid, displacement), m.points,
                  1);
      m.sort();
      motion.centre += shift;
    }
    double worst = 0.0;
    for (int p = 0; p < m.points.size(); ++p) {
      worst = std::max(worst, m.stress(p).norm() / 1e6);
      EXPECT_LE((m.points.position[p] - m.start[p]).norm(), 1e-11);
    }
    std::cout << name_of(kind) << ": stress over E " << worst << ", volume "
              << m.soil_volume() / volume - 1.0 << "\n";
    EXPECT_LE(worst, 1e-10);
    EXPECT_NEAR(m.soil_volume() / volume, 1.0, 1e-12);
  }
}

/// The mean of |sigma|/E in a block that follows its core, which is rotated by half a turn in
/// `steps` steps. Checks the largest one too.
double stress_of_turned_block(int steps) {
  const int cells = 12;
  PlaneModel m(model::crossed_mesh(cells, cells, 1.0, 1.0), 4, model::elastic_soil(1e6, 0.3),
               [](const Vector<2>& x) {
                 return std::abs(x[0] - 0.5) < 0.25 && std::abs(x[1] - 0.5) < 0.25;
               });
  std::vector<int> held;
  for (int i = 0; i < m.mesh.node_count(); ++i) {
    if ((m.mesh.nodes[i] - Vector<2>(0.5, 0.5)).norm() < 0.15) held.push_back(i);
  }
  const RigidMotion motion{std::numbers::pi / steps, Vector<2>(0.5, 0.5)};
  NodeVectors<2> turn;
  for (const Vector<2>& x : m.mesh.nodes) turn.push_back(motion.displacement(x, Vector<2>::Zero()));
  const double volume = m.soil_volume();
  for (int step = 0; step < steps; ++step) {
    if (!m.step(m.no_loads(), turn, held).converged) throw NumericalError("not converged");
  }
  double worst = 0.0;
  double mean = 0.0;
  double astray = 0.0;
  for (int p = 0; p < m.points.size(); ++p) {
    const double stress = m.stress(p).norm() / 1e6;
    worst = std::max(worst, stress);
    mean += stress / m.points.size();
    const Vector<2> expected = Vector<2>(1.0, 1.0) - m.start[p];
    astray = std::max(astray, (m.points.position[p] - expected).norm());
  }
  std::cout << "half a turn in " << steps << " steps: stress over E at most " << worst << ", mean "
            << mean << ", volume " << m.soil_volume() / volume - 1.0 << ", astray by " << astray
            << "\n";
  EXPECT_LE(worst, 6e-3);
  EXPECT_LE(astray, 4e-3);
  EXPECT_NEAR(m.soil_volume() / volume, 1.0, 1e-4);
  return mean;
}

TEST(CarriedBlock, IsHinderedByTheSoftElementsAtItsEdgeLessInSmallerSteps) {
  // Rotation deforms partial elements, and their soft stiffness resists it like a drag: in
  // proportion to the step.
  EXPECT_NEAR(stress_of_turned_block(90) / stress_of_turned_block(180), 2.0, 0.5);
}

TEST(CarriedBlock, TurnsAboutANodeByWhichItHangsAsFarAsTheSoftStiffnessLetsIt) {
  // The upper cell touches the others in the node (0.5, 0.5), about which it could rotate freely.
  // Its moment is weight V a/2; at a rotation theta, |grad du|^2 = 2 theta^2.
  const double weight = 1e3;
  const double young = 1e6;
  PlaneModel m(model::column_mesh(4, 4), 4, model::elastic_soil(young, 0.3),
               [](const Vector<2>& x) {
                 return (x[0] < 0.5 && x[1] < 0.5) ||
                        (x[0] > 0.5 && x[0] < 0.75 && x[1] > 0.5 && x[1] < 0.75);
               });
  m.support("bottom", Support::both);
  const NewtonSolution<2> solution = m.step(m.weight(weight));
  ASSERT_TRUE(solution.converged);
  const auto settlement = [&](double x, double y) {
    const auto place = find_place(m.grid, Vector<2>(x, y));
    return -interpolate(m.grid, *place, solution.displacement)[1];
  };
  const double turn = (settlement(0.75, 0.5) - settlement(0.5, 0.5)) / 0.25;
  std::cout << "turned by " << turn << "\n";
  EXPECT_NEAR(turn, weight * 0.125 / (2.0 * SoftStiffness().gradient * young), 3e-4);
}

// ------------------------------------------------------------------------------ Newton's method

TEST(Newton, ConvergesQuadratically) {
  // A column that bulges to the right.
  PlaneModel m(column_of_cells(MeshKind::irregular, 8, 16, 18, 1.0 / 16), 4,
               model::elastic_soil(1e5, 0.3),
               [](const Vector<2>& x) { return x[1] < 1.0 && x[0] < 0.25; });
  m.support("bottom", Support::both);
  m.support("left", Support::normal);
  m.limits.tolerance = 1e-13;
  const NewtonSolution<2> solution = m.step(m.weight(6e4));
  ASSERT_TRUE(solution.converged);
  int quadratic = 0;
  for (std::size_t k = 0; k + 1 < solution.residuals.size(); ++k) {
    std::cout << solution.residuals[k] << " -> " << solution.residuals[k + 1] << "\n";
    const double before = solution.residuals[k];
    const double after = solution.residuals[k + 1];
    if (before > 1e-2 || after < 1e-12) continue;
    EXPECT_LE(after, 10.0 * before * before);
    ++quadratic;
  }
  EXPECT_GE(quadratic, 2);
}

TEST(Newton, TakesPartOfAStepThatWouldTurnElementsInsideOut) {
  // The load is six times that which halves the column: the first step of Newton's method alone
  // would end far below the bottom.
  OedometerModel m(MeshKind::regular, 4, 3);
  NodalLoads<2> loads(m.grid);
  m.surface.add_traction(m.grid, m.sorted, Vector<2>(0.0, -3e6), loads);
  const NewtonSolution<2> solution = m.step(loads.forces());
  ASSERT_TRUE(solution.converged);
  for (int p = 0; p < m.points.size(); ++p) EXPECT_NEAR(m.stress(p)(1, 1), -3e6, 1e-3);
}

}  // namespace solid_equilibrium_test
}  // namespace suffuse
