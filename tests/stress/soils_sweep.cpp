/// Exchange of fines: random laws, drives, deposition, conductivities, viscosities and floods that
/// turn back. Rates are such that a run takes from a few of its fines to all.

#include <algorithm>
#include <array>
#include <cmath>

#include "results/number_text.hpp"
#include "stress/scenario.hpp"
#include "stress/stress_mesh.hpp"

namespace suffuse::stress {
namespace {

constexpr unsigned seeds = 500;
constexpr double gravity = 9.81;
constexpr double weight = 1000.0 * gravity;

enum class Shape { column, weir, levee };

std::string entry(const std::string& key, double value) {
  return key + " = " + number_text(value);
}

std::string word(const std::string& key, const std::string& value) {
  return key + " = \"" + value + "\"";
}

std::string joined(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : ", ") + part;
  return text;
}

/// What the flow of a run is about: scales of rates, thresholds and lengths of runs.
struct Scales {
  Shape shape = Shape::column;
  double porosity = 0.0;
  double conductivity = 0.0;  ///< m/s
  double gradient = 0.0;
  double end = 0.0;        ///< s
  double modulus = 0.0;    ///< Pa
  double inflow = 0.0;     ///< largest c that comes in
  bool viscous = false;    ///< the liquid thickens with fines
  double locks_at = 0.62;  ///< c_m

  [[nodiscard]] double flux() const { return conductivity * gradient; }
  /// Volume that passes the inlet per area of it, m.
  [[nodiscard]] double passed(double duration) const { return flux() * duration; }
};

/// The first of a seed, so that its mesh, its end and its soils agree.
Scales scales_of(unsigned seed, Scheme scheme) {
  Random random(seed + 20000);
  Scales s;
  const bool unsaturated_too = scheme == Scheme::sp_implicit || scheme == Scheme::sp_monotone;
  const double kind = random.share();
  s.shape = kind < 0.5                        ? Shape::column
            : kind < 0.75 || !unsaturated_too ? Shape::weir
                                              : Shape::levee;
  s.porosity = random.between(0.2, 0.5);
  s.conductivity = is_explicit(scheme) ? random.decades(1e-3, 3e-2) : random.decades(1e-6, 3e-2);
  s.gradient = s.shape == Shape::levee ? 0.4 : random.decades(0.05, 3.0);
  // Pore volumes of a metre.
  s.end = random.decades(0.3, 10.0) * s.porosity / s.flux();
  s.modulus = is_explicit(scheme) ? random.decades(1e6, 1e7) : random.decades(2e6, 2e9);
  s.inflow = random.chance(0.5) ? 0.0 : random.decades(1e-4, 0.2);
  s.viscous = random.chance(0.3);
  s.locks_at = random.between(0.55, 0.64);
  return s;
}

/// A drive at the gradient and flux that the run is about, in its own unit.
double drive_scale(const std::string& drive, const Scales& s, double porosity) {
  const double permeability = s.conductivity * 1e-3 / weight;
  if (drive == "flux") return s.flux();
  if (drive == "gradient") return s.gradient;
  if (drive == "shear-stress")
    return weight * s.gradient * std::sqrt(2.0 * permeability / porosity);
  if (drive == "power") return weight * s.gradient * s.flux();
  return 1.0;
}

std::string residual(Random& random, double erodible, double flux) {
  if (random.chance(0.5)) return entry("residual", random.between(0.0, 0.8) * erodible);
  std::string text = "residual = [";
  const int pairs = 1 + random.below(4);
  double q = random.between(0.0, 0.5) * flux;
  double stays = random.between(0.0, 0.9) * erodible;
  for (int i = 0; i < pairs; ++i) {
    text += "[" + number_text(q) + ", " + number_text(stays) + "], ";
    q += random.between(0.05, 1.0) * flux;
    stays *= random.between(0.0, 1.0);  // flow that is faster takes more
  }
  return text + "]";
}

/// A run of `end` s takes a share of the fines that goes from a few in a hundred to nearly all.
std::string erosion(Random& random, const Scales& s, double porosity, double erodible, double end,
                    bool double_point) {
  constexpr std::array<const char*, 5> laws{"constant", "logarithmic", "first-order",
                                            "autocatalytic", "flux"};
  constexpr std::array<const char*, 5> drives{"time", "flux", "gradient", "shear-stress", "power"};
  const std::string law = laws[random.below(5)];
  const std::string drive = law == "flux" ? "flux" : drives[random.below(5)];
  std::vector<std::string> parts{word("law", law)};
  if (law != "flux") parts.push_back(word("drive", drive));
  const double scale = drive_scale(drive, s, porosity);
  double taken = random.decades(0.05, 3.0);  // S, where the state is n_e
  if (law == "constant" || law == "logarithmic") taken *= erodible;
  if (law == "autocatalytic") taken /= std::max(0.02, s.inflow);
  double above = 1.0;
  if (drive != "time" && random.chance(0.5)) {
    const double share = random.between(0.0, 1.1);
    parts.push_back(entry("threshold", share * scale));
    above = std::max(0.3, 1.0 - share);
  }
  parts.push_back(entry("rate", taken / (above * scale * end)));
  if (random.chance(0.4)) parts.push_back(entry("start", random.between(0.0, 0.5) * end));
  if (random.chance(0.5)) parts.push_back(residual(random, erodible, s.flux()));
  if (random.chance(0.4)) {
    parts.push_back(entry("critical_concentration", random.decades(0.02, 0.6)));
  }
  const bool anywhere = drive == "time" || drive == "flux";  // whatever bedding and retention
  if (random.chance(0.2) && anywhere) parts.emplace_back("momentum_transfer = true");
  if (double_point && random.chance(0.3)) parts.push_back(word("mass_transfer", "element"));
  if (double_point && random.chance(0.3)) parts.push_back(word("empty_elements", "dry"));
  return "erosion = {" + joined(parts) + "}";
}

/// Without a `porosity_min` pores fill up for good: then no more than a part of them.
std::string deposition(Random& random, const Scales& s, double porosity, double fines, double end) {
  double coefficient = random.decades(0.1, 30.0);
  std::vector<std::string> parts;
  if (random.chance(0.6)) {
    parts.push_back(entry("porosity_min", random.between(0.3, 0.95) * porosity));
  } else {
    const double offered = s.inflow * s.passed(end) + fines;
    coefficient = std::min(coefficient, 0.5 * porosity / offered);
  }
  parts.push_back(entry("coefficient", coefficient));
  if (random.chance(0.3)) parts.push_back(entry("flux_max", random.decades(0.2, 3.0) * s.flux()));
  return "deposition = {" + joined(parts) + "}";
}

std::string retention(Random& random) {
  if (random.chance(0.3)) return "";
  const bool gardner = random.chance(0.5);
  std::vector<std::string> parts{word("model", gardner ? "gardner" : "van-genuchten"),
                                 entry("alpha", random.decades(0.5, 5.0)),
                                 entry("residual_saturation", random.between(0.1, 0.3))};
  if (!gardner) parts.push_back(entry("n", random.between(1.5, 4.0)));
  return "retention = {" + joined(parts) + "}";
}

std::string soil(Random& random, const Scales& s, double end, Scheme scheme) {
  const double n = s.porosity * random.between(0.8, 1.25);
  const double loose = random.between(0.05, 0.4);  // of the solid
  const double erodible = (1.0 - n) * loose;
  std::vector<std::string> parts{entry("porosity", n),
                                 entry("skeleton_fraction", (1.0 - n) * (1.0 - loose)),
                                 "grain_density = 2700"};
  const bool bedded = !is_explicit(scheme) && !is_double_point(scheme) && random.chance(0.15);
  if (bedded) {
    parts.push_back("conductivity = [" + number_text(s.conductivity) + ", " +
                    number_text(s.conductivity / random.decades(1.0, 10.0)) + "]");
    parts.push_back(entry("bedding", random.between(-90.0, 90.0)));
  } else {
    parts.push_back(entry("conductivity", s.conductivity * random.decades(0.3, 3.0)));
  }
  const double law = random.share();
  if (law < 0.4) {
    parts.push_back(word("conductivity_law", "kozeny-carman"));
    if (random.chance(0.5)) parts.push_back(entry("size_ratio", random.decades(1.0, 20.0)));
  } else if (law < 0.6) {
    parts.push_back(word("conductivity_law", "power"));
    parts.push_back(entry("exponent", random.between(0.5, 8.0)));
  }
  const bool levee = s.shape == Shape::levee;
  if (!levee && !bedded && random.chance(0.15)) parts.push_back(word("drag", "ergun"));
  if (levee) parts.push_back(retention(random));
  if (parts.back().empty()) parts.pop_back();
  const double what = random.share();
  const bool double_point = is_double_point(scheme);
  if (what < 0.85) parts.push_back(erosion(random, s, n, erodible, end, double_point));
  if (what > 0.3) parts.push_back(deposition(random, s, n, 2.0 * erodible, end));
  return "={" + joined(parts) + "}";
}

/// Values that go between `highest` and less, and below nothing where the flow turns back.
std::string flood(Random& random, double end, double highest, bool reverses) {
  std::string text = "[[0.0, " + number_text(highest * random.between(0.3, 1.0)) + "]";
  const int pairs = 1 + random.below(4);
  for (int i = 1; i <= pairs; ++i) {
    const double low = reverses ? -1.0 : 0.0;
    text += ", [" + number_text(end * (i - random.between(0.0, 0.9)) / pairs) + ", " +
            number_text(highest * random.between(low, 1.0)) + "]";
  }
  return text + "]";
}

/// Richness of the liquid that enters.
std::string concentration(Random& random, const Scales& s, double end) {
  if (s.inflow == 0.0 || random.chance(0.5)) return ", " + entry("concentration", s.inflow);
  return ", concentration = [[0, " + number_text(s.inflow) + "], [" +
         number_text(random.between(0.1, 0.9) * end) + ", " +
         number_text(s.inflow * random.share()) + "]]";
}

Changes flows(Random& random, const Scales& s, double end) {
  const bool reverses = random.chance(0.6);
  if (s.shape == Shape::levee) {
    const std::string dry = random.chance(0.5) ? "seepage" : "impervious";
    return {"gravity=[0, -9.81]",
            "boundary[0]={on = \"left\", head = " + flood(random, end, 0.9, false) + ", " +
                word("dry", dry) + concentration(random, s, end) + "}",
            random.chance(0.6)
                ? "boundary[1]={on = \"right\", seepage_face = true}"
                : "boundary[1]={on = \"right\", " + entry("head", random.between(0.0, 0.5)) +
                      ", concentration = 0}",
            "initial.water_level=" + number_text(random.between(0.0, 0.5))};
  }
  const bool column = s.shape == Shape::column;
  const std::string one = column ? "top" : "left";
  const std::string other = column ? "bottom" : "right";
  const bool by_flux = column && random.chance(0.3);
  const std::string what = by_flux
                               ? "darcy_flux = " + flood(random, end, s.flux(), reverses)
                               : "pressure = " + flood(random, end, weight * s.gradient, reverses);
  Changes changes{
      "boundary[0]={" + word("on", one) + ", " + what + concentration(random, s, end) + "}",
      "boundary[1]={" + word("on", other) + ", pressure = 0" + concentration(random, s, end) + "}"};
  if (random.chance(0.5)) changes.emplace_back("initial.flow=steady");
  return changes;
}

Changes soils_changes(unsigned seed, Scheme scheme, double end) {
  const Scales s = scales_of(seed, scheme);
  Random random(seed + 30000);
  Changes changes{"soil.specimen" + soil(random, s, end, scheme),
                  "soil.other" + soil(random, s, end, scheme)};
  for (std::string& change : flows(random, s, end)) changes.push_back(std::move(change));
  changes.push_back("liquid.bulk_modulus=" + number_text(s.modulus));
  if (s.viscous) {
    changes.emplace_back("liquid.viscosity_law=krieger-dougherty");
    changes.push_back("liquid.maximum_concentration=" + number_text(s.locks_at));
  }
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

}  // namespace

Sweep soils_sweep() {
  Sweep sweep{"soils",
              "laws, drives, deposition, conductivities and viscosities at random; "
              "floods that turn back",
              {}};
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    Scenario scenario;
    scenario.scheme = all_schemes[seed % all_schemes.size()];
    const Scheme scheme = scenario.scheme;
    const Scales scales = scales_of(seed, scheme);
    scenario.parameters = name_of(scales.shape) + " at random";
    scenario.seed = seed;
    scenario.mesh = [=] { return soils_mesh(seed, scales.shape); };
    scenario.end = scales.end;
    scenario.explicit_steps = 3000.0;
    // A liquid in which the grains lock flows no more: the run ends with an error that says so.
    if (scales.viscous) scenario.expected = Expected::either;
    scenario.changes = [=](const Span& span) { return soils_changes(seed, scheme, span.end); };
    sweep.scenarios.push_back(std::move(scenario));
  }
  return sweep;
}

}  // namespace suffuse::stress
