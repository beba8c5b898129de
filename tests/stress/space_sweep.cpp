/// Tetrahedra: boxes and dams of soils that differ by up to six decades, with all kinds of boundary
/// conditions.

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>
#include <utility>

#include "files/number_text.hpp"
#include "stress/random_soil.hpp"
#include "stress/scenario.hpp"
#include "stress/space_mesh.hpp"

namespace suffuse::stress {
namespace {

constexpr unsigned seeds = 500;
constexpr std::array schemes{Scheme::sp_implicit, Scheme::dp_implicit, Scheme::sp_monotone,
                             Scheme::dp_monotone};

enum class Inside { nothing, wall, leaky_wall, well_with_rate, well_with_head, drain };
enum class Drive { pressure, head, darcy_flux, velocity };
enum class Front { closed, pressure, flux };

struct Run {
  Scheme scheme = Scheme::sp_implicit;
  SpaceShape shape = SpaceShape::column;
  Inside inside = Inside::nothing;
  Drive drive = Drive::pressure;
  Front front = Front::closed;
  bool pressed = false;  ///< volumes are prescribed, not pressures
  bool heavy = false;    ///< gravity acts
  bool air = false;      ///< there is air at the outlet, which lets no water in
  double jitter = 0.0;
  Scales scales;

  [[nodiscard]] bool is_dam() const { return shape == SpaceShape::dam; }
  [[nodiscard]] Cut cut() const {
    return inside == Inside::nothing      ? Cut::none
           : inside == Inside::leaky_wall ? Cut::any
                                          : Cut::part;
  }
};

Scales drawn_scales(Random& random, const Run& run) {
  Scales s;
  s.unsaturated = run.is_dam();
  s.linear_drag =
      run.air || run.inside == Inside::drain || (run.heavy && run.inside == Inside::well_with_head);
  s.uneven = run.inside != Inside::nothing || run.shape != SpaceShape::column || run.pressed;
  s.porosity = random.between(0.2, 0.5);
  s.conductivity = random.decades(1e-7, 3e-2);
  s.gradient = run.is_dam() ? 0.4 : random.decades(run.heavy ? 0.5 : 0.05, 3.0);
  // Pore volumes of a metre.
  s.end = random.decades(0.3, 10.0) * s.porosity / s.flux();
  s.modulus = random.decades(2e6, 2e9);
  // If all other faces may close, fluxes need compressible water.
  if (!(run.air && run.pressed) && random.chance(0.2)) {
    s.modulus = std::numeric_limits<double>::infinity();
  }
  s.inflow = random.chance(0.4) ? 0.0 : random.decades(1e-4, 0.2);
  s.viscous = random.chance(0.2);
  s.locks_at = random.between(0.55, 0.64);
  return s;
}

/// Draws all that mesh, end and soils have in common first, so that they agree for a seed.
Run drawn_run(unsigned seed) {
  Random random(seed + 70000);
  Run run;
  run.scheme = schemes[seed % schemes.size()];
  const bool double_point = is_double_point(run.scheme);
  const double kind = random.share();
  run.shape = kind < 0.3     ? SpaceShape::column
              : kind < 0.65  ? SpaceShape::block
              : double_point ? SpaceShape::layers
                             : SpaceShape::dam;
  const bool layers = run.shape == SpaceShape::layers;
  run.pressed = !run.is_dam() && random.chance(0.4);
  // Under gravity water would circulate, across a block through the most pervious soil and between
  // layers through the free water, and the weight of each point would make steps very short.
  const bool circles = layers || (run.pressed && run.shape == SpaceShape::block);
  run.heavy = run.is_dam() || (!circles && random.chance(0.3));
  if (run.pressed) {
    run.drive = random.chance(0.5) ? Drive::darcy_flux : Drive::velocity;
  } else {
    run.drive = !run.heavy && random.chance(0.3) ? Drive::head : Drive::pressure;
  }
  if (!layers && random.chance(0.4)) {
    std::vector<Inside> things{Inside::wall};
    if (run.pressed) things.push_back(Inside::well_with_rate);
    if (!run.pressed) things.insert(things.end(), {Inside::well_with_head, Inside::drain});
    if (!double_point) things.push_back(Inside::leaky_wall);
    run.inside = things[random.below(static_cast<int>(things.size()))];
  }
  if (!layers && random.chance(0.3)) run.front = run.pressed ? Front::flux : Front::pressure;
  // Only faces of soil have air: at free water they would open and close without end.
  run.air = !run.is_dam() && random.chance(0.2) && !layers;
  run.jitter = random.chance(0.3) ? random.between(0.0, 0.3) : 0.0;
  run.scales = drawn_scales(random, run);
  return run;
}

/// Gives each soil of the mesh its own conductivity. That of the run is the largest, or the
/// smallest if liquid is pressed through.
Changes soils(Random& random, const Run& run, const Mesh<3>& mesh, double end) {
  const double contrast = random.decades(1.0, 1e6);
  Changes changes;
  for (const std::string& name : mesh.region_names) {
    const bool water = name == "inflow" || name == "outflow" || name.starts_with("free_");
    if (water) continue;
    Scales own = run.scales;
    const double times = random.decades(1.0, contrast);
    own.conductivity *= run.pressed ? times : 1.0 / times;
    changes.push_back("soil." + name + random_soil(random, own, end, run.scheme));
  }
  return changes;
}

std::string boundary(const std::string& name, const std::string& what) {
  return "{" + word("on", name) + ", " + what + "}";
}

/// Heads that come and go on one side of a dam, air or water on the other; rain.
std::vector<std::string> dam_boundaries(Random& random, const Scales& s, double end) {
  constexpr std::array<const char*, 3> dry{"seepage", "impervious", "suction"};
  std::vector<std::string> all{
      boundary("left", "head = " + flood(random, end, 0.9, false) + ", " +
                           word("dry", dry[random.below(3)]) +
                           inflow_concentration(random, s, end)),
      boundary("right", random.chance(0.6)
                            ? "seepage_face = true"
                            : entry("head", random.between(0.0, 0.5)) + ", concentration = 0")};
  if (random.chance(0.5)) {
    all.push_back(boundary(
        "top", "concentration = 0, " + entry("rain", random.decades(1e-3, 3.0) * s.conductivity)));
  }
  if (random.chance(0.3)) all.push_back(boundary("front", "seepage_face = true"));
  return all;
}

/// Pressures, heads or fluxes that change their sign, against a pressure or air.
std::vector<std::string> driven_boundaries(Random& random, const Run& run, double end) {
  const Scales& s = run.scales;
  const bool across = run.shape == SpaceShape::block;
  const bool layers = run.shape == SpaceShape::layers;
  // Without an inlet, an outflow from the soil would tear the water apart.
  const bool reverses = !(run.air && run.pressed) && random.chance(0.6);
  const double pressure = weight * s.gradient;
  const auto [key, highest] = run.drive == Drive::pressure ? std::pair("pressure", pressure)
                              : run.drive == Drive::head   ? std::pair("head", s.gradient)
                              : run.drive == Drive::darcy_flux
                                  ? std::pair("darcy_flux", s.flux())
                                  : std::pair("velocity", s.flux() / s.porosity);
  std::vector<std::string> all{
      boundary(across   ? "left"
               : layers ? "inflow"
                        : "top",
               key + (" = " + flood(random, end, highest, reverses)) +
                   inflow_concentration(random, s, end)),
      boundary(
          across   ? "right"
          : layers ? "outflow"
                   : "bottom",
          run.air ? "seepage_face = true" : "pressure = 0" + inflow_concentration(random, s, end))};
  if (run.front == Front::pressure) {
    all.push_back(boundary("front", "pressure = " + flood(random, end, pressure, reverses)));
  } else if (run.front == Front::flux) {
    const double low = run.air ? 0.0 : -0.1;
    all.push_back(boundary("front", entry("darcy_flux", random.between(low, 0.1) * s.flux())));
  }
  return all;
}

Changes inside_changes(Random& random, const Run& run) {
  const Scales& s = run.scales;
  const auto list = [](const std::string& name, const std::string& what) {
    return Changes{name + "=[{on = \"cut\"" + what + "}]"};
  };
  switch (run.inside) {
    case Inside::nothing:
      return {};
    case Inside::wall:
      return list("wall", "");
    case Inside::leaky_wall:
      return list("wall", ", " + entry("conductance", s.conductivity * random.decades(1e-3, 1e3)));
    case Inside::well_with_rate:
      return list("well",
                  ", " + entry("rate", random.between(run.air ? 0.0 : -0.1, 0.1) * s.flux()));
    case Inside::well_with_head:
      return list("well", ", " + entry("head", random.between(0.0, 1.0) * s.gradient));
    case Inside::drain:
      return list("well", ", seepage_face = true");
  }
  throw std::logic_error("no such thing");
}

Changes point_changes(Random& random, const Run& run, unsigned seed) {
  constexpr std::array rules{1, 4, 14};
  Changes changes{"points.solid_per_element=" + std::to_string(rules[random.below(3)]),
                  "points.jitter=" + number_text(run.jitter),
                  "points.seed=" + std::to_string(seed)};
  if (!is_double_point(run.scheme)) return changes;
  const int seeding = random.below(3);
  const bool gauss = seeding == 2;
  const int count = gauss ? rules[random.below(2)] : 1 + random.below(12);
  constexpr std::array<const char*, 3> seedings{"low-discrepancy", "random", "gauss"};
  changes.push_back(std::string("points.seeding=") + seedings[seeding]);
  changes.push_back("points.liquid_per_element=" + std::to_string(count));
  if (!gauss && random.chance(0.5)) changes.emplace_back("points.equal_volume=false");
  return changes;
}

Changes space_changes(unsigned seed, const Run& run, double end) {
  Random random(seed + 80000);
  const Mesh<3> mesh = space_mesh(seed, run.shape, run.cut());
  Changes changes = soils(random, run, mesh, end);
  const auto add = [&](const Changes& more) {
    changes.insert(changes.end(), more.begin(), more.end());
  };
  std::string boundaries;
  for (const std::string& one : run.is_dam() ? dam_boundaries(random, run.scales, end)
                                             : driven_boundaries(random, run, end)) {
    boundaries += one + ", ";
  }
  add({"boundary=[" + boundaries + "]"});
  add(inside_changes(random, run));
  if (run.heavy) {
    const double across = run.shape == SpaceShape::block ? random.between(-1.0, 1.0) : 0.0;
    add({"gravity=[" + number_text(across) + ", 0, -9.81]"});
  }
  if (random.chance(0.4)) {
    add({"initial.flow=steady"});
  } else if (run.heavy) {
    add({"initial.water_level=" + number_text(run.is_dam() ? random.between(0.0, 0.5) : 1.0)});
  }
  add(liquid_changes(run.scales));
  // Undamped waves in free water would need a million steps.
  if (run.shape == SpaceShape::layers) add({"time.inertia=false"});
  add(point_changes(random, run, seed));
  if (!is_double_point(run.scheme) && random.chance(0.6)) add({"time.transport=implicit"});
  if (random.chance(0.2)) add({"time.step=" + number_text(end * random.decades(0.002, 0.5))});
  const Vector<3> at = element_centroid(mesh, mesh.element_count() / 2);
  add({"output.probe=[{at = [" + number_text(at[0]) + ", " + number_text(at[1]) + ", " +
       number_text(at[2]) + "]}]"});
  return changes;
}

std::string in_words(const Run& run) {
  constexpr std::array<const char*, 6> things{"",
                                              " with a wall",
                                              " with a leaky wall",
                                              " with a well's rate",
                                              " with a well's head",
                                              " with a drain"};
  return name_of(run.shape) + things[static_cast<int>(run.inside)] + (run.heavy ? "; gravity" : "");
}

Scenario refused(Scheme scheme) {
  Scenario scenario;
  scenario.scheme = scheme;
  scenario.parameters = "explicit";
  scenario.mesh = [] { return space_mesh(1, SpaceShape::column, Cut::none); };
  scenario.changes = [](const Span&) {
    Changes changes;
    for (const std::string& name : space_mesh(1, SpaceShape::column, Cut::none).region_names) {
      if (name != "specimen") changes.push_back("soil." + name + ".like=specimen");
    }
    return changes;
  };
  scenario.expected = Expected::refused;
  return scenario;
}

}  // namespace

Sweep space_sweep() {
  Sweep sweep{
      "space",
      "tetrahedra: boxes and dams of soils six decades apart; walls and wells; all laws and "
      "boundaries at random",
      {}};
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    const Run run = drawn_run(seed);
    Scenario scenario;
    scenario.scheme = run.scheme;
    scenario.parameters = in_words(run);
    scenario.seed = seed;
    scenario.mesh = [=] { return space_mesh(seed, run.shape, run.cut()); };
    scenario.end = run.scales.end;
    // A liquid in which the grains lock cannot flow, points may come too near to corners, and water
    // that falls into dry soil may erode it at once: the run ends with an error that says so.
    if (run.scales.viscous || run.jitter > 0.0 || run.is_dam()) {
      scenario.expected = Expected::either;
    }
    scenario.changes = [=](const Span& span) { return space_changes(seed, run, span.end); };
    sweep.scenarios.push_back(std::move(scenario));
  }
  for (const Scheme scheme : {Scheme::sp_explicit, Scheme::dp_mixed, Scheme::dp_material_point}) {
    sweep.scenarios.push_back(refused(scheme));
  }
  return sweep;
}

}  // namespace suffuse::stress
