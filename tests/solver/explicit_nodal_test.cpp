/// The explicit scheme's loops against a plain version of them (nodal_reference.hpp).

#include "explicit/explicit_nodal.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "explicit/stability_limit.hpp"
#include "physics/drag.hpp"
#include "solver/flow_model.hpp"
#include "solver/nodal_reference.hpp"
#include "verification/free_mesh.hpp"

namespace suffuse {
namespace explicit_nodal_test {

constexpr double modulus = 2.0e7;

/// Options of the scheme in addition to its mesh.
struct Options {
  std::string name;
  DragIntegration drag = DragIntegration::explicit_drag;
  bool ergun = false;
  bool porosity_gradient_term = true;
  bool pressure_moves_with_liquid = false;
  Vector<2> gravity = Vector<2>::Zero();
};

std::vector<Options> all_options() {
  const Vector<2> down(0.0, -9.81);
  return {{"as_published"},
          {"implicit_drag", DragIntegration::implicit_drag},
          {"ergun", DragIntegration::explicit_drag, true},
          {"ergun_implicit", DragIntegration::implicit_drag, true, true, false, down},
          {"no_third_term", DragIntegration::explicit_drag, false, false},
          {"double_point", DragIntegration::implicit_drag, false, true, true, down},
          {"gravity", DragIntegration::explicit_drag, false, true, false, down}};
}

struct MeshCase {
  std::string name;
  Mesh<2> mesh;
};

/// The second mesh has three elements beyond a whole number of blocks; the fourth has walls along
/// no coordinate axis, far from the origin.
std::vector<MeshCase> all_meshes() {
  const auto aslant = [](const Vector<2>& x) {
    return Vector<2>(1000.0 + x[0] - 0.4 * x[1], 500.0 + x[1] + 0.3 * x[0]);
  };
  std::vector<MeshCase> meshes{
      {"column", model::column_mesh(3, 11, 0.25, 1.0)},
      {"odd_column", model::column_mesh(1, 1)},
      {"jittered", model::column_mesh(9, 8, 1.0, 1.0, model::jittered(0.03, 8))},
      {"aslant", model::column_mesh(6, 7, 1.0, 1.0, aslant)},
      {"free", model::free_mesh(0.09)}};
  // Triangles that no wall of the mesh touches, and one wall within it.
  meshes[2].mesh.boundaries.push_back({"sheet", {{33, 43}, {43, 53}}});
  return meshes;
}

/// Both schemes on one mesh, with the same operator and the same changes.
class Twins {
 public:
  Twins(Mesh<2> mesh, const Options& options, int threads = 1)
      : case_(model::make_case(std::move(mesh), scene())),
        grid_(case_.mesh),
        op_(grid_, conditions(), options.gravity, options.porosity_gradient_term),
        settings_{modulus,
                  1.5,
                  options.drag,
                  options.porosity_gradient_term,
                  options.pressure_moves_with_liquid,
                  threads},
        fast_(op_, settings_),
        plain_(op_, settings_),
        ergun_(options.ergun) {
    change_coefficients();
    std::vector<double> pressure(case_.mesh.element_count());
    // Pressures are a hundredth of the modulus, so that their convection is above round-off.
    for (double& p : pressure) p = 2e5 * random_();
    VectorField<2> velocity(case_.mesh.node_count());
    for (auto& v : velocity) v = {0.1 * random_(), 0.1 * random_()};
    fast_.set_pressure(pressure);
    plain_.set_pressure(pressure);
    fast_.set_velocity(velocity);
    plain_.set_velocity(velocity);
  }

  void change_coefficients() {
    FlowCoefficients<2> c;
    for (int e = 0; e < case_.mesh.element_count(); ++e) {
      const double n = 0.5 + 0.3 * random_();
      c.porosity.push_back(n);
      c.water_volume.push_back(n * (0.9 + 0.1 * random_()) * grid_.volume[e]);
      c.mixture_density.push_back(1100.0 + 100.0 * random_());
      c.drag.push_back(darcy_drag(n, 1000.0, 0.5));
      if (ergun_) c.quadratic_drag.push_back(1e6 * (1.0 + 0.5 * random_()));
    }
    for (int f = 0; f < grid_.face_count(); ++f) {
      c.face_concentration.push_back(0.3 + 0.2 * random_());
    }
    op_.update(c);
    fast_.update(c);
    plain_.update(c);
    plain_.reset_volumes();
    dt_ = 0.3 * assembled_limit(op_, c, modulus, settings_.mass_scaling, settings_.drag,
                                std::vector<double>(ergun_ ? case_.mesh.node_count() : 0, 1.0));
  }

  /// Steps under boundary values that change between steps.
  void run(int steps) {
    const BoundaryValues<2> values(case_, grid_);
    for (int s = 0; s < steps; ++s, time_ += dt_) {
      op_.set_boundary_values(values, time_, time_ + 0.5 * dt_);
      fast_.step(dt_);
      plain_.step(dt_);
    }
  }

  /// Difference of the two schemes relative to the largest value.
  template <class Field>
  static double difference(const Field& a, const Field& b) {
    EXPECT_EQ(a.size(), b.size());
    double largest = 0.0;
    double most = 0.0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
      if constexpr (std::is_same_v<Field, VectorField<2>>) {
        largest = std::max(largest, b[i].norm());
        most = std::max(most, (a[i] - b[i]).norm());
      } else {
        largest = std::max(largest, std::abs(b[i]));
        most = std::max(most, std::abs(a[i] - b[i]));
      }
      EXPECT_TRUE(most >= 0.0) << "not a number";
    }
    EXPECT_GT(largest, 0.0);
    return most / largest;
  }
  [[nodiscard]] double pressures() const { return difference(fast_.pressure(), plain_.pressure()); }
  [[nodiscard]] double velocities() const {
    return std::max(difference(fast_.velocity(), plain_.velocity()),
                    difference(fast_.previous_velocity(), plain_.previous_velocity()));
  }
  [[nodiscard]] double volumes() const {
    const FaceVolumes volumes = fast_.volumes();
    double most = difference(volumes.liquid, plain_.volumes().liquid);
    if (settings_.pressure_moves_with_liquid) {
      EXPECT_TRUE(volumes.density_excess.empty()) << "nobody asks for it";
    } else {
      most = std::max(most, difference(volumes.density_excess, plain_.volumes().density_excess));
    }
    return most;
  }
  /// Liquid that passes walls, m3, and velocities at the corners between walls, m/s.
  [[nodiscard]] double leak() const {
    const FaceVolumes volumes = fast_.volumes();
    double leak = 0.0;
    for (int f = 0; f < grid_.face_count(); ++f) {
      if (op_.conditions()[f].kind == FaceKind::wall) leak += std::abs(volumes.liquid[f]);
    }
    for (const auto& c : op_.constraints()) {
      if (c.free.isZero(0.0) && c.prescribed.isZero(0.0)) leak += fast_.velocity()[c.node].norm();
    }
    return leak;
  }
  [[nodiscard]] ExplicitNodal<2>& fast() { return fast_; }

 private:
  static Scene scene() {
    Scene scene = model::paper_scene();
    const auto rising = [](double from, double to) {
      return TimeFunction{{{0.0, from}, {0.02, to}}};
    };
    BoundaryCondition top;
    top.on = "top";
    top.pressure = rising(1e5, 2e5);
    BoundaryCondition bottom;
    bottom.on = "bottom";
    bottom.darcy_flux = rising(0.02, 0.05);
    scene.boundaries = {top, bottom};
    return scene;
  }
  /// The left half of the top has a velocity; the sheet is a wall within the mesh.
  std::vector<FaceCondition> conditions() {
    std::vector<FaceCondition> result = face_conditions(case_, grid_);
    for (const auto& set : case_.mesh.boundaries) {
      for (const auto& nodes : set.faces) {
        FaceCondition& condition = result[grid_.find_face(nodes)];
        if (set.name == "sheet") condition.kind = FaceKind::wall;
        if (set.name == "right" && grid_.face_centre(grid_.find_face(nodes))[1] > 0.5) {
          condition.kind = FaceKind::velocity;
          condition.value = -0.01;
        }
      }
    }
    return result;
  }

  Case<2> case_;
  Grid<2> grid_;
  NodalOperator<2> op_;
  ExplicitSettings settings_;
  ExplicitNodal<2> fast_;
  model::NodalReference<2> plain_;
  bool ergun_;
  model::Uniform random_{7};
  double dt_ = 0.0;
  double time_ = 0.0;
};

TEST(ExplicitNodal, IsThePlainSchemeToRoundOff) {
  for (const MeshCase& mesh : all_meshes()) {
    for (const Options& options : all_options()) {
      Twins twins(mesh.mesh, options);
      twins.run(150);
      const std::string where = mesh.name + ", " + options.name;
      EXPECT_LE(twins.pressures(), 1e-12) << where;
      EXPECT_LE(twins.velocities(), 1e-12) << where;
      EXPECT_LE(twins.volumes(), 1e-12) << where;
      twins.change_coefficients();
      twins.run(150);
      EXPECT_LE(twins.pressures(), 1e-12) << where << ", other coefficients";
      EXPECT_LE(twins.velocities(), 1e-12) << where << ", other coefficients";
      EXPECT_LE(twins.volumes(), 1e-12) << where << ", other coefficients";
      EXPECT_EQ(twins.leak(), 0.0) << where;
    }
  }
}

TEST(ExplicitNodal, IsTheSameOnTwoThreads) {
  // More elements and nodes than a loop for one thread has.
  const Mesh<2> mesh = model::column_mesh(130, 130, 1.0, 1.0, model::jittered(0.002, 8));
  for (const Options& options : all_options()) {
    Twins one(mesh, options);
    Twins two(mesh, options, 2);
    one.run(3);
    two.run(3);
    EXPECT_EQ(one.fast().pressure(), two.fast().pressure()) << options.name;
    EXPECT_EQ(one.fast().velocity(), two.fast().velocity()) << options.name;
    EXPECT_EQ(one.fast().volumes().liquid, two.fast().volumes().liquid) << options.name;
    EXPECT_EQ(one.fast().volumes().density_excess, two.fast().volumes().density_excess)
        << options.name;
  }
}

}  // namespace explicit_nodal_test
}  // namespace suffuse
