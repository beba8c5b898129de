/// Exchange of fines: random laws, drives, deposition, conductivities, viscosities and floods that
/// turn back. Rates are such that a run erodes from a few to all of its fines.

#include "files/number_text.hpp"
#include "stress/random_soil.hpp"
#include "stress/scenario.hpp"
#include "stress/stress_mesh.hpp"

namespace suffuse::stress {
namespace {

constexpr unsigned seeds = 500;
constexpr unsigned length_seeds = 200;

enum class Shape { column, weir, levee };

struct Run {
  Shape shape = Shape::column;
  Scales scales;
};

/// Draws all that mesh, end and soils have in common first, so that they agree for a seed.
Run drawn_run(unsigned seed, Scheme scheme) {
  Random random(seed + 20000);
  Run run;
  Scales& s = run.scales;
  const bool unsaturated_too = scheme == Scheme::sp_implicit || scheme == Scheme::sp_monotone;
  const double kind = random.share();
  run.shape = kind < 0.5                        ? Shape::column
              : kind < 0.75 || !unsaturated_too ? Shape::weir
                                                : Shape::levee;
  s.unsaturated = run.shape == Shape::levee;
  s.porosity = random.between(0.2, 0.5);
  s.conductivity = is_explicit(scheme) ? random.decades(1e-3, 3e-2) : random.decades(1e-6, 3e-2);
  s.gradient = s.unsaturated ? 0.4 : random.decades(0.05, 3.0);
  // Pore volumes of a metre.
  s.end = random.decades(0.3, 10.0) * s.porosity / s.flux();
  s.modulus = is_explicit(scheme) ? random.decades(1e6, 1e7) : random.decades(2e6, 2e9);
  s.inflow = random.chance(0.5) ? 0.0 : random.decades(1e-4, 0.2);
  s.viscous = random.chance(0.3);
  s.locks_at = random.between(0.55, 0.64);
  return run;
}

Changes flows(Random& random, const Run& run, double end) {
  const Scales& s = run.scales;
  const bool reverses = random.chance(0.6);
  if (s.unsaturated) {
    const std::string dry = random.chance(0.5) ? "seepage" : "impervious";
    return {"gravity=[0, -9.81]",
            "boundary[0]={on = \"left\", head = " + flood(random, end, 0.9, false) + ", " +
                word("dry", dry) + inflow_concentration(random, s, end) + "}",
            random.chance(0.6)
                ? "boundary[1]={on = \"right\", seepage_face = true}"
                : "boundary[1]={on = \"right\", " + entry("head", random.between(0.0, 0.5)) +
                      ", concentration = 0}",
            "initial.water_level=" + number_text(random.between(0.0, 0.5))};
  }
  const bool column = run.shape == Shape::column;
  const std::string one = column ? "top" : "left";
  const std::string other = column ? "bottom" : "right";
  const bool by_flux = column && random.chance(0.3);
  const std::string what = by_flux
                               ? "darcy_flux = " + flood(random, end, s.flux(), reverses)
                               : "pressure = " + flood(random, end, weight * s.gradient, reverses);
  Changes changes{
      "boundary[0]={" + word("on", one) + ", " + what + inflow_concentration(random, s, end) + "}",
      "boundary[1]={" + word("on", other) + ", pressure = 0" +
          inflow_concentration(random, s, end) + "}"};
  if (random.chance(0.5)) changes.emplace_back("initial.flow=steady");
  return changes;
}

/// \param lengths  erosion averages the flux over a random length
Changes soils_changes(unsigned seed, Scheme scheme, double end, bool lengths) {
  const Run run = drawn_run(seed, scheme);
  Random random(seed + 30000);
  Random drawn(seed + 60000);
  const auto soil = [&] {
    const double length = lengths ? drawn.decades(0.003, 3.0) : 0.0;
    return random_soil(random, run.scales, end, scheme, length);
  };
  Changes changes;
  for (const char* name : {"specimen", "other"})
    changes.push_back("soil." + std::string(name) + soil());
  for (std::string& change : flows(random, run, end)) changes.push_back(std::move(change));
  for (std::string& change : liquid_changes(run.scales)) changes.push_back(std::move(change));
  if (is_explicit(scheme)) changes.emplace_back("time.mass_scaling=100");
  const bool field = scheme == Scheme::sp_implicit || scheme == Scheme::sp_monotone;
  if (field && Random(seed + 50000).chance(0.67)) {
    changes.emplace_back("time.transport=implicit");
  }
  return changes;
}

Mesh<2> soils_mesh(unsigned seed, Shape shape) {
  Random random(seed + 40000);
  if (shape != Shape::column) return levee_mesh(seed);
  Mesh<2> mesh = plain_column();
  jitter_nodes(mesh, random.chance(0.3) ? 0.03 : 0.0, seed);
  const double border = random.between(0.2, 0.8);
  const bool across = random.chance(0.3);
  name_regions(mesh, [&](const Vector<2>& x) {
    return (across ? x[0] < 0.25 : x[1] < border) ? "other" : "specimen";
  });
  return mesh;
}

std::string name_of(Shape shape) {
  return shape == Shape::column ? "column" : shape == Shape::weir ? "weir" : "levee";
}

Sweep soils_at_random(const std::string& name, const std::string& what, unsigned count,
                      bool lengths) {
  Sweep sweep{name, what, {}};
  for (unsigned seed = 1; seed <= count; ++seed) {
    Scenario scenario;
    scenario.scheme = all_schemes[seed % all_schemes.size()];
    const Scheme scheme = scenario.scheme;
    const Run run = drawn_run(seed, scheme);
    scenario.parameters = name_of(run.shape) + " at random";
    scenario.seed = seed;
    scenario.mesh = [=] { return soils_mesh(seed, run.shape); };
    scenario.end = run.scales.end;
    scenario.explicit_steps = 3000.0;
    // A liquid in which the grains lock cannot flow: the run ends with an error that says so.
    if (run.scales.viscous) scenario.expected = Expected::either;
    scenario.changes = [=](const Span& span) {
      return soils_changes(seed, scheme, span.end, lengths);
    };
    sweep.scenarios.push_back(std::move(scenario));
  }
  return sweep;
}

}  // namespace

Sweep soils_sweep() {
  return soils_at_random("soils",
                         "laws, drives, deposition, conductivities and viscosities at random; "
                         "floods that turn back",
                         seeds, false);
}

Sweep lengths_sweep() {
  return soils_at_random("lengths", "as soils, with erosion that averages the flux over a length",
                         length_seeds, true);
}

}  // namespace suffuse::stress
