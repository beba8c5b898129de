#pragma once

/// Pressure forces on nodes and fluxes through faces in the explicit scheme, with its constraints
/// at the boundary: the discrete gradient and divergence. Nodal velocities are linear, pressure is
/// constant per element ("mixed integration"). A face carries F = N . mean(q_i), q_i = n_i v_i, one
/// number for both sides: outflow of one element is inflow of the next. The force on a node is the
/// transpose of that, so the pair exchanges energy exactly.

#include <Eigen/Core>
#include <vector>

#include "boundary/face_conditions.hpp"
#include "grid/grid.hpp"
#include "mixed/flow.hpp"
#include "results/state_archive.hpp"

namespace suffuse {

/// Velocity components that walls and prescribed fluxes fix at a node: v <- free v + prescribed.
template <int Dim>
struct NodeConstraint {
  int node;
  Eigen::Matrix<double, Dim, Dim> free;  ///< projection onto the free components
  Vector<Dim> prescribed;                ///< m/s, intrinsic
};

template <int Dim>
class NodalOperator {
 public:
  /// `porosity_gradient_term` = false carries n_e v_i instead of n_i v_i, like codes that drop the
  /// third term of Eq. 2: face volumes are then those of the intrinsic velocity, and the element
  /// multiplies them by its own porosity.
  NodalOperator(const Grid<Dim>& grid, std::vector<FaceCondition> conditions, Vector<Dim> gravity,
                bool porosity_gradient_term = true);

  /// Sets node porosities, masses, drag and prescribed values from new coefficients.
  void update(const FlowCoefficients<Dim>& coefficients);

  /// Sets boundary pressures, and velocities and fluxes, to those at two times, s, which are half a
  /// step apart. Call between updates; only the boundary changes.
  void set_boundary_values(const BoundaryValues<Dim>& values, double pressure_time,
                           double flux_time);

  /// Boundary values that change in time; call `update` after they are restored.
  void archive(StateArchive& archive);

  [[nodiscard]] const Grid<Dim>& grid() const { return grid_; }
  [[nodiscard]] const std::vector<FaceCondition>& conditions() const { return conditions_; }
  [[nodiscard]] const Vector<Dim>& gravity() const { return gravity_; }
  /// Harmonic mean of the elements around a node: the flux is continuous at a jump of porosity, and
  /// its inertia per volume is rho / n.
  [[nodiscard]] const std::vector<double>& node_porosity() const { return node_porosity_; }
  /// Factor of a node's velocity in the flux through faces.
  [[nodiscard]] const std::vector<double>& carried_porosity() const { return carried_porosity_; }
  /// Mass that accelerates per node, kg, without mass scaling.
  [[nodiscard]] const std::vector<double>& node_mass() const { return node_mass_; }
  /// Linear drag per node, kg/s. It acts on the flux n_i v_i, which is continuous at a jump of
  /// porosity or conductivity.
  [[nodiscard]] const std::vector<double>& node_drag() const { return node_drag_; }
  /// Additional drag of fast flow, per speed of the node, kg/m; may be empty.
  [[nodiscard]] const std::vector<double>& node_quadratic_drag() const {
    return node_quadratic_drag_;
  }
  [[nodiscard]] const std::vector<NodeConstraint<Dim>>& constraints() const { return constraints_; }

  /// Force of pressure and gravity on a node, N: each face at the node pushes with the difference
  /// of the pressures on its sides. Outside is 0: boundary pressure is in the external force.
  [[nodiscard]] Vector<Dim> force(int node, const std::vector<double>& pressure) const {
    Vector<Dim> sum = Vector<Dim>::Zero();
    for (int k = grid_.node_face_begin[node]; k < grid_.node_face_begin[node + 1]; ++k) {
      const int f = grid_.node_face[k];
      if (flux_is_fixed_[f] != 0) continue;
      const double right = grid_.is_outer(f) ? 0.0 : pressure[grid_.face_right[f]];
      sum += (pressure[grid_.face_left[f]] - right) * grid_.face_normal[f];
    }
    return external_force_[node] + sum / Dim;
  }

  /// Liquid volume through a face per second, along its normal, m3/s.
  [[nodiscard]] double face_flux(int face, const VectorField<Dim>& velocity) const {
    if (flux_is_fixed_[face] != 0) return fixed_flux_[face];
    Vector<Dim> q = Vector<Dim>::Zero();
    for (const int i : grid_.face_nodes[face]) q += carried_porosity_[i] * velocity[i];
    return grid_.face_normal[face].dot(q) / Dim;
  }

  void constrain(VectorField<Dim>& velocity) const {
    for (const auto& c : constraints_) {
      velocity[c.node] = c.free * velocity[c.node] + c.prescribed;
    }
  }

 private:
  void make_constraint_normals();
  void set_boundary_force();
  void set_held_values();
  void set_fixed_fluxes();
  void update_constraints();
  void set_prescribed();

  const Grid<Dim>& grid_;
  std::vector<FaceCondition> conditions_;
  Vector<Dim> gravity_;
  bool porosity_gradient_term_;
  std::vector<double> node_porosity_;
  std::vector<double> carried_porosity_;
  std::vector<double> node_mass_;
  std::vector<double> node_drag_;
  std::vector<double> node_quadratic_drag_;
  std::vector<unsigned char>
      flux_is_fixed_;  ///< one byte per face: the hot loop reads nothing else
  std::vector<double> fixed_flux_;
  std::vector<int> pressure_faces_;  ///< faces with a prescribed pressure
  std::vector<int> fixed_faces_;     ///< faces with a prescribed flux, walls included
  std::vector<int> pressure_nodes_;  ///< of `pressure_faces_`, ascending, each once
  VectorField<Dim> boundary_force_;
  VectorField<Dim> external_force_;
  std::vector<NodeConstraint<Dim>> constraints_;

  /// One direction in which a node is held, averaged over faces that nearly share a plane.
  struct HeldNormal {
    int node;
    Vector<Dim> normal;
    std::vector<int> faces;
    double velocity = 0.0;  ///< outward intrinsic velocity prescribed, m/s
    double flux = 0.0;      ///< outward Darcy flux prescribed, m/s
  };
  std::vector<HeldNormal> held_;  ///< ascending in node

  /// Prescribed velocity of a node, by the values of its normals; ordered as `constraints_`.
  struct Prescription {
    int first;                                           ///< index in `held_`
    Eigen::Matrix<double, Dim, Eigen::Dynamic> inverse;  ///< a column per normal
  };
  std::vector<Prescription> prescriptions_;
};

}  // namespace suffuse
