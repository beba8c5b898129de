#pragma once

/// Cost of a run: steps, wall time, memory and disk, estimated from a short trial.

#include <limits>
#include <string>
#include <vector>

#include "driver/plan.hpp"

namespace suffuse {

/// Limits of an estimate, wall time in s. A trial ends after the interval in which it reaches
/// `seconds` or `share`.
struct TrialBudget {
  double seconds = 1.2;
  double share = 1.0;               ///< of the simulated time
  double ahead = 3.8;               ///< for the pilot
  double ahead_if_expensive = 7.0;  ///< for the pilot if steps are expensive
  double patience = 9.5;            ///< for all; longer steps are aborted
};

struct Estimate {
  double steps = 0.0;    ///< of the flow, as in run.json
  double seconds = 0.0;  ///< of wall time
  double memory = 0.0;   ///< largest resident set, bytes
  /// Size of the results folder, bytes; NaN if no file could be written to measure it.
  double disk = std::numeric_limits<double>::quiet_NaN();
  long snapshots = 0;

  // Basis of the estimate.
  long trial_steps = 0;
  double trial_time = 0.0;     ///< simulated, s
  long pilot_steps = 0;        ///< long steps of the pilot (tools/pilot.hpp)
  double trial_seconds = 0.0;  ///< of wall time
  bool whole = false;          ///< the trial reached the end
  bool over_budget = false;    ///< the first interval alone took longer than the budget
  double pilot_time = 0.0;     ///< simulated time that the pilot reaches, s
  bool too_short = false;      ///< too few steps ended in time: there is no estimate
  std::string transport;       ///< the scheme used and the cost of the other; empty: none
  std::string warning;         ///< of liquid points that cross many elements; empty: none
  std::string failure;         ///< failure of the run in the trial; empty: none
};

/// Runs a trial of the case from its start. Rows are computed but not written; at most about twenty
/// snapshots are written into a temporary folder, to measure their size and time. If steps keep a
/// tolerance, a pilot then explores the rest of the run. The remaining time is extrapolated from
/// the later half of the explored time. `earlier`: the initial state from another run, if any. Ends
/// early on an interrupt (see catch_interrupts).
template <int Dim>
Estimate estimate_run(const Case<Dim>& c, const Plan& plan, const TrialBudget& budget = {},
                      const EarlierState<Dim>* earlier = nullptr);

/// The lines that `--explain` prints.
std::vector<std::string> sentences(const Estimate& estimate, int threads);

}  // namespace suffuse
