#include "flow/implicit_mixed.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "case/errors.hpp"

namespace suffuse {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
/// Alexander's gamma: both stages last gamma dt, which makes their matrices alike.
constexpr double stage_share = 1.0 - 0.5 * std::numbers::sqrt2;

template <int Dim>
double norm_with_weights(const std::vector<Vector<Dim>>& field, const std::vector<double>& weight) {
  double sum = 0.0;
  for (std::size_t e = 0; e < field.size(); ++e) sum += weight[e] * field[e].squaredNorm();
  return std::sqrt(sum);
}

}  // namespace

template <int Dim>
ImplicitMixed<Dim>::ImplicitMixed(const Grid<Dim>& grid, ImplicitSettings settings,
                                  Vector<Dim> gravity)
    : grid_(grid), settings_(settings), gravity_(std::move(gravity)) {
  const int elements = grid.mesh.element_count();
  normal_products_.resize(elements);
  for (int e = 0; e < elements; ++e) {
    // Rows add up to zero, as pressure alone moves nothing: better so than by round-off.
    auto& products = normal_products_[e];
    for (int a = 0; a <= Dim; ++a) {
      products[a][a] = 0.0;
      for (int b = 0; b < a; ++b) {
        products[a][b] = products[b][a] =
            outward_normal(e, a).dot(outward_normal(e, b)) / grid.volume[e];
      }
    }
    for (int a = 0; a <= Dim; ++a) {
      double others = 0.0;
      for (int b = 0; b <= Dim; ++b) {
        if (b != a) others += products[a][b];
      }
      products[a][a] = -others;
    }
  }
}

template <int Dim>
std::vector<double> ImplicitMixed<Dim>::stages() const {
  if (settings_.stepping == TimeStepping::monotone) return {1.0};
  return {stage_share, 1.0};
}

template <int Dim>
SolveCounts ImplicitMixed<Dim>::counts() const {
  SolveCounts result = earlier_counts_;
  if (factor_) {
    result.factorisations += factor_->counts().factorisations;
    result.solves += factor_->counts().solves;
    result.iterations += factor_->counts().iterations;
  }
  return result;
}

template <int Dim>
void ImplicitMixed<Dim>::set_up(const std::vector<FaceCondition>& conditions) {
  const auto same_kind = [](FaceKind kind, const FaceCondition& c) { return kind == c.kind; };
  if (std::equal(kinds_.begin(), kinds_.end(), conditions.begin(), conditions.end(), same_kind)) {
    return;
  }
  const int faces = grid_.face_count();
  const int elements = grid_.mesh.element_count();
  kinds_.clear();
  for (const FaceCondition& c : conditions) kinds_.push_back(c.kind);
  unknown_.assign(faces, -1);
  unknowns_ = 0;
  for (int f = 0; f < faces; ++f) {
    if (kinds_[f] != FaceKind::pressure) unknown_[f] = unknowns_++;
  }

  std::vector<Eigen::Triplet<double>> entries;
  for (int e = 0; e < elements; ++e) {
    for (const int f : grid_.element_face[e]) {
      for (const int g : grid_.element_face[e]) {
        if (unknown_[f] >= 0 && unknown_[g] >= 0) {
          entries.emplace_back(unknown_[f], unknown_[g], 1.0);
        }
      }
    }
  }
  matrix_.resize(unknowns_, unknowns_);
  matrix_.setFromTriplets(entries.begin(), entries.end());
  matrix_.makeCompressed();

  const auto position = [&](int row, int column) {
    const int* inner = matrix_.innerIndexPtr();
    const int* begin = inner + matrix_.outerIndexPtr()[column];
    const int* end = inner + matrix_.outerIndexPtr()[column + 1];
    return static_cast<int>(std::lower_bound(begin, end, row) - inner);
  };
  position_.resize(elements);
  for (int e = 0; e < elements; ++e) {
    for (int a = 0; a <= Dim; ++a) {
      for (int b = 0; b <= Dim; ++b) {
        const int row = unknown_[grid_.element_face[e][a]];
        const int column = unknown_[grid_.element_face[e][b]];
        position_[e][a][b] = row >= 0 && column >= 0 ? position(row, column) : -1;
      }
    }
  }

  earlier_counts_ = counts();
  factor_.emplace(matrix_);
  correction_.emplace(grid_, conditions);
  rise_rate_.assign(faces, 0.0);
  flux_scale_ = 0.0;
  last_steady_.face_pressure.assign(faces, 0.0);
  last_steady_.velocity.assign(elements, Vector<Dim>::Zero());
  last_steady_flux_.assign(elements, Vector<Dim>::Zero());
}

template <int Dim>
double ImplicitMixed<Dim>::prescribed_inflow(const FlowForcing<Dim>& forcing, int face) const {
  const FaceCondition& condition = forcing.conditions[face];
  if (condition.kind == FaceKind::wall) return 0.0;
  double inward = condition.value;
  if (condition.kind == FaceKind::velocity) {
    inward *= forcing.coefficients.porosity[grid_.face_left[face]];
  }
  return inward * grid_.face_normal[face].norm();
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
    sum += difference * outward_normal(e, k);
  }
  return sum / grid_.volume[e];
}

template <int Dim>
void ImplicitMixed<Dim>::assemble(const MomentumLaw& law, const std::vector<double>& storage) {
  double* values = matrix_.valuePtr();
  std::fill(values, values + matrix_.nonZeros(), 0.0);
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    std::array<double, Dim + 1> along;
    const bool directed = !law.direction.empty();
    if (directed) {
      for (int a = 0; a <= Dim; ++a) along[a] = law.direction[e].dot(outward_normal(e, a));
    }
    for (int a = 0; a <= Dim; ++a) {
      for (int b = 0; b <= Dim; ++b) {
        if (position_[e][a][b] < 0) continue;
        double entry = normal_products_[e][a][b];
        if (directed) entry -= along[a] * along[b] / grid_.volume[e];
        entry *= law.mobility[e];
        if (a == b) entry += storage[e];
        values[position_[e][a][b]] += entry;
      }
    }
  }
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
double ImplicitMixed<Dim>::conductance_of(int e, double mobility) const {
  double largest = 0.0;
  for (int k = 0; k <= Dim; ++k) largest = std::max(largest, normal_products_[e][k][k]);
  return mobility * largest;
}

template <int Dim>
void ImplicitMixed<Dim>::solve_pressure(const MomentumLaw& law, const std::vector<double>& storage,
                                        const std::vector<double>& net_source,
                                        const FlowForcing<Dim>& forcing, FacePressure& pressure) {
  const int elements = grid_.mesh.element_count();
  const int faces = grid_.face_count();
  assemble(law, storage);

  Eigen::VectorXd load = Eigen::VectorXd::Zero(unknowns_);
  Eigen::VectorXd guess = Eigen::VectorXd::Zero(unknowns_);
  std::vector<double> known_rise(faces, 0.0);
  for (int f = 0; f < faces; ++f) {
    if (unknown_[f] < 0) {
      known_rise[f] = pressure.rise[f];
    } else {
      guess[unknown_[f]] = pressure.rise[f];
      if (kinds_[f] != FaceKind::interior) load[unknown_[f]] += prescribed_inflow(forcing, f);
    }
  }
  // Residuals need be no smaller than the round-off of the load, nor than this share of the flux.
  Eigen::VectorXd tolerance = Eigen::VectorXd::Constant(unknowns_, 1e-13 * flux_scale_);
  for (int e = 0; e < elements; ++e) {
    const Vector<Dim> gradient = pressure_gradient(e, pressure.reference, known_rise);
    Vector<Dim> push = law.drive[e] - gradient;
    if (!law.direction.empty()) push -= law.direction[e] * law.direction[e].dot(push);
    push *= law.mobility[e];
    const double round_off =
        2.0 * epsilon * law.mobility[e] * (law.drive[e].norm() + gradient.norm());
    for (int k = 0; k <= Dim; ++k) {
      const int f = grid_.element_face[e][k];
      const int row = unknown_[f];
      if (row < 0) continue;
      load[row] += push.dot(outward_normal(e, k)) + net_source[e] / (Dim + 1) -
                   storage[e] * pressure.offset[f];
      tolerance[row] += round_off * grid_.face_normal[f].norm();
    }
  }

  // Where nothing holds the level, a pressure that is free to choose is chosen: with its diagonal
  // doubled the rise there is zero, as the rest of the system adds up to zero.
  for (const int e : correction_->sealed_root()) {
    if (storage[e] > 0.0) continue;
    matrix_.valuePtr()[position_[e][0][0]] *= 2.0;
  }

  const Eigen::VectorXd solution = factor_->solve(matrix_, load, guess, tolerance);
  for (int f = 0; f < faces; ++f) {
    if (unknown_[f] >= 0) pressure.rise[f] = solution[unknown_[f]];
  }
}

template <int Dim>
typename ImplicitMixed<Dim>::Stage ImplicitMixed<Dim>::solve_stage(const MixedState<Dim>& base,
                                                                   double duration,
                                                                   const FlowForcing<Dim>& forcing,
                                                                   const Field& flux_guess) {
  const int elements = grid_.mesh.element_count();
  const int faces = grid_.face_count();
  const FlowCoefficients<Dim>& c = forcing.coefficients;
  const auto pieces = static_cast<std::size_t>(correction_->sealed_piece_count());

  // Linear resistance, drive and storage of each element.
  std::vector<double> resistance(elements);
  Field drive(elements);
  std::vector<double> storage(elements);
  for (int e = 0; e < elements; ++e) {
    const double inertia = settings_.inertia ? c.mixture_density[e] / duration : 0.0;
    resistance[e] = (inertia + c.drag[e]) / c.porosity[e];
    drive[e] = c.mixture_density[e] * gravity_;
    if (inertia > 0.0) drive[e] += inertia * base.velocity[e];
    storage[e] = c.water_volume[e] / (settings_.bulk_modulus * (Dim + 1) * duration);
    if (!(resistance[e] > 0.0) || !std::isfinite(resistance[e])) {
      std::ostringstream text;
      const Vector<Dim> at = element_centroid(grid_.mesh, e);
      text << "the liquid must meet resistance everywhere; element " << e << " at ("
           << at.transpose() << ") has " << resistance[e] << " kg/(m3 s) per flux";
      throw NumericalError(text.str());
    }
  }

  // What no pressure boundary can take up must cancel where no water is stored either.
  std::vector<double> net_source(elements, 0.0);
  if (!forcing.source.empty()) net_source = forcing.source;
  std::vector<double> surplus(pieces, 0.0);
  if (pieces > 0) {
    const std::vector<int>& piece = correction_->sealed_piece();
    std::vector<double> gross(pieces, 0.0);
    std::vector<double> volume(pieces, 0.0);
    for (int e = 0; e < elements; ++e) {
      if (piece[e] < 0) continue;
      surplus[piece[e]] += net_source[e];
      gross[piece[e]] += std::abs(net_source[e]);
      volume[piece[e]] += grid_.volume[e];
    }
    for (int f = 0; f < faces; ++f) {
      const int p = piece[grid_.face_left[f]];
      if (p < 0 || !grid_.is_outer(f)) continue;
      surplus[p] += prescribed_inflow(forcing, f);
      gross[p] += std::abs(prescribed_inflow(forcing, f));
    }
    for (std::size_t p = 0; p < pieces; ++p) {
      if (storage[correction_->sealed_root()[p]] > 0.0) continue;
      if (!(std::abs(surplus[p]) <= 1e-9 * gross[p])) {
        std::ostringstream text;
        text.precision(10);
        text << "no boundary prescribes a pressure and water is not stored, so prescribed inflow "
                "and sources must cancel; they add up to "
             << surplus[p] << " m3/s, of " << gross[p] << " m3/s in all";
        throw NumericalError(text.str());
      }
    }
    // The round-off that remains is spread over the piece.
    for (int e = 0; e < elements; ++e) {
      if (piece[e] >= 0 && storage[correction_->sealed_root()[piece[e]]] == 0.0) {
        net_source[e] -= surplus[piece[e]] * grid_.volume[e] / volume[piece[e]];
      }
    }
  }

  FacePressure pressure;
  pressure.reference = base.face_pressure;
  pressure.offset.assign(faces, 0.0);
  pressure.rise.resize(faces);
  for (int f = 0; f < faces; ++f) {
    if (kinds_[f] == FaceKind::pressure) {
      pressure.rise[f] = forcing.conditions[f].value - base.face_pressure[f];
    } else {
      pressure.rise[f] = std::isfinite(duration) ? rise_rate_[f] * duration : 0.0;
    }
  }

  // Newton's method on flux and pressure together: continuity is linear, so after the first
  // iteration only momentum is left to fulfil. Without quadratic drag there is one iteration, or a
  // second one to be rid of round-off: pressures that rise a lot leave that of the rise times the
  // largest conductance, which may be more than what flows through a tight soil.
  const bool quadratic = !c.quadratic_drag.empty();
  MomentumLaw law;
  law.mobility.resize(elements);
  law.drive = drive;
  if (quadratic) law.direction.resize(elements);
  Field flux = quadratic ? flux_guess : Field(elements, Vector<Dim>::Zero());
  Field push = drive;  // drive less pressure gradient
  double error = std::numeric_limits<double>::infinity();
  double last_change = std::numeric_limits<double>::infinity();
  for (int iteration = 0;; ++iteration) {
    for (int e = 0; e < elements; ++e) {
      law.mobility[e] = 1.0 / resistance[e];
      if (!quadratic) continue;
      const double speed = flux[e].norm();
      const double secant = c.quadratic_drag[e] * speed;
      law.mobility[e] = 1.0 / (resistance[e] + secant);
      law.drive[e] = drive[e] + secant * flux[e];
      law.direction[e] = Vector<Dim>::Zero();
      if (secant > 0.0) {
        law.direction[e] = std::sqrt(secant / (resistance[e] + 2.0 * secant)) / speed * flux[e];
      }
    }
    if (iteration > 0) pressure.move_reference(base.face_pressure);
    solve_pressure(law, storage, net_source, forcing, pressure);
    Field new_flux(elements);
    Field new_push(elements);
    for (int e = 0; e < elements; ++e) {
      const Vector<Dim> gradient = pressure_gradient(e, pressure.reference, pressure.rise);
      new_push[e] = drive[e] - gradient;
      Vector<Dim> linear = law.drive[e] - gradient;
      if (quadratic) linear -= law.direction[e] * law.direction[e].dot(linear);
      new_flux[e] = law.mobility[e] * linear;
    }
    double largest = 0.0;
    double change = 0.0;
    double most_through = 0.0;  // a face, m3/s
    double most_round_off = 0.0;
    bool converged = true;
    for (int e = 0; e < elements; ++e) largest = std::max(largest, new_flux[e].norm());
    for (int e = 0; e < elements; ++e) {
      double rise = 0.0;
      double area = 0.0;
      for (const int f : grid_.element_face[e]) {
        rise = std::max(rise, std::abs(pressure.rise[f]));
        area = std::max(area, grid_.face_normal[f].norm());
      }
      const double round_off =
          epsilon * (conductance_of(e, law.mobility[e]) * rise / area +
                     law.mobility[e] * (law.drive[e].norm() + new_push[e].norm()));
      const double here = (new_flux[e] - flux[e]).norm();
      if (here > 1e-12 * largest + 16.0 * round_off) converged = false;
      change = std::max(change, here);
      most_through = std::max(most_through, new_flux[e].norm() * area);
      most_round_off =
          std::max(most_round_off, epsilon * conductance_of(e, law.mobility[e]) * rise);
    }
    if (!quadratic) converged = iteration > 0 || most_round_off <= 1e-12 * most_through;
    // A small change that no longer halves is round-off that spread through the mesh.
    if (change <= 1e-6 * largest && change > 0.5 * last_change) converged = true;
    if (converged) {
      flux = std::move(new_flux);
      break;
    }
    if (!quadratic) continue;
    if (iteration == 100) {
      std::ostringstream text;
      text << "the flow with quadratic drag did not converge in 100 iterations of Newton's method: "
              "the flux still changes by "
           << change << " m/s of " << largest << " m/s";
      throw NumericalError(text.str());
    }

    const auto momentum_error = [&](const Field& at_flux, const Field& at_push) {
      Field residual(elements);
      std::vector<double> weight(elements);
      for (int e = 0; e < elements; ++e) {
        residual[e] =
            (resistance[e] + c.quadratic_drag[e] * at_flux[e].norm()) * at_flux[e] - at_push[e];
        weight[e] = grid_.volume[e] * law.mobility[e];
      }
      return norm_with_weights<Dim>(residual, weight);
    };
    // The whole step, or the part of it that lessens the error of momentum. Not for the first: it
    // is what fulfils continuity.
    double share = 1.0;
    if (iteration > 0) {
      error = momentum_error(flux, push);
      while (share > 1e-3) {
        Field part_flux(elements);
        Field part_push(elements);
        for (int e = 0; e < elements; ++e) {
          part_flux[e] = flux[e] + share * (new_flux[e] - flux[e]);
          part_push[e] = push[e] + share * (new_push[e] - push[e]);
        }
        if (momentum_error(part_flux, part_push) <= error) {
          new_flux = std::move(part_flux);
          new_push = std::move(part_push);
          break;
        }
        share *= 0.5;
      }
    }
    last_change = share == 1.0 ? change : std::numeric_limits<double>::infinity();
    flux = std::move(new_flux);
    push = std::move(new_push);
  }

  Stage stage;
  stage.rise.resize(faces);
  for (int f = 0; f < faces; ++f) stage.rise[f] = pressure.offset[f] + pressure.rise[f];

  // The water that a sealed piece stores takes up what enters it: to the last digit where next to
  // no storage hardly holds the level.
  if (pieces > 0) {
    const std::vector<int>& piece = correction_->sealed_piece();
    std::vector<double> stored(pieces, 0.0);
    std::vector<double> capacity(pieces, 0.0);
    for (int e = 0; e < elements; ++e) {
      if (piece[e] < 0) continue;
      for (const int f : grid_.element_face[e]) stored[piece[e]] += storage[e] * stage.rise[f];
      capacity[piece[e]] += (Dim + 1) * storage[e];
    }
    std::vector<double> shift(pieces);
    for (std::size_t p = 0; p < pieces; ++p) {
      if (capacity[p] > 0.0) {
        shift[p] = (surplus[p] - stored[p]) / capacity[p];
      } else {
        const int held = grid_.element_face[correction_->sealed_root()[p]][0];
        shift[p] = -(base.face_pressure[held] + stage.rise[held]);
      }
    }
    for (int f = 0; f < faces; ++f) {
      const int p = piece[grid_.face_left[f]];
      if (p >= 0) stage.rise[f] += shift[p];
    }
  }

  // Fluxes, from the side that conducts less, where pressures give them with more digits.
  std::vector<double> conductance(elements);
  std::vector<double> net_outflow(elements);
  for (int e = 0; e < elements; ++e) {
    double trace = Dim;
    if (quadratic) trace -= law.direction[e].squaredNorm();
    conductance[e] = law.mobility[e] * trace / grid_.volume[e];
  }
  stage.face_flux.assign(faces, 0.0);
  for (int e = 0; e < elements; ++e) {
    net_outflow[e] = net_source[e];
    for (int k = 0; k <= Dim; ++k) {
      const int f = grid_.element_face[e][k];
      const double storing = storage[e] * stage.rise[f];
      net_outflow[e] -= storing;
      if (grid_.is_outer(f)) {
        if (kinds_[f] != FaceKind::pressure) continue;
      } else {
        const int other = grid_.face_left[f] == e ? grid_.face_right[f] : grid_.face_left[f];
        if (conductance[e] > conductance[other]) continue;
        if (conductance[e] == conductance[other] && grid_.face_left[f] != e) continue;
      }
      stage.face_flux[f] = grid_.element_face_sign[e][k] * (flux[e].dot(outward_normal(e, k)) -
                                                            storing + net_source[e] / (Dim + 1));
    }
  }
  for (int f = 0; f < faces; ++f) {
    if (forcing.conditions[f].fixes_flux()) stage.face_flux[f] = -prescribed_inflow(forcing, f);
  }
  correction_->follow(conductance);
  correction_->correct(stage.face_flux, net_outflow);

  stage.flux_through = stage.face_flux;
  for (int f = 0; f < faces; ++f) {
    if (kinds_[f] != FaceKind::pressure) continue;
    stage.flux_through[f] += storage[grid_.face_left[f]] * stage.rise[f];
  }

  flux_scale_ = 0.0;
  for (const double value : stage.face_flux) flux_scale_ = std::max(flux_scale_, std::abs(value));
  if (std::isfinite(duration)) {
    for (int f = 0; f < faces; ++f) rise_rate_[f] = stage.rise[f] / duration;
  }
  stage.state.face_pressure.resize(faces);
  for (int f = 0; f < faces; ++f) {
    stage.state.face_pressure[f] = kinds_[f] == FaceKind::pressure
                                       ? forcing.conditions[f].value
                                       : base.face_pressure[f] + stage.rise[f];
  }
  stage.state.velocity.resize(elements);
  for (int e = 0; e < elements; ++e) stage.state.velocity[e] = flux[e] / c.porosity[e];
  return stage;
}

template <int Dim>
MixedStep<Dim> ImplicitMixed<Dim>::step(const MixedState<Dim>& begin, double dt,
                                        const std::vector<const FlowForcing<Dim>*>& forcing) {
  set_up(forcing.front()->conditions);
  const auto flux_of = [&](const std::vector<Vector<Dim>>& velocity, const auto& coefficients) {
    Field flux(velocity.size());
    for (std::size_t e = 0; e < flux.size(); ++e) flux[e] = coefficients.porosity[e] * velocity[e];
    return flux;
  };
  if (settings_.stepping == TimeStepping::monotone) {
    const FlowForcing<Dim>& last = *forcing.at(0);
    Stage stage = solve_stage(begin, dt, last, flux_of(begin.velocity, last.coefficients));
    std::vector<double> volume = stage.face_flux;
    for (double& v : volume) v *= dt;
    return {std::move(stage.state), std::move(volume), std::move(stage.face_flux),
            std::move(stage.flux_through)};
  }

  const double duration = stage_share * dt;
  const FlowForcing<Dim>& early = *forcing.at(0);
  const FlowForcing<Dim>& late = *forcing.at(1);
  const Stage first =
      solve_stage(begin, duration, early, flux_of(begin.velocity, early.coefficients));
  constexpr double ahead = (1.0 - stage_share) / stage_share;
  MixedState<Dim> base = begin;
  for (int f = 0; f < grid_.face_count(); ++f) base.face_pressure[f] += ahead * first.rise[f];
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    base.velocity[e] += ahead * (first.state.velocity[e] - begin.velocity[e]);
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
  Stage stage = solve_stage(last_steady_, std::numeric_limits<double>::infinity(), forcing,
                            last_steady_flux_);
  last_steady_ = stage.state;
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    last_steady_flux_[e] = forcing.coefficients.porosity[e] * stage.state.velocity[e];
  }
  return {std::move(stage.state), {}, std::move(stage.face_flux), std::move(stage.flux_through)};
}

template class ImplicitMixed<2>;

}  // namespace suffuse
