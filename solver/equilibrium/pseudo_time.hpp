#pragma once

/// Decides whether soil under constant loads comes to rest or fails.

#include <algorithm>
#include <functional>
#include <vector>

#include "equilibrium/force_balance.hpp"
#include "linear/newton_system.hpp"

namespace suffuse {

enum class Settling {
  rests,      ///< forces balance, or the soil moves very slowly
  runs_away,  ///< displacements have exceeded the limit, or grow at a constant speed
  undecided   ///< neither, when steps or iterations ran out
};

/// Length of the longest vector.
template <int Dim>
double largest_length(const NodeVectors<Dim>& vectors) {
  double result = 0.0;
  for (const Vector<Dim>& v : vectors) result = std::max(result, v.norm());
  return result;
}

template <int Dim>
struct SettlingLimits {
  /// Largest residual of soil at rest, over the forces of the elements and the loads together.
  double tolerance = 1e-9;
  /// Size of a displacement from the start that counts as running away.
  double far = 0.0;
  /// Speed, as a size per unit of pseudo-time, up to which soil counts as at rest when the
  /// iterations end; faster soil that did not slow down runs away. 0: it is not judged so.
  double slow = 0.0;
  /// The size of a displacement, to which `far` and `slow` refer: by default that of the node that
  /// moves most, m. A caller may divide it by a length.
  std::function<double(const NodeVectors<Dim>&)> size = largest_length<Dim>;
  /// Iterations of Newton's method, in all steps.
  int max_iterations = 400;
};

template <int Dim>
struct SettledSoil {
  Settling end = Settling::undecided;
  NodeVectors<Dim> displacement;  ///< m
  NodeVectors<Dim> motion;        ///< displacement in the last step of pseudo-time, m
  double residual = 0.0;          ///< as in `SettlingLimits::tolerance`
  int iterations = 0;             ///< of Newton's method
  int worst_node = -1;            ///< node with the largest unbalanced force
};

/// Follows the soil in a pseudo-time t in which its elastic stiffness K also acts as viscosity,
///
///     K du/dt = loads - forces(u),
///
/// by backward Euler in steps that grow as long as Newton's method converges in few iterations
/// (pseudo-transient continuation: Kelley and Keyes, SIAM J. Numer. Anal. 35 (1998) 508; its use
/// for soil: Griffiths and Lane, Geotechnique 49 (1999) 387, with viscoplastic strains). For a
/// perfectly plastic body with associated flow this is the path of steepest descent of a convex
/// energy: it ends at an equilibrium if there is one; otherwise the forces that no stress can
/// balance make displacements grow in proportion to t. Soil without associated flow has no such
/// energy, but trials show the same two ends. Its forces may go on to alternate about a state that
/// they do not leave, or its steps remain short: the motion in the second half of the iterations
/// then decides.
template <int Dim>
class PseudoTime {
 public:
  /// Keeps references. Throws NumericalError when nothing holds the soil.
  /// \param loads  per node, N
  PseudoTime(ForceBalance<Dim>& equilibrium, const NodeVectors<Dim>& loads);

  /// Leaves the equilibrium displaced by the result.
  /// \param start  displacement to start from, m, which must be possible
  SettledSoil<Dim> settle(NodeVectors<Dim> start, const SettlingLimits<Dim>& limits);

 private:
  [[nodiscard]] Eigen::VectorXd unbalanced() const;
  [[nodiscard]] Eigen::VectorXd moved_by(const NodeVectors<Dim>& displacement) const;
  [[nodiscard]] NodeVectors<Dim> predicted() const;
  bool take(const NodeVectors<Dim>& displacement, Eigen::VectorXd& defect);
  bool step(int max_iterations);
  bool improve(Eigen::VectorXd& defect);
  void judge(const SettlingLimits<Dim>& limits);
  /// Judges by the motion over the second half of the iterations.
  void judge_motion(const SettlingLimits<Dim>& limits);

  /// Present displacement from an earlier one, m.
  [[nodiscard]] NodeVectors<Dim> way_from(const NodeVectors<Dim>& earlier) const;

  /// A state on the way.
  struct Sample {
    double time = 0.0;
    NodeVectors<Dim> displacement;  ///< m
  };

  ForceBalance<Dim>& equilibrium_;
  const NodeVectors<Dim>& loads_;
  NewtonSystem system_;
  Eigen::SparseMatrix<double> elastic_;
  Eigen::SparseMatrix<double> matrix_;
  SettledSoil<Dim> soil_;        ///< at the end of the last step
  NodeVectors<Dim> start_;       ///< displacement, m
  NodeVectors<Dim> trial_;       ///< displacement in the iterations of a step, m
  Eigen::VectorXd unbalanced_;   ///< forces at the start of the step
  double length_ = 1.0;          ///< of the step, in pseudo-time
  double last_length_ = 0.0;     ///< of the last step; 0: none
  double time_ = 0.0;            ///< since the start
  std::vector<Sample> samples_;  ///< after a half and three quarters of the iterations
  int step_iterations_ = 0;      ///< of the step
};

}  // namespace suffuse
