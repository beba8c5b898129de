#include "plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "case/errors.hpp"
#include "flow/nodal_operator.hpp"
#include "physics/drag.hpp"
#include "physics/liquid.hpp"
#include "solid/rigid_skeleton.hpp"

namespace suffuse {
namespace {

std::string number(double value) {
  std::ostringstream text;
  text.precision(4);
  text << value;
  return text.str();
}

double largest_inflow_concentration(const Scene& scene) {
  double largest = 0.0;
  for (const BoundaryCondition& b : scene.boundaries) {
    if (b.concentration) largest = std::max(largest, b.concentration->largest());
  }
  return largest;
}

/// Coefficients at which the stability limit is smallest: porosity as it will be at the end, water
/// fraction at its least. Erosion swaps solid for grains in the liquid, so where a soil erodes n_w
/// stays at its initial value; a soil that does not erode can fill with the richest liquid there
/// is, but need not: `with_richest_liquid` says whether it counts.
template <int Dim>
FlowCoefficients<Dim> worst_coefficients(const Case<Dim>& c, const Grid<Dim>& grid,
                                         const RigidSkeleton<Dim>& skeleton,
                                         bool with_richest_liquid) {
  const Scene& scene = c.document.scene;
  const int elements = grid.mesh.element_count();
  const std::vector<double> final_porosity = skeleton.porosity_after(
      skeleton.initial_porosity(), 0.0, scene.time.end,
      std::vector<double>(skeleton.points().size(), std::numeric_limits<double>::infinity()));
  std::vector<double> first(elements, 0.0);
  std::vector<double> last(elements, 0.0);
  const MaterialPoints<Dim>& points = skeleton.points();
  for (int p = 0; p < points.size(); ++p) {
    const double share = points.volume[p] / grid.volume[points.element[p]];
    first[points.element[p]] += share * skeleton.initial_porosity()[p];
    last[points.element[p]] += share * final_porosity[p];
  }
  const double clean = 1.0 - largest_inflow_concentration(scene);
  double dilution = 1.0;  // of water by eroded grains, at worst
  for (int e = 0; e < elements; ++e) {
    if (!skeleton.is_soil(e)) first[e] = last[e] = 1.0;
    dilution = std::min(dilution, first[e] / last[e]);
  }

  FlowCoefficients<Dim> worst;
  for (int e = 0; e < elements; ++e) {
    const bool erodes = last[e] > first[e];
    const double damped_porosity =
        scene.time.drag == DragIntegration::explicit_drag ? last[e] : first[e];
    worst.porosity.push_back(last[e]);
    worst.water_volume.push_back(grid.volume[e] * first[e] * clean *
                                 (erodes || !with_richest_liquid ? 1.0 : dilution));
    worst.mixture_density.push_back(scene.liquid.density);
    worst.drag.push_back(darcy_drag(damped_porosity, scene.liquid.density,
                                    skeleton.soil_of_element(e).conductivity));
  }
  worst.face_concentration.assign(grid.face_count(), 0.0);
  return worst;
}

template <int Dim>
void refuse_unstable_step(const Case<Dim>& c, const Plan& plan) {
  if (!plan.flow.step_given || plan.flow.step <= plan.limit.step) return;
  const Vector<Dim> place = element_centroid(c.mesh, plan.limit.element);
  std::ostringstream expected;
  expected.precision(6);
  expected << "at most " << plan.limit.step << " s, the stability limit, set by element "
           << plan.limit.element << " at (" << place[0];
  for (int d = 1; d < Dim; ++d) expected << ", " << place[d];
  expected << ")";
  std::ostringstream found;
  found.precision(6);
  found << plan.flow.step << " s";
  throw InputError(
      {{c.document.locate("time.step"), "time.step", found.str(), expected.str(), ""}});
}

/// Without a prescribed pressure a steady flow exists only if the prescribed fluxes add up to zero.
template <int Dim>
void refuse_contradictory_fluxes(const Case<Dim>& c, const Grid<Dim>& grid,
                                 const RigidSkeleton<Dim>& skeleton,
                                 const std::vector<FaceCondition>& conditions) {
  const Scene& scene = c.document.scene;
  if (scene.initial_flow != InitialFlow::steady) return;
  double net = 0.0;
  double gross = 0.0;
  for (int f = 0; f < grid.face_count(); ++f) {
    if (conditions[f].kind == FaceKind::pressure) return;
    double flux = grid.face_normal[f].norm() * conditions[f].value;
    if (conditions[f].kind == FaceKind::velocity) {
      flux *= skeleton.soil_of_element(grid.face_left[f]).initial_porosity(grid.face_centre(f));
    }
    net += flux;
    gross += std::abs(flux);
  }
  if (std::abs(net) <= 1e-6 * gross) return;
  throw InputError(
      {{c.document.locate("initial.flow"), "initial.flow",
        "\"steady\" with boundaries that bring in " + number(net) + " m3/s more than they take out",
        "prescribed fluxes that add up to zero, or a boundary with a pressure", ""}});
}

void warn_of_mass_scaling(const Scene& scene, Plan& plan) {
  const double scaling = scene.time.mass_scaling;
  if (scaling <= 1.0) return;
  double relaxation = 0.0;
  for (const Soil& soil : scene.soils) {
    relaxation = std::max(relaxation, soil.conductivity / (soil.porosity * conductivity_gravity));
  }
  if (relaxation * scaling > 0.01 * scene.time.end) {
    plan.warnings.push_back(
        "mass_scaling = " + number(scaling) +
        " stretches the time in which the flow settles from " + number(relaxation) + " s to " +
        number(relaxation * scaling) +
        " s; fluxes and concentrations can be trusted only while that is below 1 % of the run (" +
        number(0.01 * scene.time.end) + " s). Porosity is not touched by it.");
  }
}

void describe(const Scene& scene, const SolverOptions& options, Plan& plan) {
  const auto say = [&](const std::string& sentence) { plan.sentences.push_back(sentence); };
  const double steps = std::ceil(scene.time.end / plan.flow.step * (1.0 - 1e-12));
  say("run: flow, explicit nodal scheme, about " + number(steps) + " steps of " +
      number(plan.flow.step) + " s (stability limit " + number(plan.limit.step) + " s, " +
      (plan.flow.step_given ? "step from the scene" : "0.9 of the limit") + ")");
  const std::string because = options.no_skip ? " (--no-skip)" : "";
  say(plan.erosion ? "run: erosion" + because : "skip: erosion, no soil erodes");
  if (scene.formulation == Formulation::double_point) {
    const bool carried = scene.flow.integration == PressureIntegration::material_point;
    say(carried
            ? "run: movement of liquid points with every step of the flow; they carry velocity "
              "and pressure (material-point integration)"
            : "run: movement of liquid points whenever the flow has brought them a quarter of an "
              "element on; nodes and elements keep velocity and pressure (mixed integration)");
  } else {
    say(plan.transport ? "run: transport of fluidised grains" + because
                       : "skip: transport, no soil erodes and no grains flow in");
  }
  say("skip: motion of the solid, the skeleton is rigid");
  const bool gravity =
      std::any_of(scene.gravity.begin(), scene.gravity.end(), [](double g) { return g != 0.0; });
  say(gravity ? "run: gravity" : "skip: gravity, none is given");
}

}  // namespace

template <int Dim>
Plan make_plan(const Case<Dim>& c, const SolverOptions& options) {
  const Scene& scene = c.document.scene;
  const Grid<Dim> grid(c.mesh);
  const RigidSkeleton<Dim> skeleton(c, grid);
  Plan plan;
  plan.erosion = skeleton.erodes();
  plan.transport = plan.erosion || largest_inflow_concentration(scene) > 0.0;

  // A step that the scene gives is refused for what is certain to come; while the run goes on it is
  // checked against what came.
  plan.flow.threads = options.threads;
  plan.flow.step_given = scene.time.step.has_value();
  const FlowCoefficients<Dim> worst = worst_coefficients(c, grid, skeleton, !plan.flow.step_given);
  const std::vector<FaceCondition> conditions = face_conditions(c, grid);
  refuse_contradictory_fluxes(c, grid, skeleton, conditions);
  NodalOperator<Dim> op(grid, conditions, Vector<Dim>::Zero());
  op.update(worst);
  plan.limit = stability_limit(grid, worst, op.node_porosity(), scene.liquid.bulk_modulus,
                               scene.time.mass_scaling, scene.time.drag);
  if (uses_assembled_limit(scene) && plan.flow.step_given && *scene.time.step > plan.limit.step) {
    plan.limit.step =
        std::max(plan.limit.step, assembled_limit(op, worst, scene.liquid.bulk_modulus,
                                                  scene.time.mass_scaling, scene.time.drag));
  }
  plan.flow.step = scene.time.step.value_or(0.9 * plan.limit.step);
  refuse_unstable_step(c, plan);

  if (options.no_skip && scene.flow.porosity_gradient_term) plan.erosion = plan.transport = true;
  warn_of_mass_scaling(scene, plan);
  describe(scene, options, plan);
  return plan;
}

template Plan make_plan(const Case<2>&, const SolverOptions&);

}  // namespace suffuse
