/// Newton's method of the mixed elements for fast flow, whose drag grows with the square of the
/// flux.

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "common/errors.hpp"
#include "grid/parallel.hpp"
#include "mixed/implicit_mixed.hpp"
#include "physics/numbers.hpp"

namespace suffuse {
namespace {

template <int Dim>
std::vector<Vector<Dim>> part_of_way(const std::vector<Vector<Dim>>& from,
                                     const std::vector<Vector<Dim>>& to, double share) {
  std::vector<Vector<Dim>> result(from.size());
  for (std::size_t e = 0; e < from.size(); ++e) result[e] = from[e] + share * (to[e] - from[e]);
  return result;
}

template <int Dim>
double largest_norm(const std::vector<Vector<Dim>>& field) {
  double largest = 0.0;
  for (const Vector<Dim>& v : field) largest = std::max(largest, v.norm());
  return largest;
}

}  // namespace

template <int Dim>
void ImplicitMixed<Dim>::linearise_about(const Field& flux,
                                         const std::vector<double>& quadratic_drag) {
  Work& w = work_;
  for_each_index(grid_.mesh.element_count(), settings_.threads, [&](int e) {
    const double speed = flux[e].norm();
    const double secant = quadratic_drag[e] * speed;
    w.law.mobility[e] = 1.0 / (w.resistance[e] + secant);
    w.law.drive[e] = w.drive[e] + secant * flux[e];
    w.law.factor[e] = soils_.bedding.empty() ? DirectionalFactor<Dim>{} : soils_.bedding[e];
    if (secant > 0.0) {
      w.law.factor[e] = {std::sqrt(secant / (w.resistance[e] + 2.0 * secant)) / speed * flux[e],
                         -1.0};
    }
  });
}

template <int Dim>
double ImplicitMixed<Dim>::momentum_error(const Field& flux, const Field& push,
                                          const std::vector<double>& quadratic_drag) const {
  double sum = 0.0;
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    const double resistance = work_.resistance[e] + quadratic_drag[e] * flux[e].norm();
    const double weight = grid_.volume[e] * work_.law.mobility[e];
    // Soil with bedding has no quadratic drag.
    const Vector<Dim> held =
        soils_.bedding.empty() ? flux[e] : soils_.bedding[e].inverse_times(flux[e]);
    sum += weight * (resistance * held - push[e]).squaredNorm();
  }
  return std::sqrt(sum);
}

template <int Dim>
typename ImplicitMixed<Dim>::FluxChange ImplicitMixed<Dim>::flux_change(
    const Field& new_flux, const Field& new_push) const {
  const Work& w = work_;
  FluxChange result{0.0, largest_norm<Dim>(new_flux), true};
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    const double rise = largest_at_faces(e, w.pressure.rise);
    const double area = largest_at_faces(e, face_area_);
    const double round_off =
        epsilon * (conductance_of(e) * rise / area +
                   w.law.mobility[e] * (w.law.drive[e].norm() + new_push[e].norm()));
    const double here = (new_flux[e] - w.flux[e]).norm();
    if (here > 1e-12 * result.largest_flux + 16.0 * round_off) result.is_round_off = false;
    result.largest = std::max(result.largest, here);
  }
  return result;
}

template <int Dim>
double ImplicitMixed<Dim>::damp(Field& new_flux, Field& new_push,
                                const std::vector<double>& quadratic_drag) const {
  constexpr double least_share = 1e-3;
  const double error = momentum_error(work_.flux, work_.push, quadratic_drag);
  double share = 1.0;
  while (share > least_share) {
    Field part_flux = part_of_way<Dim>(work_.flux, new_flux, share);
    Field part_push = part_of_way<Dim>(work_.push, new_push, share);
    if (momentum_error(part_flux, part_push, quadratic_drag) <= error) {
      new_flux = std::move(part_flux);
      new_push = std::move(part_push);
      break;
    }
    share *= 0.5;
  }
  return share;
}

template <int Dim>
void ImplicitMixed<Dim>::solve_quadratic(const MixedState<Dim>& base,
                                         const FlowForcing<Dim>& forcing, const Field& flux_guess) {
  // Continuity is linear, so after the first iteration only momentum is left to fulfil.
  constexpr int max_iterations = 100;
  Work& w = work_;
  const int elements = grid_.mesh.element_count();
  const std::vector<double>& quadratic_drag = forcing.coefficients.quadratic_drag;
  w.law.mobility.resize(elements);
  w.law.factor.resize(elements);
  w.law.drive.resize(elements);
  w.flux = flux_guess;
  w.push = w.drive;
  Field new_flux;
  Field new_push;
  double last_change = std::numeric_limits<double>::infinity();
  for (int iteration = 0;; ++iteration) {
    linearise_about(w.flux, quadratic_drag);
    if (iteration > 0) w.pressure.move_reference(base.face_pressure);
    solve_pressure(forcing);
    find_flux(new_flux, new_push);

    const FluxChange change = flux_change(new_flux, new_push);
    // A small change that no longer halves is round-off that spread through the mesh.
    const bool stagnates =
        change.largest <= 1e-6 * change.largest_flux && change.largest > 0.5 * last_change;
    if (change.is_round_off || stagnates) {
      w.flux.swap(new_flux);
      return;
    }
    if (iteration == max_iterations) {
      std::ostringstream text;
      text << "the flow with quadratic drag did not converge in " << max_iterations
           << " iterations of Newton's method: the flux still changes by " << change.largest
           << " m/s of " << change.largest_flux << " m/s";
      throw NumericalError(text.str());
    }
    // The first step is never shortened: it is the one that fulfils continuity.
    const double share = iteration > 0 ? damp(new_flux, new_push, quadratic_drag) : 1.0;
    last_change = share == 1.0 ? change.largest : std::numeric_limits<double>::infinity();
    w.flux.swap(new_flux);
    w.push.swap(new_push);
  }
}

template void ImplicitMixed<2>::solve_quadratic(const MixedState<2>&, const FlowForcing<2>&,
                                                const Field&);
template void ImplicitMixed<3>::solve_quadratic(const MixedState<3>&, const FlowForcing<3>&,
                                                const Field&);

}  // namespace suffuse
