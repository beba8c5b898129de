#include "coupling/coupled_flow.hpp"

#include <algorithm>
#include <sstream>

#include "mixed/implicit_thresholds.hpp"
#include "motion/compressed_soil.hpp"

namespace suffuse {
namespace {

/// Throws EquilibriumLost if the step leaves soil without pores.
template <int Dim>
void check_pores(const Grid<Dim>& grid, const MovingSkeleton<Dim>& solid,
                 const MotionStep<Dim>& step) {
  refuse_compressed<Dim>(grid, solid.soils(),
                         {solid.points(), solid.state().solid_volumes(), solid.initial_porosity(),
                          step.equilibrium->law_increments(), step.forcing.end});
}

}  // namespace

template <int Dim>
CoupledStep<Dim> FlowOfMovingSolid<Dim>::solve(const FlowInterval<Dim>& interval) {
  const PassTimer timer(flow_.timing());
  const double longest = std::min(interval.longest, solid_.longest_step());
  const FlowInterval<Dim> ahead{interval.start, interval.latest, longest, interval.pores};
  CoupledStep<Dim> step{flow_.propose(ahead), std::nullopt, rise_};
  for (;;) {
    ++flow_.timing().calls;
    flow_.set_forcing(ahead, step.flow);
    const double end = step.flow.start + step.flow.dt;
    const auto find = [&] {
      return both_.solve(
          flow_.scheme(),
          {flow_.mixed_state(), flow_.pressure(), tolerance_ * flow_.pressure_scale()},
          {.end = end,
           .duration = step.flow.dt,
           .porosity = interval.pores.of_points_at(end),
           .longest_travel = failure_.longest_travel()},
          step);
    };
    std::optional<Unsolved> why = find();
    const bool accepted = !why && flow_.accepts(ahead, step.flow);
    for (int repeat = 0; repeat < implicit_thresholds.expansion_repeats; ++repeat) {
      if (!accepted || why || !flow_.let_out_expansion(step.flow)) break;
      why = find();
    }
    if (why) failure_.count_unsolved(step.flow.start);
    if (why && !flow_.is_shortest(step.flow) && !failure_.is_stuck()) {
      flow_.reject(step.flow);
    } else if (why) {
      failure_.step_unsolved(step.flow.start, *why);
      flow_.plan_anew(ahead, step.flow);
    } else if (accepted) {
      check_pores(grid_, solid_, *step.motion);
      return step;
    }
  }
}

template <int Dim>
FlowProgress FlowOfMovingSolid<Dim>::commit(CoupledStep<Dim> step) {
  const double duration = step.flow.dt;
  if (failure_.has_inertia()) {
    failure_.finish_motion(duration, solid_.take_velocities(*step.motion));
  }
  const FlowForcing<Dim>& forcing = step.flow.forcing.back();
  ElementPores pores =
      element_pores(grid_, solid_.element_porosity(), forcing.coefficients.porosity,
                    flow_.scheme().soils().soil_share);
  check_gaps(pores, step.flow.start);
  const auto [motion, kinetics] = solid_.commit(*std::move(step.motion));
  step.flow.relative = step.flow.found.face_volume;
  step.flow.room_gained = move_liquid(grid_, forcing.conditions, motion, flow_.mixed_state(),
                                      std::move(pores), step.flow.found);
  FlowProgress progress = flow_.commit(std::move(step.flow));
  failure_.finish_step(progress.end, flow_.next_step(), kinetics);
  if (flow_.is_breakpoint(progress.end)) failure_.expect_short_steps();
  rise_ = std::move(step.rise);
  iterations_ += step.iterations;
  return progress;
}

template <int Dim>
void FlowOfMovingSolid<Dim>::check_gaps(const ElementPores& pores, double start) {
  if (warned_of_gap_) return;
  const std::optional<int> element = element_with_full_gap(grid_, pores);
  if (!element) return;
  warned_of_gap_ = true;
  const bool sank = pores.gap[*element] > 0.0;
  std::ostringstream text;
  text << "soil with a retention has " << (sank ? "sunk below" : "swelled beyond")
       << " the boundary of the mesh in " << element_text(grid_, *element)
       << " by more than its elements can follow, t = " << start
       << " s: suction there is wrong from now on; give it room above (a region free_above, or one "
          "with free = true) or larger elements";
  flow_.warn(text.str());
}

template <int Dim>
FlowOfMovingSolid<Dim>::FlowOfMovingSolid(const Scene& scene, const Grid<Dim>& grid,
                                          ImplicitFlow<Dim>& flow, MovingSkeleton<Dim>& solid,
                                          int threads)
    : grid_(grid),
      flow_(flow),
      solid_(solid),
      both_(grid, solid, threads),
      failure_(grid, solid, scene.follows_failure(grid.mesh.region_names)),
      end_(scene.time.end),
      tolerance_(scene.time.tolerance) {}

template <int Dim>
void FlowOfMovingSolid<Dim>::start(SoilStart how) {
  const MixedState<Dim>& flow = flow_.mixed_state();
  const FlowCoefficients<Dim>& coefficients = flow_.coefficients();
  const std::vector<double> pressure = pressure_on_solid(
      grid_, flow_.scheme().soils(), flow_.pressure(), coefficients.porosity, flow.air);
  const std::vector<double> mass = liquid_mass(grid_, coefficients, flow.air);
  if (how == SoilStart::finds_stress) failure_.start(solid_.start_motion(pressure, mass));
  if (how == SoilStart::has_stress) solid_.start_construction(pressure, mass);
  const double of_construction =
      how == SoilStart::has_stress ? solid_.soils().scene().construction_time() : 0.0;
  const double time_of_change = failure_.has_inertia() ? solid_.time_of_fall() : of_construction;
  // Compressibility for a step as long as the run: inertia is then negligible, and soil is as soft
  // as when drained.
  flow_.start_steps({.load_change = solid_.largest_load_change(),
                     .stiffness = solid_.stiffness(),
                     .compressibility = solid_.compressibility(end_),
                     .time_of_change = time_of_change});
}

template <int Dim>
CoupledFlow<Dim>::CoupledFlow(const Scene& scene, const Grid<Dim>& grid, FlowSolver<Dim>& flow,
                              MovingSkeleton<Dim>* moving, int threads)
    : flow_(flow) {
  if (moving == nullptr) return;
  moving_ = std::make_unique<FlowOfMovingSolid<Dim>>(
      scene, grid, dynamic_cast<ImplicitFlow<Dim>&>(flow), *moving, threads);
}

template <int Dim>
void CoupledFlow<Dim>::start(SoilStart how) {
  flow_.start();
  if (moving_) moving_->start(how);
}

template <int Dim>
void CoupledFlow<Dim>::start_from(const EarlierFlow<Dim>& earlier, SoilStart how) {
  flow_.start_from(earlier);
  if (moving_) moving_->start(how);
}

template <int Dim>
CoupledStep<Dim> CoupledFlow<Dim>::solve(const FlowInterval<Dim>& interval) {
  if (moving_) return moving_->solve(interval);
  return {flow_.solve(interval)};
}

template <int Dim>
FlowProgress CoupledFlow<Dim>::commit(CoupledStep<Dim> step) {
  return moving_ ? moving_->commit(std::move(step)) : flow_.commit(std::move(step.flow));
}

template <int Dim>
long CoupledFlow<Dim>::iterations() const {
  return moving_ ? moving_->iterations() : 0;
}

template <int Dim>
std::vector<PassTiming> CoupledFlow<Dim>::passes() const {
  std::vector<PassTiming> result = flow_.passes();
  if (moving_) result.push_back({"flow, iterations with the solid", moving_->iterations(), 0.0});
  return result;
}

template <int Dim>
void CoupledFlow<Dim>::describe(HistoryRow& row) const {
  if (!moving_) return;
  row.failure_time = moving_->failure().time();
  row.has_failed = moving_->failure().has_failed();
  row.has_inertia = moving_->failure().has_inertia();
}

template <int Dim>
void CoupledFlow<Dim>::archive(StateArchive& archive) {
  if (moving_) archive(*moving_);
}

template class FlowOfMovingSolid<2>;
template class FlowOfMovingSolid<3>;
template class CoupledFlow<2>;
template class CoupledFlow<3>;

}  // namespace suffuse
