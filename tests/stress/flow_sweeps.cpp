#include <cmath>

#include "stress/sweep_parts.hpp"

namespace suffuse::stress {
namespace {

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
    // The imposed flux sets liquid in motion at once: with 1e6 times its inertia, pressures exceed
    // K.
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
                // The smallest limit, which erosion changes, occurs within the run.
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
      // Short steps have a short run.
      s.end = share < 1e-4 ? 1e-3 : 100.0;
      const double step = share < 1e-4 ? 1e-6 : share * 100.0;
      s.changes = [step](const Span&) { return Changes{set("time.step", step)}; };
    });
  }
  sweep.add_refused(implicit_ones, "step longer than the run", {"time.step=101"});
  return sweep.done();
}

}  // namespace

std::vector<Sweep> flow_sweeps() {
  return {conductivity(), contrast(), modulus(), scaling(), given_step()};
}

}  // namespace suffuse::stress
