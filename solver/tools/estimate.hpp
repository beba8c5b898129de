#pragma once

/// What a run will take: steps, wall time, memory and disk, estimated from a short trial of it.

#include <limits>
#include <string>
#include <vector>

#include "driver/plan.hpp"

namespace suffuse {

/// How long an estimate may take, wall time in s. A trial ends with the interval in which it
/// reaches `seconds` or `share`.
struct TrialBudget {
  double seconds = 1.2;
  double share = 1.0;               ///< of the simulated time
  double ahead = 3.8;               ///< to look at the rest of the run
  double ahead_if_expensive = 7.0;  ///< to look at the rest where steps take long
  double patience = 9.5;            ///< for all of it; steps that take longer are broken off
};

struct Estimate {
  double steps = 0.0;    ///< of the flow, as in run.json
  double seconds = 0.0;  ///< of wall time
  double memory = 0.0;   ///< largest resident set, bytes
  /// The results folder, bytes; NaN where no file could be written to measure it.
  double disk = std::numeric_limits<double>::quiet_NaN();
  long snapshots = 0;

  // What it rests on.
  long trial_steps = 0;
  double trial_time = 0.0;     ///< simulated, s
  long pilot_steps = 0;        ///< long ones, of a look ahead (tools/pilot.hpp)
  double trial_seconds = 0.0;  ///< of wall time
  bool whole = false;          ///< the trial reached the end
  bool over_budget = false;    ///< the first interval alone took longer than the budget
  double pilot_time = 0.0;     ///< simulated, that they reach, s
  bool too_short = false;      ///< too few steps ended in time: there is no estimate
  std::string transport;       ///< which runs, and what the other would cost; empty: none
  std::string warning;         ///< of liquid points that have far to go; empty: none
  std::string failure;         ///< how the run failed in the trial; empty otherwise
};

/// Runs the case from its start for a while. Rows are made but not written; some twenty snapshots
/// at most are written into a temporary folder, for their bytes and seconds. Where steps keep a
/// tolerance, a pilot then looks at the rest of the run. What neither has met is extrapolated from
/// the later half of what they have. `earlier`: what the run starts from, if any. Ends early on an
/// interrupt (see catch_interrupts).
template <int Dim>
Estimate estimate_run(const Case<Dim>& c, const Plan& plan, const TrialBudget& budget = {},
                      const EarlierState<Dim>* earlier = nullptr);

/// The lines that `--explain` prints.
std::vector<std::string> sentences(const Estimate& estimate, int threads);

}  // namespace suffuse
