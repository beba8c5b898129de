#include "stress/random_soil.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "files/number_text.hpp"

namespace suffuse::stress {
namespace {

std::string joined(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : ", ") + part;
  return text;
}

/// Value of a drive at the gradient and flux of the run, in its own unit.
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
    stays *= random.between(0.0, 1.0);  // a faster flow erodes more
  }
  return text + "]";
}

/// Erosion that takes from a few per cent to nearly all of the fines in a run of `end` s.
std::string erosion(Random& random, const Scales& s, double porosity, double erodible, double end,
                    bool double_point, double length) {
  constexpr std::array<const char*, 5> laws{"constant", "logarithmic", "first-order",
                                            "autocatalytic", "flux"};
  constexpr std::array<const char*, 5> drives{"time", "flux", "gradient", "shear-stress", "power"};
  const std::string law = laws[random.below(5)];
  std::string drive = law == "flux" ? "flux" : drives[random.below(5)];
  if (length > 0.0 && drive == "time") drive = "flux";
  std::vector<std::string> parts{word("law", law)};
  if (length > 0.0) parts.push_back(entry("length", length));
  if (law != "flux") parts.push_back(word("drive", drive));
  const double scale = drive_scale(drive, s, porosity);
  double taken = random.decades(0.05, 3.0);  // S, if the state is n_e
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
  const bool anywhere = drive == "time" || drive == "flux";  // both allow bedding and retention
  if (random.chance(0.2) && anywhere) parts.emplace_back("momentum_transfer = true");
  if (double_point && random.chance(0.3)) parts.push_back(word("mass_transfer", "element"));
  if (double_point && random.chance(0.3)) parts.push_back(word("empty_elements", "dry"));
  return "erosion = {" + joined(parts) + "}";
}

/// Without a `porosity_min` pores can fill up for good: then deposits take only a part of them.
std::string deposition(Random& random, const Scales& s, double porosity, double fines, double end) {
  double coefficient = random.decades(0.1, 30.0);
  std::vector<std::string> parts;
  if (s.uneven || random.chance(0.6)) {
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

}  // namespace

std::string entry(const std::string& key, double value) {
  return key + " = " + number_text(value);
}

std::string word(const std::string& key, const std::string& value) {
  return key + " = \"" + value + "\"";
}

std::string random_soil(Random& random, const Scales& s, double end, Scheme scheme, double length) {
  const double n = s.porosity * random.between(0.8, 1.25);
  const double loose = random.between(0.05, 0.4);  // share of the solid
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
  if (!s.unsaturated && !s.linear_drag && !bedded && random.chance(0.15))
    parts.push_back(word("drag", "ergun"));
  if (s.unsaturated) parts.push_back(retention(random));
  if (parts.back().empty()) parts.pop_back();
  const double what = random.share();
  const bool double_point = is_double_point(scheme);
  if (what < 0.85) parts.push_back(erosion(random, s, n, erodible, end, double_point, length));
  if (what > 0.3) parts.push_back(deposition(random, s, n, 2.0 * erodible, end));
  return "={" + joined(parts) + "}";
}

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

std::string inflow_concentration(Random& random, const Scales& s, double end) {
  if (s.inflow == 0.0 || random.chance(0.5)) return ", " + entry("concentration", s.inflow);
  return ", concentration = [[0, " + number_text(s.inflow) + "], [" +
         number_text(random.between(0.1, 0.9) * end) + ", " +
         number_text(s.inflow * random.share()) + "]]";
}

Changes liquid_changes(const Scales& s) {
  Changes changes{"liquid.bulk_modulus=" + number_text(s.modulus)};
  if (s.viscous) {
    changes.emplace_back("liquid.viscosity_law=krieger-dougherty");
    changes.push_back("liquid.maximum_concentration=" + number_text(s.locks_at));
  }
  return changes;
}

}  // namespace suffuse::stress
