#pragma once

/// What a run will take: steps, wall time, memory and disk, from a short trial of it in memory.

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
  double disk = 0.0;     ///< the results folder, bytes; NaN: nothing could be written for a try
  long snapshots = 0;
  long rows = 0;  ///< of each table

  // What it rests on.
  long trial_steps = 0;
  double trial_time = 0.0;     ///< simulated, s
  long steady_steps = 0;       ///< of a second trial that began with the steady flow; 0: none
  double trial_seconds = 0.0;  ///< of wall time
  bool whole = false;          ///< the trial reached the end
  bool over_budget = false;    ///< not even one interval fitted the budget
  std::string failure;         ///< how the run failed in the trial; empty otherwise
};

/// Runs the case from its start for a while, with the outputs that it would make computed but not
/// written, and writes the first and the last of them into a temporary folder, removed afterwards.
/// The rest is extrapolated from the latter part of the trial; when that is
/// still the start-up of the flow, from a second trial that begins with the steady flow. Ends early
/// on an interrupt (see catch_interrupts).
template <int Dim>
Estimate estimate_run(const Case<Dim>& c, const Plan& plan, const TrialBudget& budget = {});

/// Sentences for people.
std::vector<std::string> sentences(const Estimate& estimate, int threads);

/// 1.23e7 -> "12 MB": two or three digits, decimal units.
std::string bytes_text(double bytes);

}  // namespace suffuse
