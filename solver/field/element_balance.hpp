#pragma once

/// Fines in one element over one step of implicit transport, once it is known what enters: two
/// stages of the L-stable method of Alexander (SIAM J. Numer. Anal. 14 (1977) 1006) for the linear
/// concentration, limited towards one backward Euler step for its mean, which stays within bounds
/// whatever the length of the step. The exchange with the solid is part of the system.

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "field/element_sides.hpp"
#include "solid/skeleton.hpp"

namespace suffuse {

/// The first stage of the method: its time, as a share of the step.
inline constexpr double first_stage = 0.29289321881345247560;  // 1 - 1 / sqrt(2)

/// Concentrations at places of an element, at the first stage and at the end of the step.
template <int Dim>
struct StageValues {
  ElementValues<Dim> first;
  ElementValues<Dim> last;
};

/// What an element starts a step with.
template <int Dim>
struct ElementStart {
  int element;
  ElementValues<Dim> liquid;   ///< m3
  ElementValues<Dim> fines;    ///< m3
  double gained = 0.0;         ///< liquid that the flow brings within the step, m3
  ElementValues<Dim> outflow;  ///< through its sides within the step, m3
  UpwindPlaces<Dim> upwind;
  std::array<int, Dim + 1> neighbour;  ///< across each side; negative: none
};

/// Estimates of errors of a step, and what they compare with, m3 of fines.
struct StepErrors {
  double fines = 0.0;      ///< in a wrong element
  double exchange = 0.0;   ///< of what solid and liquid exchanged
  double held = 0.0;       ///< in the liquid at the end
  double exchanged = 0.0;  ///< with the solid, either way
  double entered = 0.0;    ///< from outside the model

  void add(const StepErrors& other) {
    fines += other.fines;
    exchange += other.exchange;
    held += other.held;
    exchanged += other.exchanged;
    entered += other.entered;
  }
};

/// Exchange at the solid points in a step.
template <int Dim>
struct SolidInStep {
  const Skeleton<Dim>& solid;
  const PointFlows& flows;
  double from;  ///< s
  double to;    ///< s
  bool exchanges = true;

  [[nodiscard]] double first_time() const { return from + first_stage * (to - from); }
  /// Just before its end: what starts there has not yet started.
  [[nodiscard]] double end() const { return to - 1e-9 * (to - from); }
};

template <int Dim>
class ElementBalance {
 public:
  explicit ElementBalance(const SoilMap<Dim>& soils);

  /// Solves for one element. `first` and `last`: values at the vertices of all elements and at
  /// outer faces, as `ElementSides` places them; those of this element are set. `exchange`: per
  /// solid point; those of this element are set. `slope`: the most of the linear solution that may
  /// be kept; becomes what was kept.
  StepErrors solve(const ElementStart<Dim>& start, const SolidInStep<Dim>& solid, double& slope,
                   std::vector<double>& first, std::vector<double>& last,
                   std::vector<Exchange>& exchange);

 private:
  using Values = Eigen::Matrix<double, Dim + 1, 1>;
  using Matrix = Eigen::Matrix<double, Dim + 1, Dim + 1>;

  /// One stage: (liquid + s) c - first_stage moved c = known + s, where s is what points give.
  struct Stage {
    Values liquid;
    Values known;
  };
  struct Range {
    double low;
    double high;
    [[nodiscard]] bool includes(double value) const { return value >= low && value <= high; }
    void include(double value) {
      low = std::min(low, value);
      high = std::max(high, value);
    }
  };
  using SideMatrix = Eigen::Matrix<double, Dim + 1, Dim>;
  /// What transport adds to an element's fines at its nodes, per m3 that leaves through a side.
  struct SideMatrices {
    Matrix inside;      ///< by c at the nodes, where liquid enters there
    Matrix outflow;     ///< by c at the nodes, where liquid leaves
    SideMatrix inflow;  ///< by c at the nodes of the side, where it enters
  };

  void find_points(const ElementStart<Dim>& start, const SolidInStep<Dim>& solid);
  /// What transport adds, by what enters and by what is in the element.
  void find_moved(const ElementStart<Dim>& start, const std::vector<double>& first,
                  const std::vector<double>& last);
  /// Exchange at each point of the element since the start of the step, if the concentration at the
  /// nodes is `c` at this stage. False where the point's own equation has no solution.
  [[nodiscard]] bool find_exchange(const SolidInStep<Dim>& solid, bool is_last, const Values& c);
  [[nodiscard]] Values spread(const std::vector<Exchange>& exchange) const;
  /// False where its iteration does not converge.
  [[nodiscard]] bool solve_stage(const SolidInStep<Dim>& solid, const Stage& stage, bool is_last,
                                 Values& c);
  /// The linear solution; false where there is none.
  bool solve_linear(const ElementStart<Dim>& start, const SolidInStep<Dim>& solid,
                    StepErrors& errors);
  /// The mean by one backward Euler step.
  [[nodiscard]] double solve_mean(const ElementStart<Dim>& start, const SolidInStep<Dim>& solid);
  /// What values at vertices may be: between those that were there, those that enter and the means
  /// where these come from, and beyond them by what the element itself gives and takes.
  [[nodiscard]] Range allowed(const ElementStart<Dim>& start) const;
  /// Whether the linear solution is.
  [[nodiscard]] bool is_within(const Range& range) const;
  /// The most of the linear solution's deviation from `mean` that stays within `range`.
  [[nodiscard]] double slope_within(const Range& range, double mean) const;

  const SoilMap<Dim>& soils_;
  std::array<SideMatrices, Dim + 1> by_side_;
  // Values of the element that is solved.
  int begin_ = 0;
  int end_ = 0;
  bool exchanges_ = false;
  bool coupled_ = false;          ///< exchange depends on the concentration
  std::vector<Values> basis_;     ///< per point: basis functions there
  std::vector<Exchange> now_;     ///< per point, per volume of soil
  std::vector<Exchange> linear_;  ///< per point: of the linear solution
  std::vector<double> slope_;     ///< per point: of the net exchange by c
  std::vector<Exchange> first_;   ///< per point: up to the first stage
  std::vector<double> guess_;     ///< per point: what porosity gains up to there
  Values given_;                  ///< by the points to the liquid, per node, m3
  Matrix moved_;                  ///< what transport adds per node, by c at nodes
  Values first_load_;     ///< what transport adds per node, by what enters: at the first stage
  Values last_load_;      ///< and at the last
  double entered_ = 0.0;  ///< fines, over the step, m3
  double outflow_ = 0.0;  ///< of liquid through all sides that it leaves by, m3
  Range entering_{};      ///< of the concentrations that enter
  StageValues<Dim> at_vertices_;  ///< of the linear solution
};

}  // namespace suffuse
