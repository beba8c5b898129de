#pragma once

/// The nodal scheme as its equations are written, one loop per equation over all nodes, faces or
/// elements: slow and plain, for comparison with the solver's own loops.

#include <vector>

#include "explicit/explicit_nodal.hpp"

namespace suffuse::model {

template <int Dim>
class NodalReference {
 public:
  NodalReference(const NodalOperator<Dim>& op, ExplicitSettings settings)
      : operator_(op),
        settings_(settings),
        pressure_(op.grid().mesh.element_count(), 0.0),
        velocity_(op.grid().mesh.node_count(), Vector<Dim>::Zero()),
        previous_velocity_(velocity_),
        face_flux_(op.grid().face_count(), 0.0),
        upwind_pressure_(op.grid().face_count(), 0.0) {
    reset_volumes();
  }

  void update(const FlowCoefficients<Dim>& coefficients) { coefficients_ = coefficients; }
  void set_pressure(std::vector<double> pressure) { pressure_ = std::move(pressure); }
  void set_velocity(VectorField<Dim> velocity) {
    velocity_ = std::move(velocity);
    operator_.constrain(velocity_);
    previous_velocity_ = velocity_;
  }
  void reset_volumes() {
    volumes_.liquid.assign(operator_.grid().face_count(), 0.0);
    volumes_.density_excess = volumes_.liquid;
  }

  void step(double dt) {
    previous_velocity_ = velocity_;
    accelerate(0.5 * (last_dt_ + dt));
    cross_faces(dt);
    compress(dt);
    last_dt_ = dt;
  }

  [[nodiscard]] const std::vector<double>& pressure() const { return pressure_; }
  [[nodiscard]] const VectorField<Dim>& velocity() const { return velocity_; }
  [[nodiscard]] const VectorField<Dim>& previous_velocity() const { return previous_velocity_; }
  [[nodiscard]] const FaceVolumes& volumes() const { return volumes_; }

 private:
  void accelerate(double dt) {
    const bool implicit_drag = settings_.drag == DragIntegration::implicit_drag;
    const std::vector<double>& quadratic = operator_.node_quadratic_drag();
    for (int i = 0; i < operator_.grid().mesh.node_count(); ++i) {
      const double rate = dt / (settings_.mass_scaling * operator_.node_mass()[i]);
      double drag = operator_.node_drag()[i];
      if (!quadratic.empty()) drag += quadratic[i] * velocity_[i].norm();
      const double damping = rate * drag;
      const Vector<Dim> push = rate * operator_.force(i, pressure_);
      if (implicit_drag) {
        velocity_[i] = (velocity_[i] + push) / (1.0 + damping);
      } else {
        velocity_[i] += push - damping * velocity_[i];
      }
    }
    operator_.constrain(velocity_);
  }

  void cross_faces(double dt) {
    const Grid<Dim>& grid = operator_.grid();
    const auto& conditions = operator_.conditions();
    for (int f = 0; f < grid.face_count(); ++f) {
      const double flux = operator_.face_flux(f, velocity_);
      const int right = grid.face_right[f];
      double upwind = pressure_[grid.face_left[f]];
      if (flux < 0.0) {
        if (right >= 0) {
          upwind = pressure_[right];
        } else if (conditions[f].kind == FaceKind::pressure) {
          upwind = conditions[f].value;
        }
      }
      face_flux_[f] = flux;
      upwind_pressure_[f] = upwind;
      volumes_.liquid[f] += dt * flux;
      // rho_w / rho_w0 - 1 = exp(p / K) - 1 to third order.
      const double x = upwind / settings_.bulk_modulus;
      volumes_.density_excess[f] += dt * flux * x * (1.0 + 0.5 * x * (1.0 + x / 3.0));
    }
  }

  void compress(double dt) {
    const Grid<Dim>& grid = operator_.grid();
    const double modulus = settings_.bulk_modulus;
    const double convected = settings_.pressure_moves_with_liquid ? 0.0 : 1.0 / modulus;
    for (int e = 0; e < grid.mesh.element_count(); ++e) {
      double outflow = 0.0;
      for (int k = 0; k <= Dim; ++k) {
        const int f = grid.element_face[e][k];
        const double heavier =
            (1.0 - coefficients_.face_concentration[f]) * (upwind_pressure_[f] - pressure_[e]);
        outflow += grid.element_face_sign[e][k] * face_flux_[f] * (1.0 + convected * heavier);
      }
      const double carried = settings_.porosity_gradient_term ? 1.0 : coefficients_.porosity[e];
      // ln(1 - x) to second order.
      const double lost = dt * outflow * carried / coefficients_.water_volume[e];
      pressure_[e] -= modulus * lost * (1.0 + 0.5 * lost);
    }
  }

  const NodalOperator<Dim>& operator_;
  ExplicitSettings settings_;
  FlowCoefficients<Dim> coefficients_;
  std::vector<double> pressure_;
  VectorField<Dim> velocity_;
  VectorField<Dim> previous_velocity_;
  double last_dt_ = 0.0;
  FaceVolumes volumes_;
  std::vector<double> face_flux_;
  std::vector<double> upwind_pressure_;
};

}  // namespace suffuse::model
