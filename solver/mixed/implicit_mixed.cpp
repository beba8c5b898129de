#include "mixed/implicit_mixed.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "common/errors.hpp"
#include "grid/parallel.hpp"
#include "physics/numbers.hpp"

namespace suffuse {
namespace {

/// Alexander's gamma: both stages last gamma dt, which makes their matrices alike.
constexpr double stage_share = 1.0 - 0.5 * std::numbers::sqrt2;

}  // namespace

template <int Dim>
ImplicitMixed<Dim>::ImplicitMixed(const Grid<Dim>& grid, ImplicitSettings settings,
                                  Vector<Dim> gravity, FlowSoils<Dim> soils,
                                  std::vector<LeakyFace> walls)
    : grid_(grid),
      settings_(settings),
      gravity_(std::move(gravity)),
      soils_(std::move(soils)),
      walls_(std::move(walls)),
      matrix_(grid, settings.threads) {
  for (const Vector<Dim>& normal : grid.face_normal) face_area_.push_back(normal.norm());
}

template <int Dim>
std::vector<double> ImplicitMixed<Dim>::stages() const {
  if (settings_.stepping == TimeStepping::monotone) return {1.0};
  return {stage_share, 1.0};
}

template <int Dim>
SolveCounts ImplicitMixed<Dim>::counts() const {
  SolveCounts result = earlier_counts_;
  if (solver_) result += solver_->counts();
  if (newton_) result += newton_->counts();
  return result;
}

template <int Dim>
void ImplicitMixed<Dim>::archive(StateArchive& archive,
                                 const std::vector<FaceCondition>& conditions) {
  set_up(conditions);
  archive(open_, corrected_);
  if (archive.restores() && !switching_.empty()) set_up_correction();
  solver_->archive(archive, matrix_.values());
  newton_->archive(archive, matrix_.values());
  correction_->archive(archive);
  archive(earlier_counts_, rise_rate_, flux_scale_, last_steady_, last_steady_flux_);
}

template <int Dim>
void ImplicitMixed<Dim>::set_up(const std::vector<FaceCondition>& conditions) {
  // Faces whose kind may change count as one kind, which has an unknown.
  const auto lasting = [](const FaceCondition& c) {
    return c.switches ? FaceKind::seepage : c.kind;
  };
  const auto same_kind = [&](FaceKind kind, const FaceCondition& c) { return kind == lasting(c); };
  if (std::equal(kinds_.begin(), kinds_.end(), conditions.begin(), conditions.end(), same_kind)) {
    return;
  }
  const int faces = grid_.face_count();
  kinds_.clear();
  switching_.clear();
  for (const FaceCondition& c : conditions) {
    if (c.switches) switching_.push_back(static_cast<int>(kinds_.size()));
    kinds_.push_back(lasting(c));
  }
  matrix_.lay_out(kinds_);
  earlier_counts_ = counts();
  solver_.emplace(settings_.threads, LagLimits{}, flow_factor(Dim, faces));
  newton_.emplace(newton_factor(Dim, faces));
  open_.assign(faces, 0);
  held_.assign(faces, 0);
  for (int f = 0; f < faces; ++f) {
    held_[f] = conditions[f].kind == FaceKind::pressure ? 1 : 0;
  }
  corrected_ = held_;
  set_up_correction();
  rise_rate_.assign(faces, 0.0);
  flux_scale_ = 0.0;
  last_steady_.face_pressure.assign(faces, 0.0);
  last_steady_.velocity.assign(grid_.mesh.element_count(), Vector<Dim>::Zero());
  last_steady_flux_ = last_steady_.velocity;
}

template <int Dim>
void ImplicitMixed<Dim>::set_up_correction() {
  std::vector<FaceCondition> held(corrected_.size());
  for (std::size_t f = 0; f < held.size(); ++f) {
    held[f].kind = corrected_[f] != 0 ? FaceKind::pressure : FaceKind::wall;
  }
  correction_.emplace(grid_, held, walls_);
}

template <int Dim>
double ImplicitMixed<Dim>::prescribed_inflow(const FlowForcing<Dim>& forcing, int face) const {
  const FaceCondition& prescribed = condition(face);
  if (prescribed.kind == FaceKind::wall) return 0.0;
  double inward = prescribed.value;
  if (prescribed.kind == FaceKind::velocity) {
    inward *= forcing.coefficients.porosity[grid_.face_left[face]];
  }
  return inward * face_area_[face];
}

template <int Dim>
Vector<Dim> ImplicitMixed<Dim>::pressure_gradient(int e, const std::vector<double>& reference,
                                                  const std::vector<double>& rise) const {
  // Differences first: the normals add up to zero, so the level plays no part.
  const auto& faces = grid_.element_face[e];
  Vector<Dim> sum = Vector<Dim>::Zero();
  for (int k = 1; k <= Dim; ++k) {
    const double difference =
        (reference[faces[k]] - reference[faces[0]]) + (rise[faces[k]] - rise[faces[0]]);
    sum += difference * grid_.outward_normal(e, k);
  }
  return sum / grid_.volume[e];
}

template <int Dim>
void ImplicitMixed<Dim>::FacePressure::move_reference(const std::vector<double>& base) {
  for (std::size_t f = 0; f < rise.size(); ++f) {
    const double old = reference[f];
    reference[f] += rise[f];
    rise[f] -= reference[f] - old;
    offset[f] = reference[f] - base[f];
  }
}

template <int Dim>
double ImplicitMixed<Dim>::conductance_of(int e) const {
  return work_.law.mobility[e] * soils_.best_over_along(e) * matrix_.largest_product(e);
}

template <int Dim>
void ImplicitMixed<Dim>::find_load(const FlowForcing<Dim>& forcing) {
  Work& w = work_;
  const int elements = grid_.mesh.element_count();
  w.known_rise.resize(grid_.face_count());
  w.face_push.resize(elements);
  w.round_off.resize(elements);
  w.load.resize(matrix_.unknowns());
  w.guess.resize(matrix_.unknowns());
  w.tolerance.resize(matrix_.unknowns());
  for_each_index(grid_.face_count(), settings_.threads,
                 [&](int f) { w.known_rise[f] = is_held(f) ? w.pressure.rise[f] : 0.0; });
  for_each_index(elements, settings_.threads, [&](int e) {
    const Vector<Dim> gradient = pressure_gradient(e, w.pressure.reference, w.known_rise);
    w.face_push[e] = w.law.mobility[e] * w.law.directed(e, w.law.drive[e] - gradient);
    w.round_off[e] = 2.0 * epsilon * w.law.mobility[e] * soils_.best_over_along(e) *
                     (w.law.drive[e].norm() + gradient.norm());
  });
  const auto known_in_mean = [&](int e) {
    return stored_in_mean(e, [&](int f) { return w.pressure.offset[f] + w.known_rise[f]; });
  };
  for_each_index(grid_.face_count(), settings_.threads, [&](int f) {
    const int row = matrix_.unknown(f);
    if (row < 0) return;
    w.guess[row] = w.pressure.rise[f];
    w.load[row] = grid_.is_outer(f) ? prescribed_inflow(forcing, f) : 0.0;
    // Residuals need be no smaller than the round-off of the load, nor than this share of the flux.
    w.tolerance[row] = 1e-13 * flux_scale_;
    for (const int e : {grid_.face_left[f], grid_.face_right[f]}) {
      if (e < 0) continue;
      const int k = grid_.side_of(e, f);
      w.load[row] += w.face_push[e].dot(grid_.outward_normal(e, k)) + w.net_source[e] / (Dim + 1) -
                     w.storage[e] * w.pressure.offset[f] - known_in_mean(e) / (Dim + 1);
      if (!w.displaced.empty()) w.load[row] -= w.displaced[e][k];
      w.tolerance[row] += w.round_off[e] * face_area_[f];
    }
  });
  add_walls_to_load();
}

template <int Dim>
void ImplicitMixed<Dim>::solve_pressure(const FlowForcing<Dim>& forcing) {
  matrix_.assemble(work_.law, work_.storage, {}, work_.mean_storage);
  for (const LeakyFace& wall : work_.walls) matrix_.couple(wall);
  find_load(forcing);

  for (const int e : correction_->sealed_root()) {
    if (!stores(e)) matrix_.hold_level(e);
  }

  const Eigen::VectorXd solution =
      solver_->solve({matrix_.values(), work_.load, work_.guess, work_.tolerance});
  for_each_index(grid_.face_count(), settings_.threads, [&](int f) {
    if (!is_held(f)) work_.pressure.rise[f] = solution[matrix_.unknown(f)];
  });
}

template <int Dim>
void ImplicitMixed<Dim>::find_resistance(const MixedState<Dim>& base, double duration,
                                         const FlowForcing<Dim>& forcing) {
  Work& w = work_;
  const int elements = grid_.mesh.element_count();
  const FlowCoefficients<Dim>& c = forcing.coefficients;
  w.resistance.resize(elements);
  w.drive.resize(elements);
  w.storage.resize(elements);
  for_each_index(elements, settings_.threads, [&](int e) {
    const double inertia = settings_.inertia ? c.mixture_density[e] / duration : 0.0;
    w.resistance[e] = (inertia + c.drag[e]) / c.porosity[e];
    w.drive[e] = c.mixture_density[e] * gravity_;
    if (inertia > 0.0) w.drive[e] += inertia * base.velocity[e];
    w.storage[e] = c.water_volume[e] / (settings_.bulk_modulus * (Dim + 1) * duration);
  });
  w.mean_storage = forcing.mean_storage;
  for (double& storage : w.mean_storage) storage /= duration;
  w.beside = forcing.mean_mobility;
  w.expected_gradient.resize(w.beside.size());
  for_each_index(static_cast<int>(w.beside.size()), settings_.threads, [&](int e) {
    w.expected_gradient[e] = pressure_gradient(e, base.face_pressure, forcing.expected_rise);
  });
  const auto wrong = std::find_if_not(w.resistance.begin(), w.resistance.end(),
                                      [](double r) { return r > 0.0 && std::isfinite(r); });
  if (wrong == w.resistance.end()) return find_wall_conductance();
  const auto e = static_cast<int>(wrong - w.resistance.begin());
  std::ostringstream text;
  text << "the liquid must meet resistance everywhere; " << element_text(grid_, e) << " has "
       << *wrong << " kg/(m3 s) per flux";
  throw NumericalError(text.str());
}

template <int Dim>
void ImplicitMixed<Dim>::set_mobility(int e, double of_darcy) {
  Work& w = work_;
  w.law.mobility[e] = of_darcy;
  if (w.beside.empty()) return;
  w.law.mobility[e] += w.beside[e];
  w.law.drive[e] =
      (of_darcy * w.drive[e] + w.beside[e] * w.expected_gradient[e]) / w.law.mobility[e];
}

template <int Dim>
void ImplicitMixed<Dim>::guess_pressure(const MixedState<Dim>& base, double duration) {
  FacePressure& pressure = work_.pressure;
  const int faces = grid_.face_count();
  pressure.reference = base.face_pressure;
  pressure.offset.assign(faces, 0.0);
  pressure.rise.resize(faces);
  for_each_index(faces, settings_.threads, [&](int f) {
    if (is_held(f)) {
      pressure.rise[f] = condition(f).value - base.face_pressure[f];
    } else {
      pressure.rise[f] =
          std::isfinite(duration) && !has_retention() ? rise_rate_[f] * duration : 0.0;
    }
  });
}

template <int Dim>
void ImplicitMixed<Dim>::find_flux(Field& flux, Field& push) const {
  const MomentumLaw<Dim>& law = work_.law;
  const int elements = grid_.mesh.element_count();
  flux.resize(elements);
  push.resize(elements);
  for_each_index(elements, settings_.threads, [&](int e) {
    const Vector<Dim> gradient =
        pressure_gradient(e, work_.pressure.reference, work_.pressure.rise);
    push[e] = work_.drive[e] - gradient;
    flux[e] = law.mobility[e] * law.directed(e, law.drive[e] - gradient);
  });
}

template <int Dim>
void ImplicitMixed<Dim>::solve_linear(const MixedState<Dim>& base,
                                      const FlowForcing<Dim>& forcing) {
  Work& w = work_;
  const int elements = grid_.mesh.element_count();
  w.law.mobility.resize(elements);
  w.law.factor = soils_.bedding;
  w.law.drive = w.drive;
  for_each_index(elements, settings_.threads,
                 [&](int e) { set_mobility(e, 1.0 / w.resistance[e]); });
  solve_pressure(forcing);
  find_flux(w.flux, w.push);

  // Pressures that rise a lot leave the round-off of the rise times the largest conductance, which
  // may be more than what flows through a tight soil: a second solution is rid of it.
  const double through = largest_of(elements, settings_.threads, 0.0, [&](int e) {
    return w.flux[e].norm() * largest_at_faces(e, face_area_);
  });
  const double round_off = largest_of(elements, settings_.threads, 0.0, [&](int e) {
    return epsilon * conductance_of(e) * largest_at_faces(e, w.pressure.rise);
  });
  if (std::max(round_off, wall_round_off()) <= 1e-12 * through) return;
  w.pressure.move_reference(base.face_pressure);
  solve_pressure(forcing);
  find_flux(w.flux, w.push);
}

template <int Dim>
double ImplicitMixed<Dim>::stored(int e, int k, double rise) const {
  const double compressed =
      work_.storage[e] * rise + stored_in_mean(e, [&](int f) {
                                  return work_.pressure.offset[f] + work_.pressure.rise[f];
                                }) / (Dim + 1);
  return work_.displaced.empty() ? compressed : compressed + work_.displaced[e][k];
}

template <int Dim>
double ImplicitMixed<Dim>::flux_out(int e, int k, double rise) const {
  return work_.flux[e].dot(grid_.outward_normal(e, k)) - stored(e, k, rise) +
         work_.net_source[e] / (Dim + 1);
}

template <int Dim>
void ImplicitMixed<Dim>::find_face_flux(const MixedState<Dim>& base, double duration,
                                        const FlowForcing<Dim>& forcing, Stage& stage) {
  Work& w = work_;
  const int elements = grid_.mesh.element_count();
  const int faces = grid_.face_count();
  const bool displaces = !w.displaced.empty();
  w.conductance.resize(elements);
  w.net_outflow.resize(elements);
  for_each_index(elements, settings_.threads, [&](int e) {
    const double trace = w.law.factor.empty() ? Dim : w.law.factor[e].trace();
    w.conductance[e] = w.law.mobility[e] * trace / grid_.volume[e];
    w.net_outflow[e] = w.net_source[e] - stored_in_mean(e, [&](int f) { return stage.rise[f]; });
    for (int k = 0; k <= Dim; ++k) {
      const int f = grid_.element_face[e][k];
      w.net_outflow[e] -= w.storage[e] * stage.rise[f];
      if (!displaces) continue;
      const double pressure = stage.state.face_pressure[f];
      w.displaced[e][k] = displacement_rate(base, duration, forcing, e, k, pressure);
      w.net_outflow[e] -= w.displaced[e][k];
    }
  });
  const auto out_of = [&](int e, int f) { return flux_out(e, grid_.side_of(e, f), stage.rise[f]); };

  // From the side that conducts less, where pressures give fluxes with more digits.
  stage.face_flux.resize(faces);
  stage.flux_through.resize(faces);
  for_each_index(faces, settings_.threads, [&](int f) {
    if (condition(f).fixes_flux()) {
      stage.face_flux[f] = -prescribed_inflow(forcing, f);
      return;
    }
    const int left = grid_.face_left[f];
    const int right = grid_.face_right[f];
    const int e = right < 0 || w.conductance[left] <= w.conductance[right] ? left : right;
    stage.face_flux[f] = e == left ? out_of(e, f) : -out_of(e, f);
  });
  for (const LeakyFace& wall : w.walls) {
    const double flux = wall_flux(wall, out_of(grid_.face_left[wall.face], wall.face),
                                  out_of(grid_.face_left[wall.partner], wall.partner));
    stage.face_flux[wall.face] = flux;
    stage.face_flux[wall.partner] = -flux;
  }
  correction_->follow(w.conductance);
  correction_->correct(stage.face_flux, w.net_outflow);
  for_each_index(faces, settings_.threads, [&](int f) {
    stage.flux_through[f] = stage.face_flux[f];
    if (!is_held(f)) return;
    const int e = grid_.face_left[f];
    stage.flux_through[f] += stored(e, grid_.side_of(e, f), stage.rise[f]);
  });
}

template <int Dim>
typename ImplicitMixed<Dim>::Stage ImplicitMixed<Dim>::solve_stage(const MixedState<Dim>& base,
                                                                   double duration,
                                                                   const FlowForcing<Dim>& forcing,
                                                                   const Field& flux_guess) {
  const int elements = grid_.mesh.element_count();
  const int faces = grid_.face_count();
  const bool quadratic = !forcing.coefficients.quadratic_drag.empty();
  for (ElementField<Dim>* field : {&work_.displaced, &work_.side_storage, &work_.gain}) {
    field->resize(has_retention() ? elements : 0);
  }
  find_resistance(base, duration, forcing);
  resolve_conditions(forcing);
  balance_sealed_pieces(forcing);
  guess_pressure(base, duration);
  iterations_ = 1;
  if (is_nonlinear()) {
    solve_nonlinear(base, duration, forcing);
  } else if (quadratic) {
    solve_quadratic(base, forcing, flux_guess);
  } else {
    solve_linear(base, forcing);
  }

  Stage stage;
  stage.rise.resize(faces);
  for_each_index(faces, settings_.threads,
                 [&](int f) { stage.rise[f] = work_.pressure.offset[f] + work_.pressure.rise[f]; });
  if (!is_nonlinear()) level_sealed_pieces(base, stage.rise);
  stage.state.face_pressure.resize(faces);
  for_each_index(faces, settings_.threads, [&](int f) {
    if (std::isfinite(duration)) rise_rate_[f] = stage.rise[f] / duration;
    stage.state.face_pressure[f] =
        is_held(f) ? condition(f).value : base.face_pressure[f] + stage.rise[f];
  });
  find_face_flux(base, duration, forcing, stage);
  if (!work_.displaced.empty()) settle_air(base, duration, forcing, stage);

  flux_scale_ = largest_of(faces, settings_.threads, 0.0,
                           [&](int f) { return std::abs(stage.face_flux[f]); });
  stage.state.velocity.resize(elements);
  for_each_index(elements, settings_.threads, [&](int e) {
    stage.state.velocity[e] = work_.flux[e] / forcing.coefficients.porosity[e];
  });
  return stage;
}

template <int Dim>
MixedStep<Dim> ImplicitMixed<Dim>::step(const MixedState<Dim>& start, double dt,
                                        const std::vector<const FlowForcing<Dim>*>& forcing) {
  set_up(forcing.front()->conditions);
  if (settings_.stepping == TimeStepping::monotone) return one_stage(start, dt, *forcing.back());
  if (!has_retention()) return two_stages(start, dt, *forcing.front(), *forcing.back());
  // The second stage starts from contents ahead of the first, which may be more than full or less
  // than dry.
  try {
    return two_stages(start, dt, *forcing.front(), *forcing.back());
  } catch (const NotConverged&) {
    return one_stage(start, dt, *forcing.back());
  }
}

template <int Dim>
typename ImplicitMixed<Dim>::Field ImplicitMixed<Dim>::flux_of(
    const Field& velocity, const FlowCoefficients<Dim>& coefficients) const {
  Field flux(velocity.size());
  for (std::size_t e = 0; e < flux.size(); ++e) flux[e] = coefficients.porosity[e] * velocity[e];
  return flux;
}

template <int Dim>
MixedStep<Dim> ImplicitMixed<Dim>::one_stage(const MixedState<Dim>& start, double dt,
                                             const FlowForcing<Dim>& forcing) {
  Stage stage = solve_stage(start, dt, forcing, flux_of(start.velocity, forcing.coefficients));
  std::vector<double> volume = stage.face_flux;
  for (double& v : volume) v *= dt;
  return {std::move(stage.state), std::move(volume), std::move(stage.face_flux),
          std::move(stage.flux_through)};
}

template <int Dim>
MixedStep<Dim> ImplicitMixed<Dim>::two_stages(const MixedState<Dim>& start, double dt,
                                              const FlowForcing<Dim>& early,
                                              const FlowForcing<Dim>& late) {
  const double duration = stage_share * dt;
  const Stage first =
      solve_stage(start, duration, early, flux_of(start.velocity, early.coefficients));
  constexpr double ahead = (1.0 - stage_share) / stage_share;
  MixedState<Dim> base = start;
  for (int f = 0; f < grid_.face_count(); ++f) base.face_pressure[f] += ahead * first.rise[f];
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    base.velocity[e] += ahead * (first.state.velocity[e] - start.velocity[e]);
    if (start.air.empty()) continue;
    for (int k = 0; k <= Dim; ++k) {
      base.air[e][k] += ahead * (first.state.air[e][k] - start.air[e][k]);
    }
  }
  Stage second =
      solve_stage(base, duration, late, flux_of(first.state.velocity, late.coefficients));
  std::vector<double> volume(grid_.face_count());
  for (int f = 0; f < grid_.face_count(); ++f) {
    volume[f] = dt * ((1.0 - stage_share) * first.face_flux[f] + stage_share * second.face_flux[f]);
  }
  return {std::move(second.state), std::move(volume), std::move(second.face_flux),
          std::move(second.flux_through)};
}

template <int Dim>
MixedStep<Dim> ImplicitMixed<Dim>::steady(const FlowForcing<Dim>& forcing) {
  set_up(forcing.conditions);
  constexpr double forever = std::numeric_limits<double>::infinity();
  Stage stage = is_nonlinear() ? nonlinear_steady(forcing)
                               : solve_stage(last_steady_, forever, forcing, last_steady_flux_);
  last_steady_ = stage.state;
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    last_steady_flux_[e] = forcing.coefficients.porosity[e] * stage.state.velocity[e];
  }
  return {std::move(stage.state), {}, std::move(stage.face_flux), std::move(stage.flux_through)};
}

template class ImplicitMixed<2>;
template class ImplicitMixed<3>;

}  // namespace suffuse
