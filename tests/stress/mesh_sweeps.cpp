#include <algorithm>

#include "stress/sweep_parts.hpp"

namespace suffuse::stress {
namespace {

Sweep porosity() {
  SweepMaker sweep("porosity",
                   "n_0 from 0.01 to 0.99; nothing to erode, a little, nearly everything; at rates "
                   "up to all at once");
  for (const double n : {0.01, 0.05, 0.5, 0.95, 0.99}) {
    for (const double left : {1.0, 0.9, 1e-6}) {  // share of the solid that is skeleton
      // "At once" is within a millionth of the run, in its middle.
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
        // The gradient is the same for all heights of the column.
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
  // In single-point models the fields would run out of pores with these points.
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

}  // namespace

std::vector<Sweep> mesh_sweeps() {
  return {porosity(), porosity_jump(), thin_layer(), slivers(), jitter(), points()};
}

}  // namespace suffuse::stress
