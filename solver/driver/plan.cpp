#include "driver/plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "case/plausibility.hpp"
#include "case/soil_height.hpp"
#include "common/errors.hpp"
#include "driver/exchange_sentences.hpp"
#include "explicit/nodal_operator.hpp"
#include "files/number_text.hpp"
#include "flow/flow_scales.hpp"
#include "flow/implicit_settings.hpp"
#include "formulation/point_checks.hpp"
#include "formulation/single_point.hpp"
#include "linear/lagged_preconditioner.hpp"
#include "mesh/place_text.hpp"
#include "physics/drag.hpp"
#include "physics/head.hpp"
#include "physics/liquid.hpp"
#include "scene/scene_schema.hpp"

namespace suffuse {
namespace {

/// Motion in equilibrium, over the height of the soil that can yield, from which on a run warns.
constexpr double noticed_motion = 0.01;

double largest_inflow_concentration(const Scene& scene) {
  double largest = 0.0;
  for (const BoundaryCondition& b : scene.boundaries) {
    if (b.concentration) largest = std::max(largest, b.concentration->largest());
  }
  return largest;
}

/// Whether air can be in the pores of some soil.
bool retains_air(const Scene& scene) {
  return std::ranges::any_of(scene.soils, &Soil::drains);
}

/// Largest porosity that erosion can cause until `end`, s, under any flow.
double largest_porosity(const ErosionModel& model, double porosity, double end) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  if (depends_on_flux(model) || depends_on_concentration(model)) {
    return porosity_after_scaled(model, porosity, end > model.start ? infinite : 0.0, infinite);
  }
  return porosity_after(model, porosity, 0.0, end, infinite);
}

/// Coefficients with the smallest stability limit: the porosity at the end of the run and the
/// smallest water fraction. Erosion turns solid into fines in the liquid, so n_w of a soil that
/// erodes does not change. Soil that does not erode may fill with the liquid richest in fines,
/// which is assumed if `with_richest_liquid`.
template <int Dim>
FlowCoefficients<Dim> worst_coefficients(const Case<Dim>& c, const Grid<Dim>& grid,
                                         const SoilMap<Dim>& soils, bool with_richest_liquid) {
  const Scene& scene = c.document.scene;
  const int elements = grid.mesh.element_count();
  std::vector<double> first(elements, 0.0);
  std::vector<double> last(elements, 0.0);
  const MaterialPoints<Dim>& points = soils.points();
  for (int p = 0; p < points.size(); ++p) {
    const double share = points.volume[p] / grid.volume[points.element[p]];
    const double porosity = soils.initial_porosity(p);
    first[points.element[p]] += share * porosity;
    last[points.element[p]] += share * largest_porosity(soils.erosion_of_element(points.element[p]),
                                                        porosity, scene.time.end);
  }
  const double clean = 1.0 - largest_inflow_concentration(scene);
  double dilution = 1.0;  // least share of water in liquid with eroded fines
  for (int e = 0; e < elements; ++e) {
    if (!soils.is_soil(e)) first[e] = last[e] = 1.0;
    dilution = std::min(dilution, first[e] / last[e]);
  }

  FlowCoefficients<Dim> worst;
  for (int e = 0; e < elements; ++e) {
    const bool erodes = last[e] > first[e];
    const Soil& soil = soils.soil_of_element(e);
    const auto drag_at = [&](double porosity) {
      return darcy_drag(
          porosity, scene.liquid.density,
          soils.conductivity_factor(e) * soil.conductivity_model().at(first[e], porosity));
    };
    // Explicit drag lowers the limit, implicit drag raises it. With most laws drag decreases with
    // porosity; with a constant conductivity it increases.
    const auto [least, most] = std::minmax({drag_at(first[e]), drag_at(last[e])});
    worst.porosity.push_back(last[e]);
    worst.water_volume.push_back(grid.volume[e] * first[e] * clean *
                                 (erodes || !with_richest_liquid ? 1.0 : dilution));
    worst.mixture_density.push_back(scene.liquid.density);
    worst.drag.push_back(scene.time.drag == DragIntegration::explicit_drag ? most : least);
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
           << plan.limit.element << " at " << place_text<Dim>(place);
  std::ostringstream found;
  found.precision(6);
  found << plan.flow.step << " s";
  throw InputError(
      InputProblem{c.document.locate("time.step"), "time.step", found.str(), expected.str()});
}

/// Without a prescribed pressure a steady flow exists only if the prescribed fluxes add up to zero.
/// For incompressible water this must hold at all times, unless unsaturated soil stores liquid.
template <int Dim>
void refuse_contradictory_fluxes(const Case<Dim>& c, const Grid<Dim>& grid,
                                 const SoilMap<Dim>& soils, const BoundaryValues<Dim>& values) {
  const Scene& scene = c.document.scene;
  const bool stiff = std::isinf(scene.liquid.bulk_modulus) && !retains_air(scene);
  // For incompressible water the tolerance is that of the implicit scheme.
  const double round_off = stiff ? 1e-9 : 1e-6;
  const bool steady = scene.initial_flow == InitialFlow::steady;
  std::vector<double> times;
  if (stiff || steady) times.push_back(0.0);
  if (stiff) {
    times.insert(times.end(), values.breakpoints().begin(), values.breakpoints().end());
    times.push_back(scene.time.end);
  }
  for (const double time : times) {
    const std::vector<FaceCondition> conditions = values.at(time);
    double net = 0.0;
    double gross = 0.0;
    for (int f = 0; f < grid.face_count(); ++f) {
      const FaceKind kind = conditions[f].kind;
      if (kind == FaceKind::pressure || kind == FaceKind::seepage) return;  // takes the difference
      double flux = grid.face_normal[f].norm() * conditions[f].value;
      if (kind == FaceKind::velocity) {
        if (time > 0.0 || !steady) return;  // the flux then depends on the porosity
        flux *= soils.soil_of_element(grid.face_left[f]).initial_porosity(grid.face_centre(f));
      }
      net += flux;
      gross += std::abs(flux);
    }
    if (std::abs(net) <= round_off * gross) continue;
    const std::string key = stiff ? "liquid.bulk_modulus" : "initial.flow";
    throw InputError(
        InputProblem{c.document.locate(key), key,
                     std::string(stiff ? "inf" : "\"steady\"") + " with boundaries that bring in " +
                         short_text(net) + " m3/s more than they take out" +
                         (time > 0.0 ? " at t = " + short_text(time) + " s" : ""),
                     "prescribed fluxes that add up to zero, or a boundary with a pressure"});
  }
}

/// Refuses Ergun's drag where faces open, close or fall dry: the iteration of the implicit flow
/// needs linear drag there.
template <int Dim>
void refuse_ergun_with_switching_faces(const Case<Dim>& c,
                                       const std::vector<FaceCondition>& conditions) {
  const Scene& scene = c.document.scene;
  const auto ergun = std::ranges::find(scene.soils, SoilDrag::ergun, &Soil::drag);
  const auto face = std::ranges::find(conditions, true, &FaceCondition::switches);
  if (ergun == scene.soils.end() || face == conditions.end()) return;
  const BoundaryCondition& boundary = scene.boundaries[face->boundary];
  const std::string name = boundary.seepage_face ? "seepage_face" : boundary.rain ? "rain" : "head";
  const std::string key = joined("soil", shown_name(ergun->region)) + ".drag";
  throw InputError(InputProblem{c.document.locate(key), key,
                                "\"ergun\" with " + joined(boundary.key, name),
                                "\"darcy\": where faces open, close or fall dry, drag is linear"});
}

/// Longest relaxation time of the flow in a soil by drag, k / (n g), s.
double longest_relaxation(const Scene& scene) {
  double relaxation = 0.0;
  for (const Soil& soil : scene.soils) {
    for (const double n : {soil.porosity, soil.porosity_max()}) {
      if (n > soil.porosity && !soil.erosion.law->erodes()) continue;
      const double k = soil.conductivity_model().at(soil.porosity, n);
      relaxation = std::max(relaxation, k / (n * conductivity_gravity));
    }
  }
  return relaxation;
}

/// Not used with scaled masses, for which `RowChecks` has another check.
template <int Dim>
void find_speed_that_drag_follows(const Case<Dim>& c, Plan& plan) {
  const Scene& scene = c.document.scene;
  const bool inertia = scene.time.scheme == FlowScheme::explicit_nodal || plan.flow.inertia;
  if (!inertia || scene.time.mass_scaling > 1.0) return;
  plan.row_limits.speed_that_drag_follows = extent(c.mesh).norm() / longest_relaxation(scene);
}

void warn_of_mass_scaling(const Scene& scene, Plan& plan) {
  const double scaling = scene.time.mass_scaling;
  if (scaling <= 1.0) return;
  const double relaxation = longest_relaxation(scene);
  if (relaxation * scaling > 0.01 * scene.time.end) {
    plan.warnings.push_back(
        "mass_scaling = " + short_text(scaling) +
        " stretches the time in which the flow settles from " + short_text(relaxation) + " s to " +
        short_text(relaxation * scaling) +
        " s; fluxes and concentrations can be trusted only while that is below 1 % of the run (" +
        short_text(0.01 * scene.time.end) + " s). Porosity is not touched by it.");
  }
}

void describe_explicit_flow(const Scene& scene, Plan& plan) {
  // The time between two outputs is divided into equal steps.
  const double stretch =
      std::min({scene.output.every, scene.output.snapshot_every, scene.time.end});
  const double step = stretch / std::ceil(stretch / plan.flow.step * (1.0 - 1e-12));
  plan.sentences.push_back(
      "run: flow, explicit nodal scheme, about " +
      short_text(std::ceil(scene.time.end / step * (1.0 - 1e-12))) + " steps of " +
      short_text(step) + " s (stability limit " + short_text(plan.limit.step) + " s, " +
      (plan.flow.step_given ? "step from the scene" : "0.9 of the limit") + ")");
}

void describe_implicit_flow(const Scene& scene, const SolverOptions& options, Plan& plan) {
  const auto say = [&](const std::string& sentence) { plan.sentences.push_back(sentence); };
  const bool monotone = scene.time.stepping == TimeStepping::monotone;
  say("run: flow, implicit mixed finite elements, " +
      std::string(monotone ? "monotone (first order)" : "second order") + " in time, steps " +
      (plan.flow.step_given ? "of " + short_text(plan.flow.step) + " s as given"
                            : "chosen for a local error of " + short_text(scene.time.tolerance)));
  const std::string why = scene.time.inertia   ? "as the scene says"
                          : scene.moves()      ? "it is part of that of the failing soil"
                          : retains_air(scene) ? "air gives way before it counts"
                          : plan.flow.inertia  ? "too long to leave out"
                                               : "too short to be noticed";
  say((plan.flow.inertia ? "run" : "skip") +
      std::string(": inertia of the liquid; drag stops it within ") +
      short_text(longest_relaxation(scene)) + " s, " + why);
  if (retains_air(scene)) {
    std::vector<std::string> soils;
    for (const Soil& soil : scene.soils) {
      if (soil.drains()) soils.push_back(soil.region);
    }
    say("run: air in the pores under suction, soils " + listed(soils, "and") +
        "; each step iterates until fluxes fit contents and conductivities");
    return;
  }
  say("skip: air in the pores, no soil has a retention");
  say(options.no_skip ? "run: the flow in every step (--no-skip)"
                      : "skip: the flow while it is steady and nothing that drives it changes");
}

/// Describes the times without erosion.
void describe_spans(const Scene& scene, Plan& plan) {
  const bool late = plan.erosion && plan.erosion_span.start > 0.0;
  const bool early = plan.erosion && plan.erosion_span.end < scene.time.end;
  std::string when;
  if (late)
    when = "before t = " + short_text(std::min(plan.erosion_span.start, scene.time.end)) + " s";
  if (early) {
    when +=
        std::string(late ? " and " : "") + "after t = " + short_text(plan.erosion_span.end) + " s";
  }
  if (late || early) plan.sentences.push_back("skip: erosion " + when + ", nothing can erode");
}

std::string how_fines_are_carried(const Scene& scene) {
  if (scene.time.scheme == FlowScheme::explicit_nodal) return "explicit";
  switch (scene.time.transport) {
    case TransportScheme::explicit_steps:
      return "explicit, as the scene says";
    case TransportScheme::implicit_sweeps:
      return "implicit, as the scene says";
    case TransportScheme::by_count:
      break;
  }
  return "explicit; implicit while the flow is so fast that the run would take more than " +
         short_text(explicit_steps_of_a_run) + " explicit steps";
}

void describe(const Scene& scene, const std::vector<std::string>& regions,
              const SolverOptions& options, Plan& plan) {
  const auto say = [&](const std::string& sentence) { plan.sentences.push_back(sentence); };
  if (scene.time.scheme == FlowScheme::explicit_nodal) {
    describe_explicit_flow(scene, plan);
  } else {
    describe_implicit_flow(scene, options, plan);
  }
  const std::string because = options.no_skip ? " (--no-skip)" : "";
  describe_exchange(scene, because, plan);
  describe_spans(scene, plan);
  if (scene.formulation == Formulation::double_point) {
    say(scene.flow.integration == PressureIntegration::material_point
            ? "run: movement of liquid points with every step of the flow; they carry velocity and "
              "pressure (material-point integration)"
            : "run: movement of liquid points along the volumes that cross the faces, by an "
              "element "
              "at most at a time");
  } else {
    say(plan.transport
            ? "run: transport of fluidised grains, " + how_fines_are_carried(scene) + because
            : "skip: transport, no soil erodes and no grains flow in");
    if (plan.transport && plan.fines_from > 0.0) {
      say("skip: transport before t = " + short_text(std::min(plan.fines_from, scene.time.end)) +
          " s, no grains in the liquid");
    }
  }
  if (scene.moves()) {
    const bool follow = scene.follows_failure(regions);
    say("run: motion of the solid, in equilibrium (quasi-static), with each step of the flow");
    say(follow ? "skip: inertia of the solid, until it loses its equilibrium and is followed "
                 "(time.failure)"
               : "skip: inertia of the solid; the run stops where it loses its equilibrium "
                 "(time.failure)");
    if (retains_air(scene)) say("skip: compressibility of the liquid, air is in the pores");
  } else {
    say("skip: motion of the solid, the skeleton is rigid");
  }
  say(has_gravity(scene.gravity) ? "run: gravity" : "skip: gravity, none is given");
  const auto outputs = [&](double every) {
    return short_text(std::ceil(scene.time.end / every * (1.0 - 1e-12)) + 1.0);
  };
  say("skip: what only outputs need, but for " + outputs(scene.output.every) + " rows and " +
      outputs(scene.output.snapshot_every) + " snapshots; steps end on them");
}

/// Inertia delays the flow by its relaxation time. It is neglected if this time is short against
/// the given step, or if the delayed volume is within the tolerance of the volume that flows in the
/// whole run. It is also off if the soil moves: the soil's inertia includes that of its liquid.
void plan_implicit_step(const Scene& scene, Plan& plan) {
  constexpr double short_of_a_step = 0.01;
  plan.flow.step = scene.time.step.value_or(unset);
  const double unnoticed =
      scene.time.step ? short_of_a_step * *scene.time.step : scene.time.tolerance * scene.time.end;
  plan.flow.inertia = !retains_air(scene) && !scene.moves() &&
                      scene.time.inertia.value_or(longest_relaxation(scene) > unnoticed);
  // Inertia matters for the duration of the start-up; its waves need not be resolved.
  if (plan.flow.inertia && !scene.time.inertia) plan.flow.unnoticed = unnoticed;
}

/// Warns of free water with inertia: it has little drag, so its oscillations last for hours.
template <int Dim>
void warn_of_free_water_with_inertia(const Case<Dim>& c, Plan& plan) {
  const Scene& scene = c.document.scene;
  const auto& regions = c.mesh.region_names;
  const bool free_water =
      std::any_of(regions.begin(), regions.end(),
                  [&](const std::string& region) { return scene.is_free_water(region); });
  if (!plan.flow.inertia || !free_water) return;
  plan.warnings.emplace_back(
      "with inertia free water, which has next to no drag, rings for long, and steps follow it; "
      "take time.inertia = false unless that is what you look for");
}

/// Warns of a constant pressure on a boundary that is not level: outer water has a constant head,
/// which is most likely meant.
template <int Dim>
void warn_of_pressures_on_slopes(const Case<Dim>& c, const Grid<Dim>& grid,
                                 const std::vector<FaceCondition>& conditions, Plan& plan) {
  const Scene& scene = c.document.scene;
  if (!has_gravity(scene.gravity)) return;
  const auto z = [&](const Vector<Dim>& x) { return height(x, scene.gravity); };
  const double level = 1e-9 * extent(c.mesh).norm();
  for (int b = 0; b < static_cast<int>(scene.boundaries.size()); ++b) {
    const BoundaryCondition& boundary = scene.boundaries[b];
    if (!boundary.pressure) continue;
    double lowest = std::numeric_limits<double>::infinity();
    double highest = -lowest;
    double area = 0.0;
    double moment = 0.0;
    for (int f = 0; f < grid.face_count(); ++f) {
      if (conditions[f].boundary != b) continue;
      for (const int node : grid.face_nodes[f]) {
        lowest = std::min(lowest, z(c.mesh.nodes[node]));
        highest = std::max(highest, z(c.mesh.nodes[node]));
      }
      area += grid.face_normal[f].norm();
      moment += grid.face_normal[f].norm() * z(grid.face_centre(f));
    }
    if (!(highest - lowest > level)) continue;
    const double pressure = boundary.pressure->value(0.0);
    const double mean = moment / area;
    plan.warnings.push_back(
        boundary.key + ".pressure: " + shown_number(pressure) + " Pa all over \"" + boundary.on +
        "\", which rises from z = " + short_text(lowest) + " m to " + short_text(highest) +
        " m: water that stands there has one head, not one pressure; head = " +
        short_text(pressure / unit_weight(scene.liquid.density, scene.gravity) + mean) +
        " has this pressure at mid-height, z = " + short_text(mean) + " m");
  }
}

/// The step of the explicit scheme, checked against its stability limit.
template <int Dim>
void plan_explicit_step(const Case<Dim>& c, const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                        const std::vector<FaceCondition>& conditions, Plan& plan) {
  const Scene& scene = c.document.scene;
  // A given step is refused only for liquid that is certain to occur. During the run it is checked
  // against the present limit.
  const FlowCoefficients<Dim> worst = worst_coefficients(c, grid, soils, !plan.flow.step_given);
  NodalOperator<Dim> op(grid, conditions, Vector<Dim>::Zero());
  op.update(worst);
  plan.limit = stability_limit(grid, worst, op.node_porosity(), scene.liquid.bulk_modulus,
                               scene.time.mass_scaling, scene.time.drag);
  const bool carried = scene.flow.integration == PressureIntegration::material_point;
  const bool too_long = plan.flow.step_given && *scene.time.step > plan.limit.step;
  if (carried || (uses_assembled_limit(scene) && too_long)) {
    const double assembled =
        sure_of_assembled * assembled_limit(op, worst, scene.liquid.bulk_modulus,
                                            scene.time.mass_scaling, scene.time.drag, {},
                                            scene.flow.integration);
    plan.limit.step = carried ? assembled : std::max(plan.limit.step, assembled);
  }
  plan.flow.step = scene.time.step.value_or(0.9 * plan.limit.step);
  refuse_unstable_step(c, plan);
}

}  // namespace

template <int Dim>
Plan make_plan(const Case<Dim>& c, const SolverOptions& options) {
  const Scene& scene = c.document.scene;
  const Grid<Dim> grid(c.mesh);
  const SoilMap<Dim> soils(c);
  Plan plan;
  plan.warnings = plausibility_warnings(c.document, c.mesh);
  // The liquid of an earlier run may also contain fines.
  const bool fines_enter = largest_inflow_concentration(scene) > 0.0 || !scene.initial_from.empty();
  plan.erosion = soils.erodes() || (soils.deposits() && fines_enter);
  plan.transport = plan.erosion || fines_enter;

  if (!options.no_skip) {
    plan.erosion_span = soils.exchange_span(fines_enter);
    if (!fines_enter) plan.fines_from = plan.erosion_span.start;
  }

  plan.flow.threads = options.threads;
  plan.flow.reuse_steady = !options.no_skip;
  plan.flow.step_given = scene.time.step.has_value();
  const std::vector<FaceCondition> conditions = face_conditions(c, grid);
  refuse_contradictory_fluxes(c, grid, soils, BoundaryValues<Dim>(c, grid));
  refuse_points_near_corners(c, grid, soils);
  check_scheme(c);
  if (scene.time.scheme == FlowScheme::explicit_nodal) {
    if constexpr (Dim == 2) plan_explicit_step(c, grid, soils, conditions, plan);
  } else {
    refuse_ergun_with_switching_faces(c, conditions);
    plan_implicit_step(scene, plan);
    if (!plan.flow.inertia) plan.row_limits.obtuse_elements = obtuse_elements(grid);
    warn_of_free_water_with_inertia(c, plan);
  }

  if (options.no_skip && scene.flow.porosity_gradient_term) plan.erosion = plan.transport = true;
  warn_of_mass_scaling(scene, plan);
  warn_of_pressures_on_slopes(c, grid, conditions, plan);
  find_speed_that_drag_follows(c, plan);
  const double height = height_that_yields(c);
  if (height > 0.0) plan.row_limits.watched_motion = noticed_motion * height;
  describe(scene, c.mesh.region_names, options, plan);
  if constexpr (Dim == 3) {
    plan.sentences.push_back(
        std::string("run: linear systems of the flow, ") +
        (prefers_multigrid(Dim, grid.face_count()) ? "multigrid, " : "a direct factor, ") +
        std::to_string(grid.face_count()) + " faces");
  }
  return plan;
}

template Plan make_plan(const Case<2>&, const SolverOptions&);
template Plan make_plan(const Case<3>&, const SolverOptions&);

}  // namespace suffuse
