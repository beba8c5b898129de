#pragma once

/// The linear systems for the pressures of a stage.

#include <optional>
#include <vector>

#include "linear/lagged_preconditioner.hpp"
#include "linear/newton_system.hpp"
#include "linear/shared_system.hpp"
#include "mixed/sealed_pieces.hpp"

namespace suffuse {

template <int Dim>
class PressureSystem {
 public:
  PressureSystem(const MixedModel<Dim>& model, const std::vector<FaceKind>& kinds)
      : ranks_(model.grid.ranks()),
        matrix_(model.grid, kinds, model.settings.threads),
        solver_(model.settings.threads, LagLimits{}, flow_factor(Dim, model.grid.face_count())),
        newton_(newton_factor(Dim, model.grid.face_count())),
        face_push_(model.grid.volume.size()),
        round_off_(model.grid.volume.size()),
        known_rise_(kinds.size()),
        load_(matrix_.unknowns()),
        guess_(matrix_.unknowns()),
        tolerance_(matrix_.unknowns()) {
    if (ranks_.count() > 1) {
      shared_.emplace(ranks_, model.grid.face_rows(), matrix_.unknowns_of_faces());
    }
  }

  [[nodiscard]] MixedMatrix<Dim>& matrix() { return matrix_; }
  [[nodiscard]] SolveCounts counts() const {
    SolveCounts result = solver_.counts();
    if (shared_) result += shared_->counts();
    return result += newton_.counts();
  }
  /// Assembles the matrix for the law of the stage.
  void assemble(const MixedStage<Dim>& stage, const ElementField<Dim>& side_storage) {
    matrix_.assemble(stage.law, stage.storage, side_storage, stage.mean_storage);
    for (const LeakyFace& wall : stage.walls) matrix_.couple(wall);
  }
  /// Finds the rises of the pressures that are not prescribed, with the law of the stage.
  void solve(MixedStage<Dim>& stage) {
    assemble(stage, {});
    find_load(stage);
    const std::vector<char> stores = pieces_that_store(stage);
    for (std::size_t p = 0; p < stores.size(); ++p) {
      const int e = stage.faces.correction().sealed_root()[p];
      if (e >= 0 && stores[p] == 0) matrix_.hold_level(e);
    }
    const SymmetricSystem system{matrix_.values(), load_, guess_, tolerance_};
    const Eigen::VectorXd solution = shared_ ? shared_->solve(system) : solver_.solve(system);
    stage.for_each_face([&](int f) {
      if (!stage.faces.is_held(f)) stage.pressure.rise[f] = solution[matrix_.unknown(f)];
    });
  }
  /// Sets `step` to the solution for the residual: of the assembled matrix, or of `tangent`, which
  /// is near it. Throws NumericalError.
  void solve_newton(const std::optional<Eigen::SparseMatrix<double>>& tangent,
                    Eigen::VectorXd& step) {
    const Eigen::SparseMatrix<double>& nearly = matrix_.values();
    if (shared_) {
      step = tangent ? shared_->solve_near(nearly, *tangent, load_)
                     : shared_->solve({nearly, load_, guess_, tolerance_});
      return;
    }
    if (tangent) {
      newton_.solve_tangent(nearly, *tangent, load_, step);
    } else {
      newton_.factorise(nearly);
      newton_.solve(nearly, load_, step);
    }
  }
  /// Finds pressures and fluxes of a stage whose law does not depend on them.
  void solve_linear(MixedStage<Dim>& stage) {
    const MixedModel<Dim>& model = stage.model;
    solve(stage);
    stage.flux = stage.found_flux();
    // Where pressures rise much, the round-off of the rise times the largest conductance may exceed
    // the flux through a tight soil; a second solution removes it.
    const double through = stage.largest_of_elements(
        [&](int e) { return stage.flux[e].norm() * model.largest_at_faces(e, model.face_area); });
    const double round_off = stage.largest_of_elements([&](int e) {
      return epsilon * stage.conductance_of(e) * model.largest_at_faces(e, stage.pressure.rise);
    });
    double of_walls = 0.0;
    for (const auto& [face, partner, conductance] : stage.walls) {
      const double rise = std::hypot(stage.pressure.rise[face], stage.pressure.rise[partner]);
      of_walls = std::max(of_walls, epsilon * conductance * rise);
    }
    if (std::max(round_off, largest_of_all(ranks_, of_walls)) <= 1e-12 * through) return;
    stage.pressure.move_reference(stage.base.face_pressure);
    solve(stage);
    stage.flux = stage.found_flux();
  }
  /// Finds the residual of the balance at each unknown, m3/s, at the reference of the pressures;
  /// zero at seepage faces that are held. On several ranks it is complete at own faces.
  void find_load(const MixedStage<Dim>& stage) {
    const MixedModel<Dim>& model = stage.model;
    const FacePressure& pressure = stage.pressure;
    const MomentumLaw<Dim>& law = stage.law;
    stage.for_each_face(
        [&](int f) { known_rise_[f] = stage.faces.is_held(f) ? pressure.rise[f] : 0.0; });
    stage.for_each_element([&](int e) {
      const Vector<Dim> gradient = model.pressure_gradient(e, pressure.reference, known_rise_);
      face_push_[e] = law.mobility[e] * law.directed(e, law.drive[e] - gradient);
      round_off_[e] =
          2.0 * epsilon * law.best_mobility(e) * (law.drive[e].norm() + gradient.norm());
    });
    const auto known = [&](int f) { return pressure.offset[f] + known_rise_[f]; };
    stage.for_each_face([&](int f) {
      const int row = matrix_.unknown(f);
      if (row < 0) return;
      guess_[row] = pressure.rise[f];
      load_[row] = model.grid.is_outer(f) ? stage.inflow(f) : 0.0;
      // Residuals need not be below the round-off of the load, nor below this share of the flux.
      tolerance_[row] = 1e-13 * stage.flux_scale;
      for (const int e : {model.grid.face_left[f], model.grid.face_right[f]}) {
        if (e < 0) continue;
        const int k = model.grid.side_of(e, f);
        load_[row] += face_push_[e].dot(model.grid.outward_normal(e, k)) + stage.side_source(e, k) -
                      stage.storage[e] * pressure.offset[f] -
                      stage.stored_in_mean(e, known) / (Dim + 1);
        if (!stage.displaced.empty()) load_[row] -= stage.displaced[e][k];
        tolerance_[row] += round_off_[e] * model.face_area[f];
      }
    });
    for (const LeakyFace& wall : stage.walls) {
      const double flux =
          wall.conductance * (pressure.reference[wall.face] - pressure.reference[wall.partner]);
      load_[matrix_.unknown(wall.face)] -= flux;
      load_[matrix_.unknown(wall.partner)] += flux;
      for (const int f : {wall.face, wall.partner}) {
        tolerance_[matrix_.unknown(f)] += 2.0 * epsilon * std::abs(flux);
      }
    }
    for (const int f : stage.faces.switching()) {
      if (stage.faces.is_held(f)) load_[matrix_.unknown(f)] = 0.0;
    }
  }
  [[nodiscard]] const Eigen::VectorXd& load() const { return load_; }
  /// Norm of the residual at all unknowns, and the largest, m3/s.
  [[nodiscard]] double load_norm() const {
    return std::sqrt(sum_of_all(ranks_, own_load().squaredNorm()));
  }
  [[nodiscard]] double largest_load() const {
    const auto own = own_load();
    double largest = 0.0;
    if (own.size() > 0) largest = own.template lpNorm<Eigen::Infinity>();
    return largest_of_all(ranks_, own.allFinite() ? largest : infinity);
  }

  void archive(auto& archive) {
    // On several ranks the state of one process has factors of the whole matrix, which none uses.
    solver_.archive(archive, matrix_.values(), !shared_);
    newton_.archive(archive, matrix_.values(), !shared_);
  }

 private:
  /// The residual at own unknowns: that at others is not complete.
  [[nodiscard]] auto own_load() const {
    const NumberRange own = shared_ ? shared_->own() : NumberRange(0, matrix_.unknowns());
    return load_.segment(*own.begin(), *own.end() - *own.begin());
  }

  const Ranks& ranks_;
  MixedMatrix<Dim> matrix_;
  std::optional<SharedSystem> shared_;  ///< on several ranks, in the place of `solver_`
  LaggedPreconditioner solver_;
  NewtonSystem newton_;
  // Members, so that stages do not allocate them.
  VectorField<Dim> face_push_;     ///< flux of an element without the unknown rises, m/s
  std::vector<double> round_off_;  ///< of `face_push_`, m/s
  std::vector<double> known_rise_;
  Eigen::VectorXd load_;
  Eigen::VectorXd guess_;
  Eigen::VectorXd tolerance_;
};

}  // namespace suffuse
