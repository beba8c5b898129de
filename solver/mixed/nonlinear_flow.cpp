/// Newton's method of the mixed elements for what depends on the pressure itself: how much liquid
/// soil under suction holds (in the mixed form of Celia, Bouloutas and Zarba, Water Resour. Res. 26
/// (1990) 1483), how well it conducts, and which seepage faces let water out.

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

constexpr int max_newton_iterations = 60;
/// From here on the iteration of a step has to be nearer to the balance than at its start.
constexpr int patient_iterations = 20;
/// The balance at a face may be missed by this share of the largest flux, in addition to round-off
/// of what gravity drives and of the contents of the elements.
constexpr double flux_accuracy = 1e-8;
constexpr double round_off_units = 64.0;
/// Looser tolerance when the iteration stagnates: in units of round-off of what the pressures of an
/// element drive.
constexpr double many_round_off_units = 512.0;
/// From here on seepage faces open and close.
constexpr double near_solution = 0.1;
/// Smallest share of a step of Newton's method that is taken.
constexpr double min_share = 1.0 / 16.0;
/// In an iteration, suction grows by this factor of itself and a metre at most.
constexpr double max_suction_growth = 10.0;

[[noreturn]] void refuse_unsettled(int iterations, double left, double scale, bool switched) {
  std::ostringstream text;
  text << "the iteration of the flow did not converge in " << iterations << " solutions: " << left
       << " m3/s are missing at a face, of " << scale << " m3/s"
       << (switched ? "; seepage faces keep opening and closing" : "");
  throw NotConverged(text.str());
}

}  // namespace

template <int Dim>
ElementField<Dim> ImplicitMixed<Dim>::air_at(const std::vector<double>& face_pressure,
                                             const std::vector<double>& porosity) const {
  ElementField<Dim> air;
  if (soils_.saturated()) return air;
  air.resize(grid_.mesh.elements.size());
  for_each_index(grid_.mesh.element_count(), settings_.threads, [&](int e) {
    const double share = porosity[e] * grid_.volume[e] / (Dim + 1);
    for (int k = 0; k <= Dim; ++k) {
      air[e][k] = share * (1.0 - soils_.saturation(e, face_pressure[grid_.element_face[e][k]]));
    }
  });
  return air;
}

template <int Dim>
void ImplicitMixed<Dim>::resolve(const FaceCondition& condition, int face) {
  FaceCondition& resolved = work_.resolved[face];
  resolved = condition;
  if (condition.kind == FaceKind::seepage) {
    const bool open = open_[face] != 0;
    resolved.kind = open ? FaceKind::pressure : FaceKind::flux;
    resolved.value = open ? 0.0 : condition.value;
  }
  held_[face] = resolved.kind == FaceKind::pressure ? 1 : 0;
}

template <int Dim>
void ImplicitMixed<Dim>::resolve_conditions(const FlowForcing<Dim>& forcing) {
  work_.conditions = &forcing.conditions;
  if (switching_.empty()) return;
  work_.resolved = forcing.conditions;
  work_.conditions = &work_.resolved;
  for (const int f : switching_) resolve(forcing.conditions[f], f);
}

template <int Dim>
double ImplicitMixed<Dim>::displacement_rate(const MixedState<Dim>& base, double duration,
                                             const FlowForcing<Dim>& forcing, int e, int k,
                                             double pressure) const {
  if (!std::isfinite(duration)) return 0.0;
  const double share = forcing.coefficients.porosity[e] * grid_.volume[e] / (Dim + 1);
  const double air = share * (1.0 - soils_.saturation(e, pressure));
  return (base.air[e][k] - air) / duration;
}

template <int Dim>
std::vector<double> ImplicitMixed<Dim>::relative_conductivity(
    const std::vector<double>& face_pressure) const {
  std::vector<double> result;
  if (soils_.saturated()) return result;
  result.resize(grid_.mesh.element_count(), 0.0);
  for_each_index(grid_.mesh.element_count(), settings_.threads, [&](int e) {
    for (const int f : grid_.element_face[e]) {
      result[e] += soils_.relative_conductivity(e, face_pressure[f]) / (Dim + 1);
    }
  });
  return result;
}

template <int Dim>
void ImplicitMixed<Dim>::linearise_retention(const MixedState<Dim>& base, double duration,
                                             const FlowForcing<Dim>& forcing) {
  Work& w = work_;
  const std::vector<double>& pressure = w.pressure.reference;
  for_each_index(grid_.mesh.element_count(), settings_.threads, [&](int e) {
    double conducts = 0.0;
    const double share = forcing.coefficients.porosity[e] * grid_.volume[e] / (Dim + 1);
    for (int k = 0; k <= Dim; ++k) {
      const double p = pressure[grid_.element_face[e][k]];
      conducts += soils_.relative_conductivity(e, p) / (Dim + 1);
      w.displaced[e][k] = displacement_rate(base, duration, forcing, e, k, p);
      w.side_storage[e][k] =
          std::isfinite(duration) ? share * soils_.capacity(e, p) / duration : 0.0;
    }
    const double of_darcy = conducts / w.resistance[e];
    set_mobility(e, of_darcy);
    for (int k = 0; k <= Dim; ++k) {
      // The slope is a difference over a little of the suction: at saturation it may be infinite.
      const double p = pressure[grid_.element_face[e][k]];
      const double near = 1.0 + 1e-3 * std::abs(p);  // Pa
      const double rise =
          soils_.relative_conductivity(e, p + near) - soils_.relative_conductivity(e, p - near);
      w.gain[e][k] = rise / (2.0 * near) / (Dim + 1) / conducts;
      if (!w.beside.empty()) w.gain[e][k] *= of_darcy / w.law.mobility[e];
    }
  });
}

template <int Dim>
bool ImplicitMixed<Dim>::switch_faces(const FlowForcing<Dim>& forcing, double flux_tolerance,
                                      double pressure_tolerance) {
  bool switched = false;
  for (const int f : switching_) {
    const FaceCondition& condition = forcing.conditions[f];
    if (condition.kind != FaceKind::seepage) continue;
    const int e = grid_.face_left[f];
    const double rise = work_.pressure.offset[f] + work_.pressure.rise[f];
    const bool takes_in_more =
        open_[f] != 0 &&
        -flux_out(e, grid_.side_of(e, f), rise) > condition.value * face_area_[f] + flux_tolerance;
    const bool presses =
        open_[f] == 0 && work_.pressure.reference[f] + work_.pressure.rise[f] > pressure_tolerance;
    if (!takes_in_more && !presses) continue;
    open_[f] = presses ? 1 : 0;
    resolve(condition, f);
    switched = true;
  }
  return switched;
}

template <int Dim>
void ImplicitMixed<Dim>::follow_held_faces() {
  bool changed = false;
  for (const int f : switching_) {
    const char held = is_held(f) ? 1 : 0;
    changed = changed || corrected_[f] != held;
    corrected_[f] = held;
  }
  if (changed) set_up_correction();
}

template <int Dim>
bool ImplicitMixed<Dim>::is_level_held(int piece) const {
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    if (correction_->sealed_piece()[e] != piece) continue;
    if (stores(e)) return true;
    if (work_.side_storage.empty()) continue;
    if (std::ranges::any_of(work_.side_storage[e], [](double s) { return s > 0.0; })) return true;
  }
  return false;
}

template <int Dim>
bool ImplicitMixed<Dim>::hold_levels(const FlowForcing<Dim>& forcing) {
  bool opened = false;
  for (int p = 0; p < correction_->sealed_piece_count(); ++p) {
    if (is_level_held(p)) continue;
    int highest = -1;
    for (const int f : switching_) {
      if (forcing.conditions[f].kind != FaceKind::seepage) continue;
      if (correction_->sealed_piece()[grid_.face_left[f]] != p) continue;
      const std::vector<double>& pressure = work_.pressure.reference;
      if (highest < 0 || pressure[f] > pressure[highest]) highest = f;
    }
    if (highest < 0) {
      work_.level_elements.push_back(correction_->sealed_root()[p]);
      continue;
    }
    open_[highest] = 1;
    resolve(forcing.conditions[highest], highest);
    opened = true;
  }
  return opened;
}

template <int Dim>
void ImplicitMixed<Dim>::solve_newton() try {
  Work& w = work_;
  // A wetter element conducts better. Where water enters, that adds to the diagonal; the symmetric
  // matrix with this alone is factored, the whole one is solved with it.
  ElementField<Dim> flux(w.displaced.size());
  ElementField<Dim> on_diagonal = w.side_storage;
  for_each_index(static_cast<int>(flux.size()), settings_.threads, [&](int e) {
    for (int k = 0; k <= Dim; ++k) {
      flux[e][k] = w.flux[e].dot(grid_.outward_normal(e, k));
      on_diagonal[e][k] += std::max(0.0, -flux[e][k] * w.gain[e][k]);
    }
  });
  matrix_.assemble(w.law, w.storage, on_diagonal, w.mean_storage);
  for (const LeakyFace& wall : w.walls) matrix_.couple(wall);
  for (const int e : w.level_elements) matrix_.hold_level(e);
  for (const int f : switching_) {
    if (is_held(f)) matrix_.uncouple(f);
  }
  newton_->factorise(matrix_.values());
  if (flux.empty()) {
    newton_->solve(matrix_.values(), w.load, w.step);
  } else {
    newton_->solve_tangent(matrix_.with_gain(flux, w.gain, held_), w.load, w.step);
  }
} catch (const NumericalError& error) {
  throw NotConverged(error.what());
}

template <int Dim>
void ImplicitMixed<Dim>::evaluate(const MixedState<Dim>& base, double duration,
                                  const FlowForcing<Dim>& forcing) {
  Work& w = work_;
  w.level_elements.clear();
  follow_held_faces();
  for (const int f : switching_) {
    if (is_held(f)) w.pressure.rise[f] = condition(f).value - w.pressure.reference[f];
  }
  w.pressure.move_reference(base.face_pressure);
  if (has_retention()) linearise_retention(base, duration, forcing);
  if (hold_levels(forcing)) return evaluate(base, duration, forcing);
  find_flux(w.flux, w.push);
  find_load(forcing);
  for (const int f : switching_) {
    if (is_held(f)) w.load[matrix_.unknown(f)] = 0.0;
  }
}

template <int Dim>
double ImplicitMixed<Dim>::balance_round_off(double duration,
                                             const FlowForcing<Dim>& forcing) const {
  return round_off_units * epsilon *
         largest_of(grid_.mesh.element_count(), settings_.threads, 0.0, [&](int e) {
           const double pores = forcing.coefficients.porosity[e] * grid_.volume[e];
           return gravity_flux(e, forcing.coefficients) + pores / duration;
         });
}

template <int Dim>
bool ImplicitMixed<Dim>::is_round_off_left(const FlowCoefficients<Dim>& c) const {
  const double units = largest_of(grid_.face_count(), settings_.threads, 0.0, [&](int f) {
    const double missing = is_held(f) ? 0.0 : std::abs(work_.load[matrix_.unknown(f)]);
    double terms = 0.0;
    for (const int e : {grid_.face_left[f], grid_.face_right[f]}) {
      if (e < 0) continue;
      const double pressure = largest_at_faces(e, work_.pressure.reference);
      terms += gravity_flux(e, c) + conductance_of(e) * pressure;
    }
    return missing > 0.0 ? missing / (epsilon * terms) : 0.0;
  });
  return units <= many_round_off_units;
}

template <int Dim>
void ImplicitMixed<Dim>::solve_nonlinear(const MixedState<Dim>& base, double duration,
                                         const FlowForcing<Dim>& forcing) {
  Work& w = work_;
  const int elements = grid_.mesh.element_count();
  w.law.factor = soils_.bedding;
  w.law.drive = w.drive;
  w.law.mobility.resize(elements);
  for (int e = 0; e < elements; ++e) set_mobility(e, 1.0 / w.resistance[e]);
  const double round_off = balance_round_off(duration, forcing);
  double share = 1.0;
  double first_norm = 0.0;
  double last_norm = std::numeric_limits<double>::infinity();
  std::vector<double> from;
  for (iterations_ = 0;; ++iterations_) {
    evaluate(base, duration, forcing);
    double norm = w.load.norm();
    // The first pressures have none to go back to.
    while (iterations_ > 0 && !(norm < last_norm) && share > min_share) {
      // Back, and a shorter step.
      share *= 0.5;
      w.pressure.reference = from;
      take_step(share);
      evaluate(base, duration, forcing);
      norm = w.load.norm();
    }
    if (iterations_ == 0) first_norm = norm;
    const double scale = largest_flux();
    const double left = w.load.size() > 0 ? w.load.template lpNorm<Eigen::Infinity>() : 0.0;
    const double allowed = flux_accuracy * scale + round_off + round_off_units * wall_round_off();
    // Where water stands still, or an element is next to flat: pressures have no more digits.
    const bool stays = norm > 0.5 * last_norm && is_round_off_left(forcing.coefficients);
    const bool solved = left <= allowed || stays;
    const bool switched =
        (solved || left <= near_solution * scale + allowed) &&
        switch_faces(forcing, stays ? std::max(left, allowed) : allowed, pressure_accuracy());
    if (!switched && solved) return;
    // A shorter step starts nearer to its end.
    const bool wanders =
        std::isfinite(duration) && iterations_ >= patient_iterations && norm > first_norm;
    if (!std::isfinite(left) || wanders || iterations_ == max_newton_iterations) {
      refuse_unsettled(iterations_, left, scale, switched);
    }
    share = 1.0;
    last_norm = switched ? std::numeric_limits<double>::infinity() : norm;
    if (switched) evaluate(base, duration, forcing);
    from = w.pressure.reference;
    solve_newton();
    take_step(share);
  }
}

template <int Dim>
void ImplicitMixed<Dim>::take_step(double share) {
  for_each_index(grid_.face_count(), settings_.threads, [&](int f) {
    work_.pressure.rise[f] = is_held(f) ? 0.0 : share * work_.step[matrix_.unknown(f)];
  });
  limit_change();
}

template <int Dim>
double ImplicitMixed<Dim>::largest_flux() const {
  return largest_of(grid_.mesh.element_count(), settings_.threads, 0.0, [&](int e) {
    double largest = 0.0;
    for (int k = 0; k <= Dim; ++k) {
      largest = std::max(largest, std::abs(work_.flux[e].dot(grid_.outward_normal(e, k))));
    }
    return largest;
  });
}

template <int Dim>
void ImplicitMixed<Dim>::limit_change() {
  if (!has_retention()) return;
  FacePressure& pressure = work_.pressure;
  for_each_index(grid_.face_count(), settings_.threads, [&](int f) {
    const bool stays_wet =
        pressure.reference[f] >= 0.0 && pressure.reference[f] + pressure.rise[f] >= 0.0;
    if (is_held(f) || stays_wet) return;
    for (const int e : {grid_.face_left[f], grid_.face_right[f]}) {
      if (e < 0) continue;
      for (const double steepest : soils_.steepest(e)) {
        const double way = steepest - pressure.reference[f];
        const bool passes = steepest < 0.0 && way != 0.0 &&
                            (way > 0.0) == (pressure.rise[f] > 0.0) &&
                            std::abs(pressure.rise[f]) > std::abs(way);
        if (passes) pressure.rise[f] = way;
      }
    }
    const double suction = std::abs(pressure.reference[f]) + 1.0 / soils_.head_per_pressure;
    pressure.rise[f] = std::max(pressure.rise[f], -max_suction_growth * suction);
  });
}

template <int Dim>
double ImplicitMixed<Dim>::pressure_accuracy() const {
  const FacePressure& pressure = work_.pressure;
  return 1e-9 * largest_of(grid_.face_count(), settings_.threads, 0.0, [&](int f) {
           return std::abs(pressure.reference[f]) + std::abs(pressure.rise[f]);
         });
}

template <int Dim>
void ImplicitMixed<Dim>::settle_air(const MixedState<Dim>& base, double duration,
                                    const FlowForcing<Dim>& forcing, Stage& stage) const {
  stage.state.air = air_at(stage.state.face_pressure, forcing.coefficients.porosity);
  if (!std::isfinite(duration)) return;
  for_each_index(grid_.mesh.element_count(), settings_.threads, [&](int e) {
    // What the pressures say, and what left by the fluxes: equal but for round-off, or for what the
    // iteration missed in a piece without an outlet.
    double missing = -work_.net_source[e] * duration;
    if (!work_.mean_storage.empty()) {
      missing += duration * stored_in_mean(e, [&](int f) { return stage.rise[f]; });
    }
    for (int k = 0; k <= Dim; ++k) {
      const int f = grid_.element_face[e][k];
      missing += duration * (grid_.element_face_sign[e][k] * stage.face_flux[f] +
                             work_.storage[e] * stage.rise[f]);
      missing += base.air[e][k] - stage.state.air[e][k];
    }
    for (double& air : stage.state.air[e]) air += missing / (Dim + 1);
  });
}

template <int Dim>
double ImplicitMixed<Dim>::gravity_flux(int e, const FlowCoefficients<Dim>& c) const {
  return c.mixture_density[e] * gravity_.norm() * c.porosity[e] / c.drag[e] *
         soils_.best_over_along(e) * largest_at_faces(e, face_area_);
}

template ElementField<2> ImplicitMixed<2>::air_at(const std::vector<double>&,
                                                  const std::vector<double>&) const;
template void ImplicitMixed<2>::resolve_conditions(const FlowForcing<2>&);
template double ImplicitMixed<2>::displacement_rate(const MixedState<2>&, double,
                                                    const FlowForcing<2>&, int, int, double) const;
template void ImplicitMixed<2>::solve_nonlinear(const MixedState<2>&, double,
                                                const FlowForcing<2>&);
template void ImplicitMixed<2>::settle_air(const MixedState<2>&, double, const FlowForcing<2>&,
                                           Stage&) const;
template std::vector<double> ImplicitMixed<2>::relative_conductivity(
    const std::vector<double>&) const;
template double ImplicitMixed<2>::gravity_flux(int, const FlowCoefficients<2>&) const;
template ElementField<3> ImplicitMixed<3>::air_at(const std::vector<double>&,
                                                  const std::vector<double>&) const;
template void ImplicitMixed<3>::resolve_conditions(const FlowForcing<3>&);
template double ImplicitMixed<3>::displacement_rate(const MixedState<3>&, double,
                                                    const FlowForcing<3>&, int, int, double) const;
template void ImplicitMixed<3>::solve_nonlinear(const MixedState<3>&, double,
                                                const FlowForcing<3>&);
template void ImplicitMixed<3>::settle_air(const MixedState<3>&, double, const FlowForcing<3>&,
                                           Stage&) const;
template std::vector<double> ImplicitMixed<3>::relative_conductivity(
    const std::vector<double>&) const;
template double ImplicitMixed<3>::gravity_flux(int, const FlowCoefficients<3>&) const;

}  // namespace suffuse
