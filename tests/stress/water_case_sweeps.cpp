/// Water in the classes of input that tests/cases represents: dry soil under rising floods, decades
/// with jumps, heads at ground level, bedding, slivers and coarse meshes, steady flow in
/// unsaturated space. Each is judged by a known bound or number.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "box_mesh.hpp"
#include "solver/model_case.hpp"
#include "stress/random_soil.hpp"
#include "stress/space_mesh.hpp"
#include "stress/sweep_parts.hpp"

namespace suffuse::stress {
namespace {

constexpr unsigned runs = 30;
constexpr double round_off = 1e-12;
/// Largest relative error of a known discharge: three times the default tolerance.
constexpr double max_error = 3e-3;
/// Largest share of grains in the volume of a liquid.
constexpr double packing = 0.62;

double largest(const std::vector<double>& values) {
  return *std::ranges::max_element(values);
}

// --- Dry soil under a rising flood

/// A levee of one soil.
struct Bank {
  int rows = 0;
  double height = 0.0;
  double crest = 0.0;
  double water_side = 0.0;  ///< slopes: metres along per metre up
  double land_side = 0.0;

  [[nodiscard]] double length() const { return crest + height * (water_side + land_side); }
};

Bank drawn_bank(unsigned seed) {
  Random random(seed + 100000);
  Bank bank;
  bank.rows = 4 + random.below(4);
  bank.height = random.between(1.0, 4.0);
  bank.crest = bank.height * random.between(0.3, 1.0);
  bank.water_side = random.between(0.5, 2.5);
  bank.land_side = random.between(0.5, 2.5);
  return bank;
}

Mesh<2> bank_mesh(unsigned seed) {
  const Bank bank = drawn_bank(seed);
  const int columns = std::max(3, static_cast<int>(bank.rows * 0.7 * bank.length() / bank.height));
  return model::column_mesh(columns, bank.rows, 1.0, bank.height, [&](const Vector<2>& x) {
    const double left = bank.water_side * x[1];
    const double right = bank.length() - bank.land_side * x[1];
    return Vector<2>(std::lerp(left, right, x[0]), x[1]);
  });
}

constexpr double dry = 0.3;         // effective saturation
constexpr double lost_there = 0.1;  // share of the fines

/// Soil that the flood never wets keeps its fines, and no liquid holds more of them than their
/// densest packing.
Complaints keeps_dry_fines(const ResultsReader& results, double residual) {
  Complaints complaints;
  const Table history = results.history();
  const double c = largest(history.column("concentration_max"));
  if (c > packing) complaints.push_back("c = " + shown(c) + " > " + shown(packing));
  const auto field = [&](std::size_t index, const char* name) {
    return results.field(index, "cell", name).values;
  };
  const std::vector<double> first = field(0, "erodible_fraction");
  std::vector<double> wettest(first.size(), 0.0);
  for (std::size_t i = 0; i < results.times().size(); ++i) {
    const std::vector<double> saturation = field(i, "saturation");
    for (std::size_t e = 0; e < wettest.size(); ++e) {
      wettest[e] = std::max(wettest[e], (saturation[e] - residual) / (1.0 - residual));
    }
  }
  const std::vector<double> last = field(results.times().size() - 1, "erodible_fraction");
  for (std::size_t e = 0; e < wettest.size(); ++e) {
    if (wettest[e] > dry || last[e] >= (1.0 - lost_there) * first[e]) continue;
    complaints.push_back("element " + std::to_string(e) + " lost " +
                         shown(1.0 - last[e] / first[e]) +
                         " of its fines; its saturation is never above " + shown(wettest[e]));
    break;
  }
  return complaints;
}

Sweep dry_crest_sweep() {
  SweepMaker maker("dry-crest",
                   "drives gradient, shear-stress and power in nearly dry levees under rising "
                   "floods");
  for (unsigned seed = 1; seed <= runs; ++seed) {
    Random random(seed + 101000);
    const Bank bank = drawn_bank(seed);
    constexpr std::array<const char*, 3> drives{"gradient", "power", "shear-stress"};
    const std::string drive = drives[seed % drives.size()];
    const double k = random.decades(1e-6, 1e-3);
    const double n = random.between(0.3, 0.45);
    const double fines = (1.0 - n) * random.between(0.1, 0.3);
    const double residual = random.between(0.02, 0.15);
    const double end = random.decades(2.0, 20.0) * n * bank.height / k;
    // Fines take at most a third of the liquid that has crossed the levee: k_r i of the drive
    // `gradient` is q / k, so that c grows by fines * rate / k per metre.
    const double share = random.decades(0.01, 0.3) * k / (fines * bank.length());
    const double permeability = k * 1e-3 / weight;
    const double scale = drive == "gradient" ? 1.0
                         : drive == "power"  ? weight * k
                                             : weight * std::sqrt(2.0 * permeability / n);
    std::string soil =
        "soil.specimen={" + entry("porosity", n) + ", " +
        entry("skeleton_fraction", 1.0 - n - fines) + ", grain_density=2650, " +
        entry("conductivity", k) + ", retention={model=\"van-genuchten\", " +
        entry("alpha", random.decades(1.0, 15.0)) + ", " + entry("n", random.decades(1.3, 4.0)) +
        ", " + entry("residual_saturation", residual) + "}, " + "erosion={law=\"first-order\", " +
        word("drive", drive) + ", " + entry("rate", share / scale) + ", " +
        entry("threshold", (random.chance(0.5) ? 0.0 : 0.1) * scale) + ", " +
        entry("residual", random.chance(0.5) ? 0.0 : 0.2 * fines) + "}";
    if (random.chance(0.5)) soil += ", conductivity_law=\"kozeny-carman\"";
    constexpr std::array<const char*, 3> above{"seepage", "impervious", "suction"};
    const std::string flood =
        pairs({{0.0, random.between(-0.3, 0.0)},
               {random.decades(0.01, 0.5) * end, bank.height * random.between(0.4, 0.95)}});
    const Changes changes{"gravity=[0, -9.81]",
                          soil + "}",
                          "boundary[0]={on=\"left\", concentration=0, head=" + flood + ", " +
                              word("dry", above[random.below(2)]) + "}",
                          "boundary[1]={on=\"right\", seepage_face=true}",
                          "initial.water_level=" + number(-random.decades(0.1, 3.0)),
                          "liquid.bulk_modulus=" + std::string(random.chance(0.5) ? "2e9" : "inf"),
                          "time.tolerance=1e-2"};
    maker.add(
        {Scheme::sp_implicit}, drive,
        [&](Scenario& s) {
          s.mesh = [seed] { return bank_mesh(seed); };
          s.end = end;
          s.changes = [changes](const Span&) { return changes; };
          s.demands = [residual](const ResultsReader& results) {
            return keeps_dry_fines(results, residual);
          };
        },
        seed);
  }
  return maker.done();
}

// --- Decades, jumps and far ends

/// Times and values of a pressure that jumps within almost no time, as `pairs`.
struct Jumps {
  std::vector<std::pair<double, double>> values;

  [[nodiscard]] double at(double t) const {
    double value = values.front().second;
    for (std::size_t i = 1; i < values.size(); ++i) {
      const auto& [before, low] = values[i - 1];
      const auto& [after, high] = values[i];
      if (t >= after) value = high;
      if (t > before && t < after) value = std::lerp(low, high, (t - before) / (after - before));
    }
    return value;
  }
};

Jumps drawn_jumps(Random& random, double end) {
  Jumps jumps{{{0.0, random.between(1e3, 6e3)}}};
  const int count = 1 + random.below(4);
  for (int i = 1; i <= count; ++i) {
    const double at = end * (i - random.between(0.05, 0.95)) / count;
    const double width = random.chance(0.5) ? std::max(1e-3, 1e-14 * end) : 1e-6 * end;
    jumps.values.emplace_back(at, jumps.values.back().second);
    jumps.values.emplace_back(at + width, random.between(-6e3, 6e3));
  }
  return jumps;
}

Complaints follows_jumps(const ResultsReader& results, const Jumps& jumps, double k) {
  const Table history = results.history();
  const std::vector<double>& t = history.column("t");
  const double highest = 0.5 * k * 6e3 / weight;
  for (std::size_t i = 1; i < t.size(); ++i) {
    const double exact = 0.5 * k * std::abs(jumps.at(t[i])) / weight;
    const double flux = history.column("flux_out")[i];
    if (std::abs(flux - exact) <= max_error * std::max(exact, 0.01 * highest)) continue;
    return {"flux_out = " + shown(flux) + " m3/s at t = " + shown(t[i]) + " s; expected " +
            shown(exact)};
  }
  return {};
}

Sweep decades_sweep() {
  SweepMaker maker("decades",
                   "columns over up to 1e12 s, with jumps at any time; fines that stay, "
                   "erode, come and settle");
  for (unsigned seed = 1; seed <= runs; ++seed) {
    Random random(seed + 110000);
    const double end = random.decades(1e6, 1e12);
    const double k = random.decades(1e-7, 2e-2);
    const Jumps jumps = drawn_jumps(random, end);
    const bool second_order = random.chance(0.5);
    const int kind = static_cast<int>(seed % 3);
    Changes changes{
        set("soil.specimen.conductivity", k),
        "boundary[0]={on=\"top\", concentration=" + std::string(kind == 2 ? "0.01" : "0") +
            ", pressure=" + pairs(jumps.values) + "}"};
    constexpr std::array<const char*, 3> moduli{"2e7", "2e9", "inf"};
    changes.push_back(std::string("liquid.bulk_modulus=") + moduli[random.below(3)]);
    if (kind == 0) {
      changes.emplace_back("soil.specimen.erosion={law=\"none\"}");
    } else {
      const double passed = k * 0.5 * end;  // m
      changes.emplace_back("soil.specimen.conductivity_law=kozeny-carman");
      changes.push_back("soil.specimen.erosion={law=\"first-order\", drive=\"flux\", " +
                        entry("rate", random.decades(0.1, 100.0) / passed) + ", " +
                        entry("threshold", random.between(0.0, 0.4) * k) + "}");
      if (kind == 2) {
        changes.push_back("soil.specimen.deposition={" +
                          entry("coefficient", random.decades(0.1, 100.0)) + ", porosity_min=0.1}");
      }
    }
    constexpr std::array<const char*, 3> kinds{"nothing erodes", "erodes", "erodes and settles"};
    maker.add(
        {second_order ? Scheme::sp_implicit : Scheme::sp_monotone}, kinds[kind],
        [&](Scenario& s) {
          s.end = end;
          s.changes = [changes](const Span&) { return changes; };
          if (kind == 0) {
            s.demands = [=](const ResultsReader& results) {
              return follows_jumps(results, jumps, k);
            };
          }
        },
        seed);
  }
  return maker.done();
}

// --- Heads at the height of the ground

/// Ground in two levels, `up` on the left and `down` on the right of a steep bank.
struct Terrace {
  double high = 0.0;
  double low = 0.0;
  double width = 0.0;
  int columns = 0;
  int rows = 0;
  int depth = 0;  ///< cells across; 0: two dimensions

  [[nodiscard]] double level(double x) const {
    const double step = width / columns;
    const double bank = step * (columns / 2);
    const double share = std::clamp((x - bank) / step, 0.0, 1.0);
    return share <= 1e-9 ? high : share >= 1.0 - 1e-9 ? low : std::lerp(high, low, share);
  }
};

Terrace drawn_terrace(unsigned seed) {
  Random random(seed + 120000);
  Terrace terrace;
  terrace.low = random.decades(0.3, 30.0);
  terrace.high = terrace.low * random.between(1.1, 3.0);
  terrace.width = terrace.low * random.between(1.0, 5.0);
  terrace.columns = 4 + random.below(8);
  terrace.rows = 3 + random.below(5);
  terrace.depth = seed % 2 == 0 ? 0 : 1 + random.below(3);
  return terrace;
}

/// Splits `top` into the faces at each level; the bank between them stays `top`.
template <int Dim>
Mesh<Dim> with_terraces(Mesh<Dim> mesh, const Terrace& terrace) {
  BoundarySet<Dim> up{"up", {}};
  BoundarySet<Dim> down{"down", {}};
  for (BoundarySet<Dim>& set : mesh.boundaries) {
    if (set.name != "top") continue;
    std::erase_if(set.faces, [&](const auto& face) {
      const auto all_at = [&](double level) {
        return std::ranges::all_of(face,
                                   [&](int node) { return mesh.nodes[node][Dim - 1] == level; });
      };
      if (all_at(terrace.high)) up.faces.push_back(face);
      if (all_at(terrace.low)) down.faces.push_back(face);
      return all_at(terrace.high) || all_at(terrace.low);
    });
  }
  mesh.boundaries.push_back(up);
  mesh.boundaries.push_back(down);
  return mesh;
}

Mesh<2> plane_terrace(const Terrace& t) {
  return with_terraces(model::column_mesh(t.columns, t.rows, t.width, 1.0,
                                          [&](const Vector<2>& x) {
                                            const double level = t.level(x[0]);
                                            return Vector<2>(x[0],
                                                             x[1] == 1.0 ? level : level * x[1]);
                                          }),
                       t);
}

Mesh<3> space_terrace(const Terrace& t) {
  const double depth = t.width * t.depth / t.columns;
  return with_terraces(model::box_mesh({t.columns, t.depth, t.rows}, {t.width, depth, 1.0},
                                       [&](const Vector<3>& x) {
                                         const double level = t.level(x[0]);
                                         return Vector<3>(x[0], x[1],
                                                          x[2] == 1.0 ? level : level * x[2]);
                                       }),
                       t);
}

/// Heads at ground level first, then above and below it by a share of the difference.
Complaints is_continuous(const ResultsReader& results, const std::vector<double>& share_of_head) {
  const Table history = results.history();
  const std::vector<double>& flux = history.column("flux_out");
  if (flux.front() <= 0.0) return {"nothing flows where heads are at ground level"};
  for (std::size_t i = 0; i < flux.size(); ++i) {
    // Rows are in the middle of the intervals of constant head.
    const double exact = flux.front() * share_of_head[i];
    if (std::abs(flux[i] - exact) <= max_error * exact) continue;
    return {"flux_out = " + shown(flux[i]) + " m3/s in row " + std::to_string(i) + ", " +
            shown(flux.front()) + " at ground level; expected " + shown(exact)};
  }
  return {};
}

Sweep ground_level_sweep() {
  SweepMaker maker("ground-level",
                   "heads at exactly the height of the ground, a little above and below, in two "
                   "and three dimensions");
  constexpr double end = 100.0;
  for (unsigned seed = 1; seed <= runs; ++seed) {
    const Terrace terrace = drawn_terrace(seed);
    Random random(seed + 121000);
    const double fall = terrace.high - terrace.low;
    // Ground above its water level is dry: water leaves it, but enters only by suction.
    const bool inlet_falls = random.chance(0.5);
    const bool suction = inlet_falls || random.chance(0.5);
    const double small = fall * random.decades(1e-9, 1e-2);
    const double k = random.decades(1e-7, 1e-2);
    const bool outlet_moves = random.chance(0.5);
    const bool outlet_seeps = random.chance(0.5);
    const double below = inlet_falls || outlet_moves ? -small : 0.0;
    // Level, above, level, below, level; each row is in the middle of its interval.
    const std::vector<double> offsets{0.0, small, 0.0, below, 0.0};
    std::vector<std::pair<double, double>> heads;
    std::vector<double> shares;
    const double level = outlet_moves ? terrace.low : terrace.high;
    for (std::size_t i = 0; i < offsets.size(); ++i) {
      const double each = end / static_cast<double>(offsets.size() - 1);
      const double at = each * static_cast<double>(i);
      const double value = offsets[i] == 0.0 ? level : level + offsets[i];
      if (i > 0) heads.emplace_back(at - 0.3 * each, value);
      heads.emplace_back(at + 0.3 * each, value);
      if (i == 0) heads.insert(heads.begin(), {0.0, value});
      // Water leaves dry ground at zero pressure, as it does at ground level.
      const bool seeps = outlet_moves && outlet_seeps && offsets[i] < 0.0;
      shares.push_back(seeps ? 1.0 : 1.0 + (outlet_moves ? -1.0 : 1.0) * offsets[i] / fall);
    }
    const std::string moving = "head=" + pairs(heads);
    const bool space = terrace.depth > 0;
    const Changes changes{std::string("gravity=") + (space ? "[0, 0, -9.81]" : "[0, -9.81]"),
                          set("soil.specimen.conductivity", k),
                          "soil.specimen.erosion={law=\"none\"}",
                          "boundary[0]={on=\"up\", concentration=0, " +
                              (outlet_moves ? "head=" + number(terrace.high) : moving) + ", " +
                              word("dry", suction ? "suction" : "seepage") + "}",
                          "boundary[1]={on=\"down\", " +
                              (outlet_moves ? moving : "head=" + number(terrace.low)) + ", " +
                              word("dry", outlet_seeps ? "seepage" : "suction") + "}",
                          "initial.flow=steady",
                          "liquid.bulk_modulus=inf",
                          "output.every=" + number(end / 4.0)};
    maker.add(
        {seed % 4 < 2 ? Scheme::sp_implicit : Scheme::sp_monotone}, space ? "space" : "plane",
        [&](Scenario& s) {
          if (space) {
            s.mesh = [=] { return space_terrace(terrace); };
          } else {
            s.mesh = [=] { return plane_terrace(terrace); };
          }
          s.end = end;
          s.changes = [changes](const Span&) { return changes; };
          s.demands = [shares](const ResultsReader& results) {
            return is_continuous(results, shares);
          };
        },
        seed);
  }
  return maker.done();
}

// --- Bedding

/// The discharge of a column lies between that of vertical flow and that of level heads.
struct Bounds {
  double low = 0.0;
  double high = 0.0;
};

Complaints stays_within(const ResultsReader& results, const Bounds& bounds) {
  const Table history = results.history();
  for (const double flux : history.column("flux_out")) {
    if (flux >= (1.0 - max_error) * bounds.low && flux <= (1.0 + max_error) * bounds.high) continue;
    return {"flux_out = " + shown(flux) + " m3/s; expected " + shown(bounds.low) + " to " +
            shown(bounds.high)};
  }
  return {};
}

Sweep bedding_sweep() {
  SweepMaker maker("bedding",
                   "conductivities along and across bedding in any ratio and direction; "
                   "fines that erode by the gradient");
  for (unsigned seed = 1; seed <= runs; ++seed) {
    Random random(seed + 130000);
    const bool space = seed % 3 == 0;
    const double along = random.decades(1e-9, 1e-2);
    const double across = along * random.decades(1e-6, 1e6);
    const double dip = random.chance(0.2) ? 45.0 * random.below(4) : random.between(-180.0, 180.0);
    const double angle = dip * std::numbers::pi / 180.0;
    const double sine = std::sin(angle) * std::sin(angle);
    const double cosine = std::cos(angle) * std::cos(angle);
    const double width = random.decades(0.1, 10.0);
    const double depth = space ? random.decades(0.3, 3.0) : 1.0;
    const double drop = width * depth * 6e3 / weight;  // times the conductivity: m3/s
    const Bounds bounds{drop / (sine / along + cosine / across),
                        drop * (sine * along + cosine * across)};
    const bool erodes = random.chance(0.5);
    const int columns = 2 + random.below(5);
    const int rows = 3 + random.below(6);
    const double scale = 1.0 / std::min(along, across);  // s/m
    const double end = random.decades(0.1, 10.0) * 0.3 * scale;
    const Changes changes{
        "soil.specimen.conductivity=[" + number(along) + ", " + number(across) + "]",
        set("soil.specimen.bedding", dip),
        erodes ? "soil.specimen.erosion={law=\"first-order\", drive=\"gradient\", " +
                     entry("rate", random.decades(0.01, 0.3) * std::min(along, across)) +
                     ", threshold=0.1}"
               : "soil.specimen.erosion={law=\"none\"}",
        "boundary[0]={on=\"top\", pressure=6e3, concentration=0}",
        "initial.flow=steady",
        std::string("liquid.bulk_modulus=") + (random.chance(0.5) ? "2e9" : "inf")};
    maker.add(
        {random.chance(0.5) ? Scheme::sp_implicit : Scheme::sp_monotone},
        std::string(space ? "space" : "plane") + (erodes ? "; erodes" : ""),
        [&](Scenario& s) {
          if (space) {
            s.mesh = [=] { return model::box_mesh({columns, 2, rows}, {width, depth, 1.0}); };
          } else {
            s.mesh = [=] {
              Mesh<2> mesh = model::column_mesh(columns, rows, width, 1.0);
              jitter_nodes(mesh, 0.2 * std::min(width / columns, 1.0 / rows), seed);
              return mesh;
            };
          }
          s.end = end;
          s.changes = [changes](const Span&) { return changes; };
          if (!erodes) {
            s.demands = [bounds](const ResultsReader& results) {
              return stays_within(results, bounds);
            };
          }
        },
        seed);
  }
  return maker.done();
}

// --- Slivers and coarse meshes

/// Columns with straight sides, of which one row is `thin` times as high as the others and its
/// upper nodes stand above the middle of the edges below, or of one or two cells in all.
Mesh<2> plane_slivers(unsigned seed, double thin) {
  Random random(seed + 140000);
  const int columns = thin == 1.0 ? 1 : 2 + random.below(4);
  const int rows = thin == 1.0 ? 1 + random.below(2) : 3 + random.below(4);
  const int flat = 1 + random.below(std::max(1, rows - 1));
  const double cell = 0.5 / columns;
  return model::column_mesh(columns, rows, 0.5, 1.0, [=](const Vector<2>& x) {
    const auto row = std::lround(x[1] * rows);
    if (row != flat || thin == 1.0) return x;
    const bool inside = x[0] > 1e-9 && x[0] < 0.5 - 1e-9;
    return Vector<2>(x[0] + (inside ? 0.5 * cell : 0.0), (flat - 1.0 + thin) / rows);
  });
}

Mesh<3> space_slivers(unsigned seed, double thin) {
  Random random(seed + 140000);
  const int columns = thin == 1.0 ? 1 : 2 + random.below(2);
  const int rows = thin == 1.0 ? 1 : 2 + random.below(3);
  const int flat = 1 + random.below(std::max(1, rows - 1));
  const double cell = 0.5 / columns;
  return model::box_mesh({columns, columns, rows}, {0.5, 0.5, 1.0}, [=](const Vector<3>& x) {
    const auto row = std::lround(x[2] * rows);
    if (row != flat || thin == 1.0) return x;
    const bool inside = x[0] > 1e-9 && x[0] < 0.5 - 1e-9;
    return Vector<3>(x[0] + (inside ? 0.5 * cell : 0.0), x[1], (flat - 1.0 + thin) / rows);
  });
}

/// In still water, only round-off of the pressures flows.
Complaints is_still(const ResultsReader& results, double k) {
  const Table history = results.history();
  const double flux =
      std::max(largest(history.column("flux_in")), largest(history.column("flux_out")));
  if (flux <= 1e-9 * k) return {};
  return {"still water flows: " + shown(flux) + " m3/s"};
}

Complaints has_flux(const ResultsReader& results, double exact) {
  const Table history = results.history();
  for (const double flux : history.column("flux_out")) {
    if (std::abs(flux - exact) <= max_error * exact) continue;
    return {"flux_out = " + shown(flux) + " m3/s; expected " + shown(exact)};
  }
  return {};
}

Sweep flat_cells_sweep() {
  SweepMaker maker("flat-cells",
                   "next to flat triangles and tetrahedra, and meshes of one or two "
                   "cells: still water, air, a flux that is known");
  for (unsigned seed = 1; seed <= runs; ++seed) {
    Random random(seed + 141000);
    const bool space = seed % 2 == 0;
    const double thin = seed % 5 == 0 ? 1.0 : random.decades(1e-7, 1e-2);
    const double k = random.decades(1e-7, 1e-2);
    const int kind = static_cast<int>(seed % 3);
    const std::string retention = "soil.specimen.retention={model=\"van-genuchten\", " +
                                  entry("alpha", random.decades(1.0, 10.0)) + ", " +
                                  entry("n", random.between(1.3, 3.0)) +
                                  ", residual_saturation=0.1}";
    Changes changes{set("soil.specimen.conductivity", k), "soil.specimen.erosion={law=\"none\"}",
                    std::string("liquid.bulk_modulus=") + (random.chance(0.5) ? "2e9" : "inf")};
    const std::string heavy = space ? "gravity=[0, 0, -9.81]" : gravity;
    const double end = random.decades(1.0, 100.0) * 0.3 / k;
    if (kind == 0) {
      // The column is full to its top, where there is air.
      changes = joined(changes, {heavy, rest_level, "boundary[0]={on=\"top\", seepage_face=true}",
                                 "boundary[1]={on=\"right\", head=1.0}"});
      if (random.chance(0.5)) changes.push_back(retention);
    } else if (kind == 1) {
      // Water below the level, suction above.
      const double level = random.between(0.1, 0.9);
      changes = joined(changes, {heavy, retention, set("initial.water_level", level),
                                 "boundary[0]={on=\"top\", seepage_face=true}",
                                 "boundary[1]={on=\"bottom\", " + entry("head", level) + "}"});
    } else {
      changes.emplace_back("initial.flow=steady");
    }
    const double area = space ? 0.25 : 0.5;
    constexpr std::array<const char*, 3> kinds{"still", "still with air", "flows"};
    maker.add(
        {seed % 4 < 2 ? Scheme::sp_implicit : Scheme::sp_monotone},
        std::string(kinds[kind]) + "; " + (space ? "space" : "plane") + "; 1:" + shown(1.0 / thin),
        [&](Scenario& s) {
          if (space) {
            s.mesh = [=] { return space_slivers(seed, thin); };
          } else {
            s.mesh = [=] { return plane_slivers(seed, thin); };
          }
          s.end = end;
          s.changes = [changes](const Span&) { return changes; };
          s.demands = [=](const ResultsReader& results) {
            return kind < 2 ? is_still(results, k) : has_flux(results, area * k * 6e3 / weight);
          };
        },
        seed);
  }
  return maker.done();
}

// --- Steady flow in unsaturated space

/// Inflow equals outflow, and nothing changes.
Complaints stays_steady(const ResultsReader& results) {
  Complaints complaints;
  const Table history = results.history();
  const std::vector<double>& in = history.column("flux_in");
  const std::vector<double>& out = history.column("flux_out");
  const double flux = std::max(in.front(), out.front());
  if (std::abs(in.front() - out.front()) > 1e-6 * flux) {
    complaints.push_back(shown(in.front()) + " m3/s enter and " + shown(out.front()) +
                         " leave at the start");
  }
  if (std::abs(out.back() - out.front()) > 0.01 * flux) {
    complaints.push_back("flux_out goes from " + shown(out.front()) + " to " + shown(out.back()) +
                         " m3/s");
  }
  const Table ledger = results.ledger();
  const std::vector<double>& water = ledger.column("water");
  const double change = std::abs(water.back() / water.front() - 1.0);
  if (change > 1e-3) complaints.push_back("the water changes by " + shown(change));
  return complaints;
}

Sweep steady_space_sweep() {
  SweepMaker maker("steady-space",
                   "dams of unsaturated soils in three dimensions, steady from the start");
  for (unsigned seed = 1; seed <= runs; ++seed) {
    const Mesh<3> mesh = space_mesh(seed + 1000, SpaceShape::dam, Cut::none);
    Random random(seed + 150000);
    const double k = random.decades(1e-7, 1e-3);
    Changes changes{"gravity=[0, 0, -9.81]"};
    double least = k;
    for (const std::string& name : mesh.region_names) {
      const double own = k * random.decades(1e-3, 1.0);
      least = std::min(least, own);
      const bool gardner = random.chance(0.5);
      changes.push_back("soil." + name + "={porosity=0.35, skeleton_fraction=0.65, " +
                        "grain_density=2650, " + entry("conductivity", own) + ", retention={" +
                        word("model", gardner ? "gardner" : "van-genuchten") + ", " +
                        entry("alpha", random.decades(0.5, 8.0)) +
                        (gardner ? "" : ", " + entry("n", random.between(1.3, 4.0))) + ", " +
                        entry("residual_saturation", random.between(0.0, 0.2)) + "}}");
    }
    constexpr std::array<const char*, 3> above{"seepage", "impervious", "suction"};
    std::string boundaries = "boundary=[{on=\"left\", " + entry("head", random.between(0.2, 1.0)) +
                             ", " + word("dry", above[random.below(2)]) + "}, {on=\"right\", " +
                             (random.chance(0.6) ? std::string("seepage_face=true")
                                                 : entry("head", random.between(0.0, 0.2))) +
                             "}";
    if (random.chance(0.5)) {
      boundaries += ", {on=\"top\", " + entry("rain", random.decades(1e-3, 2.0) * least) + "}";
    }
    changes = joined(changes,
                     {boundaries + "]", "initial.flow=steady",
                      std::string("liquid.bulk_modulus=") + (random.chance(0.5) ? "2e9" : "inf")});
    const double end = random.decades(0.1, 10.0) * 0.35 / k;
    maker.add(
        {Scheme::sp_implicit}, "dam",
        [&](Scenario& s) {
          s.mesh = [mesh] { return mesh; };
          s.end = end;
          s.changes = [changes](const Span&) { return changes; };
          s.demands = stays_steady;
        },
        seed);
  }
  return maker.done();
}

}  // namespace

std::vector<Sweep> water_case_sweeps() {
  return {dry_crest_sweep(), decades_sweep(),    ground_level_sweep(),
          bedding_sweep(),   flat_cells_sweep(), steady_space_sweep()};
}

}  // namespace suffuse::stress
