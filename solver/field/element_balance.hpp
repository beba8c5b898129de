#pragma once

/// Fines in one element over one step of implicit transport with known inflow: two stages of the
/// L-stable method of Alexander (SIAM J. Numer. Anal. 14 (1977) 1006) for the linear concentration,
/// limited towards one backward Euler step for its mean, which stays within bounds for any length
/// of the step. The exchange with the solid is part of the system.

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

/// State and flow of an element for a step.
template <int Dim>
struct ElementStart {
  int element;
  ElementValues<Dim> liquid;   ///< m3
  ElementValues<Dim> fines;    ///< m3
  double gained = 0.0;         ///< liquid that the element gains in the step, m3
  ElementValues<Dim> outflow;  ///< through its sides in the step, m3
  UpwindPlaces<Dim> upwind;
  std::array<int, Dim + 1> neighbour;  ///< across each side; negative: none
};

/// Error estimates of a step and their reference values, m3 of fines.
struct StepErrors {
  double fines = 0.0;      ///< error of the fines in elements
  double exchange = 0.0;   ///< error of the exchange with the solid
  double held = 0.0;       ///< fines in the liquid at the end
  double exchanged = 0.0;  ///< absolute exchange with the solid
  double entered = 0.0;    ///< fines from outside the model
};

/// Their sums over elements, exact: the same in any order and on any number of ranks.
struct StepErrorSums {
  ExactSum fines;
  ExactSum exchange;
  ExactSum held;
  ExactSum exchanged;
  ExactSum entered;

  void add(const auto& other) {
    fines.add(other.fines);
    exchange.add(other.exchange);
    held.add(other.held);
    exchanged.add(other.exchanged);
    entered.add(other.entered);
  }
  [[nodiscard]] StepErrors of_all(const Ranks& ranks) {
    ranks.sum({&fines, &exchange, &held, &exchanged, &entered});
    return {fines.value(), exchange.value(), held.value(), exchanged.value(), entered.value()};
  }
};

/// The solid in a step, for its exchange.
template <int Dim>
struct SolidInStep {
  const Skeleton<Dim>& solid;
  const PointFlows& flows;
  double from;  ///< s
  double to;    ///< s
  bool exchanges = true;

  [[nodiscard]] double first_time() const { return from + first_stage * (to - from); }
  /// Just before the end, so that erosion that starts there is not included.
  [[nodiscard]] double end() const { return to - 1e-9 * (to - from); }
};

template <int Dim>
class ElementBalance {
 public:
  explicit ElementBalance(const SoilMap<Dim>& soils);

  /// Solves for one element; sets its values in `first` and `last` (values at the vertices of all
  /// elements and at outer faces, in the order of `ElementSides`) and in `exchange` (per solid
  /// point). `slope`: largest allowed share of the linear solution; becomes the share taken.
  StepErrors solve(const ElementStart<Dim>& start, const SolidInStep<Dim>& solid, double& slope,
                   std::vector<double>& first, std::vector<double>& last,
                   std::vector<Exchange>& exchange);

 private:
  using Values = Eigen::Matrix<double, Dim + 1, 1>;
  using Matrix = Eigen::Matrix<double, Dim + 1, Dim + 1>;

  /// One stage: (liquid + s) c - first_stage moved c = known + s, s: fines from the points.
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
  /// Gain of fines at the nodes of an element by transport, per m3 of outflow through a side.
  struct SideMatrices {
    Matrix inside;      ///< coefficients of c at the nodes, for inflow
    Matrix outflow;     ///< coefficients of c at the nodes, for outflow
    SideMatrix inflow;  ///< coefficients of c at the nodes of the side, for inflow
  };

  void find_points(const ElementStart<Dim>& start, const SolidInStep<Dim>& solid);
  /// Finds the gain by transport for entering concentrations and those of the element.
  void find_moved(const ElementStart<Dim>& start, const std::vector<double>& first,
                  const std::vector<double>& last);
  /// Finds the exchange at each point since the start of the step for the concentration `c` at the
  /// nodes at this stage. False if the equation of a point has no solution.
  [[nodiscard]] bool find_exchange(const SolidInStep<Dim>& solid, bool is_last, const Values& c);
  [[nodiscard]] Values spread(const std::vector<Exchange>& exchange) const;
  /// Solves a stage for `c`. False if the iteration does not converge.
  [[nodiscard]] bool solve_stage(const SolidInStep<Dim>& solid, const Stage& stage, bool is_last,
                                 Values& c);
  /// Finds the linear solution; false if there is none.
  bool solve_linear(const ElementStart<Dim>& start, const SolidInStep<Dim>& solid,
                    StepErrors& errors);
  /// Finds the mean by one backward Euler step.
  [[nodiscard]] double solve_mean(const ElementStart<Dim>& start, const SolidInStep<Dim>& solid);
  /// Allowed range of values at vertices: that of the earlier values, the entering values and the
  /// upwind means, extended by the exchange in the element.
  [[nodiscard]] Range allowed(const ElementStart<Dim>& start) const;
  /// Whether the linear solution is within `range`.
  [[nodiscard]] bool is_within(const Range& range) const;
  /// Largest share of the linear solution's deviation from `mean` that stays within `range`.
  [[nodiscard]] double slope_within(const Range& range, double mean) const;

  const SoilMap<Dim>& soils_;
  std::array<SideMatrices, Dim + 1> by_side_;
  // Values of the current element.
  int begin_ = 0;
  int end_ = 0;
  bool exchanges_ = false;
  bool coupled_ = false;          ///< exchange depends on the concentration
  std::vector<Values> basis_;     ///< per point: basis functions there
  std::vector<Exchange> now_;     ///< per point, per volume of soil
  std::vector<Exchange> linear_;  ///< per point: exchange of the linear solution
  std::vector<double> slope_;     ///< per point: d(net exchange) / dc
  std::vector<Exchange> first_;   ///< per point: exchange until the first stage
  std::vector<double> guess_;     ///< per point: gain of porosity until the first stage
  Values given_;                  ///< fines from the points to the liquid, per node, m3
  Matrix moved_;                  ///< gain by transport per node: coefficients of c at nodes
  Values first_load_;             ///< gain per node by entering liquid, at the first stage
  Values last_load_;              ///< gain per node by entering liquid, at the last stage
  double entered_ = 0.0;          ///< fines that enter in the step, m3
  double outflow_ = 0.0;          ///< liquid that leaves in the step, m3
  Range entering_{};              ///< of the entering concentrations
  StageValues<Dim> at_vertices_;  ///< of the linear solution
};

}  // namespace suffuse
