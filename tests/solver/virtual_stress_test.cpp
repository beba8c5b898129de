/// Forces of a traction on soil that has sunk below the faces on which the traction started.

#include "boundary/virtual_stress.hpp"

#include <gtest/gtest.h>

#include "box_mesh.hpp"
#include "grid/near_element.hpp"
#include "solver/solid_model.hpp"

namespace suffuse {
namespace virtual_stress_test {

const SkeletonModel soil = model::elastic_soil(1e6, 0.3);

Mesh<2> irregular_square() {
  return model::column_mesh(8, 8, 1.0, 1.0, model::jittered(0.03, 5));
}
Mesh<3> irregular_cube() {
  return model::box_mesh({4, 4, 4}, Vector<3>::Ones(), model::disturbed(0.04));
}
std::vector<QuadraturePoint<2>> places_in(const Mesh<2>& /*mesh*/) {
  return model::places_in_triangle(3);
}
std::vector<QuadraturePoint<3>> places_in(const Mesh<3>& /*mesh*/) {
  return model::places_in_tetrahedron();
}

/// Soil fills the mesh. A traction acts on faces at its top.
template <int Dim>
struct Loaded : model::SolidModel<Dim> {
  explicit Loaded(const Mesh<Dim>& of, std::vector<int> faces = {})
      : model::SolidModel<Dim>(of, places_in(of), soil),
        on(faces.empty() ? this->faces_of("top") : std::move(faces)) {
    this->surface = LoadedSurface<Dim>(this->grid, this->sorted, on);
    stress =
        std::make_unique<VirtualStress<Dim>>(this->grid, this->sorted, on, this->surface.places());
  }
  /// Moves the points down to this share of their height, evenly.
  void sink(double share) {
    for (int p = 0; p < this->points.size(); ++p) {
      this->points.position[p][Dim - 1] *= share;
      this->points.volume[p] *= share;
      this->points.element[p] =
          element_at(this->grid, this->points.element[p], this->points.position[p]);
    }
    this->sort();
  }
  [[nodiscard]] std::vector<double> volumes() const {
    return soil_volumes(this->points, this->sorted, *this->classes);
  }
  [[nodiscard]] NodeVectors<Dim> forces(const Vector<Dim>& traction) const {
    NodalLoads<Dim> loads(this->grid);
    EXPECT_TRUE(stress->add(this->grid, this->sorted, volumes(), traction, loads));
    return loads.forces();
  }

  std::vector<int> on;
  std::unique_ptr<VirtualStress<Dim>> stress;
};

template <int Dim>
Vector<Dim> traction() {
  Vector<Dim> t = Vector<Dim>::Constant(2.0);
  t[Dim - 1] = -7.0;
  return t;
}

template <int Dim>
void is_that_of_the_faces_at_the_start(const Mesh<Dim>& mesh) {
  const Loaded<Dim> m(mesh);
  NodalLoads<Dim> on_faces(m.grid);
  m.surface.add_traction(m.grid, m.sorted, traction<Dim>(), on_faces);
  const NodeVectors<Dim>& loads = on_faces.forces();
  const NodeVectors<Dim> found = m.forces(traction<Dim>());
  for (std::size_t i = 0; i < loads.size(); ++i) {
    EXPECT_NEAR((found[i] - loads[i]).norm(), 0.0, 1e-13) << i;
  }
}

TEST(VirtualStress, IsThatOfTheFacesAtTheStart) {
  is_that_of_the_faces_at_the_start(irregular_square());
  is_that_of_the_faces_at_the_start(irregular_cube());
}

/// Soil with the stress t n^T everywhere is in equilibrium with a traction t at every node that is
/// not at the bottom, however far it has sunk.
template <int Dim>
void balances_the_stress_of_soil_that_has_sunk(const Mesh<Dim>& mesh, double share) {
  Loaded<Dim> m(mesh);
  m.sink(share);
  const Vector<Dim> t = traction<Dim>();
  NodeVectors<Dim> left = m.forces(t);
  const std::vector<double> volume = m.volumes();
  for (int e = 0; e < m.mesh.element_count(); ++e) {
    for (int a = 0; a <= Dim; ++a) {
      left[m.mesh.elements[e][a]] -= volume[e] * t * m.grid.shape_gradient[e][a][Dim - 1];
    }
  }
  Vector<Dim> sum = Vector<Dim>::Zero();
  for (const Vector<Dim>& force : m.forces(t)) sum += force;
  EXPECT_NEAR((sum - t).norm(), 0.0, 1e-12);
  for (int i = 0; i < m.mesh.node_count(); ++i) {
    if (m.mesh.nodes[i][Dim - 1] == 0.0) continue;
    EXPECT_NEAR(left[i].norm(), 0.0, 1e-13) << i << " at " << m.mesh.nodes[i].transpose();
  }
}

TEST(VirtualStress, BalancesTheStressOfSoilThatHasSunk) {
  for (const double share : {0.97, 0.9, 0.7, 0.4}) {
    balances_the_stress_of_soil_that_has_sunk(irregular_square(), share);
    balances_the_stress_of_soil_that_has_sunk(irregular_cube(), share);
  }
}

/// Half of the top is loaded; soil farther away feels nothing.
TEST(VirtualStress, ActsBehindItsFaces) {
  const Mesh<2> mesh = model::crossed_mesh(8, 8, 1.0, 1.0);
  std::vector<int> half;
  for (const int f : model::PlaneModel(mesh, 3, soil).faces_of("top")) {
    if (Grid<2>(mesh).face_centre(f)[0] < 0.5) half.push_back(f);
  }
  Loaded<2> m(mesh, half);
  m.sink(0.6);
  Vector<2> sum = Vector<2>::Zero();
  const NodeVectors<2> loads = m.forces(traction<2>());
  for (int i = 0; i < m.mesh.node_count(); ++i) {
    sum += loads[i];
    if (m.mesh.nodes[i][0] > 0.5) {
      EXPECT_EQ(loads[i].norm(), 0.0);
    }
  }
  EXPECT_NEAR((sum - 0.5 * traction<2>()).norm(), 0.0, 1e-13);
}

TEST(VirtualStress, EndsWhereSoilTakesItsLoadAlongOrIsGone) {
  Loaded<2> m(model::crossed_mesh(8, 8, 1.0, 1.0));
  // Elements at the border are an eighth of the width wide and half as high.
  const auto share_after = [&](double x, double y) {
    std::vector<Vector<2>> places = m.surface.places();
    for (Vector<2>& place : places) place += Vector<2>(x, y);
    return m.stress->share(m.grid, places);
  };
  constexpr double height = 1.0 / 16.0;
  EXPECT_EQ(share_after(0.0, -0.3), 1.0);
  EXPECT_EQ(share_after(0.4 * height, 0.0), 1.0);
  EXPECT_NEAR(share_after(0.75 * height, 0.0), 0.5, 1e-12);
  EXPECT_EQ(share_after(1.1 * height, -0.3), 0.0);
  m.sorted = PointsByElement(m.mesh.element_count(), {});
  NodalLoads<2> loads(m.grid);
  EXPECT_FALSE(m.stress->add(m.grid, m.sorted, std::vector<double>(m.mesh.element_count(), 0.0),
                             traction<2>(), loads));
  for (const Vector<2>& force : loads.forces()) EXPECT_EQ(force.norm(), 0.0);
}

}  // namespace virtual_stress_test
}  // namespace suffuse
