#pragma once

/// Newton's method on flux and pressure together for fast flow, whose drag grows with the square of
/// the flux. Soil with bedding has no such drag.

#include "grid/field_values.hpp"
#include "mixed/pressure_system.hpp"

namespace suffuse {

template <int Dim>
class QuadraticNewton {
 public:
  QuadraticNewton(MixedStage<Dim>& stage, PressureSystem<Dim>& system)
      : stage_(stage), system_(system), quadratic_drag_(stage.coefficients.quadratic_drag) {}

  /// Finds pressures and fluxes, starting from `flux_guess`. Throws NumericalError.
  void solve(const VectorField<Dim>& flux_guess) {
    // Continuity is linear: after the first iteration only the momentum equation has a residual.
    constexpr int max_iterations = 100;
    stage_.flux = flux_guess;
    double last_change = infinity;
    for (int iteration = 0;; ++iteration) {
      linearise_about(stage_.flux);
      if (iteration > 0) stage_.pressure.move_reference(stage_.base.face_pressure);
      system_.solve(stage_);
      Field new_flux = stage_.found_flux();
      Field new_push = push();

      const Change change = change_to(new_flux, new_push);
      // A small change that no longer halves is round-off that spread through the mesh.
      const bool stagnates =
          change.largest <= 1e-6 * change.largest_flux && change.largest > 0.5 * last_change;
      if (change.is_round_off || stagnates) return stage_.flux.swap(new_flux);
      if (iteration == max_iterations) {
        std::ostringstream text;
        text << "the flow with quadratic drag did not converge in " << max_iterations
             << " iterations of Newton's method: the flux still changes by " << change.largest
             << " m/s of " << change.largest_flux << " m/s";
        throw NumericalError(text.str());
      }
      // The first step is never shortened, as it satisfies continuity.
      const double share = iteration > 0 ? damp(new_flux, new_push) : 1.0;
      last_change = share == 1.0 ? change.largest : infinity;
      stage_.flux.swap(new_flux);
      push_.swap(new_push);
    }
  }

 private:
  using Field = VectorField<Dim>;

  /// How an iteration changes the flux of the elements.
  struct Change {
    double largest = 0.0;       ///< m/s
    double largest_flux = 0.0;  ///< m/s
    bool is_round_off = true;   ///< true in every element
  };

  void linearise_about(const Field& flux) {
    MomentumLaw<Dim>& law = stage_.law;
    law.factor.resize(flux.size());
    stage_.for_each_element([&](int e) {
      const double resistance = stage_.resistance[e];
      const double speed = flux[e].norm();
      const double secant = quadratic_drag_[e] * speed;
      law.mobility[e] = 1.0 / (resistance + secant);
      law.drive[e] = stage_.drive[e] + secant * flux[e];
      law.factor[e] = stage_.bedding.empty() ? DirectionalFactor<Dim>{} : stage_.bedding[e];
      if (secant > 0.0) {
        law.factor[e] = {std::sqrt(secant / (resistance + 2.0 * secant)) / speed * flux[e], -1.0};
      }
    });
  }
  /// Drive minus pressure gradient of each element at the pressures found, Pa/m.
  [[nodiscard]] Field push() const {
    const FacePressure& pressure = stage_.pressure;
    Field result(stage_.drive.size());
    stage_.for_each_element([&](int e) {
      result[e] =
          stage_.drive[e] - stage_.model.pressure_gradient(e, pressure.reference, pressure.rise);
    });
    return result;
  }
  [[nodiscard]] Change change_to(const Field& new_flux, const Field& new_push) const {
    const MixedModel<Dim>& model = stage_.model;
    const Ranks& ranks = model.grid.ranks();
    Change result;
    result.largest_flux = stage_.largest_of_elements([&](int e) { return new_flux[e].norm(); });
    for (std::size_t i = 0; i < new_flux.size(); ++i) {
      const int e = static_cast<int>(i);
      const double rise = model.largest_at_faces(e, stage_.pressure.rise);
      const double area = model.largest_at_faces(e, model.face_area);
      const double round_off =
          epsilon * (stage_.conductance_of(e) * rise / area +
                     stage_.law.mobility[e] * (stage_.law.drive[e].norm() + new_push[e].norm()));
      const double here = (new_flux[e] - stage_.flux[e]).norm();
      if (here > 1e-12 * result.largest_flux + 16.0 * round_off) result.is_round_off = false;
      result.largest = std::max(result.largest, here);
    }
    result.is_round_off = !any_of_all(ranks, !result.is_round_off);
    result.largest = largest_of_all(ranks, result.largest);
    return result;
  }
  /// Shortens the step to the new flux and push until it does not raise the error of momentum.
  /// Returns the share of the step that is taken. If no share helps, the whole step is taken, and
  /// the value returned is below 1e-3.
  double damp(Field& new_flux, Field& new_push) const {
    constexpr double least_share = 1e-3;
    const double error = momentum_error(stage_.flux, push_);
    double share = 1.0;
    for (; share > least_share; share *= 0.5) {
      Field part_flux = between(stage_.flux, new_flux, share);
      Field part_push = between(push_, new_push, share);
      if (!(momentum_error(part_flux, part_push) <= error)) continue;
      new_flux = std::move(part_flux);
      new_push = std::move(part_push);
      break;
    }
    return share;
  }
  /// Norm of the residual of momentum at a flux and its push.
  [[nodiscard]] double momentum_error(const Field& flux, const Field& push) const {
    double sum = 0.0;
    for (const int e : stage_.model.grid.own_elements()) {
      const double resistance = stage_.resistance[e] + quadratic_drag_[e] * flux[e].norm();
      const double weight = stage_.model.grid.volume[e] * stage_.law.mobility[e];
      const Vector<Dim> held =
          stage_.bedding.empty() ? flux[e] : stage_.bedding[e].inverse_times(flux[e]);
      sum += weight * (resistance * held - push[e]).squaredNorm();
    }
    return std::sqrt(sum_of_all(stage_.model.grid.ranks(), sum));
  }

  MixedStage<Dim>& stage_;
  PressureSystem<Dim>& system_;
  const std::vector<double>& quadratic_drag_;
  Field push_;  ///< of the current flux
};

}  // namespace suffuse
