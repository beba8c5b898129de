#include "tools/rank_trial.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>

#include "common/errors.hpp"
#include "driver/interrupt.hpp"
#include "driver/memory.hpp"
#include "driver/rank_refusals.hpp"
#include "driver/run_loop.hpp"
#include "driver/source_run.hpp"
#include "driver/stopwatch.hpp"
#include "ranks/launch_ranks.hpp"
#include "ranks/local_part.hpp"

namespace suffuse {
namespace {

/// A trial whose steps are not given ends after `fewest_tried_steps` and `enough_seconds` of wall
/// time, or after `most_seconds`.
constexpr long fewest_tried_steps = 3;
constexpr double enough_seconds = 3.0;
constexpr double most_seconds = 15.0;
/// A step may take that much longer with fewer ranks.
constexpr double nearly_as_fast = 1.1;

constexpr double megabyte = 1e6;
constexpr const char* line_format =
    "trial on %d rank%s: %ld step%s, %.3g s each, %.0f MB of memory in all, %.0f MB in the largest "
    "process";
constexpr const char* line_pattern =
    "trial on %d rank%*[s:] %ld step%*[s,] %lf s each, %lf MB of memory in all, %lf MB";

}  // namespace

template <int Dim>
RankTrial try_ranks(const Case<Dim>& c, const Plan& plan, const SolverOptions& options,
                    long steps) {
  const Ranks& ranks = *options.ranks;
  if (ranks.count() > 1) refuse_on_ranks(c);
  std::optional<SourceRun<Dim>> source;
  together(ranks, [&] { source = read_source_run(c, options); });
  const OwnPart<Dim> own = own_part(c, options.ranks);
  ModelOptions model_options = plan;
  model_options.part = own.part;
  RunLoop<Dim> loop(own.own ? *own.own : c, model_options, source ? &source->state : nullptr);
  TwoPhaseModel<Dim>& model = loop.model();
  const double end = c.document.scene.time.end;
  const Stopwatch watch;
  const auto is_enough = [&] {
    if (steps > 0) return model.steps() >= steps;
    const double passed = watch.seconds();
    return passed >= most_seconds ||
           (passed >= enough_seconds && model.steps() >= fewest_tried_steps);
  };
  // The clock of rank 0 decides.
  const auto stops = [&] {
    return any_of_all(ranks, (ranks.rank() == 0 && is_enough()) || interrupted());
  };
  while (model.time() < end && !stops()) model.advance(end);
  RankTrial result{.ranks = ranks.count(), .steps = model.steps()};
  result.seconds = watch.seconds() / static_cast<double>(std::max(model.steps(), 1L));
  Snapshot output = model.snapshot(model.flow_state());
  output.restart = loop.restart_point();
  result.memory = sum_of_all(ranks, peak_memory());
  result.largest = largest_of_all(ranks, peak_memory());
  return result;
}

std::string sentence(const RankTrial& trial) {
  std::array<char, 256> line{};
  std::snprintf(line.data(), line.size(), line_format, trial.ranks, trial.ranks == 1 ? "" : "s",
                trial.steps, trial.steps == 1 ? "" : "s", trial.seconds, trial.memory / megabyte,
                trial.largest / megabyte);
  return line.data();
}

RankTrial rank_trial_of(const std::string& text) {
  const std::size_t at = text.find("trial on ");
  RankTrial trial;
  if (at == std::string::npos ||
      std::sscanf(text.c_str() + at, line_pattern, &trial.ranks, &trial.steps, &trial.seconds,
                  &trial.memory, &trial.largest) != 5) {
    throw NumericalError("a trial on ranks has ended without an answer");
  }
  trial.memory *= megabyte;
  trial.largest *= megabyte;
  return trial;
}

RankTrial recommended(const std::vector<RankTrial>& trials) {
  const auto fastest = std::ranges::min_element(trials, {}, &RankTrial::seconds);
  return *std::ranges::find_if(trials, [&](const RankTrial& trial) {
    return trial.seconds <= nearly_as_fast * fastest->seconds;
  });
}

std::vector<std::string> compare_ranks(int most, const std::vector<std::string>& arguments) {
  std::vector<std::string> lines;
  std::vector<RankTrial> trials;
  long steps = 0;
  for (int ranks = 1;; ranks = std::min(2 * ranks, most)) {
    std::vector<std::string> words = arguments;
    words.push_back("--trial=" + std::to_string(steps));
    std::string output;
    const int code = launch_ranks(ranks, words, &output);
    if (code == static_cast<int>(ExitCode::interrupted)) return lines;
    if (code != static_cast<int>(ExitCode::done)) {
      throw NumericalError("the trial on " + std::to_string(ranks) +
                           " ranks has failed, for the reason above");
    }
    trials.push_back(rank_trial_of(output));
    steps = std::max(trials.back().steps, 1L);
    lines.push_back(sentence(trials.back()));
    if (ranks == most) break;
  }
  const RankTrial best = recommended(trials);
  std::array<char, 32> share{};
  std::snprintf(share.data(), share.size(), "%.2f", best.seconds / trials.front().seconds);
  lines.push_back(best.ranks == 1
                      ? "recommended on this machine: one process, no ranks"
                      : "recommended on this machine: --ranks " + std::to_string(best.ranks) +
                            ", steps take " + share.data() + " of their time in one process");
  return lines;
}

template RankTrial try_ranks(const Case<2>&, const Plan&, const SolverOptions&, long);
template RankTrial try_ranks(const Case<3>&, const Plan&, const SolverOptions&, long);

}  // namespace suffuse
