#include "grid/face_walk.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>

#include "common/errors.hpp"
#include "grid/face_flux.hpp"
#include "solver/model_case.hpp"

namespace suffuse {
namespace face_walk_test {

/// The same numbers on every platform, in [0, 1).
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double operator()() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

 private:
  std::mt19937_64 engine_;
};

/// A mesh of the unit square with volumes through its faces; porosity 0.3.
struct Field {
  explicit Field(Mesh<2> m)
      : mesh(std::move(m)),
        grid(mesh),
        volume(grid.face_count(), 0.0),
        begin(mesh.element_count(), 0.3),
        end(begin) {}
  Field(const Field&) = delete;
  Field& operator=(const Field&) = delete;
  ~Field() = default;

  /// Sets volumes of a flux that is constant or linear along faces.
  void set_flux(const std::function<Vector<2>(const Vector<2>&)>& flux) {
    for (int f = 0; f < grid.face_count(); ++f) {
      volume[f] = grid.face_normal[f].dot(flux(grid.face_centre(f)));
    }
  }
  /// Sets volumes without divergence: differences of the stream function at the nodes.
  void set_stream(const std::vector<double>& stream) {
    for (int f = 0; f < grid.face_count(); ++f) {
      const auto [i, j] = grid.face_nodes[f];
      const Vector<2> along = mesh.nodes[j] - mesh.nodes[i];
      const double side = grid.face_normal[f].dot(Vector<2>(along[1], -along[0]));
      volume[f] = (side > 0.0 ? 1.0 : -1.0) * (stream[j] - stream[i]);
    }
  }
  /// A stream function, random at inner nodes, zero along the walls.
  [[nodiscard]] std::vector<double> random_stream(Random& random, double size) const {
    std::vector<double> stream;
    for (const Vector<2>& x : mesh.nodes) {
      const bool inside = x.minCoeff() > 0.0 && x.maxCoeff() < 1.0;
      stream.push_back(inside ? size * (random() - 0.5) : 0.0);
    }
    return stream;
  }
  void set_random_porosity(Random& random, bool changing) {
    for (int e = 0; e < mesh.element_count(); ++e) {
      begin[e] = 0.1 + 0.6 * random();
      end[e] = changing ? 0.1 + 0.6 * random() : begin[e];
    }
  }
  int walk(PointPlace<2>& place, double from = 0.0, double to = 1.0) {
    return walk_along_faces(grid, {volume, begin, end}, place, from, to, 7, passages);
  }

  Mesh<2> mesh;
  Grid<2> grid;
  std::vector<double> volume;
  std::vector<double> begin;
  std::vector<double> end;
  std::vector<FacePassage<2>> passages;
};

Mesh<2> rough_mesh(int cells, unsigned seed) {
  return model::column_mesh(cells, cells, 1.0, 1.0, model::jittered(0.25 / cells, seed));
}

/// A place inside an element, on one of its edges or on one of its nodes, with equal probability.
PointPlace<2> random_place(const Mesh<2>& mesh, Random& random, int kinds = 3) {
  const auto element = static_cast<int>(random() * mesh.element_count());
  std::array<double, 3> at{random(), random(), random()};
  const auto kind = static_cast<int>(random() * kinds);
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

TEST(FaceWalk, UniformFluxMovesPointsStraight) {
  double worst = 0.0;
  int compared = 0;
  int left = 0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    Random random(seed);
    // Half of the fields flow along the diagonals of the cells, which are edges of elements.
    const bool along_edges = seed % 2 == 0;
    const Vector<2> flux =
        along_edges ? Vector<2>(0.3, 0.3) : Vector<2>(0.6 * random() - 0.3, 0.6 * random() - 0.3);
    Field field(along_edges ? model::column_mesh(9, 9) : rough_mesh(9, seed));
    for (int p = 0; p < 300; ++p) {
      PointPlace<2> place = random_place(field.mesh, random);
      const double duration = random();
      field.set_flux([&](const Vector<2>&) { return Vector<2>(duration * flux); });
      const Vector<2> expected = place.position(field.mesh) + duration / 0.3 * flux;
      const bool inside = expected.minCoeff() > 1e-9 && expected.maxCoeff() < 1.0 - 1e-9;
      const bool outside = expected.minCoeff() < -1e-9 || expected.maxCoeff() > 1.0 + 1e-9;
      if (inside == outside) continue;
      const int face = field.walk(place);
      expect_inside(place);
      if (outside) {
        ASSERT_GE(face, 0);
        EXPECT_TRUE(field.grid.is_outer(face));
        ++left;
        continue;
      }
      EXPECT_EQ(face, -1);
      worst = std::max(worst, (place.position(field.mesh) - expected).norm());
      ++compared;
    }
  }
  EXPECT_GE(compared, 500);
  EXPECT_GE(left, 500);
  EXPECT_LE(worst, 1e-13);
  std::cout << "uniform flux: " << compared << " walks, largest error " << worst << '\n';
}

TEST(FaceWalk, VelocityChangesOnTheFaceAtAJumpOfPorosity) {
  Field field(model::column_mesh(6, 6));
  for (int e = 0; e < field.mesh.element_count(); ++e) {
    if (element_centroid(field.mesh, e)[1] > 0.5) field.begin[e] = field.end[e] = 0.8;
  }
  Random random(11);
  double worst = 0.0;
  for (int p = 0; p < 2000; ++p) {
    PointPlace<2> place = random_place(field.mesh, random);
    const Vector<2> start = place.position(field.mesh);
    const double above = (start[1] - 0.5) / (0.1 / 0.8);
    if (above < 0.0) continue;
    const double duration = above + 1.4 * random();  // to y = 0.5 - 0.1 / 0.3 * 1.4 > 0
    const double sideways = 0.2 * (start[0] > 0.5 ? -0.1 : 0.1);
    field.set_flux(
        [&](const Vector<2>&) { return Vector<2>(duration * sideways, -0.1 * duration); });
    const Vector<2> expected(start[0] + sideways * (above / 0.8 + (duration - above) / 0.3),
                             0.5 - 0.1 * (duration - above) / 0.3);
    EXPECT_EQ(field.walk(place), -1);
    worst = std::max(worst, (place.position(field.mesh) - expected).norm());
  }
  EXPECT_LE(worst, 1e-13);
}

TEST(FaceWalk, FollowsPorosityInTime) {
  // x = integral of q/n dt: n goes from 0.3 to 0.4, to 0.3 (1 + 1e-9), to 0.2 across many elements.
  for (const double end : {0.4, 0.3 * (1.0 + 1e-9), 0.2}) {
    Field field(rough_mesh(8, 3));
    field.end.assign(field.end.size(), end);
    const double travel = 0.12;  // volume per area over the interval
    field.set_flux([&](const Vector<2>&) { return Vector<2>(travel, 0.0); });
    Random random(5);
    int compared = 0;
    for (int p = 0; p < 300; ++p) {
      PointPlace<2> place = random_place(field.mesh, random);
      const double from = 0.5 * random();
      const double to = from + (1.0 - from) * random();
      // A fine midpoint rule, which does not use logarithms.
      double path = 0.0;
      const int pieces = 2000;
      for (int k = 0; k < pieces; ++k) {
        const double s = from + (to - from) * (k + 0.5) / pieces;
        path += travel * (to - from) / pieces / (0.3 + s * (end - 0.3));
      }
      const Vector<2> expected = place.position(field.mesh) + Vector<2>(path, 0.0);
      if (expected[0] > 1.0 - 1e-9 || place.position(field.mesh)[1] < 1e-9) continue;
      field.passages.clear();
      EXPECT_EQ(field.walk(place, from, to), -1);
      EXPECT_LE((place.position(field.mesh) - expected).norm(), 1e-8);
      const double exact =
          travel / (end - 0.3) * std::log1p((end - 0.3) * (to - from) / (0.3 + from * (end - 0.3)));
      EXPECT_NEAR(path, exact, 1e-8);
      EXPECT_LE((place.position(field.mesh) - expected).norm(), 1e-13 + std::abs(path - exact));
      double growth = 1.0;
      for (const auto& passage : field.passages) growth *= passage.growth;
      EXPECT_NEAR(growth, (0.3 + to * (end - 0.3)) / (0.3 + from * (end - 0.3)), 1e-13);
      ++compared;
    }
    EXPECT_GE(compared, 100);
  }
}

TEST(FaceWalk, PassagesTellWhereAndByHowMuchPorosityGrew) {
  // Porosity grows in the upper half only; the point goes down through both, two rows of two
  // elements each.
  Field field(model::column_mesh(4, 4));
  for (int e = 0; e < field.mesh.element_count(); ++e) {
    if (element_centroid(field.mesh, e)[1] > 0.5) field.end[e] = 0.36;
  }
  field.set_flux([](const Vector<2>&) { return Vector<2>(0.0, -0.16); });
  PointPlace<2> place{24, {0.25, 0.5, 0.25}};  // lower triangle of the first cell of the top row
  const Vector<2> start = place.position(field.mesh);
  EXPECT_EQ(field.walk(place), -1);
  ASSERT_EQ(field.passages.size(), 3u);
  double height = start[1];
  double share = 0.0;
  for (const auto& passage : field.passages) {
    const Vector<2> middle =
        PointPlace<2>{passage.element, passage.barycentric}.position(field.mesh);
    const double below = 2.0 * middle[1] - height;
    // Time to fall through a passage: 0.16 / 0.06 log(n_out / n_in) = height lost.
    const double in = 0.3 + 0.06 * share;
    const double out = in * std::exp((height - below) * 0.06 / 0.16);
    EXPECT_NEAR(passage.growth, out / in, 1e-13);
    height = below;
    share = (out - 0.3) / 0.06;
  }
  EXPECT_NEAR(height, 0.5, 1e-13);
  EXPECT_NEAR(place.position(field.mesh)[1], 0.5 - 0.16 * (1.0 - share) / 0.3, 1e-13);
}

TEST(FaceWalk, FollowsALinearFluxWithDivergence) {
  // The space of Raviart and Thomas contains a + b x on any mesh: x + a/b = e^(b tau) (x_0 + a/b).
  double worst = 0.0;
  for (const double b : {0.3, -0.3, 1e-9, -1e-14}) {
    Field field(rough_mesh(7, 9));
    field.end.assign(field.end.size(), 0.45);
    const Vector<2> a(0.05 - 0.5 * b, -0.03 - 0.5 * b);
    field.set_flux([&](const Vector<2>& x) { return Vector<2>(a + b * x); });
    Random random(2);
    int compared = 0;
    for (int p = 0; p < 1000; ++p) {
      PointPlace<2> place = random_place(field.mesh, random);
      const Vector<2> start = place.position(field.mesh);
      const double clock = std::log(0.45 / 0.3) / 0.15;
      const Vector<2> expected = start + std::expm1(b * clock) / b * (a + b * start);
      if (expected.minCoeff() < 1e-9 || expected.maxCoeff() > 1.0 - 1e-9) continue;
      if (field.walk(place) >= 0) continue;  // started on an outer face and left at once
      worst = std::max(worst, (place.position(field.mesh) - expected).norm());
      ++compared;
    }
    EXPECT_GE(compared, 100);
  }
  std::cout << "linear flux with divergence: largest error " << worst << '\n';
  EXPECT_LE(worst, 1e-13);
}

TEST(FaceWalk, AgreesWithRungeKuttaInsideAnElement) {
  // Random volumes with divergence, in one element after the other; porosity changes in time.
  double worst = 0.0;
  int compared = 0;
  Random random(21);
  Field field(rough_mesh(3, 8));
  for (int p = 0; p < 200; ++p) {
    for (double& v : field.volume) v = 0.02 * (random() - 0.5);
    field.set_random_porosity(random, true);
    PointPlace<2> place = random_place(field.mesh, random, 1);
    const int e = place.element;
    Vector<2> x = place.position(field.mesh);
    if (field.walk(place) >= 0 || place.element != e) continue;
    const int steps = 400;
    const auto velocity = [&](double s, const Vector<2>& at) {
      return Vector<2>(flux_at(field.grid, field.volume, e, at) /
                       (field.begin[e] + s * (field.end[e] - field.begin[e])));
    };
    const double h = 1.0 / steps;
    for (int k = 0; k < steps; ++k) {
      const Vector<2> k1 = velocity(k * h, x);
      const Vector<2> k2 = velocity((k + 0.5) * h, x + 0.5 * h * k1);
      const Vector<2> k3 = velocity((k + 0.5) * h, x + 0.5 * h * k2);
      const Vector<2> k4 = velocity((k + 1.0) * h, x + h * k3);
      x += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    }
    worst = std::max(worst, (place.position(field.mesh) - x).norm());
    ++compared;
  }
  std::cout << "against Runge-Kutta: " << compared << " walks, largest error " << worst << '\n';
  EXPECT_GE(compared, 50);
  EXPECT_LE(worst, 1e-10);
}

TEST(FaceWalk, TheStreamFunctionIsConstantAlongAPath) {
  double worst = 0.0;
  int crossed = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    Field field(rough_mesh(7, seed));
    field.set_random_porosity(random, true);
    const auto stream = field.random_stream(random, 0.1);
    field.set_stream(stream);
    const auto value = [&](const PointPlace<2>& place) {
      double sum = 0.0;
      for (int a = 0; a < 3; ++a) {
        sum += place.barycentric[a] * stream[field.mesh.elements[place.element][a]];
      }
      return sum;
    };
    for (int p = 0; p < 200; ++p) {
      PointPlace<2> place = random_place(field.mesh, random);
      const double before = value(place);
      const int element = place.element;
      EXPECT_EQ(field.walk(place), -1);
      worst = std::max(worst, std::abs(value(place) - before) / 0.1);
      crossed += place.element != element ? 1 : 0;
    }
  }
  std::cout << "stream function: largest change " << worst << " of its range, " << crossed
            << " of 4000 ended in another element\n";
  EXPECT_GE(crossed, 2000);
  EXPECT_LE(worst, 1e-12);
}

/// At the front of a pressure, fluxes can be as small as the smallest numbers.
TEST(FaceWalk, FluxesTooSmallToDivideByMoveNothing) {
  Field field(model::column_mesh(2, 2));
  Random random(1);
  PointPlace<2> place = random_place(field.mesh, random);
  const Vector<2> start = place.position(field.mesh);
  for (const double sink : {0.0, 3.0}) {
    field.set_flux([&](const Vector<2>& x) { return Vector<2>(1e-310, -sink * 1e-310 * x[1]); });
    EXPECT_EQ(field.walk(place), -1);
    EXPECT_LE((place.position(field.mesh) - start).norm(), 1e-12);
  }
}

TEST(FaceWalk, NothingIsLost) {
  // Points start on edges, nodes and inside, in flows around nodes, with sources and sinks.
#ifdef __SANITIZE_ADDRESS__
  constexpr unsigned fields = 10;  // slow, and few fields show all errors
#else
  constexpr unsigned fields = 100;
#endif
  int walks = 0;
  for (unsigned seed = 1; seed <= fields; ++seed) {
    Random random(seed);
    Field field(rough_mesh(7, seed));
    field.set_random_porosity(random, seed % 2 == 0);
    field.set_stream(field.random_stream(random, 0.05));
    if (seed % 3 == 0) {
      for (int f = 0; f < field.grid.face_count(); ++f) {
        if (!field.grid.is_outer(f)) field.volume[f] += 0.02 * (random() - 0.5);
      }
    }
    for (int p = 0; p < 400; ++p) {
      PointPlace<2> place = random_place(field.mesh, random);
      EXPECT_EQ(field.walk(place), -1);
      expect_inside(place);
      ++walks;
    }
  }
  EXPECT_EQ(walks, 400 * static_cast<int>(fields));
}

TEST(FaceWalk, TwoParts) {
  double worst = 0.0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    Random random(seed);
    Field field(rough_mesh(7, seed));
    field.set_random_porosity(random, true);
    field.set_stream(field.random_stream(random, 0.01));
    for (int p = 0; p < 200; ++p) {
      PointPlace<2> whole = random_place(field.mesh, random, 2);
      PointPlace<2> parts = whole;
      const double at = random();
      EXPECT_EQ(field.walk(whole), -1);
      EXPECT_EQ(field.walk(parts, 0.0, at), -1);
      EXPECT_EQ(field.walk(parts, at, 1.0), -1);
      worst = std::max(worst, (whole.position(field.mesh) - parts.position(field.mesh)).norm());
    }
  }
  std::cout << "in two parts: largest difference " << worst << '\n';
  EXPECT_LE(worst, 1e-13);
}

TEST(FaceWalk, ComesBackWithTheFlowReversed) {
  double worst = 0.0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    Random random(seed);
    Field field(rough_mesh(7, seed));
    field.set_random_porosity(random, true);
    field.set_stream(field.random_stream(random, 0.01));
    Field back(field.mesh);
    std::transform(field.volume.begin(), field.volume.end(), back.volume.begin(), std::negate<>());
    back.begin = field.end;
    back.end = field.begin;
    for (int p = 0; p < 200; ++p) {
      PointPlace<2> place = random_place(field.mesh, random, 2);
      const Vector<2> start = place.position(field.mesh);
      // A path along a wall that leaves it is not unique on the way back.
      if (start.minCoeff() < 1e-12 || start.maxCoeff() > 1.0 - 1e-12) continue;
      EXPECT_EQ(field.walk(place), -1);
      EXPECT_EQ(back.walk(place), -1);
      worst = std::max(worst, (place.position(field.mesh) - start).norm());
    }
  }
  std::cout << "there and back: largest difference " << worst << '\n';
  EXPECT_LE(worst, 1e-12);
}

TEST(FaceWalk, WallsAreNeverCrossed) {
  // Flow from left to right between walls; at the walls the stream function depends only on y.
  Field field(rough_mesh(6, 4));
  std::vector<double> stream;
  for (const Vector<2>& x : field.mesh.nodes) {
    const bool inside = x.minCoeff() > 0.0 && x.maxCoeff() < 1.0;
    stream.push_back(x[1] + (inside ? 0.05 * std::sin(17.0 * x[0] + 5.0 * x[1]) : 0.0));
  }
  field.set_stream(stream);
  for (const BoundarySet<2>& boundary : field.mesh.boundaries) {
    if (boundary.name != "top" && boundary.name != "bottom") continue;
    for (const auto& nodes : boundary.faces)
      EXPECT_EQ(field.volume[field.grid.find_face(nodes)], 0.0);
  }
  Random random(9);
  for (int p = 0; p < 500; ++p) {
    PointPlace<2> place = random_place(field.mesh, random);
    const int face = field.walk(place);
    ASSERT_GE(face, 0);
    for (const int i : field.grid.face_nodes[face]) EXPECT_EQ(field.mesh.nodes[i][0], 1.0);
  }
}

TEST(FaceWalk, WithoutFlowPointsStayWhilePorosityGrows) {
  Field field(rough_mesh(4, 1));
  field.end.assign(field.end.size(), 0.36);
  Random random(4);
  for (int p = 0; p < 100; ++p) {
    PointPlace<2> place = random_place(field.mesh, random);
    const PointPlace<2> start = place;
    field.passages.clear();
    EXPECT_EQ(field.walk(place, 0.5, 1.0), -1);
    EXPECT_EQ(place.element, start.element);
    EXPECT_EQ(place.barycentric, start.barycentric);
    ASSERT_EQ(field.passages.size(), 1u);
    EXPECT_NEAR(field.passages[0].growth, 0.36 / 0.33, 1e-15);
  }
}

TEST(FaceWalk, SaysWhereAWalkHasNoEnd) {
  // The point goes around through a ring of elements 20 000 times, on a circle too wide to count as
  // a point.
  Field field(model::column_mesh(2, 2));
  std::vector<double> stream(field.mesh.node_count(), 0.0);
  stream[4] = 3e4;
  field.set_stream(stream);
  PointPlace<2> place{0, {0.4, 0.3, 0.3}};
  try {
    field.walk(place);
    FAIL() << "went on";
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("liquid point 7 at ("), std::string::npos)
        << error.what();
  }
  // A point at the node itself stays.
  PointPlace<2> centre{0, {0.0, 0.0, 1.0}};
  EXPECT_EQ(field.walk(centre), -1);
  EXPECT_EQ((centre.position(field.mesh) - Vector<2>(0.5, 0.5)).norm(), 0.0);
}

TEST(FaceWalk, CrossingsCountElementsPassed) {
  // Elements 1/4 high: a flux that moves points by 1/2 crosses two of them.
  Field field(model::column_mesh(4, 4));
  field.end.assign(field.end.size(), 0.4);
  field.set_flux([](const Vector<2>&) { return Vector<2>(0.0, -0.15); });
  for (int e = 0; e < field.mesh.element_count(); ++e) {
    EXPECT_NEAR(crossings(field.grid, {field.volume, field.begin, field.end}, e), 2.0, 1e-12);
  }
}

}  // namespace face_walk_test
}  // namespace suffuse
