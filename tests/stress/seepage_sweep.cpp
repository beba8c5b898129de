/// Levees of random soils, slopes and floods, with seepage faces and rain.

#include <algorithm>
#include <cmath>

#include "files/number_text.hpp"
#include "solver/model_case.hpp"
#include "stress/scenario.hpp"
#include "stress/stress_mesh.hpp"

namespace suffuse::stress {
namespace {

constexpr unsigned seeds = 100;

std::string entry(const std::string& key, double value) {
  return key + " = " + number_text(value);
}

std::string retention(Random& random, double residual) {
  if (random.chance(0.1)) return "";
  const bool gardner = random.chance(0.4);
  std::string text = gardner ? "{model = \"gardner\", " : "{model = \"van-genuchten\", ";
  text += entry("alpha", random.decades(0.3, 15.0));
  if (!gardner) text += ", " + entry("n", random.decades(1.1, 5.0));
  return ", retention = " + text + ", " + entry("residual_saturation", residual) + "}";
}

std::string soil(Random& random, double conductivity, double end) {
  const double n = random.between(0.2, 0.5);
  std::string text = "={" + entry("porosity", n) + ", " +
                     entry("skeleton_fraction", (1.0 - n) * random.between(0.7, 0.95)) +
                     ", grain_density = 2700";
  if (random.chance(0.3)) {
    text += ", conductivity = [" + number_text(conductivity) + ", " +
            number_text(conductivity / random.decades(1.0, 100.0)) + "], " +
            entry("bedding", random.between(-90.0, 90.0));
  } else {
    text += ", " + entry("conductivity", conductivity);
  }
  if (random.chance(0.3)) text += ", conductivity_law = \"kozeny-carman\"";
  const double residual = random.chance(0.3) ? 0.0 : random.between(0.02, 0.3);
  text += retention(random, residual);
  if (random.chance(0.7)) {
    // Without flow, fines that erode into dry pores would leave no room for the water.
    const bool by_flux = random.chance(0.5) || residual == 0.0;
    const double rate = random.decades(0.1, 10.0);
    // If the rate by flux were larger, the eroded fines would drive the flux that erodes them.
    text += std::string(", erosion = {law = \"") + (by_flux ? "flux" : "first-order") + "\", " +
            entry("rate", by_flux ? std::min(rate / (conductivity * end), 10.0) : rate / end) + "}";
  }
  return text + "}";
}

/// Heads that rise and fall four times at most.
std::string flood(Random& random, double end) {
  std::string text = "[[0.0, " + number_text(random.between(0.0, 0.6)) + "]";
  const int pairs = 1 + random.below(4);
  for (int i = 1; i <= pairs; ++i) {
    text += ", [" + number_text(end * (i - random.between(0.0, 0.9)) / pairs) + ", " +
            number_text(random.between(-0.2, 1.1)) + "]";
  }
  return text + "]";
}

}  // namespace

Changes levee_changes(unsigned seed, double end) {
  Random random(seed + 9000);
  const double conductivity = random.decades(1e-9, 1e-1);
  const double other = random.decades(1e-9, 1e-1);
  Changes changes{"gravity=[0, -9.81]", "soil.specimen" + soil(random, conductivity, end),
                  "soil.other" + soil(random, other, end)};
  constexpr std::array<const char*, 3> dry{"seepage", "impervious", "suction"};
  changes.push_back("boundary[0]={on = \"left\", head = " + flood(random, end) + ", dry = \"" +
                    dry[random.below(3)] + "\", concentration = 0}");
  changes.push_back(random.chance(0.6)
                        ? "boundary[1]={on = \"right\", seepage_face = true}"
                        : "boundary[1]={on = \"right\", " + entry("head", random.between(0, 0.5)) +
                              ", concentration = 0.01}");
  if (random.chance(0.6)) {
    const double rain = random.decades(1e-3, 3.0) * conductivity;
    changes.push_back("boundary[2]={on = \"top\", rain = [[0.0, 0.0], [" +
                      number_text(end * random.between(0.1, 0.5)) + ", " + number_text(rain) +
                      "]], concentration = 0}");
  }
  if (random.chance(0.5)) {
    changes.emplace_back("initial.flow=steady");
  } else {
    changes.push_back("initial.water_level=" + number_text(random.between(-1.0, 0.5)));
  }
  constexpr std::array<const char*, 3> moduli{"2e7", "2e9", "inf"};
  changes.push_back(std::string("liquid.bulk_modulus=") + moduli[random.below(3)]);
  return changes;
}

/// A levee 1 m high: a crest of up to 1 m, slopes of 0 to 2 m on either side, up to 14 rows.
Mesh<2> levee_mesh(unsigned seed) {
  Random random(seed);
  const int rows = 5 + random.below(10);
  const double crest = random.between(0.2, 1.0);
  const double water_side = random.chance(0.2) ? 0.0 : random.between(0.2, 2.0);
  const double land_side = random.chance(0.2) ? 0.0 : random.between(0.2, 2.0);
  const int columns =
      std::max(2, static_cast<int>(rows * (crest + 0.5 * (water_side + land_side))));
  Mesh<2> mesh = model::column_mesh(columns, rows, 1.0, 1.0, [&](const Vector<2>& x) {
    const double left = water_side * x[1];
    const double right = water_side + crest + land_side * (1.0 - x[1]);
    return Vector<2>(std::lerp(left, right, x[0]), x[1]);
  });
  jitter_nodes(mesh, random.chance(0.5) ? 0.2 / rows : 0.0, seed);
  const int shape = random.below(4);
  const double border = random.between(0.2, 0.8);
  const double middle = water_side + 0.5 * crest;
  name_regions(mesh, [&](const Vector<2>& x) {
    const bool other = shape == 0   ? x[1] < border
                       : shape == 1 ? std::abs(x[0] - middle) < 0.3 * crest
                       : shape == 2 ? random.chance(0.3)
                                    : false;
    return other ? "other" : "specimen";
  });
  const auto has = [&](const char* name) {
    return std::ranges::count(mesh.region_names, name) > 0;
  };
  // Both soils of the scene must be present.
  if (!has("other") || !has("specimen")) {
    name_regions(mesh, [&](const Vector<2>& x) { return x[1] < border ? "other" : "specimen"; });
  }
  return mesh;
}

Sweep seepage_sweep() {
  Sweep sweep{
      "seepage", "levees of random soils, slopes and floods; seepage faces, rain, erosion", {}};
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    for (const Scheme scheme : {Scheme::sp_implicit, Scheme::sp_monotone}) {
      Scenario scenario;
      scenario.scheme = scheme;
      scenario.parameters = "at random";
      scenario.seed = seed;
      scenario.mesh = [seed] { return levee_mesh(seed); };
      scenario.end = Random(seed + 5000).decades(1e3, 1e7);
      scenario.changes = [seed](const Span& span) { return levee_changes(seed, span.end); };
      sweep.scenarios.push_back(std::move(scenario));
    }
  }
  return sweep;
}

}  // namespace suffuse::stress
