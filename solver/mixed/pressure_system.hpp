#pragma once

/// The linear systems for the pressures of a stage.

#include <optional>
#include <vector>

#include "linear/lagged_preconditioner.hpp"
#include "linear/newton_system.hpp"
#include "linear/shared_system.hpp"
#include "mixed/mixed_stage.hpp"

namespace suffuse {

template <int Dim>
class PressureSystem {
 public:
  PressureSystem(const MixedModel<Dim>& model, const std::vector<FaceKind>& kinds)
      : matrix_(model.grid, kinds, model.settings.threads),
        solver_(model.settings.threads, LagLimits{}, flow_factor(Dim, model.grid.face_count())),
        newton_(newton_factor(Dim, model.grid.face_count())),
        face_push_(model.grid.volume.size()),
        round_off_(model.grid.volume.size()),
        known_rise_(kinds.size()),
        load_(matrix_.unknowns()),
        guess_(matrix_.unknowns()),
        tolerance_(matrix_.unknowns()) {
    if (model.grid.ranks().count() > 1) share_unknowns(model.grid);
  }

  [[nodiscard]] MixedMatrix<Dim>& matrix() { return matrix_; }
  [[nodiscard]] NewtonSystem& newton() { return newton_; }
  [[nodiscard]] SolveCounts counts() const {
    SolveCounts result = solver_.counts();
    if (shared_) result += {.solves = shared_->solves(), .iterations = shared_->iterations()};
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
    for (const int e : stage.faces.correction().sealed_root()) {
      if (e >= 0 && !stage.stores(e)) matrix_.hold_level(e);
    }
    const SymmetricSystem system{matrix_.values(), load_, guess_, tolerance_};
    const Eigen::VectorXd solution = shared_ ? shared_->solve(system) : solver_.solve(system);
    stage.for_each_face([&](int f) {
      if (!stage.faces.is_held(f)) stage.pressure.rise[f] = solution[matrix_.unknown(f)];
    });
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
    if (std::max(round_off, stage.wall_round_off()) <= 1e-12 * through) return;
    stage.pressure.move_reference(stage.base.face_pressure);
    solve(stage);
    stage.flux = stage.found_flux();
  }
  /// Residual of the balance at each unknown, m3/s, at the reference of the pressures; zero at
  /// seepage faces that are held.
  const Eigen::VectorXd& find_load(const MixedStage<Dim>& stage) {
    const MixedModel<Dim>& model = stage.model;
    const FacePressure& pressure = stage.pressure;
    const MomentumLaw<Dim>& law = stage.law;
    stage.for_each_face(
        [&](int f) { known_rise_[f] = stage.faces.is_held(f) ? pressure.rise[f] : 0.0; });
    stage.for_each_element([&](int e) {
      const Vector<Dim> gradient = model.pressure_gradient(e, pressure.reference, known_rise_);
      face_push_[e] = law.mobility[e] * law.directed(e, law.drive[e] - gradient);
      round_off_[e] = 2.0 * epsilon * law.mobility[e] * model.soils.best_over_along(e) *
                      (law.drive[e].norm() + gradient.norm());
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
        load_[row] += face_push_[e].dot(model.grid.outward_normal(e, k)) +
                      stage.net_source[e] / (Dim + 1) - stage.storage[e] * pressure.offset[f] -
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
    return load_;
  }
  [[nodiscard]] const Eigen::VectorXd& load() const { return load_; }

  void archive(auto& archive) {
    // On several ranks the state of one process has factors of the whole matrix, which none uses.
    solver_.archive(archive, matrix_.values(), !shared_);
    newton_.archive(archive, matrix_.values());
  }

 private:
  /// Numbers the unknowns of all ranks: each numbers those of its own faces, one after the other.
  void share_unknowns(const Grid<Dim>& grid) {
    int first = 0;
    int last = 0;
    for (int f = 0; f < grid.face_count(); ++f) {
      if (matrix_.unknown(f) < 0) continue;
      if (f < *grid.own_faces().begin()) ++first;
      if (f < *grid.own_faces().end()) ++last;
    }
    const long before = grid.ranks().before(last - first);
    std::vector<long> of_face(grid.face_count(), -1);
    for (const int f : grid.own_faces()) {
      if (matrix_.unknown(f) >= 0) of_face[f] = before + matrix_.unknown(f) - first;
    }
    grid.face_rows().exchange(of_face);
    std::vector<long> numbers;
    for (int f = 0; f < grid.face_count(); ++f) {
      if (matrix_.unknown(f) >= 0) numbers.push_back(of_face[f]);
    }
    shared_.emplace(grid.ranks(), numbers, first, last);
  }

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
