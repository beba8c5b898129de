/// The iteration of the mixed elements over what depends on the pressure itself: how much liquid
/// soil under suction holds, how well it conducts, and which seepage faces let water out.
///
/// Modified Picard iteration (Celia, Bouloutas and Zarba, Water Resour. Res. 26 (1990) 1483):
/// contents are linearised about the last pressures, conductivities are those of the last
/// pressures. Every system is symmetric and positive definite.

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "case/errors.hpp"
#include "flow/implicit_mixed.hpp"
#include "grid/parallel.hpp"

namespace suffuse {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr int max_iterations = 60;
/// What the linear system misses may be this share of the largest flux.
constexpr double flux_accuracy = 1e-6;
/// From this iteration on, it may be this share: where a conductivity has next to no slope on one
/// side of p = 0 and next to no end of it on the other, iterations lead to and fro.
constexpr int patience = 20;
constexpr double patient_accuracy = 1e-4;
/// From here on faces switch, and iterations are mixed.
constexpr double near_solution = 0.1;
/// Of a change of pressures that is taken at least.
constexpr double min_share = 0.25;
/// In an iteration, suction grows by this factor of itself and a metre at most.
constexpr double max_suction_growth = 10.0;

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
  FaceCondition& resolved = work_.conditions[face];
  resolved = condition;
  if (condition.kind != FaceKind::seepage) return;
  const bool open = open_[face] != 0;
  resolved.kind = open ? FaceKind::pressure : FaceKind::flux;
  resolved.value = open ? 0.0 : condition.value;
}

template <int Dim>
void ImplicitMixed<Dim>::resolve_conditions(const FlowForcing<Dim>& forcing) {
  work_.conditions = forcing.conditions;
  for (const int f : switching_) resolve(forcing.conditions[f], f);
}

template <int Dim>
double ImplicitMixed<Dim>::relative_conductivity(int e, const std::vector<double>& reference,
                                                 const std::vector<double>& rise) const {
  double sum = 0.0;
  for (const int f : grid_.element_face[e]) {
    sum += soils_.relative_conductivity(e, reference[f] + rise[f]);
  }
  return sum / (Dim + 1);
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
void ImplicitMixed<Dim>::linearise_retention(const MixedState<Dim>& base, double duration,
                                             const FlowForcing<Dim>& forcing) {
  Work& w = work_;
  const std::vector<double>& pressure = w.pressure.reference;
  if (iterations_ == 1) w.displaced_at.assign(pressure.size(), 0.0);
  for_each_index(grid_.mesh.element_count(), settings_.threads, [&](int e) {
    double conducts = 0.0;
    const double share = forcing.coefficients.porosity[e] * grid_.volume[e] / (Dim + 1);
    for (int k = 0; k <= Dim; ++k) {
      const double p = pressure[grid_.element_face[e][k]];
      conducts += soils_.relative_conductivity(e, p) / (Dim + 1);
      const double before = w.displaced_at[grid_.element_face[e][k]];
      const double last = w.displaced[e][k];
      w.displaced[e][k] = displacement_rate(base, duration, forcing, e, k, p);
      double slope = std::isfinite(duration) ? share * soils_.capacity(e, p) / duration : 0.0;
      // Between two pressures of which one is saturated the tangents lead to and fro.
      if (iterations_ > 1 && p != before) {
        slope = std::max(slope, (w.displaced[e][k] - last) / (p - before));
      }
      w.side_storage[e][k] = slope;
    }
    w.law.mobility[e] = conducts / w.resistance[e];
    find_wetting_slope(e);
  });
  w.displaced_at = pressure;
}

template <int Dim>
void ImplicitMixed<Dim>::find_wetting_slope(int e) {
  Work& w = work_;
  Vector<Dim> push = w.drive[e] - pressure_gradient(e, w.pressure.reference, w.pressure.rise);
  if (!w.law.direction.empty()) push -= w.law.direction[e] * w.law.direction[e].dot(push);
  for (int k = 0; k <= Dim; ++k) {
    const double inflow = -push.dot(grid_.outward_normal(e, k)) / w.resistance[e];
    const double p = w.pressure.reference[grid_.element_face[e][k]];
    w.wetting_slope[e][k] = 0.0;
    if (!(inflow > 0.0) || p > 0.0) continue;
    const double near = 1.0 - 0.01 * p;  // Pa
    const double slope =
        (soils_.relative_conductivity(e, p + near) - soils_.relative_conductivity(e, p - near)) /
        (2.0 * near);
    w.wetting_slope[e][k] = inflow * slope / (Dim + 1);
    w.side_storage[e][k] += w.wetting_slope[e][k];
  }
}

template <int Dim>
double ImplicitMixed<Dim>::flux_out(int e, int k) const {
  const Work& w = work_;
  const int f = grid_.element_face[e][k];
  const double rise = w.pressure.offset[f] + w.pressure.rise[f];
  double stored = w.storage[e] * rise;
  if (!w.displaced.empty()) stored += w.displaced[e][k] + w.side_storage[e][k] * w.pressure.rise[f];
  return w.flux[e].dot(grid_.outward_normal(e, k)) - stored + w.net_source[e] / (Dim + 1);
}

template <int Dim>
double ImplicitMixed<Dim>::linearisation_error(const MixedState<Dim>& base, double duration,
                                               const FlowForcing<Dim>& forcing) const {
  const Work& w = work_;
  return largest_of(grid_.mesh.element_count(), settings_.threads, 0.0, [&](int e) {
    const double conducts = w.law.mobility[e] * w.resistance[e];
    const double change =
        std::abs(relative_conductivity(e, w.pressure.reference, w.pressure.rise) / conducts - 1.0);
    double error = 0.0;
    for (int k = 0; k <= Dim; ++k) {
      const int f = grid_.element_face[e][k];
      const double pressure = w.pressure.reference[f] + w.pressure.rise[f];
      const double linear = w.displaced[e][k] + w.side_storage[e][k] * w.pressure.rise[f];
      const double content = displacement_rate(base, duration, forcing, e, k, pressure) - linear;
      const double conduction = change * std::abs(w.flux[e].dot(grid_.outward_normal(e, k)));
      error = std::max({error, std::abs(content), conduction});
    }
    return error;
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
    const bool takes_in_more =
        open_[f] != 0 &&
        -flux_out(e, grid_.side_of(e, f)) > condition.value * face_area_[f] + flux_tolerance;
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
    if (work_.storage[e] > 0.0) return true;
    if (work_.side_storage.empty()) continue;
    if (std::ranges::any_of(work_.side_storage[e], [](double s) { return s > 0.0; })) return true;
  }
  return false;
}

template <int Dim>
void ImplicitMixed<Dim>::hold_levels(const FlowForcing<Dim>& forcing) {
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
  }
}

template <int Dim>
void ImplicitMixed<Dim>::solve_nonlinear(const MixedState<Dim>& base, double duration,
                                         const FlowForcing<Dim>& forcing) {
  Work& w = work_;
  const int elements = grid_.mesh.element_count();
  w.law.mobility.resize(elements);
  w.law.direction = soils_.bedding;
  w.law.drive = w.drive;
  w.displaced.resize(has_retention() ? elements : 0);
  w.side_storage.resize(w.displaced.size());
  w.wetting_slope.resize(w.displaced.size());
  for (int e = 0; e < elements; ++e) w.law.mobility[e] = 1.0 / w.resistance[e];
  // Round-off of what gravity drives and of the contents of the elements.
  const double round_off = epsilon * largest_of(elements, settings_.threads, 0.0, [&](int e) {
                             const double pores =
                                 forcing.coefficients.porosity[e] * grid_.volume[e];
                             return gravity_flux(e, forcing.coefficients) + pores / duration;
                           });
  double share = 1.0;
  double last_error = std::numeric_limits<double>::infinity();
  mixing_.reset();
  for (iterations_ = 1;; ++iterations_) {
    w.pressure.move_reference(base.face_pressure);
    if (has_retention()) linearise_retention(base, duration, forcing);
    w.level_elements.clear();
    follow_held_faces();
    hold_levels(forcing);
    follow_held_faces();
    for (const int f : switching_) {
      if (is_held(f)) w.pressure.rise[f] = w.conditions[f].value - w.pressure.reference[f];
    }
    try {
      solve_pressure(forcing);
    } catch (const NumericalError& error) {
      throw NotConverged(error.what());
    }
    find_flux(w.flux, w.push);

    const double scale = largest_of(elements, settings_.threads, 0.0, [&](int e) {
      double largest = 0.0;
      for (int k = 0; k <= Dim; ++k) {
        largest = std::max(largest, std::abs(w.flux[e].dot(grid_.outward_normal(e, k))));
      }
      return largest;
    });
    const double accuracy = iterations_ < patience ? flux_accuracy : patient_accuracy;
    const double allowed = accuracy * scale + 16.0 * round_off;
    const double error = has_retention() ? linearisation_error(base, duration, forcing) : 0.0;
    const bool switched =
        error <= near_solution * scale && switch_faces(forcing, allowed, pressure_accuracy());
    if (!switched && error <= allowed) return;
    // Far from the solution, mixtures lead astray, and whole changes may lead to and fro.
    const bool near = error <= near_solution * scale;
    const double growth = error / last_error;
    if (growth < 1.0 - 0.5 * share) share = std::min(1.5 * share, 1.0);
    if (growth > 1.0 - 0.1 * share) share = std::max(0.5 * share, min_share);
    if (near && !switched) {
      mix(error > last_error, share);
    } else {
      mixing_.reset();
      damp_change(share);
      limit_change();
    }
    last_error = error;
    if (!std::isfinite(error) || iterations_ == max_iterations) {
      std::ostringstream text;
      text << "the iteration of the flow did not converge in " << iterations_
           << " solutions: it misses " << error << " m3/s through a face, of " << scale << " m3/s"
           << (switched ? "; seepage faces keep opening and closing" : "");
      throw NotConverged(text.str());
    }
  }
}

template <int Dim>
void ImplicitMixed<Dim>::mix(bool anew, double share) {
  Work& w = work_;
  if (anew) mixing_.reset();
  if (!has_retention()) return;
  const int unknowns = matrix_.unknowns();
  Eigen::VectorXd pressure(unknowns);
  Eigen::VectorXd change(unknowns);
  Eigen::VectorXd weight(unknowns);
  for_each_index(grid_.face_count(), settings_.threads, [&](int f) {
    const int row = matrix_.unknown(f);
    if (row < 0) return;
    pressure[row] = w.pressure.reference[f] + w.pressure.rise[f];
    change[row] = w.pressure.rise[f];
    weight[row] = matrix_.values().coeff(row, row);
  });
  const Eigen::VectorXd next = mixing_.next(pressure, change, weight, share);
  for_each_index(grid_.face_count(), settings_.threads, [&](int f) {
    const int row = matrix_.unknown(f);
    if (row >= 0 && !is_held(f)) w.pressure.rise[f] = next[row] - w.pressure.reference[f];
  });
}

template <int Dim>
void ImplicitMixed<Dim>::damp_change(double share) {
  if (share == 1.0 || !has_retention()) return;
  for (std::size_t f = 0; f < kinds_.size(); ++f) {
    if (!is_held(static_cast<int>(f))) work_.pressure.rise[f] *= share;
  }
}

template <int Dim>
void ImplicitMixed<Dim>::limit_change() {
  if (!has_retention()) return;
  FacePressure& pressure = work_.pressure;
  for_each_index(grid_.face_count(), settings_.threads, [&](int f) {
    if (is_held(f)) return;
    for (const int e : {grid_.face_left[f], grid_.face_right[f]}) {
      if (e < 0) continue;
      const double steepest = soils_.steepest(e);
      const double way = steepest - pressure.reference[f];
      const bool passes = steepest < 0.0 && way != 0.0 && (way > 0.0) == (pressure.rise[f] > 0.0) &&
                          std::abs(pressure.rise[f]) > std::abs(way);
      if (passes) pressure.rise[f] = way;
    }
    const double suction = std::abs(pressure.reference[f]) + 1.0 / soils_.head_per_pressure;
    pressure.rise[f] = std::max(pressure.rise[f], -max_suction_growth * suction);
  });
}

template <int Dim>
double ImplicitMixed<Dim>::pressure_accuracy() const {
  // Of the pressures that gravity makes in the smallest element, or of those there are.
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
  return c.mixture_density[e] * gravity_.norm() * c.porosity[e] / c.drag[e] * largest_area(e);
}

template <int Dim>
typename ImplicitMixed<Dim>::Stage ImplicitMixed<Dim>::nonlinear_steady(
    const FlowForcing<Dim>& forcing) {
  constexpr double forever = std::numeric_limits<double>::infinity();
  constexpr double growth = 4.0;
  constexpr int max_steps = 200;
  if (!has_retention()) return solve_stage(last_steady_, forever, forcing, last_steady_flux_);

  MixedState<Dim> state = last_steady_;
  if (state.air.empty()) {
    ignore_retention_ = true;
    state = solve_stage(last_steady_, forever, forcing, last_steady_flux_).state;
    ignore_retention_ = false;
    state.air = air_at(state.face_pressure, forcing.coefficients.porosity);
  }
  // Steps of growing length, as from a saturated model that drains.
  double pores = 0.0;
  double fastest = flux_scale_;
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    pores += grid_.volume[e] * forcing.coefficients.porosity[e];
    fastest = std::max(fastest, gravity_flux(e, forcing.coefficients));
  }
  if (fastest == 0.0) return solve_stage(state, forever, forcing, last_steady_flux_);
  const double filling = pores / fastest;
  double duration = filling;
  for (int step = 0; step < max_steps; ++step) {
    try {
      if (duration > 1e4 * filling) {
        return solve_stage(state, forever, forcing, last_steady_flux_);
      }
    } catch (const NotConverged&) {
      // A longer step brings the state nearer.
    }
    try {
      state = solve_stage(state, duration, forcing, last_steady_flux_).state;
      duration *= growth;
    } catch (const NotConverged&) {
      duration /= growth * growth;
    }
  }
  throw NotConverged("no steady flow was found under these boundary conditions");
}

template <int Dim>
MixedStep<Dim> ImplicitMixed<Dim>::saturated_steady(const FlowForcing<Dim>& forcing) {
  if (soils_.saturated()) return steady(forcing);
  set_up(forcing.conditions);
  const std::vector<char> open = open_;
  ignore_retention_ = true;
  Stage stage = solve_stage(last_steady_, std::numeric_limits<double>::infinity(), forcing,
                            last_steady_flux_);
  ignore_retention_ = false;
  open_ = open;
  return {std::move(stage.state), {}, std::move(stage.face_flux), std::move(stage.flux_through)};
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
template ImplicitMixed<2>::Stage ImplicitMixed<2>::nonlinear_steady(const FlowForcing<2>&);
template MixedStep<2> ImplicitMixed<2>::saturated_steady(const FlowForcing<2>&);
template ElementField<3> ImplicitMixed<3>::air_at(const std::vector<double>&,
                                                  const std::vector<double>&) const;
template void ImplicitMixed<3>::resolve_conditions(const FlowForcing<3>&);
template double ImplicitMixed<3>::displacement_rate(const MixedState<3>&, double,
                                                    const FlowForcing<3>&, int, int, double) const;
template void ImplicitMixed<3>::solve_nonlinear(const MixedState<3>&, double,
                                                const FlowForcing<3>&);
template void ImplicitMixed<3>::settle_air(const MixedState<3>&, double, const FlowForcing<3>&,
                                           Stage&) const;
template ImplicitMixed<3>::Stage ImplicitMixed<3>::nonlinear_steady(const FlowForcing<3>&);
template MixedStep<3> ImplicitMixed<3>::saturated_steady(const FlowForcing<3>&);

}  // namespace suffuse
