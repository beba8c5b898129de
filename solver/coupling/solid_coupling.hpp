#pragma once

/// Flow and motion of the solid in one step. Each is solved for what the other has found, until the
/// pressures agree: the flow with the storage that the solid would have if it could not move
/// sideways (the fixed-stress split: Kim, Tchelepi and Juanes, Comput. Methods Appl. Mech. Eng. 200
/// (2011) 1591), the pressures of the elements mixed with those of iterations before (Anderson).
/// Neither part knows the other.

#include <vector>

#include "mixed/implicit_mixed.hpp"
#include "solid/skeleton.hpp"

namespace suffuse {

/// The solid has found no equilibrium: in a shorter step it may.
class NoEquilibrium : public NotConverged {
 public:
  NoEquilibrium(const std::string& what, int node) : NotConverged(what), worst_node(node) {}

  int worst_node;  ///< at which forces are out of balance most; -1: not known
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

  /// A step has ended at `time`, s, and the next will be of `next_step`, s. If steps in equilibrium
  /// get much shorter than the time of a fall, or soil moves as fast as it falls freely, inertia is
  /// switched on.
  void watch_steps(double time, double next_step);
  /// What drives flow or motion changes at once: short steps follow for that reason.
  void expect_short_steps() { long_steps_ = false; }
  /// Steps have become too short for what `error` says. Throws EquilibriumLost; NumericalError
  /// where the soil does not move.
  [[noreturn]] void refuse_unsolved(double time, const NotConverged& error) const;

  /// Iterations of all steps so far.
  [[nodiscard]] long iterations() const { return iterations_; }

  void archive(auto& archive) { archive(rise_rate_, rise_time_, iterations_, long_steps_); }

 private:
  /// Storage of the elements in the iteration in addition to their own, of the soil's
  /// compressibility, m3/Pa.
  [[nodiscard]] std::vector<double> held_by_soil(const FlowSoils<Dim>& soils,
                                                 const ElementField<Dim>& air,
                                                 const FlowForcing<Dim>& forcing,
                                                 const std::vector<double>& pressure,
                                                 double dt) const;
  /// Expected rise of the pressure at faces in a step of `dt`, s, after the steps before it, Pa.
  [[nodiscard]] Eigen::VectorXd expected_rise(double dt) const;

  // What acts on the motion: not the pressure of free water, nor of soil that cannot move. There
  // the held `storage` is 0.

  /// Means of the elements, of values at faces.
  [[nodiscard]] Eigen::VectorXd at_elements(const Eigen::VectorXd& of_faces,
                                            const std::vector<double>& storage) const;
  /// Means of the elements on both sides of a face.
  [[nodiscard]] Eigen::VectorXd at_faces(const Eigen::VectorXd& of_elements,
                                         const std::vector<double>& storage) const;
  [[nodiscard]] Eigen::VectorXd rise_at_soil(const std::vector<double>& before,
                                             const std::vector<double>& after,
                                             const std::vector<double>& storage) const;
  /// Largest pressure difference that counts as converged, Pa, where the largest rise is `rise` and
  /// the largest pressure `pressure`, Pa; in equilibrium never below `floor`.
  [[nodiscard]] double allowed(double rise, double pressure, double floor) const;
  /// Where drained soil could not bear a load: the pressures if next to no water left, as a start.
  /// Throws NotConverged.
  [[nodiscard]] Eigen::VectorXd undrained_rise(MotionForcing forcing, Eigen::VectorXd rise) const;
  /// Volume that crosses faces with the motion, without its air. The pores of `forcing` become
  /// those of `start`, grown as solid leaves.
  [[nodiscard]] std::vector<double> without_air(const SolidMotion& motion,
                                                const ElementField<Dim>& air,
                                                const FlowCoefficients<Dim>& start,
                                                FlowForcing<Dim>& forcing) const;
  /// \param moved  volume that crosses faces with the motion, m3
  [[nodiscard]] std::vector<double> source_of(const std::vector<double>& moved,
                                              const std::vector<double>& own,
                                              const std::vector<double>& storage,
                                              const Eigen::VectorXd& rise, double dt) const;

  const Grid<Dim>& grid_;
  Skeleton<Dim>& solid_;
  int threads_;
  std::vector<double> rise_rate_;  ///< of the pressure in the last step, per face, Pa/s
  double rise_time_ = 0.0;         ///< duration of that step, s
  long iterations_ = 0;
  bool long_steps_ = false;  ///< there have been some since something changed at once
};

/// Mass of liquid per volume of soil and element, kg/m3.
template <int Dim>
std::vector<double> liquid_mass(const Grid<Dim>& grid, const FlowCoefficients<Dim>& coefficients,
                                const ElementField<Dim>& air);

/// The pressure of the pores as the skeleton feels it, per element, Pa: suction times the effective
/// saturation (Lu, Godt and Wu, Water Resour. Res. 46 (2010) W05515).
template <int Dim>
std::vector<double> pressure_on_solid(const Grid<Dim>& grid, const FlowSoils<Dim>& soils,
                                      std::vector<double> pressure,
                                      const std::vector<double>& porosity,
                                      const ElementField<Dim>& air);

}  // namespace suffuse
