/// Soils that move: levees of random strength under floods, columns under loads, and soft ones
/// that are compressed to their grains.

#include <algorithm>

#include "files/number_text.hpp"
#include "solver/solid_model.hpp"
#include "stress/random_soil.hpp"
#include "stress/scenario.hpp"
#include "stress/space_mesh.hpp"
#include "stress/stress_mesh.hpp"

namespace suffuse::stress {
namespace {

constexpr unsigned seeds = 100;
constexpr unsigned soft_seeds = 60;
constexpr unsigned space_seeds = 100;

/// A constant number, or one that falls with the fines.
std::string falling(Random& random, double value, double share) {
  if (random.chance(0.5)) return number_text(value);
  return "[[1.0, " + number_text(value) + "], [0.0, " + number_text(share * value) + "]]";
}

/// A law of the skeleton and its numbers. `strong`: the soil is stable.
std::string skeleton(Random& random, double stiffness, bool strong) {
  const double poisson = random.chance(0.3) ? 0.0 : random.between(0.0, 0.49);
  const std::string elastic = "young = " + falling(random, stiffness, random.between(0.3, 0.9)) +
                              ", poisson = " + number_text(poisson);
  const double least = strong ? 30.0 : 10.0;
  switch (random.below(3)) {
    case 0:
      return "{law = \"elastic\", " + elastic + "}";
    case 1:
      return "{law = \"von-mises\", " + elastic +
             ", cohesion = " + number_text(random.decades(strong ? 2e4 : 1e3, 1e6)) + "}";
    default:
      return "{law = \"mohr-coulomb\", " + elastic +
             ", friction = " + falling(random, random.between(least, 45.0), 0.8) + ", cohesion = " +
             falling(random, random.decades(strong ? 1e4 : 1e2, 1e5), random.between(0.1, 1.0)) +
             ", dilation = " + number_text(random.chance(0.5) ? 0.0 : random.between(0.0, 8.0)) +
             "}";
  }
}

Changes moving_levee_changes(unsigned seed, double end) {
  Changes changes = levee_changes(seed, end);
  Random random(seed + 11000);
  for (const char* name : {"specimen", "other"}) {
    changes.push_back("soil." + std::string(name) + ".skeleton=" +
                      skeleton(random, random.decades(1e5, 1e9), random.chance(0.7)));
  }
  const bool rain = std::ranges::any_of(
      changes, [](const std::string& change) { return change.starts_with("boundary[2]"); });
  changes.push_back("boundary[" + std::to_string(rain ? 3 : 2) +
                    "]={on = \"bottom\", fix = \"both\"}");
  changes.emplace_back("initial.stress=gravity");
  return changes;
}

/// A column of two soils that drains at its top, under loads that come and go.
Changes column_changes(unsigned seed, double end) {
  Random random(seed + 12000);
  const double stiffness = random.decades(1e5, 1e9);
  Changes changes{"time.tolerance=" + number_text(random.decades(1e-4, 1e-2))};
  const double permeability = 1000.0 * 9.81 * random.decades(1e-2, 1e2) / (stiffness * end);
  for (const char* name : {"specimen", "other"}) {
    const std::string soil = "soil." + std::string(name);
    if (std::string(name) == "other") changes.push_back(soil + ".like=specimen");
    changes.push_back(soil +
                      ".conductivity=" + number_text(permeability * random.decades(1.0, 1e3)));
    changes.push_back(soil +
                      ".skeleton=" + skeleton(random, stiffness * random.decades(1.0, 1e2), true));
  }
  const double load = random.decades(1e-4, 0.3) * std::min(stiffness, 1e5);
  std::string course = "[[0.0, 0.0, 0.0]";
  const int pairs = 1 + random.below(3);
  for (int i = 1; i <= pairs; ++i) {
    course += ", [" + number_text(end * (i - random.between(0.0, 0.99)) / pairs) + ", " +
              number_text(random.chance(0.3) ? random.between(-0.05, 0.05) * load : 0.0) + ", " +
              number_text(-random.share() * load) + "]";
  }
  changes.push_back("boundary[0]={on = \"top\", pressure = " +
                    (random.chance(0.5) ? "0" : number_text(random.share() * load)) +
                    ", concentration = 0, traction = " + course + "]}");
  changes.push_back(std::string("boundary[1]={on = \"bottom\", ") +
                    (random.chance(0.3) ? "pressure = 0, " : "") + "fix = \"both\"}");
  changes.emplace_back("boundary[2]={on = \"left\", fix = \"normal\"}");
  changes.emplace_back("boundary[3]={on = \"right\", fix = \"normal\"}");
  changes.emplace_back(random.chance(0.5) ? "liquid.bulk_modulus=2e9" : "liquid.bulk_modulus=2e7");
  return changes;
}

/// A column of one soft soil that catches fines up to almost its porosity, under a load up to its
/// modulus: nearly all pores close.
Changes soft_changes(unsigned seed, double end) {
  Random random(seed + 16000);
  const double stiffness = random.decades(1e4, 1e6);
  const double poisson = random.chance(0.5) ? 0.0 : random.between(0.0, 0.4);
  const double load = random.decades(1e-2, 1.0) * stiffness;
  const double porosity = random.between(0.25, 0.45);
  Changes changes;
  for (const char* name : {"specimen", "other"}) {
    const std::string soil = "soil." + std::string(name);
    if (std::string(name) == "other") changes.push_back(soil + ".like=specimen");
  }
  changes.push_back("soil.specimen.porosity=" + number_text(porosity));
  changes.emplace_back("soil.specimen.skeleton_fraction=0.5");
  changes.push_back("soil.specimen.conductivity=" + number_text(random.decades(1e-5, 1e-2)));
  changes.push_back("soil.specimen.skeleton={law = \"elastic\", young = " + number_text(stiffness) +
                    ", poisson = " + number_text(poisson) + "}");
  if (random.chance(0.7)) {
    changes.push_back(
        "soil.specimen.deposition={coefficient = " + number_text(random.decades(0.1, 20.0)) +
        ", porosity_min = " + number_text(porosity - random.decades(1e-3, 0.1)) + "}");
  }
  changes.push_back(
      "boundary[0]={on = \"top\", pressure = " + number_text(random.share() * 0.2 * load) +
      ", concentration = " + number_text(random.between(0.0, 0.3)) +
      ", traction = [[0.0, 0.0, 0.0], [" + number_text(random.decades(1e-3, 0.9) * end) +
      ", 0.0, " + number_text(-load) + "]]}");
  changes.emplace_back("boundary[1]={on = \"bottom\", pressure = 0, fix = \"both\"}");
  changes.emplace_back("boundary[2]={on = \"left\", fix = \"normal\"}");
  changes.emplace_back("boundary[3]={on = \"right\", fix = \"normal\"}");
  return changes;
}

Mesh<2> two_soil_column(unsigned seed) {
  Random random(seed + 13000);
  Mesh<2> mesh =
      random.chance(0.5) ? plain_column() : model::crossed_mesh(2, 4 + random.below(8), 0.5, 1.0);
  if (random.chance(0.5)) jitter_nodes(mesh, 0.02, seed);
  const double border = random.between(0.3, 0.7);
  name_regions(mesh, [&](const Vector<2>& x) { return x[1] < border ? "other" : "specimen"; });
  return mesh;
}

/// Soils of a mesh in space that move, with conductivities up to this one, m/s.
Changes space_soils(Random& random, const Mesh<3>& mesh, double stiffness, double conductivity,
                    bool drains) {
  Changes changes;
  for (const std::string& name : mesh.region_names) {
    const std::string soil = "soil." + name;
    if (name != "specimen") changes.push_back(soil + ".like=specimen");
    changes.push_back(soil +
                      ".conductivity=" + number_text(conductivity * random.decades(1e-3, 1.0)));
    changes.push_back(soil + ".skeleton=" +
                      skeleton(random, stiffness * random.decades(1.0, 30.0), random.chance(0.8)));
    if (!drains) continue;
    changes.push_back(soil + ".retention={model = \"van-genuchten\", alpha = " +
                      number_text(random.between(1.0, 4.0)) +
                      ", n = " + number_text(random.between(1.5, 3.0)) +
                      ", residual_saturation = " + number_text(random.between(0.0, 0.2)) + "}");
  }
  return changes;
}

/// A dam of tetrahedra under a flood, or a column of them under loads that come and go. Its front
/// and its back are smooth.
Changes space_motion_changes(unsigned seed, bool dam, double end) {
  Random random(seed + 18000);
  const Mesh<3> mesh = space_mesh(seed, dam ? SpaceShape::dam : SpaceShape::column, Cut::none);
  const double stiffness = random.decades(3e5, 3e8);
  const double permeability = 1000.0 * 9.81 * random.decades(1e-2, 1e2) / (stiffness * end);
  Changes changes =
      space_soils(random, mesh, stiffness, dam ? random.decades(1e-5, 1e-2) : permeability, dam);
  std::string boundaries =
      "{on = \"bottom\", fix = \"both\"}, {on = \"front\", fix = \"normal\"}, "
      "{on = \"back\", fix = \"normal\"}";
  if (dam) {
    boundaries += ", {on = \"left\", concentration = 0, head = " + flood(random, end, 0.9, false) +
                  "}, {on = \"right\", " +
                  (random.chance(0.5) ? "seepage_face = true}" : "head = 0.1, concentration = 0}");
    changes.emplace_back("gravity=[0, 0, -9.81]");
    changes.emplace_back("initial.water_level=0.1");
    changes.emplace_back("initial.stress=gravity");
  } else {
    const double load = random.decades(1e-4, 0.3) * std::min(stiffness, 1e5);
    boundaries +=
        ", {on = \"left\", fix = \"normal\"}, {on = \"right\", fix = \"normal\"}, "
        "{on = \"top\", pressure = 0, concentration = 0, traction = [[0, 0, 0, 0], [" +
        number_text(random.decades(1e-3, 0.9) * end) + ", 0, 0, " + number_text(-load) + "]]}";
  }
  changes.push_back("boundary=[" + boundaries + "]");
  changes.emplace_back(random.chance(0.5) ? "liquid.bulk_modulus=2e9" : "liquid.bulk_modulus=inf");
  if (random.chance(0.5)) changes.emplace_back("time.failure=follow");
  return changes;
}

}  // namespace

Sweep space_motion_sweep() {
  Sweep sweep{
      "space-motion", "soils of tetrahedra that move: dams under floods, columns under loads", {}};
  for (unsigned seed = 1; seed <= space_seeds; ++seed) {
    const bool dam = seed % 2 == 0;
    Scenario scenario;
    scenario.scheme = Scheme::sp_implicit;
    scenario.parameters = dam ? "dam" : "column";
    scenario.seed = seed;
    scenario.end = Random(seed + 19000).decades(1e3, 1e6);
    scenario.mesh = [seed, dam] {
      return space_mesh(seed, dam ? SpaceShape::dam : SpaceShape::column, Cut::none);
    };
    scenario.changes = [seed, dam](const Span& span) {
      return space_motion_changes(seed, dam, span.end);
    };
    // Weak soil has no equilibrium, or leaves the mesh, and the run says so.
    scenario.expected = Expected::either;
    sweep.scenarios.push_back(std::move(scenario));
  }
  return sweep;
}

Sweep motion_sweep() {
  Sweep sweep{"motion", "soils that move: levees under floods, columns under loads; erosion", {}};
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    for (const bool levee : {true, false}) {
      Scenario scenario;
      scenario.scheme = Scheme::sp_implicit;
      scenario.parameters = levee ? "levee" : "column";
      scenario.seed = seed;
      scenario.end = Random(seed + 14000).decades(1e3, 1e7);
      scenario.mesh = [seed, levee] { return levee ? levee_mesh(seed) : two_soil_column(seed); };
      scenario.changes = [seed, levee](const Span& span) {
        Changes changes =
            levee ? moving_levee_changes(seed, span.end) : column_changes(seed, span.end);
        if (Random(seed + 15000).chance(0.5)) changes.emplace_back("time.failure=follow");
        return changes;
      };
      // Weak soil has no equilibrium, and the run says so.
      scenario.expected = Expected::either;
      sweep.scenarios.push_back(std::move(scenario));
    }
  }
  for (unsigned seed = 1; seed <= soft_seeds; ++seed) {
    Scenario scenario;
    scenario.scheme = seed % 3 == 0 ? Scheme::dp_implicit : Scheme::sp_implicit;
    scenario.parameters = "soft column";
    scenario.seed = seed;
    scenario.end = Random(seed + 17000).decades(1e2, 1e4);
    scenario.mesh = [seed] { return two_soil_column(seed); };
    scenario.changes = [seed](const Span& span) { return soft_changes(seed, span.end); };
    // Soil that is compressed to its grains is refused.
    scenario.expected = Expected::either;
    sweep.scenarios.push_back(std::move(scenario));
  }
  return sweep;
}

}  // namespace suffuse::stress
