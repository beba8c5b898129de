#pragma once

/// Iterates flow and motion of the solid in one step: each is solved with the result of the other
/// until the pressures agree. The flow has the storage of soil that cannot move sideways (the
/// fixed-stress split: Kim, Tchelepi and Juanes, Comput. Methods Appl. Mech. Eng. 200 (2011) 1591),
/// and pressures are mixed with those of earlier iterations (Anderson). Neither part knows the
/// other.

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "flow/flow_step.hpp"
#include "mixed/implicit_mixed.hpp"
#include "motion/moving_skeleton.hpp"

namespace suffuse {

/// Rise of pressures in a step, which predicts that of the next one.
struct PressureRise {
  std::vector<double> rate;  ///< per face, Pa/s
  double time = 0.0;         ///< duration of the step, s

  void archive(auto& archive) { archive(rate, time); }
};

/// The solution of a step of flow and solid. Neither has changed yet.
template <int Dim>
struct CoupledStep {
  FlowStep<Dim> flow;
  std::optional<MotionStep<Dim>> motion = {};  ///< none if the solid does not move
  PressureRise rise = {};                      ///< in the step found last, or before it
  long iterations = 0;                         ///< of flow and motion, in all attempts
};

/// The flow at the start of a step.
template <int Dim>
struct FlowStart {
  const MixedState<Dim>& state;
  const std::vector<double>& pressure;  ///< of the elements, Pa
  double tolerance = 0.0;               ///< of the pressures' error in a step, Pa
};

/// Limit of the difference below which the pressures of flow and motion agree.
struct Agreement {
  double share = 0.0;      ///< of the largest change of the pressure in the step ...
  double most = 0.0;       ///< ... but no more than this, Pa
  double round_off = 0.0;  ///< in addition, Pa

  /// Largest difference for the largest change `rise`, Pa.
  [[nodiscard]] double allowed(double rise) const {
    return std::min(share * rise, most) + round_off;
  }
  /// Largest difference of pressures that come no nearer, Pa: where single elements begin and end
  /// to yield, the iteration may go round in a circle.
  [[nodiscard]] double tolerated() const { return std::isfinite(most) ? most + round_off : 0.0; }
};

template <int Dim>
class FlowAndMotion {
 public:
  /// Keeps references.
  FlowAndMotion(const Grid<Dim>& grid, const MovingSkeleton<Dim>& solid, int threads)
      : grid_(grid), solid_(solid), threads_(threads) {}

  /// Finds flow and motion of a step with given length and forcing of the flow, starting from the
  /// last attempt. Returns the reason if it has no solution.
  std::optional<Unsolved> solve(ImplicitMixed<Dim>& scheme, const FlowStart<Dim>& start,
                                MotionForcing forcing, CoupledStep<Dim>& step) const;

 private:
  /// Does what `solve` does if the soil moves. Throws NotConverged.
  std::optional<Unsolved> iterate(ImplicitMixed<Dim>& scheme, const FlowStart<Dim>& start,
                                  CoupledStep<Dim>& step) const;
  /// Finds the step of soil that has come to rest: the flow through soil that does not move.
  /// Returns false if the soil does not stay where it is under the pressures at the end.
  bool solve_at_rest(ImplicitMixed<Dim>& scheme, const FlowStart<Dim>& start,
                     CoupledStep<Dim>& step) const;
  /// Additional storage of the elements in the iteration, from the soil's compressibility, m3/Pa.
  /// \param acts  `acting_shares`
  [[nodiscard]] std::vector<double> held_by_soil(const Eigen::VectorXd& acts,
                                                 const std::vector<double>& mean_mobility,
                                                 double dt) const;
  /// Share of the elements' pressure that acts on the soil: of suction, what `pressure_on_solid`
  /// takes.
  [[nodiscard]] Eigen::VectorXd acting_shares(const FlowSoils<Dim>& soils,
                                              const ElementField<Dim>& air,
                                              const std::vector<double>& porosity,
                                              const std::vector<double>& pressure) const;
  /// Expected rise of the pressure at faces in a step of `dt`, s, after the last one, Pa.
  [[nodiscard]] Eigen::VectorXd expected_rise(const PressureRise& last, double dt) const;

  // Pressures act on the motion where the held `storage` is not 0: in soil that can move, and in
  // free water next to it.

  /// Means of the values at the faces of each element.
  [[nodiscard]] Eigen::VectorXd at_elements(const Eigen::VectorXd& of_faces,
                                            const std::vector<double>& storage) const;
  /// Means of the values of the elements on both sides of a face.
  [[nodiscard]] Eigen::VectorXd at_faces(const Eigen::VectorXd& of_elements,
                                         const std::vector<double>& storage) const;
  /// The values at faces where pressures act on the motion, zero at others.
  [[nodiscard]] Eigen::VectorXd at_soil(const Eigen::VectorXd& of_faces,
                                        const std::vector<double>& storage) const;
  /// The limit in the present step. `pressure`: the largest one at its start, Pa;
  /// `tolerance`: see `FlowStart`.
  [[nodiscard]] Agreement agreement_at(double pressure, double tolerance) const;
  /// Initial guess for a load that drained soil cannot bear: pressures if almost no water leaves.
  /// None if undrained soil cannot bear it either. `pressure`: on the solid, per element, Pa.
  [[nodiscard]] std::optional<Eigen::VectorXd> undrained_rise(MotionStep<Dim>& step,
                                                              const std::vector<double>& pressure,
                                                              Eigen::VectorXd rise) const;
  /// Volume that crosses faces with the motion, without its air. Sets the porosity in `forcing` to
  /// that of `start` plus the volume that solid leaves.
  [[nodiscard]] std::vector<double> without_air(const SolidMotion& motion,
                                                const MixedState<Dim>& state,
                                                const FlowCoefficients<Dim>& start,
                                                const FlowSoils<Dim>& soils,
                                                FlowForcing<Dim>& forcing) const;
  /// \param moved  volume that crosses faces with the motion, m3
  [[nodiscard]] std::vector<double> source_of(const std::vector<double>& moved,
                                              const std::vector<double>& own, double dt) const;

  const Grid<Dim>& grid_;
  const MovingSkeleton<Dim>& solid_;
  int threads_;
};

/// Mass of liquid per volume of soil and element, kg/m3.
template <int Dim>
std::vector<double> liquid_mass(const Grid<Dim>& grid, const FlowCoefficients<Dim>& coefficients,
                                const ElementField<Dim>& air);

/// The pore pressure that acts on the skeleton, per element, Pa: suction is multiplied by the
/// effective saturation (Lu, Godt and Wu, Water Resour. Res. 46 (2010) W05515).
template <int Dim>
std::vector<double> pressure_on_solid(const Grid<Dim>& grid, const FlowSoils<Dim>& soils,
                                      std::vector<double> pressure,
                                      const std::vector<double>& porosity,
                                      const ElementField<Dim>& air);

}  // namespace suffuse
