#include "figures.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>

#include "case/closest_name.hpp"
#include "case/errors.hpp"
#include "exact_solution.hpp"
#include "results/number_text.hpp"

namespace suffuse {
namespace {

constexpr int marker_count = 24;
constexpr int curve_intervals = 480;

/// After Okabe and Ito, for colour-blind readers; runs that are both filled or both hollow differ
/// in brightness too.
constexpr std::array<std::array<double, 3>, 6> run_colors{{{0.0, 0.27, 0.53},
                                                           {0.835, 0.369, 0.0},
                                                           {0.337, 0.706, 0.914},
                                                           {0.0, 0.45, 0.32},
                                                           {0.902, 0.624, 0.0},
                                                           {0.8, 0.475, 0.655}}};
constexpr std::array<Marker, 4> markers{Marker::circle, Marker::square, Marker::diamond,
                                        Marker::target};

/// Soil of one initial porosity.
struct Portion {
  Soil soil;
  double volume = 0.0;
  double initial_porosity = 0.0;
};

/// The soil a figure is about, as the solver's own `porosity_mean` counts it.
struct Specimen {
  std::vector<int> regions;
  std::vector<Portion> portions;
  double volume = 0.0;
  bool is_all = true;  ///< of the soil; else what does not erode is left out
};

bool erodes(const Soil& soil) {
  return soil.erosion.law != ErosionLaw::none;
}

/// Three edge midpoints integrate quadratics exactly; uniform soil collapses to one portion.
void add_element(std::map<std::pair<std::string, double>, Portion>& portions, const Mesh<2>& mesh,
                 int element, const Soil& soil) {
  const double volume = element_volume(mesh, element);
  for (int a = 0; a < 3; ++a) {
    const auto& corners = mesh.elements[element];
    const Vector<2> middle = 0.5 * (mesh.nodes[corners[a]] + mesh.nodes[corners[(a + 1) % 3]]);
    const double porosity = soil.initial_porosity(middle);
    auto& portion = portions[{soil.region, porosity}];
    portion.soil = soil;
    portion.initial_porosity = porosity;
    portion.volume += volume / 3.0;
  }
}

Specimen specimen(const ResultsReader& run) {
  const Scene& scene = run.scene().scene;
  const bool any = std::any_of(scene.soils.begin(), scene.soils.end(), erodes);
  const Mesh<2> mesh = run.mesh();
  Specimen found;
  std::vector<const Soil*> soils;
  for (int r = 0; r < static_cast<int>(mesh.region_names.size()); ++r) {
    const Soil* soil = scene.find_soil(mesh.region_names[r]);
    const bool counts = soil != nullptr && (erodes(*soil) || !any);
    soils.push_back(counts ? soil : nullptr);
    if (counts) found.regions.push_back(r);
    if (soil != nullptr && !counts) found.is_all = false;
  }
  std::map<std::pair<std::string, double>, Portion> portions;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const Soil* soil = soils[mesh.element_region[e]];
    if (soil != nullptr) add_element(portions, mesh, e, *soil);
  }
  for (const auto& [key, portion] : portions) {
    found.portions.push_back(portion);
    found.volume += portion.volume;
  }
  return found;
}

std::string soil_named(bool all) {
  return all ? "the soil" : "the soil that erodes";
}

/// Sum over the specimen of volume times a function of (soil, initial porosity, porosity now).
double integrate(const Specimen& specimen, double t,
                 const std::function<double(const Soil&, double, double)>& density) {
  double total = 0.0;
  for (const auto& portion : specimen.portions) {
    const double now = exact_porosity(portion.soil, portion.initial_porosity, t);
    total += portion.volume * density(portion.soil, portion.initial_porosity, now);
  }
  return total;
}

std::string law_label(const Specimen& specimen) {
  const auto& erosion = specimen.portions.front().soil.erosion;
  const std::string rate = ", " + number_text(erosion.rate) + " 1/s";
  switch (erosion.law) {
    case ErosionLaw::none:
      return "exact, no erosion";
    case ErosionLaw::constant:
      return "exact, constant law" + rate;
    case ErosionLaw::logarithmic:
      return "exact, logarithmic law" + rate;
    case ErosionLaw::first_order:
      return "exact, first-order law" + rate;
  }
  return "exact";
}

std::vector<double> exact_times(double end, const Specimen& specimen) {
  std::vector<double> times;
  for (int k = 0; k <= curve_intervals; ++k) times.push_back(end * k / curve_intervals);
  for (const auto& portion : specimen.portions) {  // the kink where erosion starts
    const double start = portion.soil.erosion.start;
    if (start > 0.0 && start < end) times.push_back(start);
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

/// Names of the runs; folders tell apart what the scenes call alike.
std::vector<std::string> run_labels(const std::vector<ResultsReader>& runs) {
  std::vector<std::string> labels;
  for (const auto& run : runs) {
    const auto& name = run.scene().scene.name;
    const auto alike = std::count_if(runs.begin(), runs.end(), [&](const ResultsReader& other) {
      return other.scene().scene.name == name;
    });
    std::string label = name;
    if (alike > 1) {
      auto folder = std::filesystem::path(run.folder()).lexically_normal();
      if (!folder.has_filename()) folder = folder.parent_path();
      label = folder.stem().string();
    }
    if (run.status() != "done") label += " (" + run.status() + ")";
    labels.push_back(label);
  }
  return labels;
}

/// About `marker_count` rows, evenly in time; runs take turns, so that none hides another.
Curve thinned(Curve curve, std::size_t run, std::size_t runs) {
  if (curve.x.empty()) return curve;
  const double begin = curve.x.front();
  const double spacing = (curve.x.back() - begin) / marker_count;
  double next = begin + spacing * static_cast<double>(run) / static_cast<double>(runs);
  Curve kept = curve;
  kept.x.clear();
  kept.y.clear();
  for (std::size_t row = 0; row < curve.x.size(); ++row) {
    if (curve.x[row] < next) continue;
    kept.x.push_back(curve.x[row]);
    kept.y.push_back(curve.y[row]);
    while (next <= curve.x[row] && spacing > 0.0) next += spacing;
  }
  return kept;
}

/// Exact curves first, runs over them.
Chart assemble(Chart chart, std::vector<Curve> exact, const std::vector<Curve>& numeric) {
  chart.x_label = "time (s)";
  chart.curves = std::move(exact);
  chart.curves.insert(chart.curves.end(), numeric.begin(), numeric.end());
  return chart;
}

/// Dashes by label: runs with the same exact solution share it.
Dash dash_of(std::vector<std::string>& labels, const std::string& label) {
  auto found = std::find(labels.begin(), labels.end(), label);
  if (found == labels.end()) found = labels.insert(labels.end(), label);
  return static_cast<Dash>((found - labels.begin()) % 5);
}

bool is_drawn(const std::vector<Curve>& curves, const Curve& curve) {
  return std::any_of(curves.begin(), curves.end(), [&](const Curve& other) {
    return other.dash == curve.dash && other.x == curve.x && other.y == curve.y;
  });
}

void require_curve(const ResultsReader& run, const Table& table, const std::string& name) {
  const auto& t = table.column("t");
  if (t.empty() || !(t.back() > t.front())) {
    throw FileError(run.folder() + ": " + name + " has no two times yet to draw a curve through");
  }
}

Chart porosity_figure(const std::vector<ResultsReader>& runs) {
  std::vector<Curve> exact;
  std::vector<Curve> numeric;
  std::vector<std::string> laws;
  const auto labels = run_labels(runs);
  bool all = true;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const Table history = runs[r].history();
    require_curve(runs[r], history, "history.csv");
    const Specimen soil = specimen(runs[r]);
    all = all && soil.is_all;
    Curve line;
    line.label = law_label(soil);
    line.dash = dash_of(laws, line.label);
    line.x = exact_times(history.column("t").back(), soil);
    for (const double t : line.x) {
      line.y.push_back(integrate(soil, t, [](const Soil&, double, double now) { return now; }) /
                       soil.volume);
    }
    if (!is_drawn(exact, line)) exact.push_back(line);
    Curve points;
    points.label = labels[r];
    points.x = history.column("t");
    points.y = history.column("porosity_mean");
    points.markers = true;
    points.marker = markers[r % markers.size()];
    points.hollow = (r / markers.size()) % 2 == 1;
    points.color = run_colors[r % run_colors.size()];
    numeric.push_back(thinned(points, r, runs.size()));
  }
  Chart chart;
  chart.title = "Mean porosity of " + soil_named(all);
  chart.y_label = "porosity n_L (-)";
  return assemble(chart, exact, numeric);
}

/// Masses of the specimen at one time, kg (per metre of thickness).
struct Masses {
  double solid = 0.0;
  double eroded = 0.0;
  double liquid =
      0.0;  ///< closed accounting: liquid in the soil, plus what left, less what entered

  [[nodiscard]] double total() const { return solid + liquid; }
};

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

/// The region ledgers added up over the specimen, by time.
std::map<double, Masses> computed_masses(const ResultsReader& run, const Specimen& soil) {
  const Table table = run.region_ledgers();
  require_curve(run, table, "regions.csv");
  std::map<double, Masses> masses;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const auto at = [&](const char* name) { return table.column(name)[row]; };
    const auto region = static_cast<int>(at("region"));
    if (std::find(soil.regions.begin(), soil.regions.end(), region) == soil.regions.end()) continue;
    auto& m = masses[at("t")];
    m.solid += at("solid");
    m.eroded += at("eroded");
    m.liquid += at("water") + at("fines") + (at("water_out") + at("fines_out")) -
                (at("water_in") + at("fines_in"));
  }
  return masses;
}

Masses exact_masses(const Specimen& soil, double water_density, double t) {
  Masses m;
  m.solid = integrate(
      soil, t, [](const Soil& s, double, double now) { return (1.0 - now) * s.grain_density; });
  m.eroded = integrate(soil, t, [](const Soil& s, double before, double now) {
    return (now - before) * s.grain_density;
  });
  m.liquid = m.eroded + integrate(soil, t, [&](const Soil&, double before, double) {
               return before * water_density;
             });
  return m;
}

Chart masses_figure(const std::vector<ResultsReader>& runs) {
  std::vector<Curve> exact;
  std::vector<Curve> numeric;
  std::vector<std::string> laws;
  const auto labels = run_labels(runs);
  bool all = true;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const Specimen soil = specimen(runs[r]);
    all = all && soil.is_all;
    const auto masses = computed_masses(runs[r], soil);
    const double water_density = runs[r].scene().scene.liquid.density;
    const std::string law = law_label(soil);
    const auto times = exact_times(masses.rbegin()->first, soil);
    for (std::size_t q = 0; q < quantities.size(); ++q) {
      Curve line;
      line.dash = dash_of(laws, law);
      if (q == 0) line.label = law;
      line.x = times;
      for (const double t : times) {
        line.y.push_back(quantities[q].value(exact_masses(soil, water_density, t)));
      }
      if (!is_drawn(exact, line)) exact.push_back(line);
      Curve points;
      points.label = labels[r] + ": " + quantities[q].name;
      for (const auto& [t, m] : masses) {
        points.x.push_back(t);
        points.y.push_back(quantities[q].value(m));
      }
      points.markers = true;
      points.marker = quantities[q].marker;
      points.hollow = r % 2 == 1;
      points.color = run_colors[r % run_colors.size()];
      numeric.push_back(thinned(points, r, runs.size()));
    }
  }
  Chart chart;
  chart.title = "Mass balance in closed accounting (in " + soil_named(all) + " + left - entered)";
  chart.y_label = "mass (kg per metre of thickness)";
  return assemble(chart, exact, numeric);
}

using FigureMaker = Chart (*)(const std::vector<ResultsReader>&);

const std::map<std::string, FigureMaker>& figure_makers() {
  static const std::map<std::string, FigureMaker> makers{{"porosity", porosity_figure},
                                                         {"masses", masses_figure}};
  return makers;
}

}  // namespace

std::vector<std::string> figure_names() {
  std::vector<std::string> names;
  for (const auto& [name, maker] : figure_makers()) names.push_back(name);
  return names;
}

Chart make_figure(const std::string& name, const std::vector<ResultsReader>& runs) {
  const auto found = figure_makers().find(name);
  if (found == figure_makers().end()) {
    throw InputError(
        std::vector{InputProblem{"suffuse-post figure", "NAME", "\"" + name + "\"",
                                 quoted_list(figure_names()), closest_name(name, figure_names())}});
  }
  return found->second(runs);
}

}  // namespace suffuse
