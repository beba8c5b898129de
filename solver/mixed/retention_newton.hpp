#pragma once

/// Newton's method of a stage where the equations depend on the pressure itself: the liquid content
/// and the conductivity of soil under suction (in the mixed form of Celia, Bouloutas and Zarba,
/// Water Resour. Res. 26 (1990) 1483), and the seepage faces that are open.

#include "mixed/pressure_system.hpp"
#include "mixed/side_states.hpp"

namespace suffuse {

template <int Dim>
class RetentionNewton {
 public:
  RetentionNewton(MixedStage<Dim>& stage, PressureSystem<Dim>& system)
      : stage_(stage),
        system_(system),
        model_(stage.model),
        faces_(stage.faces),
        allowed_(model_.grid.volume.size()),
        round_off_(allowed_.size()),
        side_storage_(stage.displaced.size()),
        gain_(stage.displaced.size()),
        steepest_(stage.displaced.size()) {
    for (int e = 0; e < std::ssize(steepest_); ++e) steepest_[e] = model_.soils.steepest(e);
  }

  /// Finds pressures, fluxes and the set of open seepage faces. Returns the number of solutions.
  /// Throws NotConverged.
  int solve() {
    double share = 1.0;
    double first_norm = 0.0;
    double enough = 0.0;
    double last_norm = infinity;
    std::vector<double> from;
    for (int iteration = 0;; ++iteration) {
      double norm = evaluate();
      // The first iteration has no earlier pressures to return to.
      while (iteration > 0 && !(norm < last_norm) && share > min_share) {
        // Return to the earlier pressures and take a shorter step.
        share *= 0.5;
        stage_.pressure.reference = from;
        take_step(share);
        norm = evaluate();
      }
      const double scale = largest_flux();
      const double left = system_.largest_load();
      if (iteration == 0) first_norm = norm;
      if (iteration == 0) enough = stage_.forcing.reduction * left;
      find_allowed(scale);
      const double excess = largest_excess(allowed_);
      // Accept round-off where water is at rest or an element is nearly flat.
      const bool stays =
          norm > 0.5 * last_norm && largest_excess(round_off_) <= many_round_off_units;
      const bool solved = std::isfinite(left) && (left <= enough || excess <= 1.0 || stays);
      const bool switched = (solved || left <= near_solution * scale) &&
                            switch_faces(solved ? std::max(excess, 1.0) : 1.0);
      if (!switched && solved) return iteration;
      // The iteration diverges; that of a shorter time step starts nearer to its end.
      const bool wanders =
          !stage_.is_steady() && iteration >= patient_iterations && norm > first_norm;
      if (!std::isfinite(left) || wanders || iteration == max_newton_iterations) {
        refuse_unsettled(iteration, left, scale, switched);
      }
      share = 1.0;
      last_norm = switched ? infinity : norm;
      if (switched) evaluate();
      from = stage_.pressure.reference;
      find_step();
      take_step(share);
    }
  }

 private:
  static constexpr int max_newton_iterations = 60;
  /// After this many iterations of a step the residual must be smaller than at the start.
  static constexpr int patient_iterations = 20;
  /// Tolerated residual at a face as shares of the largest flux of all and of its two elements, in
  /// addition to round-off. The second is for tight soil beside strong flow.
  static constexpr double local_accuracy = 1e-5;
  static constexpr double flux_accuracy = 1e-8;
  static constexpr double round_off_units = 64.0;
  /// Looser tolerance when the iteration stagnates, in units of the round-off of the fluxes that an
  /// element's pressures cause.
  static constexpr double many_round_off_units = 512.0;
  /// Residual over flux below which seepage faces open and close.
  static constexpr double near_solution = 0.1;
  /// Smallest share of a step of Newton's method that is taken.
  static constexpr double min_share = 1.0 / 16.0;
  /// In one iteration suction grows by at most this factor times itself plus one meter.
  static constexpr double max_suction_growth = 10.0;

  [[noreturn]] static void refuse_unsettled(int iterations, double left, double scale,
                                            bool switched) {
    std::ostringstream text;
    text << "the iteration of the flow did not converge in " << iterations << " solutions: " << left
         << " m3/s are missing at a face, of " << scale << " m3/s"
         << (switched ? "; seepage faces keep opening and closing" : "");
    throw NotConverged(text.str());
  }

  /// Conductivities, contents, fluxes and residual at the pressures reached. Returns the norm of
  /// the residual, m3/s.
  double evaluate() {
    FacePressure& pressure = stage_.pressure;
    level_elements_.clear();
    faces_.follow_held();
    for (const int f : faces_.switching()) {
      if (faces_.is_held(f)) pressure.rise[f] = faces_.condition(f).value - pressure.reference[f];
    }
    pressure.move_reference(stage_.base.face_pressure);
    if (stage_.retains) linearise_retention();
    if (hold_levels()) return evaluate();
    stage_.flux = stage_.found_flux();
    system_.find_load(stage_);
    return system_.load_norm();
  }

  /// Mobility, displaced air, and their slopes, at the reference pressures.
  void linearise_retention() {
    const SideStates<Dim> sides(model_, stage_.pressure.reference);
    stage_.for_each_element([&](int e) {
      double conducts = 0.0;
      const double share = stage_.coefficients.porosity[e] * model_.grid.volume[e] / (Dim + 1);
      for (int k = 0; k <= Dim; ++k) {
        const RetentionState side = sides.at(e, k);
        conducts += side.relative_conductivity / (Dim + 1);
        stage_.displaced[e][k] = stage_.displacement_rate(e, k, share * (1.0 - side.saturation));
        side_storage_[e][k] = stage_.is_steady() ? 0.0 : share * side.capacity / stage_.duration;
        gain_[e][k] = side.conductivity_slope / (Dim + 1);
      }
      const double of_darcy = conducts / stage_.resistance[e];
      stage_.set_mobility(e, of_darcy);
      const bool is_slowed = !stage_.expected_gradient.empty();
      const double of_gain = is_slowed ? of_darcy / stage_.law.mobility[e] : 1.0;
      for (double& gain : gain_[e]) gain *= of_gain / conducts;
    });
  }

  /// Finds the step of Newton's method. Throws NotConverged.
  void find_step() try {
    MixedMatrix<Dim>& matrix = system_.matrix();
    // A wetter element conducts better. Where water enters, that adds to the diagonal. The
    // symmetric matrix with this part is factored, and is the preconditioner of the complete one.
    ElementField<Dim> flux(side_storage_.size());
    ElementField<Dim> on_diagonal = side_storage_;
    for_each_index(static_cast<int>(flux.size()), model_.settings.threads, [&](int e) {
      for (int k = 0; k <= Dim; ++k) {
        flux[e][k] = stage_.flux[e].dot(model_.grid.outward_normal(e, k));
        on_diagonal[e][k] += std::max(0.0, -flux[e][k] * gain_[e][k]);
      }
    });
    system_.assemble(stage_, on_diagonal);
    for (const int e : level_elements_) matrix.hold_level(e);
    for (const int f : faces_.switching()) {
      if (faces_.is_held(f)) matrix.uncouple(f);
    }
    std::optional<Eigen::SparseMatrix<double>> tangent;
    if (!flux.empty()) tangent = matrix.with_gain(flux, gain_, faces_.held());
    system_.solve_newton(tangent, step_);
  } catch (const NumericalError& error) {
    throw NotConverged(error.what());
  }

  void take_step(double share) {
    stage_.for_each_face([&](int f) {
      stage_.pressure.rise[f] =
          faces_.is_held(f) ? 0.0 : share * step_[system_.matrix().unknown(f)];
    });
    if (stage_.retains) limit_change();
  }

  /// Limits the step. A pressure that would pass the point where its soil's content changes fastest
  /// stops there: from there on the content is convex or concave, and Newton's method converges.
  /// From saturated or dry soil, whose content hardly changes, the step would be arbitrarily long.
  /// Suction grows by a factor at most.
  void limit_change() {
    FacePressure& pressure = stage_.pressure;
    stage_.for_each_face([&](int f) {
      const bool stays_wet =
          pressure.reference[f] >= 0.0 && pressure.reference[f] + pressure.rise[f] >= 0.0;
      if (faces_.is_held(f) || stays_wet) return;
      for (const int e : {model_.grid.face_left[f], model_.grid.face_right[f]}) {
        if (e < 0) continue;
        for (const double steepest : steepest_[e]) {
          const double way = steepest - pressure.reference[f];
          const bool passes = steepest < 0.0 && way != 0.0 &&
                              (way > 0.0) == (pressure.rise[f] > 0.0) &&
                              std::abs(pressure.rise[f]) > std::abs(way);
          if (passes) pressure.rise[f] = way;
        }
      }
      const double suction = std::abs(pressure.reference[f]) + 1.0 / model_.soils.head_per_pressure;
      pressure.rise[f] = std::max(pressure.rise[f], -max_suction_growth * suction);
    });
    // A limit comes from both sides of a face, which only its owner has.
    model_.grid.face_rows().exchange(pressure.rise);
  }

  /// Opens and closes seepage faces. Returns whether any changed. `inexact`: residual over allowed.
  bool switch_faces(double inexact) {
    const FacePressure& pressure = stage_.pressure;
    const double pressure_tolerance = pressure_accuracy();
    bool switched = false;
    for (const int f : faces_.switching()) {
      if (!faces_.is_seepage(f)) continue;
      const int e = model_.grid.face_left[f];
      const double rise = pressure.offset[f] + pressure.rise[f];
      const bool takes_in_more =
          faces_.is_open(f) && -stage_.flux_out(e, model_.grid.side_of(e, f), rise) >
                                   faces_.most_inflow(f) + inexact * allowed_[e];
      const bool presses =
          !faces_.is_open(f) && pressure.reference[f] + pressure.rise[f] > pressure_tolerance;
      if (!takes_in_more && !presses) continue;
      faces_.set_open(f, presses);
      switched = true;
    }
    return any_of_all(model_.grid.ranks(), switched);
  }

  /// Opens the seepage face with the highest pressure where nothing fixes the level. Returns
  /// whether any was opened.
  bool hold_levels() {
    const FluxCorrection<Dim>& correction = faces_.correction();
    const std::vector<char> stores = pieces_that_store(stage_, side_storage_);
    bool opened = false;
    for (int p = 0; p < correction.sealed_piece_count(); ++p) {
      if (stores[p] != 0) continue;
      if (open_highest(p)) {
        opened = true;
      } else if (correction.sealed_root()[p] >= 0) {
        level_elements_.push_back(correction.sealed_root()[p]);
      }
    }
    return opened;
  }
  /// Opens the seepage face of a sealed piece with the highest pressure, of several the one with
  /// the lowest number. Returns false if there is none.
  bool open_highest(int piece) {
    const Grid<Dim>& grid = model_.grid;
    const std::vector<double>& pressure = stage_.pressure.reference;
    std::vector<int> candidates;
    double highest = -infinity;
    for (const int f : faces_.switching()) {
      const bool is_in = faces_.correction().sealed_piece()[grid.face_left[f]] == piece;
      if (!is_in || !faces_.is_seepage(f)) continue;
      candidates.push_back(f);
      highest = std::max(highest, pressure[f]);
    }
    highest = largest_of_all(grid.ranks(), highest);
    double lowest = infinity;
    for (const int f : candidates) {
      if (pressure[f] == highest) lowest = std::min(lowest, double(grid.face_number(f)));
    }
    lowest = smallest_of_all(grid.ranks(), lowest);
    for (const int f : candidates) {
      if (double(grid.face_number(f)) == lowest) faces_.set_open(f, true);
    }
    return std::isfinite(lowest);
  }
  /// Sets what each element may leave at a side, m3/s: shares of its largest flux and of `scale`,
  /// that of all, and round-off of the flux by gravity, conductances times pressures, contents.
  void find_allowed(double scale) {
    const FlowCoefficients<Dim>& c = stage_.coefficients;
    stage_.for_each_element([&](int e) {
      const double pressure = model_.largest_at_faces(e, stage_.pressure.reference);
      const double contents = c.porosity[e] * model_.grid.volume[e] / stage_.duration;
      round_off_[e] =
          epsilon * (model_.gravity_flux(e, c) + stage_.conductance_of(e) * pressure + contents);
      allowed_[e] = round_off_units * round_off_[e] +
                    std::min(flux_accuracy * scale, local_accuracy * largest_flux(e));
    });
    for (const LeakyFace& wall : stage_.walls) {
      for (const int f : {wall.face, wall.partner}) {
        const double more = epsilon * wall.conductance * std::abs(stage_.pressure.reference[f]);
        round_off_[model_.grid.face_left[f]] += more;
        allowed_[model_.grid.face_left[f]] += round_off_units * more;
      }
    }
  }
  /// Largest residual at a face, over what its elements may leave.
  [[nodiscard]] double largest_excess(const std::vector<double>& allowed) const {
    return stage_.largest_of_faces([&](int f) {
      const int right = model_.grid.face_right[f];
      if (faces_.is_held(f)) return 0.0;
      const double sum = allowed[model_.grid.face_left[f]] + (right < 0 ? 0.0 : allowed[right]);
      const double missing = std::abs(system_.load()[system_.matrix().unknown(f)]);
      return missing > 0.0 ? missing / sum : 0.0;
    });
  }
  /// Largest flux through a side of an element, and of all elements, m3/s.
  [[nodiscard]] double largest_flux(int e) const {
    double largest = 0.0;
    for (int k = 0; k <= Dim; ++k) {
      largest = std::max(largest, std::abs(stage_.flux[e].dot(model_.grid.outward_normal(e, k))));
    }
    return largest;
  }
  [[nodiscard]] double largest_flux() const {
    return stage_.largest_of_elements([&](int e) { return largest_flux(e); });
  }
  /// Tolerance of the pressure at a seepage face: 1e-9 of the largest pressure, Pa.
  [[nodiscard]] double pressure_accuracy() const {
    const FacePressure& pressure = stage_.pressure;
    return 1e-9 * stage_.largest_of_faces([&](int f) {
      return std::abs(pressure.reference[f]) + std::abs(pressure.rise[f]);
    });
  }

  MixedStage<Dim>& stage_;
  PressureSystem<Dim>& system_;
  const MixedModel<Dim>& model_;
  StageFaces<Dim>& faces_;
  std::vector<double> allowed_;     ///< per element, see `find_allowed`
  std::vector<double> round_off_;   ///< per element, m3/s
  ElementField<Dim> side_storage_;  ///< slope of the rate of displacement, m3/(s Pa)
  ElementField<Dim> gain_;          ///< dk_r/dp at a side over k_r of the element, 1/Pa
  std::vector<std::array<double, 2>> steepest_;  ///< `FlowSoils::steepest` per element
  std::vector<int> level_elements_;  ///< whose first face fixes the level of a sealed piece
  Eigen::VectorXd step_;             ///< per unknown, Pa
};

}  // namespace suffuse
