#include "solver/double_point_case.hpp"
#include "stress/sweep_parts.hpp"

namespace suffuse::stress {
namespace {

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
                      // No step may be short enough for the motion that such heavy grains cause.
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
  // The water is compressed or expanded without end, which works only for some time.
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
    // In one step, such rates take all there is, or almost nothing.
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

/// Random combinations of everything.
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

std::vector<Sweep> transport_sweeps() {
  return {density(),    reversal(), stagnation(), drying(),
          throughput(), inflow(),   laws(),       anything()};
}

}  // namespace suffuse::stress
