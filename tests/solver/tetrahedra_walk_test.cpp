/// Grid and face tracking on tetrahedra.

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <numeric>

#include "box_mesh.hpp"
#include "common/errors.hpp"
#include "grid/face_flux.hpp"
#include "grid/face_walk.hpp"
#include "solver/flow_model.hpp"

namespace suffuse {
namespace tetrahedra_walk_test {

/// Uniform in [0, 1), the same on every platform.
class Random {
 public:
  explicit Random(unsigned seed) : uniform_(seed) {}
  double operator()() { return 0.5 + 0.5 * uniform_(); }

 private:
  model::Uniform uniform_;
};

Mesh<3> rough_mesh(int cells) {
  return model::box_mesh({cells, cells, cells}, Vector<3>::Ones(), model::disturbed(0.2 / cells));
}

TEST(TetrahedraGrid, BoxHasItsVolumeFacesAndBoundaries) {
  const Vector<3> size(1.0, 2.0, 0.5);
  const Mesh<3> mesh = model::box_mesh({3, 4, 2}, size, model::disturbed(0.04, size));
  const Grid<3> grid(mesh);
  ASSERT_EQ(mesh.element_count(), 6 * 3 * 4 * 2);
  EXPECT_GT(*std::min_element(grid.volume.begin(), grid.volume.end()), 0.0);
  EXPECT_NEAR(std::accumulate(grid.volume.begin(), grid.volume.end(), 0.0), size.prod(), 1e-14);
  EXPECT_NEAR(std::accumulate(grid.node_volume.begin(), grid.node_volume.end(), 0.0), size.prod(),
              1e-14);
  int outer = 0;
  for (int f = 0; f < grid.face_count(); ++f) outer += grid.is_outer(f) ? 1 : 0;
  EXPECT_EQ(outer, 4 * (3 * 4 + 4 * 2 + 3 * 2));
  EXPECT_EQ(4 * mesh.element_count(), 2 * grid.face_count() - outer);
  int named = 0;
  for (const BoundarySet<3>& boundary : mesh.boundaries) {
    Vector<3> area = Vector<3>::Zero();
    for (const auto& nodes : boundary.faces) {
      const int f = grid.find_face(nodes);
      ASSERT_GE(f, 0);
      EXPECT_TRUE(grid.is_outer(f));
      area += grid.face_normal[f];
      ++named;
    }
    const int d = boundary.name == "left" || boundary.name == "right"   ? 0
                  : boundary.name == "front" || boundary.name == "back" ? 1
                                                                        : 2;
    const bool far = boundary.name == "right" || boundary.name == "back" || boundary.name == "top";
    Vector<3> expected = Vector<3>::Zero();
    expected[d] = (far ? 1.0 : -1.0) * size.prod() / size[d];
    EXPECT_LE((area - expected).norm(), 1e-14) << boundary.name;
  }
  EXPECT_EQ(named, outer);
  EXPECT_EQ(grid.find_face({0, 1, mesh.node_count() - 1}), -1);
}

TEST(TetrahedraGrid, NormalsPointOutAndGradientsReproduceALinearFunction) {
  const Mesh<3> mesh = rough_mesh(4);
  const Grid<3> grid(mesh);
  const Vector<3> slope(1.7, -0.4, 0.9);
  for (int e = 0; e < mesh.element_count(); ++e) {
    Vector<3> sum = Vector<3>::Zero();
    Vector<3> gradient = Vector<3>::Zero();
    for (int k = 0; k < 4; ++k) {
      const int f = grid.element_face[e][k];
      const double sign = grid.element_face_sign[e][k];
      const auto& nodes = grid.face_nodes[f];
      const Vector<3> along = mesh.nodes[nodes[1]] - mesh.nodes[nodes[0]];
      const Vector<3> beside = mesh.nodes[nodes[2]] - mesh.nodes[nodes[0]];
      const Vector<3> cross(along[1] * beside[2] - along[2] * beside[1],
                            along[2] * beside[0] - along[0] * beside[2],
                            along[0] * beside[1] - along[1] * beside[0]);
      EXPECT_NEAR(std::abs(grid.face_normal[f].dot(cross)), 0.5 * cross.squaredNorm(), 1e-15);
      EXPECT_NEAR(grid.face_normal[f].norm(), 0.5 * cross.norm(), 1e-15);
      EXPECT_GT(sign * grid.face_normal[f].dot(grid.face_centre(f) - element_centroid(mesh, e)),
                0.0);
      EXPECT_EQ(sign > 0.0 ? grid.face_left[f] : grid.face_right[f], e);
      EXPECT_EQ(grid.across(e, k), sign > 0.0 ? grid.face_right[f] : grid.face_left[f]);
      EXPECT_EQ(std::count(nodes.begin(), nodes.end(), mesh.elements[e][k]), 0);
      sum += sign * grid.face_normal[f];
      gradient += slope.dot(mesh.nodes[mesh.elements[e][k]]) * grid.shape_gradient[e][k];
    }
    EXPECT_LE(sum.norm(), 1e-15);
    EXPECT_LE((gradient - slope).norm(), 1e-13);
  }
}

TEST(TetrahedraGrid, FieldNodesAreAQuadratureOfDegreeTwo) {
  using Nodes = FieldNodes<3>;
  EXPECT_NEAR(Nodes::near_vertex + 3.0 * Nodes::far_vertex, 1.0, 1e-15);
  // Means over the tetrahedron: 1/4 of a coordinate, 1/10 of its square, 1/20 of a product of two.
  const double near = Nodes::near_vertex;
  const double far = Nodes::far_vertex;
  EXPECT_NEAR((near * near + 3.0 * far * far) / 4.0, 0.1, 1e-15);
  EXPECT_NEAR((2.0 * near * far + 2.0 * far * far) / 4.0, 0.05, 1e-15);
  const ElementValues<3> values{2.0, -1.0, 5.0, 0.5};
  const ElementValues<3> vertices = Nodes::at_vertices(values);
  for (int j = 0; j < 4; ++j) {
    double at_node = 0.0;
    for (int k = 0; k < 4; ++k) at_node += (k == j ? near : far) * vertices[k];
    EXPECT_NEAR(at_node, values[j], 1e-14);
  }
}

/// A mesh of the unit cube with volumes through its faces; porosity 0.3.
struct Field {
  explicit Field(Mesh<3> m)
      : mesh(std::move(m)),
        grid(mesh),
        volume(grid.face_count(), 0.0),
        begin(mesh.element_count(), 0.3),
        end(begin) {}
  Field(const Field&) = delete;
  Field& operator=(const Field&) = delete;
  ~Field() = default;

  /// Sets volumes of a flux that is constant or linear along faces.
  template <class Flux>
  void set_flux(const Flux& flux) {
    for (int f = 0; f < grid.face_count(); ++f) {
      volume[f] = grid.face_normal[f].dot(flux(grid.face_centre(f)));
    }
  }
  /// Adds the flux that turns around the edge from node `a` to node `b`, the curl of
  /// circulation (la grad lb - lb grad la): `circulation` through every face that has the edge.
  void add_turn(int a, int b, double circulation) {
    for (int f = 0; f < grid.face_count(); ++f) {
      const auto& nodes = grid.face_nodes[f];
      if (std::count(nodes.begin(), nodes.end(), a) + std::count(nodes.begin(), nodes.end(), b) <
          2) {
        continue;
      }
      const int third = nodes[0] + nodes[1] + nodes[2] - a - b;
      const Vector<3> along = mesh.nodes[b] - mesh.nodes[a];
      const Vector<3> beside = mesh.nodes[third] - mesh.nodes[a];
      const Vector<3> right_handed(along[1] * beside[2] - along[2] * beside[1],
                                   along[2] * beside[0] - along[0] * beside[2],
                                   along[0] * beside[1] - along[1] * beside[0]);
      volume[f] += (grid.face_normal[f].dot(right_handed) > 0.0 ? 1.0 : -1.0) * circulation;
    }
  }
  [[nodiscard]] bool is_inner(int node) const {
    return mesh.nodes[node].minCoeff() > 0.0 && mesh.nodes[node].maxCoeff() < 1.0;
  }
  /// Circulation around every edge between inner nodes: no divergence, no flow at the walls.
  void set_random_turns(Random& random, double size) {
    for (const auto& nodes : mesh.elements) {
      for (int a = 0; a < 4; ++a) {
        for (int b = 0; b < a; ++b) {
          if (is_inner(nodes[a]) && is_inner(nodes[b])) {
            add_turn(nodes[a], nodes[b], size * (random() - 0.5));
          }
        }
      }
    }
  }
  void set_random_porosity(Random& random, bool changing) {
    for (int e = 0; e < mesh.element_count(); ++e) {
      begin[e] = 0.1 + 0.6 * random();
      end[e] = changing ? 0.1 + 0.6 * random() : begin[e];
    }
  }
  int walk(PointPlace<3>& place, double from = 0.0, double to = 1.0) {
    return walk_along_faces(grid, {volume, begin, end}, place, from, to, 7, passages);
  }

  Mesh<3> mesh;
  Grid<3> grid;
  std::vector<double> volume;
  std::vector<double> begin;
  std::vector<double> end;
  std::vector<FacePassage<3>> passages;
};

/// A place inside an element, on one of its faces, edges or nodes, with equal probability.
PointPlace<3> random_place(const Mesh<3>& mesh, Random& random, int kinds = 4) {
  PointPlace<3> place{static_cast<int>(random() * mesh.element_count()), {}};
  const auto zeros = static_cast<int>(random() * kinds);
  const auto first = static_cast<int>(random() * 4.0);
  double sum = 0.0;
  for (int k = 0; k < 4; ++k) {
    const double share = -std::log1p(-random());
    if (k >= zeros) sum += place.barycentric[(first + k) % 4] = share;
  }
  for (double& share : place.barycentric) share /= sum;
  return place;
}

void expect_inside(const PointPlace<3>& place) {
  double sum = 0.0;
  for (const double share : place.barycentric) {
    EXPECT_GE(share, 0.0);
    sum += share;
  }
  EXPECT_NEAR(sum, 1.0, 1e-13);
}

TEST(TetrahedraWalk, UniformFluxMovesPointsStraight) {
  double worst = 0.0;
  int compared = 0;
  int left = 0;
  for (unsigned seed = 1; seed <= 9; ++seed) {
    Random random(seed);
    // Half of the fields flow along diagonals of the cells and of their sides, which are edges of
    // elements.
    const bool along_edges = seed % 2 == 0;
    Vector<3> flux(0.3, seed % 4 == 0 ? 0.3 : 0.0, 0.3);
    if (!along_edges)
      flux = Vector<3>(0.6 * random(), 0.6 * random(), 0.6 * random()).array() - 0.3;
    Field field(along_edges ? model::box_mesh({5, 5, 5}) : rough_mesh(5));
    for (int p = 0; p < 200; ++p) {
      PointPlace<3> place = random_place(field.mesh, random);
      const double duration = random();
      field.set_flux([&](const Vector<3>&) { return Vector<3>(duration * flux); });
      const Vector<3> expected = place.position(field.mesh) + duration / 0.3 * flux;
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
  EXPECT_GE(compared, 300);
  EXPECT_GE(left, 300);
  EXPECT_LE(worst, 1e-13);
  std::cout << "uniform flux: " << compared << " walks, largest error " << worst << '\n';
}

TEST(TetrahedraWalk, FollowsALinearFluxWithDivergenceAndPorosityInTime) {
  // The space of Raviart and Thomas contains a + b x on any mesh: x + a/b = e^(b tau) (x_0 + a/b)
  // with the clock tau = integral of ds/n.
  double worst = 0.0;
  for (const double change : {0.0, 0.15, -0.1}) {
    for (const double b : {0.3, -0.3, 1e-9}) {
      Field field(rough_mesh(5));
      field.end.assign(field.end.size(), 0.3 + change);
      Random random(17);
      int compared = 0;
      for (int p = 0; p < 300; ++p) {
        const Vector<3> a(0.2 * random() - 0.1, 0.2 * random() - 0.1, 0.2 * random() - 0.1);
        field.set_flux([&](const Vector<3>& x) { return Vector<3>(a + b * x); });
        PointPlace<3> place = random_place(field.mesh, random);
        const Vector<3> start = place.position(field.mesh);
        const double from = 0.5 + 0.5 * random();
        const double n = 0.3 + from * change;
        const double clock =
            change == 0.0 ? (1.0 - from) / n : std::log((0.3 + change) / n) / change;
        const Vector<3> expected = start + std::expm1(b * clock) / b * (a + b * start);
        if (expected.minCoeff() < 1e-9 || expected.maxCoeff() > 1.0 - 1e-9) continue;
        if (field.walk(place, from) >= 0) continue;  // started on an outer face and left at once
        expect_inside(place);
        worst = std::max(worst, (place.position(field.mesh) - expected).norm());
        ++compared;
      }
      EXPECT_GE(compared, 50) << change << ' ' << b;
    }
  }
  std::cout << "linear flux with divergence: largest error " << worst << '\n';
  EXPECT_LE(worst, 1e-12);
}

TEST(TetrahedraWalk, AgreesWithRungeKuttaInsideAnElement) {
  double worst = 0.0;
  int compared = 0;
  Random random(21);
  Field field(rough_mesh(2));
  for (int p = 0; p < 300; ++p) {
    for (double& v : field.volume) v = 0.01 * (random() - 0.5);
    field.set_random_porosity(random, true);
    PointPlace<3> place = random_place(field.mesh, random, 1);
    const int e = place.element;
    Vector<3> x = place.position(field.mesh);
    if (field.walk(place) >= 0 || place.element != e) continue;
    const int steps = 400;
    const double h = 1.0 / steps;
    const auto velocity = [&](double s, const Vector<3>& at) {
      return Vector<3>(flux_at(field.grid, field.volume, e, at) /
                       (field.begin[e] + s * (field.end[e] - field.begin[e])));
    };
    for (int k = 0; k < steps; ++k) {
      const Vector<3> k1 = velocity(k * h, x);
      const Vector<3> k2 = velocity((k + 0.5) * h, x + 0.5 * h * k1);
      const Vector<3> k3 = velocity((k + 0.5) * h, x + 0.5 * h * k2);
      const Vector<3> k4 = velocity((k + 1.0) * h, x + h * k3);
      x += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    }
    worst = std::max(worst, (place.position(field.mesh) - x).norm());
    ++compared;
  }
  std::cout << "against Runge-Kutta: " << compared << " walks, largest error " << worst << '\n';
  EXPECT_GE(compared, 50);
  EXPECT_LE(worst, 1e-10);
}

/// The node in the middle of `Field(model::box_mesh({2, 2, 2}))`, and one at the wall: the edge
/// between them lies along x or along the diagonal of the cube.
constexpr int middle = 13;

TEST(TetrahedraWalk, HatFunctionsOfAnEdgesEndsAreConstantAroundIt) {
  // The flux is 2 circulation grad la x grad lb in each element.
  for (const int end : {14, 26}) {
    Field field(model::box_mesh({2, 2, 2}, Vector<3>::Ones(), model::disturbed(0.08)));
    Random random(3);
    field.set_random_porosity(random, true);
    field.add_turn(middle, end, 0.1);
    const auto hats = [&](const PointPlace<3>& place) {
      std::array<double, 2> at{0.0, 0.0};
      for (int k = 0; k < 4; ++k) {
        const int node = field.mesh.elements[place.element][k];
        if (node == middle) at[0] = place.barycentric[k];
        if (node == end) at[1] = place.barycentric[k];
      }
      return at;
    };
    double worst = 0.0;
    int crossed = 0;
    for (int p = 0; p < 500; ++p) {
      PointPlace<3> place = random_place(field.mesh, random);
      const auto before = hats(place);
      const int element = place.element;
      EXPECT_EQ(field.walk(place), -1);
      const auto after = hats(place);
      for (int i = 0; i < 2; ++i) worst = std::max(worst, std::abs(after[i] - before[i]));
      crossed += place.element != element ? 1 : 0;
    }
    std::cout << "around an edge: largest change " << worst << ", " << crossed
              << " of 500 ended in another element\n";
    EXPECT_GE(crossed, 40);
    EXPECT_LE(worst, 1e-12);
  }
}

TEST(TetrahedraWalk, NearAnEdgeThatTheFlowTurnsAroundPointsStay) {
  Field field(model::box_mesh({2, 2, 2}));
  field.add_turn(middle, 14, 0.02);
  for (const double distance : {0.0, 1e-15, 1e-9}) {
    for (int e = 0; e < field.mesh.element_count(); ++e) {
      PointPlace<3> place{e, {distance, distance, distance, distance}};
      int on_edge = 0;
      for (int k = 0; k < 4; ++k) {
        const int node = field.mesh.elements[e][k];
        if (node != middle && node != 14) continue;
        place.barycentric[k] = (node == middle ? 0.3 : 0.7) - distance;
        ++on_edge;
      }
      if (on_edge < 2) continue;
      const Vector<3> start = place.position(field.mesh);
      EXPECT_EQ(field.walk(place), -1);
      EXPECT_LE((place.position(field.mesh) - start).norm(), 10.0 * distance + 1e-13);
    }
  }
  // The point circulates thousands of times through a ring of elements, on a circle too wide to
  // count as a point.
  field.add_turn(middle, 14, 3e4);
  const auto has_edge = [](const std::array<int, 4>& nodes) {
    return std::count(nodes.begin(), nodes.end(), middle) +
               std::count(nodes.begin(), nodes.end(), 14) ==
           2;
  };
  const auto& elements = field.mesh.elements;
  const auto element = std::find_if(elements.begin(), elements.end(), has_edge) - elements.begin();
  PointPlace<3> wide{static_cast<int>(element), {0.25, 0.25, 0.25, 0.25}};
  EXPECT_THROW(field.walk(wide), NumericalError);
}

TEST(TetrahedraWalk, NothingIsLostAndTwoPartsAreTheWhole) {
  double worst = 0.0;
  int crossed = 0;
#ifdef __SANITIZE_ADDRESS__
  constexpr unsigned fields = 4;  // slow
#else
  constexpr unsigned fields = 20;
#endif
  for (unsigned seed = 1; seed <= fields; ++seed) {
    Random random(seed);
    Field field(rough_mesh(4));
    field.set_random_porosity(random, seed % 2 == 0);
    field.set_random_turns(random, 4e-3);
    if (seed % 3 == 0) {
      for (int f = 0; f < field.grid.face_count(); ++f) {
        if (!field.grid.is_outer(f)) field.volume[f] += 1e-3 * (random() - 0.5);
      }
    }
    for (int p = 0; p < 200; ++p) {
      PointPlace<3> whole = random_place(field.mesh, random);
      PointPlace<3> parts = whole;
      const int element = whole.element;
      const double at = random();
      EXPECT_EQ(field.walk(whole), -1);
      expect_inside(whole);
      EXPECT_EQ(field.walk(parts, 0.0, at), -1);
      EXPECT_EQ(field.walk(parts, at, 1.0), -1);
      expect_inside(parts);
      worst = std::max(worst, (whole.position(field.mesh) - parts.position(field.mesh)).norm());
      crossed += whole.element != element ? 1 : 0;
    }
  }
  std::cout << "in two parts: largest difference " << worst << ", " << crossed << " of "
            << 200 * fields << " ended in another element\n";
  EXPECT_GE(crossed, 80 * static_cast<int>(fields));
  EXPECT_LE(worst, 1e-12);
}

}  // namespace tetrahedra_walk_test
}  // namespace suffuse
