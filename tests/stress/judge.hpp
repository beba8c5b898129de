#pragma once

/// What must hold of every result, whatever the scene.

#include <string>

#include "stress/child.hpp"
#include "stress/scenario.hpp"

namespace suffuse::stress {

/// The judgement of one run; a line of the table.
struct Judgement {
  std::string verdict;  ///< pass, refused or failed
  std::string message;  ///< of the refusal, or the violated conditions
  int exit_code = 0;
  int warnings = 0;
  double residual = 0.0;   ///< largest of the ledger
  double overshoot = 0.0;  ///< largest `pressure_overshoot`
  bool bounded = false;    ///< pressures are promised to stay within their bounds
  double concentration_min = 0.0;
  double concentration_max = 0.0;
  double fitted_min = 0.0;  ///< of the fitted field of double-point snapshots: not judged
  double volume_defect = 0.0;
  double eos_error = 0.0;  ///< largest of the history: single-point, implicit
  double misfit = 0.0;     ///< of stored water and pores, over all pores: largest of snapshots
  double discharge_error = 0.0;  ///< where it is known; relative
  double porosity_error = 0.0;   ///< of the mean porosity, where it is known
  double steps = 0.0;
  double solutions = 0.0;  ///< of linear systems; implicit
  double seconds = 0.0;
};

/// The mesher refused the scenario.
Judgement judge_refusal(const Scenario& scenario, const std::string& message);
/// The solver ran the case `c` into `folder` and ended as `end` says.
template <int Dim>
Judgement judge_run(const Scenario& scenario, const Case<Dim>& c, const ChildEnd& end,
                    const std::string& folder);

/// Judges a reduction of strength that wrote `tables`: with the strength of the scenario, and with
/// the scaled one. The second does not run if the first ended without a factor.
Judgement judge_strength(const Scenario& scenario, const std::vector<ChildEnd>& ends,
                         const std::vector<std::string>& tables);

/// One line of the table, and its first line.
std::string table_line(const std::string& sweep, const Scenario& scenario,
                       const Judgement& judgement);
std::string table_head();

}  // namespace suffuse::stress
