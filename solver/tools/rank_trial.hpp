#pragma once

/// What a run costs on several ranks: its first steps on each number of them.

#include <string>
#include <vector>

#include "driver/plan.hpp"

namespace suffuse {

/// The first steps of a run.
struct RankTrial {
  int ranks = 1;
  long steps = 0;
  double seconds = 0.0;  ///< wall time of a step, without outputs
  double memory = 0.0;   ///< largest resident sets of all processes together, bytes
  double largest = 0.0;  ///< that of the largest process, bytes
};

/// Makes the first `steps` steps of a run, or those of some seconds where it is 0, and an output
/// that is not written. All ranks have to call it. Throws InputError for what cannot run on ranks,
/// NumericalError if the run fails.
template <int Dim>
RankTrial try_ranks(const Case<Dim>& c, const Plan& plan, const SolverOptions& options, long steps);

/// The line of a trial, and the trial of a text with such a line. Throws NumericalError for a text
/// without.
std::string sentence(const RankTrial& trial);
RankTrial rank_trial_of(const std::string& text);

/// Tries the case on 1, 2, 4, and so on, up to `most` ranks of this machine, by
/// suffuse-solver-mpi with `arguments`. Returns a line for each, and how many to take; after an
/// interrupt those so far. Throws NumericalError if a trial fails.
std::vector<std::string> compare_ranks(int most, const std::vector<std::string>& arguments);

/// The trial on the fewest ranks that are nearly as fast as any.
RankTrial recommended(const std::vector<RankTrial>& trials);

}  // namespace suffuse
