#include "grid/point_walk.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <iostream>

#include "solver/model_case.hpp"

namespace suffuse {
namespace point_walk_test {

/// The same numbers on every platform, in [0, 1).
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double operator()() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

 private:
  std::mt19937_64 engine_;
};

/// A mesh of the unit square with all that `walk` needs.
struct Field {
  Field(Mesh<2> m, const std::function<Vector<2>(const Vector<2>&)>& flux,
        const std::vector<std::string>& open = {}, double n = 0.3)
      : mesh(std::move(m)), grid(mesh), porosity(mesh.element_count(), n) {
    for (const Vector<2>& x : mesh.nodes) node_flux.push_back(flux(x));
    open_face.assign(grid.face_count(), 0);
    for (const BoundarySet<2>& boundary : mesh.boundaries) {
      if (std::find(open.begin(), open.end(), boundary.name) == open.end()) continue;
      for (const auto& nodes : boundary.faces) open_face[grid.find_face(nodes)] = 1;
    }
  }
  Field(const Field&) = delete;
  Field& operator=(const Field&) = delete;
  ~Field() = default;

  [[nodiscard]] int walk_for(PointPlace<2>& place, double duration) const {
    return walk(grid, {node_flux, porosity, open_face}, place, duration, 0);
  }

  Mesh<2> mesh;
  Grid<2> grid;
  std::vector<double> porosity;
  std::vector<Vector<2>> node_flux;
  std::vector<unsigned char> open_face;
};

Mesh<2> rough_mesh(int cells, unsigned seed) {
  return model::column_mesh(cells, cells, 1.0, 1.0, model::jittered(0.25 / cells, seed));
}

/// A place inside an element, on one of its edges or on one of its nodes, with equal probability.
PointPlace<2> random_place(const Mesh<2>& mesh, Random& random) {
  const auto element = static_cast<int>(random() * mesh.element_count());
  std::array<double, 3> at{random(), random(), random()};
  const auto kind = static_cast<int>(random() * 3.0);
  const auto vertex = static_cast<int>(random() * 3.0);
  if (kind == 1) at[vertex] = 0.0;
  if (kind == 2) {
    at = {};
    at[vertex] = 1.0;
  }
  const double sum = at[0] + at[1] + at[2];
  for (double& share : at) share /= sum;
  return {element, at};
}

void expect_inside(const PointPlace<2>& place) {
  double sum = 0.0;
  for (const double share : place.barycentric) {
    EXPECT_GE(share, 0.0);
    sum += share;
  }
  EXPECT_NEAR(sum, 1.0, 1e-13);
}

/// The first element that contains `x`.
PointPlace<2> place_of(const Field& field, const Vector<2>& x) {
  for (int e = 0; e < field.mesh.element_count(); ++e) {
    PointPlace<2> place{e, {}};
    double least = 1.0;
    for (int a = 0; a < 3; ++a) {
      const Vector<2>& other = field.mesh.nodes[field.mesh.elements[e][(a + 1) % 3]];
      place.barycentric[a] = field.grid.shape_gradient[e][a].dot(x - other);
      least = std::min(least, place.barycentric[a]);
    }
    if (least < -1e-14) continue;
    for (double& share : place.barycentric) share = std::max(0.0, share);
    return place;
  }
  throw std::runtime_error("outside the mesh");
}

TEST(PointWalk, NoPointIsLostInRandomFluxBetweenWalls) {
  // Flux is random at nodes, parallel to walls at walls, so it converges at nodes and on edges too.
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    const Field field(rough_mesh(7, seed), [&](const Vector<2>& x) {
      Vector<2> q(random() - 0.5, random() - 0.5);
      for (int d = 0; d < 2; ++d) {
        if (x[d] == 0.0 || x[d] == 1.0) q[d] = 0.0;
      }
      return q;
    });
    for (int p = 0; p < 200; ++p) {
      PointPlace<2> place = random_place(field.mesh, random);
      for (const double duration : {1e-9, 0.02, 0.3}) {
        EXPECT_EQ(field.walk_for(place, duration), -1);
        expect_inside(place);
      }
    }
  }
}

TEST(PointWalk, UniformFluxMovesPointsStraightAcrossManyElements) {
  double worst = 0.0;
  int compared = 0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    Random random(seed);
    // Half of the fields flow along the diagonals of the cells, which are edges of elements.
    const bool along_edges = seed % 2 == 0;
    const Vector<2> flux =
        along_edges ? Vector<2>(0.3, 0.3) : Vector<2>(0.6 * random() - 0.3, 0.6 * random() - 0.3);
    const Field field(along_edges ? model::column_mesh(9, 9) : rough_mesh(9, seed),
                      [&](const Vector<2>&) { return Vector<2>(flux); });
    for (int p = 0; p < 300; ++p) {
      PointPlace<2> place = random_place(field.mesh, random);
      const double duration = random();
      const Vector<2> expected = place.position(field.mesh) + duration / 0.3 * flux;
      if (expected.minCoeff() < 1e-9 || expected.maxCoeff() > 1.0 - 1e-9) continue;
      EXPECT_EQ(field.walk_for(place, duration), -1);
      expect_inside(place);
      worst = std::max(worst, (place.position(field.mesh) - expected).norm());
      ++compared;
    }
  }
  EXPECT_GE(compared, 500);
  EXPECT_LE(worst, 1e-12);
  std::cout << "uniform flux: " << compared << " walks, largest error " << worst << '\n';
}

TEST(PointWalk, LinearFluxIsFollowedToSecondOrderInTheStep) {
  // Rotation about the centre with a strain: x' = a x about it, x = exp(a t) x_0; a squared is
  // -determinant times identity, so the exponential consists of sines and cosines.
  Eigen::Matrix2d a;
  a << 0.2, -1.0, 1.2, -0.2;
  const double omega = std::sqrt(a.determinant());
  const Vector<2> centre(0.5, 0.5);
  std::vector<double> errors;
  for (const int steps : {16, 32, 64, 128}) {
    const Field field(rough_mesh(3, 5),
                      [&](const Vector<2>& x) { return Vector<2>(0.3 * (a * (x - centre))); });
    Random random(3);
    double worst = 0.0;
    for (int p = 0; p < 50; ++p) {
      const double angle = 2.0 * M_PI * random();
      const Vector<2> start = 0.3 * Vector<2>(std::cos(angle), std::sin(angle));
      PointPlace<2> place = place_of(field, centre + start);
      for (int s = 0; s < steps; ++s) EXPECT_EQ(field.walk_for(place, 2.0 / steps), -1);
      const Vector<2> end =
          std::cos(2.0 * omega) * start + std::sin(2.0 * omega) / omega * (a * start);
      worst = std::max(worst, (place.position(field.mesh) - centre - end).norm());
    }
    errors.push_back(worst);
  }
  for (std::size_t k = 0; k + 1 < errors.size(); ++k) {
    const double order = std::log2(errors[k] / errors[k + 1]);
    std::cout << "linear flux, " << (16 << k) << " -> " << (32 << k) << " steps: error "
              << errors[k] << " -> " << errors[k + 1] << ", order " << order << '\n';
    EXPECT_GE(order, 1.8);
  }
}

TEST(PointWalk, TheVelocityChangesOnTheFaceAtAJumpOfPorosity) {
  Field field(model::column_mesh(6, 6), [](const Vector<2>&) { return Vector<2>(0.02, -0.1); });
  for (int e = 0; e < field.mesh.element_count(); ++e) {
    if (element_centroid(field.mesh, e)[1] > 0.5) field.porosity[e] = 0.8;
  }
  Random random(11);
  for (int p = 0; p < 100; ++p) {
    const Vector<2> start(0.1 + 0.4 * random(), 0.55 + 0.4 * random());
    PointPlace<2> place = place_of(field, start);
    const double above = (start[1] - 0.5) / (0.1 / 0.8);
    const double duration = above + 1.4 * random();  // to y = 0.5 - 0.1 / 0.3 * 1.4 > 0
    const Vector<2> expected(start[0] + 0.02 * (above / 0.8 + (duration - above) / 0.3),
                             0.5 - 0.1 * (duration - above) / 0.3);
    EXPECT_EQ(field.walk_for(place, duration), -1);
    EXPECT_LE((place.position(field.mesh) - expected).norm(), 1e-12);
  }
}

TEST(PointWalk, PointsSlideAlongWallsAndStayInTheCorner) {
  const Field field(rough_mesh(6, 2), [](const Vector<2>&) { return Vector<2>(0.03, -0.1); });
  Random random(7);
  for (int p = 0; p < 100; ++p) {
    PointPlace<2> place = random_place(field.mesh, random);
    const Vector<2> start = place.position(field.mesh);
    const double down = start[1] / (0.1 / 0.3);
    EXPECT_EQ(field.walk_for(place, down + 1.0), -1);
    expect_inside(place);
    EXPECT_NEAR(place.position(field.mesh)[0], std::min(1.0, start[0] + 0.1 * (down + 1.0)), 1e-12);
    EXPECT_NEAR(place.position(field.mesh)[1], 0.0, 1e-14);
    EXPECT_EQ(field.walk_for(place, 20.0), -1);
    EXPECT_NEAR((place.position(field.mesh) - Vector<2>(1.0, 0.0)).norm(), 0.0, 1e-14);
  }
}

TEST(PointWalk, PointsLeaveByOpenFacesAlone) {
  const Field field(rough_mesh(6, 4), [](const Vector<2>&) { return Vector<2>(0.03, -0.1); },
                    {"right"});
  Random random(9);
  int slid = 0;
  for (int p = 0; p < 200; ++p) {
    PointPlace<2> place = random_place(field.mesh, random);
    const Vector<2> start = place.position(field.mesh);
    const double due = (1.0 - start[0]) / 0.1;
    if (start[0] < 1.0 - 1e-9) {
      PointPlace<2> before = place;
      EXPECT_EQ(field.walk_for(before, due * (1.0 - 1e-9)), -1) << "before its time";
    }
    const int face = field.walk_for(place, due + 1e-9);
    ASSERT_GE(face, 0);
    EXPECT_EQ(field.open_face[face], 1);
    const double y = std::max(0.0, start[1] - due * 0.1 / 0.3);
    slid += y == 0.0 ? 1 : 0;
    EXPECT_LE((place.position(field.mesh) - Vector<2>(1.0, y)).norm(), 1e-12);
    for (const int i : field.grid.face_nodes[face]) EXPECT_EQ(field.mesh.nodes[i][0], 1.0);
  }
  EXPECT_GE(slid, 20) << "some were to come along the wall";
}

TEST(PointWalk, TheCrossingRateIsTheInverseOfTheTimeToCross) {
  // Cells of 1/4: an element is 1/4 high, crossed at 0.1 / 0.3 m/s in 0.75 s.
  const Field field(model::column_mesh(4, 4),
                    [](const Vector<2>&) { return Vector<2>(0.0, -0.1); });
  for (int e = 0; e < field.mesh.element_count(); ++e) {
    EXPECT_NEAR(crossing_rate(field.grid, {field.node_flux, field.porosity, field.open_face}, e),
                1.0 / 0.75, 1e-12);
  }
}

}  // namespace point_walk_test
}  // namespace suffuse
