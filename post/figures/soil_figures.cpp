#include "figures/soil_figures.hpp"

#include <array>
#include <cmath>

#include "figures/run_curves.hpp"

namespace suffuse {
namespace {

const std::string mass_label = "mass (kg per metre of thickness)";

/// A mass that figures show.
struct Quantity {
  const char* name;
  Marker marker;
  double (*value)(const Masses&);
};

constexpr std::array<Quantity, 4> quantities{{
    {"solid", Marker::circle, [](const Masses& m) { return m.solid; }},
    {"eroded", Marker::square, [](const Masses& m) { return m.eroded; }},
    {"liquid", Marker::diamond, [](const Masses& m) { return m.liquid; }},
    {"total", Marker::target, [](const Masses& m) { return m.total(); }},
}};

/// One quantity of computed or exact masses over time.
struct Series {
  std::vector<double> t;
  std::vector<double> y;
};

Series series(const std::vector<Masses>& masses, const Quantity& quantity) {
  Series found;
  for (const auto& m : masses) {
    found.t.push_back(m.t);
    found.y.push_back(quantity.value(m));
  }
  return found;
}

std::vector<Masses> exact_series(const ResultsReader& run, const Specimen& soil, double end) {
  std::vector<Masses> masses;
  for (const double t : exact_times(end, soil)) {
    masses.push_back(exact_masses(soil, run.scene().scene.liquid.density, t));
  }
  return masses;
}

/// Adds one quantity of every run in the style of the run, with its exact curve.
void add_quantity(RunCurves& curves, const std::vector<ResultsReader>& runs,
                  const Quantity& quantity) {
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const auto masses = computed_masses(runs[r], curves.soil(r));
    if (has_exact_porosity(curves.soil(r))) {
      const auto exact = series(exact_series(runs[r], curves.soil(r), masses.back().t), quantity);
      curves.add_exact(r, exact.t, exact.y);
    }
    const auto computed = series(masses, quantity);
    curves.add_run(r, computed.t, computed.y);
  }
}

std::string points_text(int count, const std::string& kind) {
  return std::to_string(count) + kind + (count == 1 ? "point" : "points") + " per element";
}

}  // namespace

Chart porosity_chart(const std::vector<ResultsReader>& runs) {
  RunCurves curves(runs);
  std::string soil_name = curves.soil_name();
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const Table history = runs[r].history();
    require_curve(runs[r], history, "history.csv");
    if (!curves.soil(r).has_mean_of_history) {
      soil_name = "the soil that exchanges fines, or of all soil";
    } else if (has_exact_porosity(curves.soil(r))) {
      const auto times = exact_times(history.column("t").back(), curves.soil(r));
      std::vector<double> exact;
      exact.reserve(times.size());
      for (const double t : times) exact.push_back(exact_mean_porosity(curves.soil(r), t));
      curves.add_exact(r, times, exact);
    }
    curves.add_run(r, history.column("t"), history.column("porosity_mean"));
  }
  return curves.chart("Mean porosity of " + soil_name, "porosity n_L (-)");
}

Chart masses_chart(const std::vector<ResultsReader>& runs) {
  RunCurves curves(runs);
  const bool mixed = is_mixed(runs);
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const auto masses = computed_masses(runs[r], curves.soil(r));
    const auto exact = has_exact_porosity(curves.soil(r))
                           ? exact_series(runs[r], curves.soil(r), masses.back().t)
                           : std::vector<Masses>{};
    for (const auto& quantity : quantities) {
      if (const auto line = series(exact, quantity); !exact.empty() && !std::isnan(line.y[0])) {
        if (&quantity == quantities.data()) {
          curves.add_exact(r, line.t, line.y);
        } else {
          curves.add_unlabelled_exact(r, line.t, line.y);
        }
      }
      const auto computed = series(masses, quantity);
      Curve points;
      points.label = curves.label(r) + ": " + quantity.name;
      points.x = computed.t;
      points.y = computed.y;
      points.markers = true;
      points.marker = quantity.marker;
      points.hollow = mixed ? is_double_point(runs[r]) : r % 2 == 1;
      points.color = curves.style(r).color;
      curves.add_run(r, points);
    }
  }
  return curves.chart(
      "Mass balance in closed accounting (in " + curves.soil_name() + " + left - entered)",
      mass_label);
}

std::string discretization(const Scene& scene) {
  if (scene.formulation == Formulation::single_point) {
    return ": " + points_text(scene.points.solid_per_element, " ");
  }
  bool dry = false;
  for (const auto& soil : scene.soils) {
    if (!soil.erosion.law->erodes()) continue;
    dry = dry || soil.erosion.empty_elements == EmptyElements::dry;
  }
  return ": " + points_text(scene.points.liquid_per_element, " liquid ") +
         (dry ? ", empty elements stay dry" : ", empty elements erode");
}

Chart solid_mass_chart(const std::vector<ResultsReader>& runs) {
  RunCurves curves(runs);
  for (std::size_t r = 0; r < runs.size(); ++r) {
    curves.extend_label(r, discretization(runs[r].scene().scene));
  }
  add_quantity(curves, runs, quantities[0]);
  return curves.chart("Solid mass of " + curves.soil_name(), mass_label);
}

Chart eroded_and_solid_chart(const std::vector<ResultsReader>& runs) {
  RunCurves curves(runs);
  add_quantity(curves, runs, quantities[0]);
  add_quantity(curves, runs, quantities[1]);
  return curves.chart("Solid (upper) and eroded (lower) mass of " + curves.soil_name(), mass_label);
}

}  // namespace suffuse
