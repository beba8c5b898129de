#pragma once

/// The paper's flow scheme: liquid velocities at the nodes of the mesh and one pressure per
/// element, stepped explicitly.

#include <vector>

#include "explicit/nodal_operator.hpp"
#include "results/state_archive.hpp"

namespace suffuse {

struct ExplicitSettings {
  double bulk_modulus = unset;
  double mass_scaling = 1.0;
  DragIntegration drag = DragIntegration::explicit_drag;
  /// false drops the third term of Eq. 2, for comparison: see FlowSettings.
  bool porosity_gradient_term = true;
  /// Pressure changes by strain only. Its convection, of order p / K, is done by the points that
  /// carry the liquid, or left out where no mass depends on it. The density of the water that
  /// crosses a face is then not needed.
  bool pressure_moves_with_liquid = false;
  int threads = 1;
};

/// Symplectic Euler started with half a step of velocity, so velocity is known between the times of
/// pressure: second order without drag, first order with it (drag is taken at one end).
///
/// A step has three loops. `accelerate`: each node gathers its force from the faces around it.
/// `cross_faces`: each face finds its flux from the velocity of its nodes. `compress`: each element
/// finds its pressure from the fluxes through its faces. An index writes its own values only, so
/// results do not depend on threads.
///
/// Nodes, faces and elements close in the mesh should be close in memory: on large meshes in the
/// order of Gmsh a step takes three times as long.
template <int Dim>
class ExplicitNodal {
 public:
  ExplicitNodal(const NodalOperator<Dim>& op, ExplicitSettings settings);

  /// Takes new coefficients, after the operator's update. Resets volumes.
  void update(const FlowCoefficients<Dim>& coefficients);

  /// One step of `dt` seconds. Velocities, and volumes through faces, are those of this rank's own
  /// until `exchange`.
  void step(double dt);
  /// Fetches velocities and volumes from other ranks, after the steps of an interval.
  void exchange();

  void set_pressure(std::vector<double> pressure) { pressure_ = std::move(pressure); }
  void set_velocity(VectorField<Dim> velocity) {
    velocity_ = std::move(velocity);
    operator_.constrain(velocity_);
    // At the fringe of a rank's part the constraints are not those of the model.
    operator_.grid().node_rows().exchange(velocity_);
  }
  /// Replaces velocity and pressure in place, between steps, if points carry the flow:
  /// `write(velocity, pressure)`.
  template <class Write>
  void rewrite(const Write& write) {
    write(velocity_, pressure_);
    operator_.constrain(velocity_);
  }

  /// Per element, Pa.
  [[nodiscard]] const std::vector<double>& pressure() const { return pressure_; }
  /// Per node, m/s, at half a step before the time of the pressure.
  [[nodiscard]] const VectorField<Dim>& velocity() const { return velocity_; }
  /// Velocity at the start of the last step.
  [[nodiscard]] const VectorField<Dim>& previous_velocity() const { return previous_velocity_; }

  /// Pressures and velocities, not volumes; between steps, with the present coefficients.
  void archive(StateArchive& archive);

  /// Volumes since the last `reset_volumes`, without `density_excess` if the pressure moves with
  /// the liquid.
  [[nodiscard]] const FaceVolumes& volumes() const { return volumes_; }
  void reset_volumes();

  /// The parts of a step, for benchmarks: velocities after `spacing` seconds; volumes through faces
  /// in `dt` seconds with these velocities; pressures after that.
  void accelerate(double spacing);
  void cross_faces(double dt);
  void compress(double dt);

 private:
  [[nodiscard]] double outer_pressure(int face) const;

  const NodalOperator<Dim>& operator_;
  ExplicitSettings settings_;
  std::vector<double> pressure_;  ///< per element, Pa
  VectorField<Dim> velocity_;     ///< per node, m/s
  VectorField<Dim> previous_velocity_;
  double last_dt_ = 0.0;

  std::vector<double> inverse_mass_;  ///< per node, 1 / (S m_i), 1/kg
  /// Per element, 1 / water volume (times n_e without the third term), 1/m3.
  std::vector<double> compression_;
  std::vector<double> convection_;  ///< per face, (1 - c) / K, 1/Pa
  /// Per face: the flux out of an element of pressure p is `face_flux_` - p `convected_flux_`.
  std::vector<double> face_flux_;  ///< m3/s
  std::vector<double>
      convected_flux_;  ///< m3/(Pa s); empty where the pressure moves with the liquid
  FaceVolumes volumes_;
};

}  // namespace suffuse
