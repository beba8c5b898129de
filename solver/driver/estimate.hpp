#pragma once

/// What a run will take: steps, wall time, memory and disk, estimated from a short trial of it.

#include <limits>
#include <string>
#include <vector>

#include "driver/plan.hpp"

namespace suffuse {

/// How long a trial may go on. It ends with the interval in which it reaches either bound.
struct TrialBudget {
  double seconds = 1.2;  ///< of wall time
  double share = 1.0;    ///< of the simulated time; a second trial may always go to the end
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
  long steady_steps = 0;       ///< of a second trial that starts with the steady flow; 0: none
  double trial_seconds = 0.0;  ///< of wall time
  bool whole = false;          ///< the trial reached the end
  bool over_budget = false;    ///< the first interval alone took longer than the budget
  std::string transport;       ///< which runs, and what the other would cost; empty: none
  std::string warning;         ///< of liquid points that have far to go; empty: none
  std::string failure;         ///< how the run failed in the trial; empty otherwise
};

/// Runs the case from its start for a while. Rows are made but not written; some twenty snapshots
/// at most are written into a temporary folder, for their bytes and seconds. The rest of the run
/// is extrapolated from the later half of the trial. Where that is still the start-up of the flow,
/// a second trial starts with the steady flow. `earlier`: what the run starts from, if any. Ends
/// early on an interrupt (see catch_interrupts).
template <int Dim>
Estimate estimate_run(const Case<Dim>& c, const Plan& plan, const TrialBudget& budget = {},
                      const EarlierState<Dim>* earlier = nullptr);

/// The lines that `--explain` prints.
std::vector<std::string> sentences(const Estimate& estimate, int threads);

}  // namespace suffuse
