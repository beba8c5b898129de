#pragma once

/// The paper's flow scheme: explicit liquid momentum at the nodes, one pressure per element.

#include <vector>

#include "flow/nodal_operator.hpp"

namespace suffuse {

struct ExplicitSettings {
  double bulk_modulus = unset;
  double mass_scaling = 1.0;
  DragIntegration drag = DragIntegration::explicit_drag;
  /// false drops the third term of Eq. 2, for comparison: see FlowSettings.
  bool porosity_gradient_term = true;
  /// Pressure changes with strain alone: its convection, of order p / K, is done by whoever moves
  /// the liquid, or left out where no mass hangs on it.
  bool pressure_moves_with_liquid = false;
  bool sum_displacements = false;
  int threads = 1;
};

/// Symplectic Euler started with half a step of velocity, so that velocity lives between the times
/// of pressure: second order without drag, first order with it (drag is evaluated at one end).
template <int Dim>
class ExplicitNodal {
 public:
  ExplicitNodal(const NodalOperator<Dim>& op, ExplicitSettings settings);

  /// New coefficients (the operator's update comes first).
  void update(const FlowCoefficients<Dim>& coefficients);

  /// One step of `dt` seconds.
  void step(double dt);

  void set_pressure(std::vector<double> pressure) { pressure_ = std::move(pressure); }
  void set_velocity(VectorField<Dim> velocity) {
    velocity_ = std::move(velocity);
    operator_.constrain(velocity_);
    previous_velocity_ = velocity_;
  }
  /// The same in place, for whoever carries the flow from step to step: `write(velocity, pressure)`.
  template <class Write>
  void rewrite(const Write& write) {
    write(velocity_, pressure_);
    operator_.constrain(velocity_);
    previous_velocity_ = velocity_;
  }

  [[nodiscard]] const std::vector<double>& pressure() const { return pressure_; }
  /// At half a step before the time of the pressure.
  [[nodiscard]] const VectorField<Dim>& velocity() const { return velocity_; }
  /// What the last step began with.
  [[nodiscard]] const VectorField<Dim>& previous_velocity() const { return previous_velocity_; }

  /// Velocity `ahead` seconds after the middle of the last step, on the line through the last two.
  [[nodiscard]] VectorField<Dim> velocity_at(double ahead) const;

  /// Volumes since the last `reset_volumes`.
  [[nodiscard]] const FaceVolumes& volumes() const { return volumes_; }
  /// Integral of each node's velocity since then, m; empty unless asked for.
  [[nodiscard]] const VectorField<Dim>& displacements() const { return displacement_; }
  void reset_volumes() {
    volumes_.reset(operator_.grid().face_count());
    if (settings_.sum_displacements) displacement_.assign(velocity_.size(), Vector<Dim>::Zero());
  }

 private:
  void accelerate(double dt);
  void cross_faces(double dt);
  void compress(double dt);

  const NodalOperator<Dim>& operator_;
  ExplicitSettings settings_;
  std::vector<double> pressure_;  ///< per element, Pa
  VectorField<Dim> velocity_;     ///< per node, m/s
  VectorField<Dim> previous_velocity_;
  double last_dt_ = 0.0;
  double velocity_spacing_ = 0.0;  ///< time between the last two velocities, s
  FaceVolumes volumes_;
  VectorField<Dim> displacement_;

  std::vector<double> element_weight_;  ///< 1 / water volume (times n_e without the third term)
  std::vector<double> carried_water_share_;  ///< 1 - c per face
  std::vector<double> face_flux_;            ///< m3/s
  std::vector<double> upwind_pressure_;      ///< per face, Pa
};

}  // namespace suffuse
