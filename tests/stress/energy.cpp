#include "stress/energy.hpp"

#include <chrono>
#include <iostream>
#include <ostream>
#include <sstream>

#include "solver/scheme_energy.hpp"
#include "stress/judge.hpp"
#include "stress/stress_mesh.hpp"

namespace suffuse::stress {
namespace {

constexpr unsigned seeds = 20;
/// Largest drift over the energy at the start: sums of a few hundred terms over some thousand
/// steps.
constexpr double max_drift = 1e-11;
/// Largest growth in a step over the energy before it.
constexpr double max_growth = 1e-12;

struct Box {
  model::BoxSettings settings;
  double share_of_limit = 0.0;
  double dt = 0.0;
};

/// A box with random numbers for all settings of the sweep.
Box random_box(unsigned seed) {
  Random random(seed + 300);
  Box box;
  box.settings.seed = seed;
  box.settings.jitter = random.between(0.0, 0.07);
  box.settings.conductivity = random.decades(1e-9, 1e3);
  box.settings.bulk_modulus = random.decades(2e5, 2e9);
  box.settings.mass_scaling = random.chance(0.5) ? 1.0 : random.decades(1.0, 1e6);
  box.settings.gap = random.between(0.0, 0.98);
  box.settings.convects = random.chance(0.5);
  box.share_of_limit = random.between(0.5, 0.99);
  box.dt = random.decades(1e-7, 1e2);
  return box;
}

std::string words(const Box& box) {
  std::ostringstream text;
  text.precision(3);
  text << "k " << box.settings.conductivity << "; K " << box.settings.bulk_modulus << "; S "
       << box.settings.mass_scaling;
  return text.str();
}

class EnergySweep {
 public:
  explicit EnergySweep(std::ostream& table) : table_(table) {}

  template <class Run>
  void judge(Scheme scheme, const std::string& what, const Box& box, bool conserves,
             const Run& run) {
    Scenario scenario;
    scenario.scheme = scheme;
    scenario.parameters = what + "; " + words(box);
    scenario.seed = box.settings.seed;
    Judgement result;
    const auto start = std::chrono::steady_clock::now();
    model::SealedBox released(box.settings);
    const model::EnergyChange change = run(released);
    result.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    result.residual = conserves ? change.drift : std::max(0.0, change.growth);
    const bool holds =
        change.finite && (conserves ? change.drift <= max_drift : change.growth <= max_growth);
    result.verdict = holds ? "pass" : "failed";
    if (!holds) {
      std::ostringstream text;
      text << "energy " << (conserves ? "drifts by " : "grows by ") << result.residual;
      result.message = text.str();
      std::cerr << "energy (" << scenario.parameters << ", seed " << scenario.seed
                << "): " << result.message << '\n';
      ++failed_;
    }
    table_ << table_line("energy", scenario, result) << '\n';
  }
  [[nodiscard]] int failed() const { return failed_; }

 private:
  std::ostream& table_;
  int failed_ = 0;
};

}  // namespace

std::string energy_sweep_is() {
  return "a sealed box at random let go from a random pressure: the scheme's own energy, every "
         "step";
}

int run_energy_sweep(std::ostream& table) {
  constexpr int steps = 2000;
  EnergySweep sweep(table);
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    Box box = random_box(seed);
    for (const auto drag : {DragIntegration::explicit_drag, DragIntegration::implicit_drag}) {
      box.settings.drag = drag;
      const std::string stepped =
          drag == DragIntegration::explicit_drag ? "drag explicit" : "drag implicit";
      sweep.judge(Scheme::sp_explicit, stepped, box, false, [&](model::SealedBox& released) {
        return released.run_explicit(box.share_of_limit, steps);
      });
    }
    Box free = box;
    free.settings.conductivity = std::numeric_limits<double>::infinity();
    sweep.judge(Scheme::sp_explicit, "no drag", free, true, [&](model::SealedBox& released) {
      return released.run_explicit(box.share_of_limit, steps);
    });
    for (const auto stepping : {TimeStepping::second_order, TimeStepping::monotone}) {
      const Scheme scheme =
          stepping == TimeStepping::monotone ? Scheme::sp_monotone : Scheme::sp_implicit;
      for (const bool inertia : {false, true}) {
        sweep.judge(scheme, inertia ? "with inertia" : "without inertia", box, false,
                    [&](model::SealedBox& released) {
                      return released.run_implicit(stepping, inertia, box.dt, 20);
                    });
      }
    }
  }
  return sweep.failed();
}

}  // namespace suffuse::stress
