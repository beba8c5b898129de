#include "figures/flow_figures.hpp"

#include <algorithm>
#include <cstdio>

#include "figures/run_curves.hpp"
#include "figures/soil_figures.hpp"
#include "values/column_fines.hpp"

namespace suffuse {
namespace {

constexpr int outflow_windows = 24;

/// Masses over time, counted at the boundary of the eroding soil or of the model.
std::vector<Masses> outflow_masses(const ResultsReader& run, const Specimen& soil) {
  if (soil.regions.size() == 1) return computed_masses(run, soil);
  const Table ledger = run.ledger();
  require_curve(run, ledger, "ledger.csv");
  std::vector<Masses> masses(ledger.rows());
  for (std::size_t row = 0; row < ledger.rows(); ++row) {
    masses[row].t = ledger.column("t")[row];
    masses[row].water_out = ledger.column("water_out")[row];
    masses[row].fines_out = ledger.column("fines_out")[row];
  }
  return masses;
}

/// Concentration of the outflow, a mean per window of time.
struct Outflow {
  std::vector<double> t;  ///< middles of the windows, s
  std::vector<double> concentration;
};

Outflow outflow(const ResultsReader& run, const std::vector<Masses>& masses) {
  const Scene& scene = run.scene().scene;
  const double grain_density = scene.soils.front().grain_density;
  const double window = (masses.back().t - masses.front().t) / outflow_windows;
  Outflow found;
  const Masses* before = &masses.front();
  for (const auto& now : masses) {
    if (now.t - before->t < window * (1.0 - 1e-9)) continue;
    const double grains = (now.fines_out - before->fines_out) / grain_density;
    const double water = (now.water_out - before->water_out) / scene.liquid.density;
    if (grains + water > 0.0) {
      found.t.push_back(0.5 * (now.t + before->t));
      found.concentration.push_back(grains / (grains + water));
    }
    before = &now;
  }
  return found;
}

std::string flux_text(double flux) {
  char text[48];
  std::snprintf(text, sizeof text, " q = %.4g m/s", flux);
  return text;
}

/// A line with markers in the run's style.
Curve joined_curve(const RunCurves& curves, std::size_t run, const std::string& label) {
  Curve curve;
  curve.label = label;
  curve.markers = true;
  curve.joined = true;
  curve.marker = curves.style(run).marker;
  curve.hollow = curves.style(run).hollow;
  curve.color = curves.style(run).color;
  return curve;
}

}  // namespace

std::vector<Chart> outflow_charts(const std::vector<ResultsReader>& runs) {
  RunCurves concentration(runs);
  RunCurves grains(runs);
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const auto masses = outflow_masses(runs[r], concentration.soil(r));
    if (const auto flow = column_flow(runs[r])) {
      const double end = masses.back().t;
      const ColumnFines exact(*flow, end);
      const auto times = exact_times(end, concentration.soil(r));
      std::vector<double> c;
      std::vector<double> out;
      for (const double t : times) {
        c.push_back(exact.concentration(flow->length, t));
        out.push_back(exact.fines_out(t));
      }
      const std::string steady = ", steady" + flux_text(flow->flux);
      concentration.add_exact(r, times, c, steady);
      grains.add_exact(r, times, out, steady);
    }
    const auto computed = outflow(runs[r], masses);
    concentration.add_run(r, computed.t, computed.concentration);
    std::vector<double> t;
    std::vector<double> out;
    for (const auto& m : masses) {
      t.push_back(m.t);
      out.push_back(m.fines_out);
    }
    grains.add_run(r, t, out);
  }
  const std::string soil = concentration.soil_name();
  return {concentration.chart("Liquid that leaves " + soil, "concentration c (-)"),
          grains.chart("Grains that left " + soil, "mass (kg per metre of thickness)")};
}

Chart empty_elements_chart(const std::vector<ResultsReader>& runs) {
  RunCurves curves(runs);
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const Table history = runs[r].history();
    require_curve(runs[r], history, "history.csv");
    Curve curve = joined_curve(curves, r, curves.label(r) + discretization(runs[r].scene().scene));
    curve.x = history.column("t");
    curve.y = history.column("empty_elements_total");
    curves.add_run(r, curve);
  }
  return curves.chart("Elements without liquid points, added up over the steps",
                      "cumulative empty elements (-)");
}

Chart flux_chart(const std::vector<ResultsReader>& runs) {
  RunCurves curves(runs);
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const Table history = runs[r].history();
    require_curve(runs[r], history, "history.csv");
    const auto& t = history.column("t");
    if (const auto flow = column_flow(runs[r])) {
      Curve steady;
      steady.label = "steady" + flux_text(flow->flux);
      steady.x = {t.front(), t.back()};
      steady.y.assign(2, flow->flux * flow->width);
      curves.add_line(steady);
    }
    Curve in = joined_curve(curves, r, curves.label(r) + ": in");
    in.x = t;
    in.y = history.column("flux_in");
    in.hollow = false;
    curves.add_run(r, in);
    Curve out = joined_curve(curves, r, curves.label(r) + ": out");
    out.x = t;
    out.y = history.column("flux_out");
    out.hollow = true;
    out.dash = Dash::dashed;
    curves.add_run(r, out);
  }
  return curves.chart("Liquid that enters and leaves the model",
                      "flux (m3/s per metre of thickness)");
}

}  // namespace suffuse
