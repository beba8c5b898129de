/// Soil that moves or fails, in the classes of input that tests/cases represents: factors of
/// safety, compression to the grains, rigid soil next to soil that moves, sand without an
/// equilibrium at the start. Each is judged by a known bound or number.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solver/solid_model.hpp"
#include "stress/random_soil.hpp"
#include "stress/sweep_parts.hpp"

namespace suffuse::stress {
namespace {

constexpr unsigned runs = 30;
constexpr unsigned levees = 200;

// --- Factors of safety

/// A levee 1 m high on 0.5 m of ground, with a drain in its toe, in crossed triangles.
struct Levee {
  int rows = 0;
  int columns = 0;
  double water_side = 0.0;  ///< metres along per metre up
  double land_side = 0.0;
  double crest = 0.0;
  double drain = 0.0;  ///< height of the drain, m; 0: none
};

Levee drawn_levee(unsigned seed) {
  Random random(seed + 200000);
  Levee levee;
  levee.rows = 4 + random.below(3);
  levee.water_side = random.between(0.5, 2.5);
  levee.land_side = random.between(0.5, 2.5);
  levee.crest = random.between(0.3, 1.0);
  levee.columns = static_cast<int>(
      levee.rows * (levee.crest + 0.5 * (levee.water_side + levee.land_side)) * 0.7);
  levee.drain = random.chance(0.6) ? random.between(0.25, 0.5) : 0.0;
  return levee;
}

Mesh<2> levee_of_strength(unsigned seed) {
  const Levee l = drawn_levee(seed);
  Mesh<2> mesh = model::crossed_mesh(l.columns, l.rows, 1.0, 1.0);
  const double length = l.crest + l.water_side + l.land_side;
  for (Vector<2>& node : mesh.nodes) {
    node[0] = std::lerp(l.water_side * node[1], length - l.land_side * node[1], node[0]);
  }
  name_regions(mesh, [&](const Vector<2>& x) {
    const bool in_drain = x[1] < l.drain && x[0] > length - l.land_side * l.drain - 0.2;
    return in_drain ? "other" : "specimen";
  });
  return mesh;
}

/// The friction and cohesion of a soil, with its strength scaled by `ratio`.
std::string strength_of(double friction, double cohesion, double dilation, double ratio) {
  constexpr double degree = std::numbers::pi / 180.0;
  const double angle = std::atan(ratio * std::tan(friction * degree)) / degree;
  return "{law = \"mohr-coulomb\", young = 1e7, poisson = 0.3, " + entry("friction", angle) + ", " +
         entry("cohesion", ratio * cohesion) + ", " + entry("dilation", std::min(dilation, angle)) +
         "}";
}

Sweep strength_sweep() {
  SweepMaker maker("strength",
                   "factors of safety of unsaturated levees with drains; with another strength "
                   "they are as many times as large");
  for (unsigned seed = 1; seed <= levees; ++seed) {
    Random random(seed + 201000);
    const bool drained = drawn_levee(seed).drain > 0.0;
    const double ratio = random.chance(0.5) ? random.between(0.7, 0.95) : random.between(1.05, 1.5);
    const auto retention = [&](double alpha, double n) {
      return "retention={model=\"van-genuchten\", " + entry("alpha", alpha) + ", " + entry("n", n) +
             ", residual_saturation=0.05}";
    };
    const double k = random.decades(1e-7, 1e-4);
    Changes changes{"gravity=[0, -9.81]",
                    "soil.specimen={porosity=0.38, skeleton_fraction=0.62, grain_density=2650, " +
                        entry("conductivity", k) + ", " +
                        retention(random.decades(0.5, 5.0), random.between(1.3, 3.0)) + "}"};
    const double friction = random.between(20.0, 38.0);
    const double cohesion = random.decades(300.0, 1e4);
    Changes scaled{"soil.specimen.skeleton=" + strength_of(friction, cohesion, 0.0, ratio)};
    changes.push_back("soil.specimen.skeleton=" + strength_of(friction, cohesion, 0.0, 1.0));
    if (drained) {
      const double coarse = random.between(30.0, 42.0);
      const double bond = random.chance(0.5) ? 0.0 : random.decades(30.0, 1e3);
      changes.push_back("soil.other={porosity=0.35, skeleton_fraction=0.65, grain_density=2650, " +
                        entry("conductivity", k * random.decades(10.0, 1e4)) + ", " +
                        retention(random.between(5.0, 15.0), random.between(2.0, 3.0)) + "}");
      changes.push_back("soil.other.skeleton=" + strength_of(coarse, bond, 0.0, 1.0));
      scaled.push_back("soil.other.skeleton=" + strength_of(coarse, bond, 0.0, ratio));
    }
    changes.push_back("boundary=[{on=\"left\", " + entry("head", random.between(0.1, 0.95)) +
                      ", concentration=0}, {on=\"right\", seepage_face=true}, {on=\"bottom\", "
                      "fix=\"both\"}]");
    if (random.chance(0.6)) {
      changes.emplace_back("initial.flow=steady");
    } else {
      changes.push_back("initial.water_level=" + number(random.between(-2.0, 0.3)));
    }
    maker.add(
        {Scheme::sp_implicit}, drained ? "levee with a drain" : "levee",
        [&](Scenario& s) {
          s.mesh = [seed] { return levee_of_strength(seed); };
          s.changes = [changes](const Span&) { return changes; };
          s.strength = {scaled, ratio};
          // Where water comes out of sand, soil may fail at any strength.
          s.expected = Expected::either;
          s.refusal_says_where = true;
        },
        seed);
  }
  return maker.done();
}

// --- Soil pressed to its grains

/// A column whose soil loses its stiffness with its fines, or catches fines, under a load.
Sweep to_the_grains_sweep() {
  SweepMaker maker("to-the-grains",
                   "soft soil under loads up to its stiffness, which goes with its fines; deposits "
                   "that leave hardly any pores");
  for (unsigned seed = 1; seed <= runs; ++seed) {
    Random random(seed + 210000);
    const double stiffness = random.decades(1e4, 1e6);
    const double end = random.decades(1e2, 1e4);
    const double porosity = random.between(0.25, 0.45);
    const double load = random.decades(1e-2, 1.0) * stiffness;
    const bool erodes = seed % 2 == 0;
    std::string young = number(stiffness);
    if (erodes) {
      // If the soil without fines were softer, steps would become too short
      // (docs/evidence/stability.md).
      const double left = std::max(stiffness * random.decades(1e-4, 0.3), 0.6 * load);
      young = "[[1.0, " + young + "], [0.0, " + number(left) + "]]";
    }
    std::string soil = "soil.specimen={" + entry("porosity", porosity) +
                       ", skeleton_fraction=0.5, grain_density=2650, " +
                       entry("conductivity", random.decades(1e-4, 1e-2)) +
                       ", skeleton={law=\"elastic\", young=" + young + ", " +
                       entry("poisson", random.chance(0.5) ? 0.0 : random.between(0.0, 0.4)) + "}";
    if (erodes) {
      soil += ", erosion={law=\"constant\", " +
              entry("rate", (0.5 - porosity) * random.decades(0.3, 30.0) / end) + "}";
    }
    if (!erodes || random.chance(0.5)) {
      soil += ", deposition={" + entry("coefficient", random.decades(0.1, 20.0)) + ", " +
              entry("porosity_min", porosity - random.decades(1e-3, 0.1)) + "}";
    }
    const Changes changes{
        soil + "}",
        "boundary=[{on=\"top\", " + entry("pressure", random.share() * 0.2 * load) + ", " +
            entry("concentration", random.between(0.0, 0.3)) + ", traction=[[0.0, 0.0, 0.0], [" +
            number(random.decades(1e-3, 0.9) * end) + ", 0.0, " + number(-load) +
            "]]}, {on=\"bottom\", pressure=0, fix=\"both\"}, {on=\"left\", fix=\"normal\"}, "
            "{on=\"right\", fix=\"normal\"}]",
        std::string("liquid.bulk_modulus=") + (random.chance(0.5) ? "2e9" : "inf")};
    const int rows = 4 + random.below(8);
    maker.add(
        {seed % 3 == 0 ? Scheme::dp_implicit : Scheme::sp_implicit},
        erodes ? "softens as it erodes" : "catches fines",
        [&](Scenario& s) {
          s.mesh = [rows] { return model::crossed_mesh(2, rows, 0.5, 1.0); };
          s.end = end;
          s.changes = [changes](const Span&) { return changes; };
          s.expected = Expected::either;
          s.refusal_says_where = true;
        },
        seed);
  }
  return maker.done();
}

// --- Rigid soil next to soil that moves

constexpr double settlement_error = 5e-3;  // relative

/// The rigid soil keeps its solid, and the column over it is compressed by the share `strain` of
/// its height above `border`; 0: the settlement is not known.
Complaints settles_alone(const ResultsReader& results, double border, double strain) {
  Complaints complaints;
  const Table regions = results.region_ledgers();
  const auto rigid = std::ranges::find(results.regions(), "other") - results.regions().begin();
  const std::vector<double>& region = regions.column("region");
  double first = 0.0;
  for (std::size_t i = 0; i < region.size(); ++i) {
    if (region[i] != static_cast<double>(rigid)) continue;
    const double solid = regions.column("solid")[i];
    if (first == 0.0) first = solid;
    if (std::abs(solid - first) <= 1e-12 * first) continue;
    complaints.push_back("rigid soil goes from " + shown(first) + " to " + shown(solid) + " kg");
    break;
  }
  double highest = 0.0;
  for (const Vector<2>& x : results.point_positions<2>(0, "solid")) {
    highest = std::max(highest, x[1]);
  }
  const double settlement = strain * (highest - border);
  const Table history = results.history();
  const double settled = history.column("settlement_max").back();
  if (settlement > 0.0 && std::abs(settled - settlement) > settlement_error * settlement) {
    complaints.push_back("the soil settles by " + shown(settled) + " m; expected " +
                         shown(settlement));
  }
  return complaints;
}

/// Stretch J of the confined column under a load of -M ln(J) / J, M being the modulus, by Newton's
/// method.
double stretch_under(double load, double modulus) {
  double log = 0.0;
  for (int i = 0; i < 50; ++i) {
    const double value = log * std::exp(-log) + load / modulus;
    log -= value / (std::exp(-log) * (1.0 - log));
  }
  return std::exp(log);
}

Sweep rigid_beside_sweep() {
  SweepMaker maker("rigid-beside",
                   "rigid soil below or beside soil that moves: still, under loads, with pressures "
                   "that rise from below");
  for (unsigned seed = 1; seed <= runs; ++seed) {
    Random random(seed + 220000);
    const bool side_by_side = seed % 3 == 0;
    const bool loaded = seed % 2 == 0;
    const double young = random.decades(1e5, 1e8);
    const double poisson = random.chance(0.3) ? 0.0 : random.between(0.0, 0.4);
    const double modulus = young * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
    const double k = random.decades(1e-7, 1e-3);
    const double rigid_k = k * random.decades(1e-3, 1e3);
    const double share = 0.5;  // height of the rigid soil
    // The settlement must be small against the elements, as the loaded surface does not move with
    // the soil.
    const double load = modulus * random.decades(1e-4, 5e-3);
    // The run ends long after consolidation, also that through the rigid soil.
    const double settling = weight / (modulus * std::min(k, rigid_k));
    const double end = (loaded ? 10.0 : random.decades(0.1, 10.0)) * settling;
    const bool heavy = !loaded;
    const bool mohr = !loaded && random.chance(0.5);
    std::string top = "{on=\"top\", pressure=0, concentration=0";
    if (loaded) {
      top += ", traction=[[0.0, 0.0, 0.0], [" + number(random.decades(1e-3, 0.1) * end) +
             ", 0.0, " + number(-load) + "]]";
    }
    const double rise = random.between(-0.3, 0.3) * weight;
    const std::string bottom = loaded ? std::string("{on=\"bottom\", fix=\"both\"}")
                                      : "{on=\"bottom\", fix=\"both\", pressure=" +
                                            pairs({{0.0, weight},
                                                   {0.2 * end, weight + rise},
                                                   {0.4 * end, weight - 0.5 * rise}}) +
                                            ", concentration=0}";
    Changes changes{
        "soil.specimen={porosity=0.35, skeleton_fraction=0.5, grain_density=2650, " +
            entry("conductivity", k) + "}",
        "soil.specimen.skeleton={" + word("law", mohr ? "mohr-coulomb" : "elastic") + ", " +
            entry("young", young) + ", " + entry("poisson", poisson) +
            (mohr ? ", friction=30, " + entry("cohesion", random.chance(0.5) ? 0.0 : 1e3) : "") +
            "}",
        "soil.other={porosity=0.35, skeleton_fraction=0.5, grain_density=2650, " +
            entry("conductivity", rigid_k) + "}",
        "boundary=[" + top + "}, " + bottom +
            ", {on=\"left\", fix=\"normal\"}, {on=\"right\", fix=\"normal\"}]",
        "liquid.bulk_modulus=inf"};
    if (heavy) changes = joined(changes, {gravity, rest_level});
    const double strain = loaded && !side_by_side ? 1.0 - stretch_under(load, modulus) : 0.0;
    maker.add(
        {Scheme::sp_implicit},
        std::string(side_by_side ? "beside" : "below") + (loaded ? "; load" : "; pressures"),
        [&](Scenario& s) {
          s.mesh = [=] {
            Mesh<2> mesh = model::crossed_mesh(4, 8, 0.5, 1.0);
            name_regions(mesh, [=](const Vector<2>& x) {
              const bool rigid = side_by_side ? x[0] < 0.25 : x[1] < share;
              return rigid ? "other" : "specimen";
            });
            return mesh;
          };
          s.end = end;
          s.changes = [changes](const Span&) { return changes; };
          s.demands = [share, strain](const ResultsReader& results) {
            return settles_alone(results, share, strain);
          };
          s.refusal_says_where = true;
        },
        seed);
  }
  return maker.done();
}

// --- Sand without an equilibrium at the start

/// The soil falls, at most as fast as in free fall.
Complaints falls(const ResultsReader& results, double height) {
  const Table history = results.history();
  const std::vector<double>& t = history.column("t");
  const std::vector<double>& down = history.column("settlement_max");
  const std::vector<double>& moved = history.column("displacement_max");
  for (std::size_t i = 0; i < t.size(); ++i) {
    const double fall = std::min(0.5 * 9.81 * t[i] * t[i], height);
    if (down[i] <= 1.01 * fall + 1e-3 * height) continue;
    return {"sand sinks by " + shown(down[i]) + " m in " + shown(t[i]) + " s; a fall is " +
            shown(fall)};
  }
  if (moved.back() < 0.1 * std::min(0.5 * 9.81 * t.back() * t.back(), height)) {
    return {"sand without an equilibrium moves by " + shown(moved.back()) + " m"};
  }
  return {};
}

Sweep gate_gone_sweep() {
  SweepMaker maker("gate-gone",
                   "columns of dry sand that have no equilibrium at the start, with failure = "
                   "\"follow\"");
  for (unsigned seed = 1; seed <= runs; ++seed) {
    Random random(seed + 230000);
    const int rows = 4 + random.below(4);
    const double height = random.between(0.3, 2.0);
    const double h = height / rows;
    const int sand = 2 + random.below(rows);
    const int columns = sand + 2 * rows;
    const double end = random.between(0.3, 0.6) * std::sqrt(2.0 * height / 9.81);
    const double cohesion = random.chance(0.7) ? 0.0 : random.between(0.0, 0.01) * 16e3 * height;
    const Changes changes{
        gravity,
        "soil.specimen={porosity=0.4, skeleton_fraction=0.6, grain_density=2700, conductivity=1, "
        "skeleton={law=\"mohr-coulomb\", " +
            entry("young", random.decades(3e5, 3e6)) + ", poisson=0.3, " +
            entry("friction", random.between(20.0, 38.0)) + ", " + entry("cohesion", cohesion) +
            "}}",
        "liquid.density=1",
        "liquid.bulk_modulus=inf",
        set("initial.water_level", height + h),
        "boundary=[{on=\"top\", pressure=0, concentration=0}, {on=\"bottom\", fix=\"both\"}, "
        "{on=\"left\", fix=\"normal\"}, {on=\"right\", fix=\"normal\"}]",
        "time.failure=follow"};
    maker.add(
        {Scheme::sp_implicit}, "1:" + shown(height / (sand * h)),
        [&](Scenario& s) {
          s.mesh = [=] {
            Mesh<2> mesh = model::crossed_mesh(columns, rows + 1, columns * h, height + h);
            name_regions(mesh, [=](const Vector<2>& x) {
              return x[0] < sand * h && x[1] < height ? "specimen" : "free_above";
            });
            return mesh;
          };
          s.end = end;
          s.changes = [changes](const Span&) { return changes; };
          s.demands = [height](const ResultsReader& results) { return falls(results, height); };
          s.refusal_says_where = true;
        },
        seed);
  }
  return maker.done();
}

}  // namespace

std::vector<Sweep> soil_case_sweeps() {
  return {strength_sweep(), to_the_grains_sweep(), rigid_beside_sweep(), gate_gone_sweep()};
}

}  // namespace suffuse::stress
