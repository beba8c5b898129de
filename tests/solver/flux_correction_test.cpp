#include "grid/flux_correction.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "flow_model.hpp"
#include "mesh/slit.hpp"

namespace suffuse {
namespace flux_correction_test {

using model::FlowModel;
using model::imbalance;
using model::Uniform;

/// Faces with a prescribed pressure.
std::vector<char> held(const FlowModel& m) {
  std::vector<char> result;
  for (const FaceCondition& c : m.forcing.conditions) {
    result.push_back(c.kind == FaceKind::pressure ? 1 : 0);
  }
  return result;
}

TEST(FluxCorrection, BalancesAnyFluxesAndLeavesPrescribedOnesAlone) {
  FlowModel m(model::column_mesh(9, 7, 1.0, 1.0, model::jittered(0.04, 2)));
  m.set("top", FaceKind::pressure, 0.0);
  m.set("left", FaceKind::flux, 1.0);
  Uniform uniform(4);
  std::vector<double> flux(m.grid.face_count());
  for (double& f : flux) f = uniform();
  std::vector<double> net_outflow(m.mesh.element_count());
  std::vector<double> conductance(m.mesh.element_count());
  for (double& v : net_outflow) v = uniform();
  for (double& v : conductance) v = std::pow(10.0, 4.0 * uniform());
  const std::vector<double> before = flux;
  FluxCorrection<2> correction(m.grid, held(m));
  EXPECT_EQ(correction.sealed_piece_count(), 0);
  correction.follow(conductance);
  correction.correct(flux, net_outflow);
  EXPECT_GE(imbalance(m.grid, before, net_outflow), 0.5);
  EXPECT_LE(imbalance(m.grid, flux, net_outflow), 1e-14);
  for (int f = 0; f < m.grid.face_count(); ++f) {
    if (m.forcing.conditions[f].fixes_flux()) {
      EXPECT_EQ(flux[f], before[f]) << f;
    }
  }
}

TEST(FluxCorrection, PassesWallsThatLetLiquidThrough) {
  // Two rooms; the upper one has no outlet except the faces of the wall.
  Mesh<2> mesh = model::column_mesh(3, 4);
  std::vector<std::array<int, 2>> edges;
  for (int i = 0; i < 3; ++i) edges.push_back({8 + i, 9 + i});
  ASSERT_TRUE(slit(mesh, {BoundarySet<2>{"wall", edges}}).empty());
  FlowModel m(mesh);
  m.set("bottom", FaceKind::pressure, 0.0);
  EXPECT_EQ(FluxCorrection<2>(m.grid, held(m)).sealed_piece_count(), 1);

  // The middle face of the wall has the largest conductance.
  const auto& sides = m.mesh.boundaries.back().faces;
  std::vector<LeakyFace> walls;
  std::vector<std::array<int, 2>> pairs;
  for (int i = 0; i < 3; ++i) {
    const auto [face, partner] =
        std::minmax({m.grid.find_face(sides[2 * i]), m.grid.find_face(sides[2 * i + 1])});
    walls.push_back({face, partner, i == 1 ? 1e-4 : 1e-6});
    pairs.push_back({face, partner});
  }
  m.grid.join_faces(pairs);
  FluxCorrection<2> correction(m.grid, held(m), walls);
  EXPECT_EQ(correction.sealed_piece_count(), 0);
  correction.follow(std::vector<double>(m.mesh.element_count(), 1.0));
  std::vector<double> net_outflow(m.mesh.element_count());
  double above = 0.0;
  Uniform uniform(5);
  for (int e = 0; e < m.mesh.element_count(); ++e) {
    net_outflow[e] = uniform();
    if (element_centroid(m.mesh, e)[1] > 0.5) above += net_outflow[e];
  }
  std::vector<double> flux(m.grid.face_count(), 0.0);
  correction.correct(flux, net_outflow);
  EXPECT_LE(imbalance(m.grid, flux, net_outflow), 1e-14);
  for (const auto& [face, partner, conductance] : walls) {
    EXPECT_EQ(flux[face], -flux[partner]);
    const bool face_is_above = element_centroid(m.mesh, m.grid.face_left[face])[1] > 0.5;
    EXPECT_NEAR(flux[face_is_above ? face : partner], conductance > 1e-5 ? above : 0.0, 1e-14);
  }
}

TEST(FluxCorrection, SendsWhatIsMissingAlongTheBestConductors) {
  // A strip of permeable soil at the bottom connects the sealed right side with the open left side.
  FlowModel m(model::column_mesh(8, 4));
  m.set("left", FaceKind::pressure, 0.0);
  std::vector<double> conductance(m.mesh.element_count());
  int source = -1;
  for (int e = 0; e < m.mesh.element_count(); ++e) {
    const Vector<2> x = element_centroid(m.mesh, e);
    conductance[e] = x[1] < 0.25 ? 1.0 : 1e-6;
    if (x[1] < 0.25 && x[0] > 0.9) source = e;
  }
  FluxCorrection<2> correction(m.grid, held(m));
  correction.follow(conductance);
  std::vector<double> net_outflow(m.mesh.element_count(), 0.0);
  net_outflow[source] = 1.0;
  std::vector<double> flux(m.grid.face_count(), 0.0);
  correction.correct(flux, net_outflow);
  EXPECT_LE(imbalance(m.grid, flux, net_outflow), 0.0);
  double out = 0.0;
  for (int f = 0; f < m.grid.face_count(); ++f) {
    if (m.grid.face_centre(f)[1] > 0.25 + 1e-9) {
      EXPECT_EQ(flux[f], 0.0);
    }
    if (m.forcing.conditions[f].kind == FaceKind::pressure) out += flux[f];
  }
  EXPECT_EQ(out, 1.0);
}

TEST(FluxCorrection, TreeFollowsConductancesOnlyWhenTheirRatiosChangeALot) {
  // Flow from the permeable right side to the open left side, through the upper or the lower half.
  FlowModel m(model::column_mesh(8, 4));
  m.set("left", FaceKind::pressure, 0.0);
  FluxCorrection<2> correction(m.grid, held(m));
  const auto through_upper_half = [&](double upper) {
    std::vector<double> conductance(m.mesh.element_count());
    std::vector<double> net_outflow(m.mesh.element_count(), 0.0);
    for (int e = 0; e < m.mesh.element_count(); ++e) {
      const Vector<2> x = element_centroid(m.mesh, e);
      conductance[e] = x[1] < 0.5 ? 1.0 : upper;
      if (x[0] > 0.875) conductance[e] = 1e3;
      if (x[0] > 0.875 && x[1] > 0.75) net_outflow[e] = 1.0;
    }
    correction.follow(conductance);
    std::vector<double> flux(m.grid.face_count(), 0.0);
    correction.correct(flux, net_outflow);
    EXPECT_LE(imbalance(m.grid, flux, net_outflow), 0.0);
    double through = 0.0;
    for (int f = 0; f < m.grid.face_count(); ++f) {
      if (m.forcing.conditions[f].kind == FaceKind::pressure && m.grid.face_centre(f)[1] > 0.5) {
        through += flux[f];
      }
    }
    return through;
  };
  EXPECT_EQ(through_upper_half(0.4), 0.0);
  EXPECT_EQ(through_upper_half(0.4 * 9.0), 0.0);
  EXPECT_EQ(through_upper_half(0.4 * 11.0), 2.0);
}

TEST(FluxCorrection, FindsSealedPieces) {
  Mesh<2> mesh = model::column_mesh(4, 4);
  // A second square, detached: its elements share no nodes with the first.
  const Mesh<2> other = model::column_mesh(3, 3);
  const int shift = mesh.node_count();
  for (const auto& x : other.nodes) mesh.nodes.emplace_back(x[0] + 2.0, x[1]);
  for (auto element : other.elements) {
    for (int& i : element) i += shift;
    mesh.elements.push_back(element);
  }
  FlowModel m(mesh);
  m.set("top", FaceKind::pressure, 0.0);
  const FluxCorrection<2> correction(m.grid, held(m));
  ASSERT_EQ(correction.sealed_piece_count(), 1);
  EXPECT_EQ(correction.sealed_root()[0], 32);
  for (int e = 0; e < m.mesh.element_count(); ++e) {
    EXPECT_EQ(correction.sealed_piece()[e], e < 32 ? -1 : 0);
  }
}

}  // namespace flux_correction_test
}  // namespace suffuse
