#pragma once

/// Flow and motion of the solid in one step. Each is solved for what the other has found, until the
/// pressures agree: the flow with the storage that the solid would have if it could not move
/// sideways (the fixed-stress split: Kim, Tchelepi and Juanes, Comput. Methods Appl. Mech. Eng. 200
/// (2011) 1591), the pressures of the elements mixed with those of iterations before (Anderson).
/// Neither part knows the other.

#include <vector>

#include "flow/implicit_mixed.hpp"
#include "solid/skeleton.hpp"

namespace suffuse {

/// The solid has found no equilibrium: in a shorter step it may.
class NoEquilibrium : public NotConverged {
 public:
  using NotConverged::NotConverged;
};

template <int Dim>
class SolidCoupling {
 public:
  /// Keeps references.
  SolidCoupling(const Grid<Dim>& grid, Skeleton<Dim>& solid, int threads)
      : grid_(grid), solid_(solid), threads_(threads) {}

  /// One step of `dt`, s, of the flow that `scheme` steps, which ends at `end`, s. `pressure`: of
  /// the elements at the start, Pa; `porosity`: see MotionForcing. The motion that belongs to it is
  /// the last one that the solid has tried. Throws NotConverged.
  MixedStep<Dim> step(ImplicitMixed<Dim>& scheme, const MixedState<Dim>& start,
                      const std::vector<double>& pressure, std::vector<double> porosity, double end,
                      double dt, FlowForcing<Dim> forcing);

  /// Of all steps so far, and of the one that took most.
  [[nodiscard]] long iterations() const { return iterations_; }
  [[nodiscard]] int most_iterations() const { return most_; }

  void archive(auto& archive) { archive(rise_rate_, rise_time_, iterations_, most_); }

 private:
  /// Where drained soil could not bear a load: the pressures if next to no water left, as a start.
  /// Throws NotConverged.
  [[nodiscard]] Eigen::VectorXd undrained_rise(MotionForcing forcing, Eigen::VectorXd rise) const;
  [[nodiscard]] std::vector<double> source_of(const SolidMotion& motion,
                                              const std::vector<double>& own,
                                              const std::vector<double>& storage,
                                              const Eigen::VectorXd& rise, double dt) const;

  const Grid<Dim>& grid_;
  Skeleton<Dim>& solid_;
  int threads_;
  std::vector<double> rise_rate_;  ///< of the pressure in the last step, per element, Pa/s
  double rise_time_ = 0.0;         ///< duration of that step, s
  long iterations_ = 0;
  int most_ = 0;
};

/// Mass of liquid per volume of soil and element, kg/m3.
template <int Dim>
std::vector<double> liquid_mass(const Grid<Dim>& grid, const FlowCoefficients<Dim>& coefficients,
                                const ElementField<Dim>& air);

/// The pressure of the pores as the skeleton feels it (Bishop): suction as far as the pores are
/// filled. Per element, Pa.
template <int Dim>
std::vector<double> pressure_on_solid(const Grid<Dim>& grid, std::vector<double> pressure,
                                      const std::vector<double>& porosity,
                                      const ElementField<Dim>& air);

}  // namespace suffuse
