#include <algorithm>
#include <cmath>
#include <sstream>

#include "solver/double_point_case.hpp"
#include "stress/scenario.hpp"
#include "stress/stress_mesh.hpp"

namespace suffuse::stress {
namespace {

constexpr unsigned seeds = 20;
const std::vector<Scheme> every(all_schemes.begin(), all_schemes.end());
const std::vector<Scheme> explicit_ones{Scheme::sp_explicit, Scheme::dp_mixed,
                                        Scheme::dp_material_point};
const std::vector<Scheme> implicit_ones{Scheme::sp_implicit, Scheme::sp_monotone,
                                        Scheme::dp_implicit, Scheme::dp_monotone};
const std::vector<Scheme> double_point_ones{Scheme::dp_mixed, Scheme::dp_material_point,
                                            Scheme::dp_implicit, Scheme::dp_monotone};

std::string number(double value) {
  std::ostringstream text;
  text.precision(17);
  text << value;
  return text.str();
}
std::string shown(double value) {
  std::ostringstream text;
  text.precision(4);
  text << value;
  return text.str();
}
std::string set(const std::string& key, double value) {
  return key + "=" + number(value);
}
/// Pairs [t, value] of a boundary that changes.
std::string pairs(const std::vector<std::pair<double, double>>& values) {
  std::string text = "[";
  for (const auto& [t, value] : values) text += "[" + number(t) + ", " + number(value) + "], ";
  return text + "]";
}

const std::string specimen = "soil.specimen.";
const std::string gravity = "gravity=[0, -9.81]";
/// The column is 1 m high: at rest p = 0 at its top.
const std::string rest_level = "initial.water_level=1.0";
const std::string top_flux = "boundary[0]={on=\"top\", darcy_flux=";

Changes joined(Changes first, const Changes& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

/// A law that erodes most of a tenth of the volume within the run: every law is given the rate that
/// does.
Changes erosion(const std::string& law, const Span& span) {
  const double rate = law == "constant"      ? 0.1 / (0.6 * span.end)
                      : law == "logarithmic" ? 0.5 / span.end
                      : law == "first-order" ? 3.0 / span.end
                                             : 300.0 / span.end;  // 1/m, at |q| = 0.01 m/s
  return {"soil.specimen.erosion={law=\"" + law + "\", rate=" + number(rate) +
          ", start=" + number(0.1 * span.end) + "}"};
}

/// Discharge of the 0.5 m wide column under 6 kPa, layers of the same height on each other.
double layered_discharge(const std::vector<double>& conductivities) {
  double resistance = 0.0;
  for (const double k : conductivities) {
    resistance += 1.0 / static_cast<double>(conductivities.size()) / k;
  }
  return 0.5 * 6000.0 / (1000.0 * 9.81) / resistance;
}

class SweepMaker {
 public:
  SweepMaker(std::string name, std::string what) : sweep_{std::move(name), std::move(what), {}} {}

  template <class Make>
  void add(const std::vector<Scheme>& schemes, const std::string& parameters, const Make& make,
           unsigned seed = 0) {
    for (const Scheme scheme : schemes) {
      Scenario scenario;
      scenario.scheme = scheme;
      scenario.parameters = parameters;
      scenario.seed = seed;
      scenario.mesh = plain_column;
      make(scenario);
      sweep_.scenarios.push_back(std::move(scenario));
    }
  }
  /// Of a scene whose changes do not depend on anything.
  void add(const std::vector<Scheme>& schemes, const std::string& parameters, Changes changes) {
    add(schemes, parameters,
        [&](Scenario& s) { s.changes = [changes](const Span&) { return changes; }; });
  }
  void add_refused(const std::vector<Scheme>& schemes, const std::string& parameters,
                   Changes changes) {
    add(schemes, parameters, [&](Scenario& s) {
      s.changes = [changes](const Span&) { return changes; };
      s.expected = Expected::refused;
    });
  }
  Sweep done() { return std::move(sweep_); }

 private:
  Sweep sweep_;
};

Sweep conductivity() {
  SweepMaker sweep("conductivity",
                   "k from 1e-9 to 1e-1 m/s; from rest and steady; drag stepped either way");
  for (int power = -9; power <= -1; ++power) {
    const double k = std::pow(10.0, power);
    for (const std::string start : {"rest", "steady"}) {
      sweep.add(every, "k = " + shown(k) + " from " + start, [&](Scenario& s) {
        s.changes = [=](const Span&) {
          return Changes{set(specimen + "conductivity", k), "initial.flow=" + start};
        };
        if (start == "steady") s.discharge = layered_discharge({k});
      });
    }
    sweep.add(explicit_ones, "k = " + shown(k) + " drag stepped implicitly",
              {set(specimen + "conductivity", k), "time.drag=implicit"});
  }
  return sweep.done();
}

Sweep contrast() {
  SweepMaker sweep(
      "contrast",
      "conductivities 1e8 apart: layers, strips, an inclusion, and three regions at random");
  struct Shape {
    const char* name;
    std::function<std::string(const Vector<2>&)> region;
    bool layered;
  };
  const std::vector<Shape> shapes{
      {"layers", [](const Vector<2>& x) { return x[1] > 0.5 ? "specimen" : "other"; }, true},
      {"strips", [](const Vector<2>& x) { return x[0] > 0.25 ? "specimen" : "other"; }, false},
      {"inclusion",
       [](const Vector<2>& x) {
         return std::abs(x[0] - 0.25) < 0.125 && std::abs(x[1] - 0.5) < 0.25 ? "other" : "specimen";
       },
       false}};
  for (const Shape& shape : shapes) {
    for (const auto& [inside, outside] :
         std::vector<std::pair<double, double>>{{1e-1, 1e-9}, {1e-9, 1e-1}, {1e-5, 1e-1}}) {
      for (const std::string start : {"rest", "steady"}) {
        sweep.add(every,
                  std::string(shape.name) + " " + shown(inside) + " | " + shown(outside) +
                      " from " + start,
                  [&](Scenario& s) {
                    s.mesh = [shape] {
                      Mesh<2> mesh = plain_column();
                      name_regions(mesh, shape.region);
                      return mesh;
                    };
                    s.changes = [=](const Span&) {
                      return Changes{set(specimen + "conductivity", outside),
                                     "soil.other={like=\"specimen\", conductivity=" +
                                         number(inside) + ", erosion={law=\"none\"}}",
                                     "initial.flow=" + start};
                    };
                    if (shape.layered && start == "steady") {
                      s.discharge = layered_discharge({inside, outside});
                    }
                  });
      }
    }
  }
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    sweep.add(
        every, "three regions at random",
        [&](Scenario& s) {
          s.mesh = [seed] {
            Mesh<2> mesh = plain_column();
            Random random(seed);
            name_regions(mesh, [&](const Vector<2>&) {
              return std::vector<std::string>{"specimen", "b", "c"}[random.below(3)];
            });
            return mesh;
          };
          s.changes = [seed](const Span&) {
            Random random(seed + 1000);
            const auto k = [&] { return number(random.decades(1e-9, 1e-1)); };
            return Changes{specimen + "conductivity=" + k(),
                           "soil.b={like=\"specimen\", conductivity=" + k() + "}",
                           "soil.c={like=\"specimen\", conductivity=" + k() + "}"};
          };
        },
        seed);
  }
  return sweep.done();
}

Sweep modulus() {
  SweepMaker sweep("modulus", "K from 2e5 Pa to infinity; water pressed beyond what it can take");
  for (const double modulus : {2e5, 2e6, 2e7, 2e9, 1e12}) {
    sweep.add(every, "K = " + shown(modulus), {set("liquid.bulk_modulus", modulus)});
  }
  sweep.add(implicit_ones, "K infinite", {"liquid.bulk_modulus=inf"});
  sweep.add_refused(explicit_ones, "K infinite", {"liquid.bulk_modulus=inf"});
  sweep.add_refused(every, "p > K",
                    {"liquid.bulk_modulus=2e5", "boundary[0].pressure=3e5", "initial.flow=steady"});
  sweep.add(every, "p = K/2", {"liquid.bulk_modulus=2e5", "boundary[0].pressure=1e5"});
  sweep.add(every, "suction of K/2", {"liquid.bulk_modulus=2e5", "boundary[0].pressure=-1e5"});
  return sweep.done();
}

Sweep scaling() {
  SweepMaker sweep(
      "mass-scaling",
      "S from 1 to 1e6, pressure and imposed velocity; with the implicit scheme, which has none");
  for (const double scaling : {1.0, 1e2, 1e4, 1e6}) {
    const std::string s = "S = " + shown(scaling);
    sweep.add(explicit_ones, s, {set("time.mass_scaling", scaling)});
    sweep.add(explicit_ones, s + " drag stepped implicitly",
              {set("time.mass_scaling", scaling), "time.drag=implicit"});
    // A million times as heavy, the liquid that is set in motion at once presses harder than K.
    sweep.add(explicit_ones, s + " imposed flux", [&](Scenario& scenario) {
      scenario.changes = [scaling](const Span&) {
        return Changes{set("time.mass_scaling", scaling), top_flux + "0.012, concentration=0.1}"};
      };
      if (scaling > 1e5) scenario.expected = Expected::either;
    });
    sweep.add(explicit_ones, s + " steady start",
              {set("time.mass_scaling", scaling), "initial.flow=steady"});
  }
  sweep.add_refused(implicit_ones, "S = 100", {"time.mass_scaling=100"});
  sweep.add_refused(explicit_ones, "S = 0.5", {"time.mass_scaling=0.5"});
  return sweep.done();
}

Sweep given_step() {
  SweepMaker sweep("step",
                   "given steps from 0.5 to 1.01 of the explicit limit; implicit steps from 1e-6 "
                   "of the run to all of it");
  const auto jump = [] {
    Mesh<2> mesh = plain_column();
    name_regions(mesh, [](const Vector<2>& x) { return x[1] > 0.5 ? "specimen" : "other"; });
    jitter_nodes(mesh, 0.03, 3);
    return mesh;
  };
  for (const double share : {0.5, 0.7, 0.9, 0.99, 0.9999, 1.0001, 1.01}) {
    for (const std::string drag : {"explicit", "implicit"}) {
      for (const bool jumps : {false, true}) {
        sweep.add(
            explicit_ones,
            shown(share) + " of the limit; drag " + drag + (jumps ? "; jump of porosity" : ""),
            [&](Scenario& s) {
              s.explicit_steps = 5000.0;
              if (jumps) s.mesh = jump;
              s.expected = share > 1.0 ? Expected::refused : Expected::done;
              s.changes = [=](const Span& span) {
                Changes result{"time.drag=" + drag};
                // The least of what erosion does to the limit lies within the run.
                if (jumps) {
                  result.push_back(
                      "soil.other={like=\"specimen\", porosity=0.95, skeleton_fraction=0.05, "
                      "conductivity=1e-3, erosion={law=\"none\"}}");
                  result.emplace_back(specimen + "porosity=0.05");
                }
                if (span.limit > 0.0) {
                  result.push_back(set("time.step", share * span.limit));
                }
                return result;
              };
            });
      }
    }
  }
  for (const double share : {1e-6, 1e-3, 0.05, 1.0 / 3.0, 1.0}) {
    sweep.add(implicit_ones, "step " + shown(share) + " of the run", [&](Scenario& s) {
      // Short steps in a short run.
      s.end = share < 1e-4 ? 1e-3 : 100.0;
      const double step = share < 1e-4 ? 1e-6 : share * 100.0;
      s.changes = [step](const Span&) { return Changes{set("time.step", step)}; };
    });
  }
  sweep.add_refused(implicit_ones, "step longer than the run", {"time.step=101"});
  return sweep.done();
}

Sweep porosity() {
  SweepMaker sweep("porosity",
                   "n_0 from 0.01 to 0.99; nothing to erode, a little, nearly everything; at rates "
                   "up to all at once");
  for (const double n : {0.01, 0.05, 0.5, 0.95, 0.99}) {
    for (const double left : {1.0, 0.9, 1e-6}) {  // of the solid: skeleton
      // At all once: in the middle of the run, within a millionth of it.
      for (const double duration : {0.5, 1e-6}) {
        const std::string what = left == 1.0   ? "nothing to erode"
                                 : left == 0.9 ? "a tenth erodes"
                                               : "all but 1e-6 erodes";
        sweep.add(every, "n_0 = " + shown(n) + "; " + what + (duration < 0.1 ? " at once" : ""),
                  [&](Scenario& s) {
                    s.changes = [=](const Span& span) {
                      const double erodible = (1.0 - n) * (1.0 - left);
                      const double rate = std::max(erodible, 1e-3) / (duration * span.end);
                      return Changes{set(specimen + "porosity", n),
                                     set(specimen + "skeleton_fraction", (1.0 - n) * left),
                                     set(specimen + "erosion.rate", rate),
                                     set(specimen + "erosion.start", 0.3 * span.end)};
                    };
                  });
      }
    }
  }
  sweep.add_refused(every, "n_0 + n_C > 1", {specimen + "porosity=0.5"});
  sweep.add_refused(every, "n_0 = 0", {specimen + "porosity=0"});
  sweep.add_refused(every, "n_0 = 1", {specimen + "porosity=1"});
  sweep.add_refused(every, "n_0 falls below 0 in the specimen",
                    {specimen + "porosity_gradient=[0, -0.5]"});
  return sweep.done();
}

Sweep porosity_jump() {
  SweepMaker sweep(
      "porosity-jump",
      "porosity 0.05 and 0.95 across, along, in a checkerboard; gradients; regions at random");
  const auto soils = [](double one, double other) {
    return Changes{set(specimen + "porosity", one),
                   set(specimen + "skeleton_fraction", 0.8 * (1.0 - one)),
                   "soil.other={like=\"specimen\", porosity=" + number(other) +
                       ", skeleton_fraction=" + number(0.8 * (1.0 - other)) + "}"};
  };
  struct Shape {
    const char* name;
    std::function<bool(const Vector<2>&)> is_other;
  };
  const std::vector<Shape> shapes{
      {"layers", [](const Vector<2>& x) { return x[1] < 0.5; }},
      {"strips", [](const Vector<2>& x) { return x[0] < 0.25; }},
      {"checkerboard", [](const Vector<2>& x) {
         return (static_cast<int>(x[0] * 8.0) + static_cast<int>(x[1] * 8.0)) % 2 == 0;
       }}};
  const auto meshed = [](const auto& is_other) {
    return [is_other] {
      Mesh<2> mesh = plain_column();
      name_regions(mesh, [&](const Vector<2>& x) { return is_other(x) ? "other" : "specimen"; });
      return mesh;
    };
  };
  for (const Shape& shape : shapes) {
    for (const bool swapped : {false, true}) {
      for (const std::string start : {"rest", "steady"}) {
        sweep.add(every,
                  std::string(shape.name) + (swapped ? " 0.95 | 0.05" : " 0.05 | 0.95") + " from " +
                      start,
                  [&](Scenario& s) {
                    s.mesh = meshed(shape.is_other);
                    s.changes = [=](const Span&) {
                      return joined(soils(swapped ? 0.95 : 0.05, swapped ? 0.05 : 0.95),
                                    {"initial.flow=" + start});
                    };
                    if (start == "steady") s.discharge = layered_discharge({2e-2});
                  });
      }
    }
  }
  sweep.add(every, "gradient from 0.05 to 0.55",
            {specimen + "porosity=0.05", specimen + "porosity_gradient=[0.2, 0.4]",
             specimen + "skeleton_fraction=0.4"});
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    sweep.add(
        every, "two soils at random",
        [&](Scenario& s) {
          s.mesh = [seed, meshed] {
            Random random(seed);
            return meshed([&](const Vector<2>&) { return random.chance(0.5); })();
          };
          s.changes = [seed, soils](const Span&) {
            Random random(seed + 500);
            const double one = random.between(0.01, 0.99);
            return soils(one, random.between(0.01, 0.99));
          };
        },
        seed);
  }
  return sweep.done();
}

Sweep thin_layer() {
  SweepMaker sweep("thin-layer",
                   "a layer one element thin, 1/10 to 1/10000 of its neighbours, tight or wide "
                   "open, eroding or not");
  for (const double thickness : {1e-1, 1e-2, 1e-4}) {
    for (const double k : {1e-6, 2e-2, 1.0}) {
      for (const std::string law : {"none", "constant"}) {
        sweep.add(
            every,
            "1/" + shown(1.0 / thickness) + "; k = " + shown(k) + (law == "none" ? "" : "; erodes"),
            [&](Scenario& s) {
              s.mesh = [thickness] {
                // The row from 0.5 to 0.625 shrinks to its lower end.
                Mesh<2> mesh = column_with_levels([thickness](double share) {
                  return share < 0.51 ? share : share - 0.125 * (1.0 - thickness);
                });
                name_regions(mesh, [thickness](const Vector<2>& x) {
                  return x[1] > 0.5 && x[1] < 0.5 + 0.125 * thickness ? "layer" : "specimen";
                });
                return mesh;
              };
              if (thickness < 1e-3) s.end = 2.0;  // a step per thickness
              s.changes = [=](const Span& span) {
                return Changes{"soil.layer={like=\"specimen\", conductivity=" + number(k) +
                               ", erosion={law=\"" + law + "\"" +
                               (law == "none" ? "" : ", rate=" + number(1.0 / span.end)) + "}}"};
              };
            });
      }
    }
  }
  return sweep.done();
}

Sweep slivers() {
  SweepMaker sweep("slivers", "angles of 2 degrees, aspect 50, angles of nearly 180 degrees");
  struct Shape {
    const char* name;
    std::function<Mesh<2>()> mesh;
  };
  const std::vector<Shape> shapes{{"aspect 28; 2 degrees", [] { return flat_column(28.6); }},
                                  {"aspect 50", [] { return flat_column(50.0); }},
                                  {"tall; aspect 1/50", [] { return flat_column(0.02); }},
                                  {"obtuse; 2 degrees", [] { return obtuse_column(2.0); }},
                                  {"obtuse; 0.2 degrees", [] { return obtuse_column(0.2); }}};
  for (const Shape& shape : shapes) {
    for (const std::string start : {"rest", "steady"}) {
      sweep.add(every, shape.name + std::string(" from ") + start, [&](Scenario& s) {
        s.mesh = shape.mesh;
        // The same gradient however low the column.
        double height = 0.0;
        for (const Vector<2>& node : shape.mesh().nodes) height = std::max(height, node[1]);
        s.changes = [=](const Span&) {
          return Changes{"initial.flow=" + start, set("boundary[0].pressure", 6000.0 * height)};
        };
        s.end = std::min(100.0, 100.0 * height);
      });
    }
  }
  return sweep.done();
}

Sweep jitter() {
  SweepMaker sweep(
      "jitter",
      "inner nodes moved by up to 0.45 h; half of the runs with an inclusion 1e6 times tighter");
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    sweep.add(
        every, seed % 2 == 0 ? "with inclusion" : "one soil",
        [&](Scenario& s) {
          s.mesh = [seed] {
            Mesh<2> mesh = plain_column();
            jitter_nodes(mesh, 0.45 * 0.125, seed);
            if (seed % 2 == 0) {
              name_regions(mesh, [](const Vector<2>& x) {
                return (x - Vector<2>(0.25, 0.5)).norm() < 0.15 ? "other" : "specimen";
              });
            }
            return mesh;
          };
          s.changes = [seed](const Span&) {
            if (seed % 2 != 0) return Changes{};
            return Changes{
                "soil.other={like=\"specimen\", conductivity=2e-8, erosion={law=\"none\"}}"};
          };
        },
        seed);
  }
  return sweep.done();
}

Sweep points() {
  SweepMaker sweep(
      "points",
      "points jittered, anywhere, on edges, on nodes, twice at one place, 1 or 0 per element");
  for (const int per_element : {1, 3, 6, 12}) {
    for (unsigned seed = 1; seed <= 5; ++seed) {
      sweep.add(
          every, std::to_string(per_element) + " solid points jittered",
          [&](Scenario& s) {
            s.changes = [=](const Span&) {
              return Changes{"points.solid_per_element=" + std::to_string(per_element),
                             "points.jitter=0.5", "points.seed=" + std::to_string(seed)};
            };
          },
          seed);
    }
  }
  const std::vector<std::pair<std::string, Placement>> placements{
      {"anywhere", Placement::anywhere},
      {"on edges", Placement::on_edges},
      {"on nodes", Placement::on_nodes}};
  for (const auto& [name, placement] : placements) {
    for (unsigned seed = 1; seed <= seeds; ++seed) {
      const auto where = placement;
      sweep.add(
          double_point_ones, "liquid points " + name,
          [&](Scenario& s) {
            s.disturb = [=](Case<2>& c) { place(c.liquid_points, where, seed); };
          },
          seed);
      if (seed > 5) continue;
      sweep.add(
          every, "solid points " + name,
          [&](Scenario& s) { s.disturb = [=](Case<2>& c) { place(c.solid_points, where, seed); }; },
          seed);
      sweep.add(
          every, "one solid point " + name,
          [&](Scenario& s) {
            s.disturb = [=](Case<2>& c) {
              join(c.solid_points);
              place(c.solid_points, where, seed);
            };
          },
          seed);
    }
  }
  // The fields of single-point models would run out of pores there.
  const auto on_corners = [](Scenario& s) {
    s.disturb = [](Case<2>& c) {
      join(c.solid_points);
      place(c.solid_points, Placement::on_nodes, 1);
    };
    s.changes = [](const Span& span) {
      return Changes{specimen + "porosity=0.05", specimen + "skeleton_fraction=0.01",
                     set(specimen + "erosion.rate", 0.94 / (0.6 * span.end))};
    };
    s.expected = is_double_point(s.scheme) ? Expected::done : Expected::refused;
  };
  sweep.add(every, "one solid point on a node; all but 1e-2 erodes", on_corners);
  sweep.add(every, "all points twice", [](Scenario& s) {
    s.disturb = [](Case<2>& c) {
      duplicate(c.solid_points);
      duplicate(c.liquid_points);
    };
  });
  sweep.add(double_point_ones, "1 liquid point per element",
            [](Scenario& s) { s.disturb = [](Case<2>& c) { join(c.liquid_points); }; });
  for (const std::string transfer : {"nodal", "element"}) {
    for (const std::string empty : {"wet", "dry"}) {
      sweep.add(double_point_ones, "1 liquid point per element; " + transfer + "; " + empty,
                {"points.liquid_per_element=1", "points.seeding=random",
                 "soil.specimen.erosion.mass_transfer=" + transfer,
                 "soil.specimen.erosion.empty_elements=" + empty});
    }
  }
  const auto refused = [&](const std::vector<Scheme>& schemes, const std::string& name,
                           const std::function<void(Case<2>&)>& disturb) {
    sweep.add(schemes, name, [&](Scenario& s) {
      s.disturb = disturb;
      s.expected = Expected::refused;
    });
  };
  refused(double_point_ones, "no liquid points in every third element",
          [](Case<2>& c) { drop(c.liquid_points, 3); });
  refused(double_point_ones, "no liquid points at all",
          [](Case<2>& c) { drop(c.liquid_points, 1); });
  refused(every, "no solid points in every third element",
          [](Case<2>& c) { drop(c.solid_points, 3); });
  refused(every, "no solid points at all", [](Case<2>& c) { drop(c.solid_points, 1); });
  refused(double_point_ones, "liquid points of twice the volume", [](Case<2>& c) {
    for (double& volume : c.liquid_points.volume) volume *= 2.0;
  });
  refused(every, "solid points of half the volume", [](Case<2>& c) {
    for (double& volume : c.solid_points.volume) volume *= 0.5;
  });
  refused(every, "one solid point 1e-6 too large",
          [](Case<2>& c) { c.solid_points.volume.back() *= 1.0 + 1e-6; });
  return sweep.done();
}

Sweep density() {
  SweepMaker sweep("density",
                   "grains 1 to 1000 times as heavy as water, light and heavy water, with gravity "
                   "and the momentum of grains");
  for (const double ratio : {1.0, 2.7, 100.0, 1000.0}) {
    for (const double water : {1.0, 1000.0}) {
      for (const bool heavy : {false, true}) {
        for (const bool momentum : {false, true}) {
          sweep.add(every,
                    "ratio " + shown(ratio) + "; water " + shown(water) +
                        (heavy ? "; gravity" : "") + (momentum ? "; momentum" : ""),
                    [&](Scenario& s) {
                      s.explicit_steps = 4000.0;
                      // What so heavy grains do when they set in motion, no step may be short
                      // enough for.
                      if (ratio > 50.0 && (momentum || heavy)) s.expected = Expected::either;
                      s.changes = [=](const Span&) {
                        Changes result{set("liquid.density", water),
                                       set("boundary[0].pressure", 6.0 * water),
                                       set(specimen + "grain_density", ratio * water)};
                        if (heavy) result.insert(result.end(), {gravity, rest_level});
                        if (momentum) {
                          result.emplace_back(specimen + "erosion.momentum_transfer=true");
                        }
                        return result;
                      };
                    });
        }
      }
    }
  }
  return sweep.done();
}

/// Values of a boundary that jump, turn and change their sign.
std::vector<std::pair<double, double>> random_table(Random& random, double end, double size) {
  std::vector<std::pair<double, double>> result;
  const int knots = 2 + random.below(6);
  double t = 0.0;
  for (int i = 0; i < knots; ++i) {
    result.emplace_back(t * end, size * random.between(-1.0, 1.0));
    t += random.chance(0.3) ? 1e-9 : random.between(0.02, 0.3);
  }
  return result;
}

Sweep reversal() {
  SweepMaker sweep(
      "reversal",
      "boundary values that change sign in time: pressure, flux, velocity, and tables at random");
  const std::vector<std::string> laws{"constant", "flux"};
  for (const std::string& law : laws) {
    for (const std::string kind : {"pressure", "darcy_flux", "velocity"}) {
      for (const bool sudden : {false, true}) {
        sweep.add(every, kind + (sudden ? " jumps; " : " turns; ") + law, [&](Scenario& s) {
          s.changes = [=](const Span& span) {
            const double value = kind == "pressure" ? 6000.0 : 0.012;
            const double end = span.end;
            const std::string table =
                sudden
                    ? pairs({{0.0, value}, {0.5 * end, value}, {0.5 * end * (1.0 + 1e-9), -value}})
                    : pairs({{0.0, value}, {end, -value}});
            return joined(erosion(law, span), {"boundary[0]={on=\"top\", " + kind + "=" + table +
                                               ", concentration=0.05}"});
          };
        });
      }
    }
  }
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    sweep.add(
        every, "tables at random",
        [&](Scenario& s) {
          s.changes = [=](const Span& span) {
            Random random(seed);
            const bool both = random.chance(0.5);
            Changes result = erosion(laws[random.below(2)], span);
            const std::string kind =
                std::vector<std::string>{"pressure", "darcy_flux", "velocity"}[random.below(3)];
            const double size = kind == "pressure" ? 6000.0 : 0.012;
            result.push_back("boundary[0]={on=\"top\", " + kind + "=" +
                             pairs(random_table(random, span.end, size)) +
                             ", concentration=" + number(random.between(0.0, 0.5)) + "}");
            if (both) {
              result.push_back("boundary[1]={on=\"bottom\", concentration=0.3, pressure=" +
                               pairs(random_table(random, span.end, 6000.0)) + "}");
            }
            return result;
          };
        },
        seed);
  }
  return sweep.done();
}

Sweep stagnation() {
  SweepMaker sweep("stagnation",
                   "nothing drives: equal pressures, sealed box, hydrostatic; every law");
  const std::vector<std::string> laws{"constant", "logarithmic", "first-order", "flux"};
  for (const std::string& law : laws) {
    const auto with = [&](const std::string& name, const Changes& more,
                          const std::vector<Scheme>& schemes) {
      sweep.add(schemes, name + "; " + law, [&](Scenario& s) {
        s.changes = [=](const Span& span) { return joined(erosion(law, span), more); };
      });
    };
    with("equal pressures", {"boundary[0].pressure=0"}, every);
    with("equal pressures of 1e5", {"boundary[0].pressure=1e5", "boundary[1].pressure=1e5"}, every);
    with("equal pressures; steady", {"boundary[0].pressure=0", "initial.flow=steady"}, every);
    with("hydrostatic",
         {"boundary[0].pressure=0", "boundary[1].pressure=9810", gravity, rest_level}, every);
    with("no boundaries", {"boundary=[]"}, every);
    with("no boundaries; K infinite", {"boundary=[]", "liquid.bulk_modulus=inf"}, implicit_ones);
    with("no boundaries; gravity", {"boundary=[]", gravity, rest_level}, every);
  }
  return sweep.done();
}

Sweep drying() {
  SweepMaker sweep(
      "drying", "inflow that falls to zero and returns; drawn from both ends; sealed and pumped");
  for (const std::string law : {"constant", "first-order", "flux"}) {
    for (const std::string kind : {"darcy_flux", "velocity", "pressure"}) {
      const double size = kind == "pressure" ? 6000.0 : 0.012;
      for (const bool sudden : {false, true}) {
        sweep.add(every, kind + " falls to zero and returns" + (sudden ? " at once; " : "; ") + law,
                  [&](Scenario& s) {
                    s.changes = [=](const Span& span) {
                      const double end = span.end;
                      const double ramp = sudden ? 1e-9 : 0.15;
                      return joined(erosion(law, span), {"boundary[0]={on=\"top\", " + kind + "=" +
                                                         pairs({{0.0, size},
                                                                {0.25 * end, size},
                                                                {(0.25 + ramp) * end, 0.0},
                                                                {0.6 * end, 0.0},
                                                                {(0.6 + ramp) * end, size}}) +
                                                         "}"});
                    };
                  });
      }
    }
  }
  for (const double draw : {-0.012, -0.12}) {
    sweep.add(every, "drawn from the top at " + shown(draw) + " m/s",
              {top_flux + number(draw) + "}"});
  }
  sweep.add(every, "in as much as out by flux",
            {top_flux + "0.012}", "boundary[1]={on=\"bottom\", darcy_flux=-0.012}"});
  // Water that must be compressed or expanded without end: possible for as long as it lasts.
  for (const double net : {1e-3, -1e-3}) {
    sweep.add(every, "sealed and pumped at " + shown(net) + " m/s", [&](Scenario& s) {
      s.changes = [net](const Span&) {
        return Changes{top_flux + number(net) + "}", "boundary[1]={on=\"bottom\", darcy_flux=0}"};
      };
      s.expected = Expected::either;
    });
  }
  sweep.add_refused(
      implicit_ones, "sealed and pumped; K infinite",
      {top_flux + "1e-3}", "boundary[1]={on=\"bottom\", darcy_flux=0}", "liquid.bulk_modulus=inf"});
  sweep.add_refused(
      every, "steady start of fluxes that do not cancel",
      {top_flux + "1e-3}", "boundary[1]={on=\"bottom\", darcy_flux=0}", "initial.flow=steady"});
  return sweep.done();
}

Sweep throughput() {
  SweepMaker sweep("throughput",
                   "40 pore volumes through the specimen; clean, laden, with free water around it");
  const auto forty = [](const Span& span) { return 40.0 * 0.3 / span.end; };
  const std::vector<std::string> open{specimen + "conductivity=1", "initial.flow=steady"};
  for (const double c : {0.0, 0.2, 0.9}) {
    sweep.add(every, "c = " + shown(c) + " enters", [&](Scenario& s) {
      if (is_explicit(s.scheme)) s.end = 20.0;
      s.explicit_steps = 2e5;
      s.changes = [=](const Span& span) {
        return joined(open,
                      {top_flux + number(forty(span)) + ", concentration=" + number(c) + "}"});
      };
    });
  }
  for (const std::string seeding : {"gauss", "random"}) {
    sweep.add(double_point_ones, "points seeded " + seeding, [&](Scenario& s) {
      if (is_explicit(s.scheme)) s.end = 20.0;
      s.explicit_steps = 2e5;
      s.changes = [=](const Span& span) {
        return joined(open, {top_flux + number(forty(span)) + "}", "points.seeding=" + seeding});
      };
    });
  }
  sweep.add(double_point_ones, "free water above and below", [&](Scenario& s) {
    if (is_explicit(s.scheme)) s.end = 20.0;
    s.explicit_steps = 2e5;
    s.mesh = [] {
      LayerSettings layers;
      layers.inflow = layers.outflow = layers.above = layers.below = 1;
      return model::layered_mesh(4, layers, 4, 1.0);
    };
    s.changes = [=](const Span& span) {
      return joined(open, {"boundary[0]={on=\"inflow\", darcy_flux=" + number(forty(span)) + "}",
                           "boundary[1]={on=\"outflow\", pressure=0}",
                           "soil.buffer={like=\"specimen\", erosion={law=\"none\"}}"});
    };
  });
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    sweep.add(
        every, "jittered mesh",
        [&](Scenario& s) {
          if (is_explicit(s.scheme)) s.end = 20.0;
          s.explicit_steps = 2e5;
          s.mesh = [seed] {
            Mesh<2> mesh = plain_column();
            jitter_nodes(mesh, 0.45 * 0.125, seed);
            return mesh;
          };
          s.changes = [=](const Span& span) {
            return joined(open, {top_flux + number(forty(span)) + ", concentration=0.1}"});
          };
        },
        seed);
  }
  return sweep.done();
}

Sweep inflow() {
  SweepMaker sweep("inflow", "concentrations of 0 to 0.999 that enter, jump, come from both ends");
  for (const double c : {0.0, 0.5, 0.9, 0.999}) {
    sweep.add(every, "c = " + shown(c), {set("boundary[0].concentration", c)});
    sweep.add(every, "c = " + shown(c) + " jumps", [&](Scenario& s) {
      s.changes = [c](const Span& span) {
        const double middle = 0.5 * span.end;
        return Changes{"boundary[0].concentration=" +
                       pairs({{0.0, 0.0}, {middle, 0.0}, {middle * (1.0 + 1e-9), c}})};
      };
    });
  }
  sweep.add_refused(every, "c = 1", {"boundary[0].concentration=1"});
  sweep.add_refused(every, "c < 0", {"boundary[0].concentration=-0.1"});
  return sweep.done();
}

Sweep laws() {
  SweepMaker sweep("laws",
                   "every erosion law with Kozeny-Carman, Ergun, gravity, the momentum of grains, "
                   "and all together");
  for (const std::string law : {"constant", "logarithmic", "first-order", "flux"}) {
    for (int bits = 0; bits < 16; ++bits) {
      const bool carman = (bits & 1) != 0;
      const bool ergun = (bits & 2) != 0;
      const bool heavy = (bits & 4) != 0;
      const bool momentum = (bits & 8) != 0;
      sweep.add(every,
                law + (carman ? " carman" : "") + (ergun ? " ergun" : "") +
                    (heavy ? " gravity" : "") + (momentum ? " momentum" : ""),
                [&](Scenario& s) {
                  s.explicit_steps = 4000.0;
                  s.changes = [=](const Span& span) {
                    Changes result = erosion(law, span);
                    if (carman) result.emplace_back(specimen + "conductivity_law=kozeny-carman");
                    if (ergun) result.emplace_back(specimen + "drag=ergun");
                    if (heavy) result.insert(result.end(), {gravity, rest_level});
                    if (momentum) result.emplace_back(specimen + "erosion.momentum_transfer=true");
                    return result;
                  };
                });
    }
    // Rates of which one step takes all there is, or next to nothing.
    for (const double times : {1e-9, 1e3, 1e9}) {
      sweep.add(every, law + " at " + shown(times) + " times the rate", [&](Scenario& s) {
        s.changes = [=](const Span& span) {
          return joined(erosion(law, span), {set(specimen + "erosion.rate", times / span.end * 0.3),
                                             specimen + "conductivity_law=kozeny-carman"});
        };
      });
    }
  }
  return sweep.done();
}

/// Anything together: what nobody thought of.
Sweep anything() {
  SweepMaker sweep("anything", "mesh, soils, laws, boundaries and water at random, all at a time");
  for (unsigned seed = 1; seed <= 2 * seeds; ++seed) {
    sweep.add(
        every, "at random",
        [&](Scenario& s) {
          s.end = 20.0;
          s.explicit_steps = 4000.0;
          s.expected = Expected::either;
          s.mesh = [seed] {
            Random random(seed);
            Mesh<2> mesh =
                random.chance(0.2) ? flat_column(random.between(5.0, 50.0)) : plain_column();
            jitter_nodes(mesh, random.chance(0.5) ? 0.05 : 0.0, seed);
            const int shape = random.below(3);
            name_regions(mesh, [&](const Vector<2>& x) {
              const bool other = shape == 0   ? random.chance(0.5)
                                 : shape == 1 ? x[0] > 0.25
                                              : x[1] < 0.3;
              return other ? "other" : "specimen";
            });
            return mesh;
          };
          s.changes = [seed](const Span& span) {
            Random random(seed + 7000);
            const std::vector<std::string> laws{"none", "constant", "logarithmic", "first-order",
                                                "flux"};
            Changes result;
            const double grains = random.decades(1000.0, 2e4);
            for (const std::string soil : {"soil.specimen", "soil.other"}) {
              const double n = random.between(0.02, 0.95);
              const std::string law = laws[random.below(5)];
              std::string text = "={porosity=" + number(n) +
                                 ", skeleton_fraction=" + number((1.0 - n) * random.share()) +
                                 ", grain_density=" + number(grains) +
                                 ", conductivity=" + number(random.decades(1e-7, 1e-1));
              if (random.chance(0.5)) text += ", conductivity_law=\"kozeny-carman\"";
              if (random.chance(0.3)) text += ", drag=\"ergun\"";
              if (law != "none") {
                text += ", erosion={law=\"" + law +
                        "\", rate=" + number(random.decades(1e-2, 1e2) / span.end) +
                        ", start=" + number(random.between(0.0, 0.5) * span.end) +
                        ", momentum_transfer=" + (random.chance(0.3) ? "true" : "false") + "}";
              }
              result.push_back(soil + text + "}");
            }
            result.push_back(set("liquid.bulk_modulus", random.decades(1e6, 1e9)));
            if (random.chance(0.3)) {
              result.insert(result.end(), {"gravity=[1, -9.81]", rest_level});
            }
            const bool flux = random.chance(0.5);
            result.push_back(
                "boundary[0]={on=\"top\", concentration=" + number(random.between(0.0, 0.6)) +
                (flux ? ", darcy_flux=" : ", pressure=") +
                pairs(random_table(random, span.end, flux ? 1e-4 : 5e4)) + "}");
            if (random.chance(0.5)) result.emplace_back("initial.flow=steady");
            return result;
          };
        },
        seed);
  }
  return sweep.done();
}

}  // namespace

std::vector<Sweep> all_sweeps() {
  return {conductivity(),  contrast(),      modulus(),     scaling(),      given_step(), porosity(),
          porosity_jump(), thin_layer(),    slivers(),     jitter(),       points(),     density(),
          reversal(),      stagnation(),    drying(),      throughput(),   inflow(),     laws(),
          anything(),      seepage_sweep(), soils_sweep(), motion_sweep(), space_sweep()};
}

}  // namespace suffuse::stress
