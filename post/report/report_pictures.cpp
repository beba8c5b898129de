#include "report/report_pictures.hpp"

#include <algorithm>
#include <cmath>

#include "common/errors.hpp"
#include "common/scratch_folder.hpp"
#include "drawing/chart.hpp"
#include "drawing/png_file.hpp"
#include "figures/axes.hpp"
#include "figures/figures.hpp"
#include "figures/render.hpp"
#include "figures/run_curves.hpp"
#include "figures/seepage_map.hpp"
#include "files/number_text.hpp"
#include "report/html.hpp"
#include "values/derived_fields.hpp"
#include "values/dry_mass.hpp"
#include "values/fields.hpp"
#include "values/name_words.hpp"
#include "values/run_names.hpp"

namespace suffuse {
namespace {

constexpr std::size_t max_snapshots = 12;
/// Upper end of the colours of safety: larger values are not of interest.
constexpr double largest_safety = 5.0;

std::string card(const std::string& images) {
  return "<div class=\"card\">" + images + "</div>\n";
}

std::string image(const std::string& path, const std::string& what,
                  const std::string& attributes = {}) {
  return "<img" + attributes + " alt=\"" + html::escaped(what) + "\" src=\"" +
         html::data_address(path) + "\">\n";
}

/// The column that is drawn as a share of the dry mass.
const std::string drawn_as_share = "fines_out";

/// A column of a table, and what its chart is called.
struct CurveColumn {
  std::string table;
  std::string column;
  std::string title;
  bool is_motion = false;  ///< of soil that moves
};

const std::vector<CurveColumn>& curve_columns() {
  static const std::vector<CurveColumn> columns{
      {"history", "porosity_mean",
       "Mean porosity of the soil that exchanges fines, or of all soil"},
      {"history", drawn_as_share,
       "Fines that left the model, in % of the dry mass at the start of the soils that exchange "
       "fines"},
      {"boundaries", "discharge", "Discharge through the boundaries, out minus in"},
      {"history", "turbidity_out", "Turbidity of the liquid that leaves"},
      {"history", "conductivity_ratio", "Conductivity of the soil over that at the start"},
      {"history", "settlement_max", "Largest settlement of the soil", true},
      {"history", "displacement_max", "Largest displacement of the soil", true}};
  return columns;
}

/// Whether a run has the column, and rows enough for curves. Soil that stays has no motion.
bool has_curve(const ResultsReader& run, const CurveColumn& column) {
  if (column.is_motion && !run.scene().scene.moves()) return false;
  const auto is_curve = [&](const Table& table) {
    return table.has(column.column) && table.rows() > 1;
  };
  if (column.table == "history") return is_curve(run.history());
  const std::vector<NamedTable> parts = run.boundaries();
  return !parts.empty() &&
         std::ranges::all_of(parts, [&](const NamedTable& part) { return is_curve(part.table); });
}

/// Divides the masses of a chart, with a curve for each run, by the dry masses at the start. False
/// where a run has none.
bool make_shares(const std::vector<ResultsReader>& runs, Chart& chart) {
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const double mass = dry_mass_at_start(runs[r]);
    if (!(mass > 0.0)) return false;
    for (double& y : chart.curves[r].y) y *= 100.0 / mass;
  }
  chart.title = "Fines that left the model";
  chart.y_label = "share of the dry mass at the start (%)";
  return true;
}

std::string curve_html(const std::vector<ResultsReader>& runs, const CurveColumn& column,
                       const ScratchFolder& folder) {
  for (const ResultsReader& run : runs) {
    if (!has_curve(run, column)) return "";
  }
  FigureOptions options;
  options.columns = {column.table + "." + column.column};
  std::vector<Chart> charts = make_figure("curves", runs, options);
  if (column.column == drawn_as_share && !make_shares(runs, charts.front())) return "";
  const std::string path = (folder.path() / (column.column + ".png")).string();
  draw_charts(charts, path);
  return "<figure>" + html::element("figcaption", column.title) +
         card(image(path, column.title + " against time")) + "</figure>\n";
}

/// Heads at the boundaries that change in time; nothing if none does.
std::optional<Chart> heads_chart(const ResultsReader& run) {
  constexpr int intervals = 400;
  Chart chart{"Heads at the boundaries", seconds_label, "head (m)", {}};
  const double end = run.times().empty() ? 0.0 : run.times().back();
  for (const BoundaryCondition& boundary : run.scene().scene.boundaries) {
    if (!boundary.head) continue;
    const auto [low, high] = boundary.head->range(0.0, end);
    if (low == high) continue;
    Curve curve;
    for (int k = 0; k <= intervals; ++k) {
      curve.x.push_back(end * k / intervals);
      curve.y.push_back(boundary.head->value(curve.x.back()));
    }
    curve.color = curve_style(1 + chart.curves.size()).color;
    curve.label = boundary.on;
    chart.curves.push_back(std::move(curve));
  }
  if (chart.curves.empty()) return std::nullopt;
  return chart;
}

std::string heads_html(const ResultsReader& run, const ScratchFolder& folder) {
  auto chart = heads_chart(run);
  if (!chart) return "";
  set_axes({}, "suffuse-post report", *chart);
  const std::string path = (folder.path() / "heads.png").string();
  draw_charts({*chart}, path);
  return "<figure>" + html::element("figcaption", chart->title) +
         card(image(path, chart->title + " against time")) + "</figure>\n";
}

/// A field as the report shows it.
struct ShownField {
  std::string name;
  bool change;
  std::string title;
};

bool has_field(const ResultsReader& run, const std::vector<std::size_t>& snapshots,
               const std::string& where, const std::string& name) {
  const auto names = all_field_names(run, snapshots.back(), where);
  return std::ranges::find(names, name) != names.end();
}

std::string missing(const std::string& title) {
  return html::element("p", title + ": these results do not have it.");
}

/// Least and largest finite value over snapshots.
std::array<double, 2> range_of(const ResultsReader& run, const FieldPlace& place,
                               const std::vector<std::size_t>& snapshots) {
  std::array<double, 2> range{HUGE_VAL, -HUGE_VAL};
  for (const std::size_t index : snapshots) {
    for (const double value : read_scalar(run, index, place).values) {
      if (!std::isfinite(value)) continue;
      range = {std::min(range[0], value), std::max(range[1], value)};
    }
  }
  return range;
}

/// Pictures of one field with a slider in time.
std::string film_html(const ResultsReader& run, const std::vector<std::size_t>& snapshots,
                      const std::vector<std::string>& pictures, const std::string& title) {
  make_equal_size(pictures);
  std::string frames;
  std::string time;
  for (std::size_t k = 0; k < pictures.size(); ++k) {
    time = html::escaped(snapshot_time_words(run, snapshots[k]));
    const bool last = k + 1 == pictures.size();
    std::string attributes = last ? " class=\"frame last shown\"" : " class=\"frame\"";
    attributes.append(" data-time=\"").append(time).append("\"");
    frames += image(pictures[k], std::string(title).append(" at t = ").append(time), attributes);
  }
  const std::string last = std::to_string(pictures.size() - 1);
  const std::string slider =
      "<div class=\"time\"><label>time <input type=\"range\" min=\"0\" max=\"" + last +
      "\" value=\"" + last + "\" aria-valuetext=\"" + time + "\"></label> <output>" + time +
      "</output></div>\n";
  return "<figure class=\"film\">" + html::element("figcaption", title) + card(frames) +
         (pictures.size() > 1 ? slider : "") + "</figure>\n";
}

/// The plane in the middle of a model in space, across the shorter of its horizontal sides.
CutPlane middle_plane(const Mesh<3>& mesh, const Vector<3>& upward) {
  Vector<3> low = mesh.nodes.front();
  Vector<3> high = low;
  for (const Vector<3>& x : mesh.nodes) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  Vector<3> size = high - low;
  size += upward.cwiseAbs() * 2.0 * size.maxCoeff();  // never across the vertical
  CutPlane plane;
  size.minCoeff(&plane.axis);
  plane.at = 0.5 * (low + high)[plane.axis];
  return plane;
}

/// A film of a field; for a model in space, one of its surface and one of a plane in its middle.
std::string render_html(const ResultsReader& run, RenderRequest request, const std::string& title,
                        const ScratchFolder& folder) {
  request.output = (folder.path() / (request.field + ".png")).string();
  std::string films = film_html(run, request.snapshots, render(run, request), title);
  if (run.dimension() == 2) return films;
  request.cut = middle_plane(run.mesh<3>(), upward<3>(run.scene().scene));
  request.output = (folder.path() / (request.field + "_cut.png")).string();
  return films + film_html(run, request.snapshots, render(run, request),
                           title + ", " + cut_text(*request.cut));
}

std::string head_html(const ResultsReader& run, const std::vector<std::size_t>& snapshots,
                      const ScratchFolder& folder) {
  if (!has_field(run, snapshots, "node", "head")) return missing("Head");
  if (run.dimension() == 3) {
    RenderRequest request;
    request.field = "head";
    request.on = "node";
    request.snapshots = snapshots;
    request.mesh = false;
    return render_html(run, request, "Head", folder);
  }
  std::vector<SeepageMap> maps;
  maps.reserve(snapshots.size());
  for (const std::size_t index : snapshots) maps.push_back(head_map(run, run.times()[index]));
  align_maps(maps);
  std::vector<std::string> pictures;
  for (const SeepageMap& map : maps) {
    pictures.push_back(
        (folder.path() / ("head_" + std::to_string(pictures.size()) + ".png")).string());
    draw_seepage_map(map, pictures.back());
  }
  return film_html(run, snapshots, pictures, "Head");
}

std::string field_html(const ResultsReader& run, const ShownField& field,
                       const std::vector<std::size_t>& snapshots, const ScratchFolder& folder) {
  if (!has_field(run, snapshots, "cell", field.name)) return missing(field.title);
  const auto [low, high] = range_of(run, {field.name, "cell", field.change}, snapshots);
  if (low > high) return html::element("p", field.title + ": water rises nowhere.");
  if (low == high) {
    return html::element("p", field.title + ": " + short_text(low) + " everywhere and always.");
  }
  RenderRequest request;
  request.field = field.name;
  request.on = "cell";
  request.change = field.change;
  request.snapshots = snapshots;
  request.mesh = false;  // thin lines make files large, and the sketch of the model has them
  if (field.name == "safety") request.range = {0.0, largest_safety};
  return render_html(run, request, field.title, folder);
}

}  // namespace

std::vector<std::size_t> snapshots_evenly(const std::vector<double>& times, std::size_t count) {
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < count && !times.empty(); ++k) {
    const double share = count > 1 ? static_cast<double>(k) / static_cast<double>(count - 1) : 1.0;
    const double wanted = times.front() + share * (times.back() - times.front());
    const auto nearest =
        std::ranges::min_element(times, {}, [&](double t) { return std::abs(t - wanted); });
    const auto index = static_cast<std::size_t>(nearest - times.begin());
    if (chosen.empty() || chosen.back() != index) chosen.push_back(index);
  }
  return chosen;
}

std::string model_html(const ResultsReader& run, const ReportProgress& progress) {
  if (run.times().empty()) return html::element("p", "The run has no snapshot yet.");
  tell(progress, "sketch of the model");
  const ScratchFolder folder("suffuse-post");
  const std::string path = (folder.path() / "model.png").string();
  draw_figure("model", {run}, path);
  return "<figure>" +
         html::element("figcaption", "Mesh, regions, points, what boundaries prescribe") +
         card(image(path, "Sketch of the model: mesh, regions, points, boundary conditions")) +
         "</figure>\n";
}

std::string factor_html(const ResultsReader& run, const std::vector<double>& times,
                        const std::vector<double>& factors) {
  Curve curve;
  curve.x = times;
  curve.y = factors;
  curve.color = curve_style(0).color;
  Chart chart{"Factor of safety", seconds_label, "factor of safety (-)", {curve}};
  chart.extra_y = {1.0};
  std::vector<Chart> charts{chart};
  if (auto heads = heads_chart(run)) charts.push_back(std::move(*heads));
  const ScratchFolder folder("suffuse-post");
  const std::string path = (folder.path() / "factor.png").string();
  for (Chart& each : charts) set_axes({}, "suffuse-post report", each);
  draw_charts(charts, path);
  return "<figure>" + html::element("figcaption", "Factor of safety against time") +
         card(image(path, "Factor of safety against time")) + "</figure>\n";
}

std::string curves_html(const std::vector<ResultsReader>& runs, const ReportProgress& progress) {
  const ScratchFolder folder("suffuse-post");
  std::string charts;
  if (runs.size() == 1) charts += heads_html(runs.front(), folder);
  for (const CurveColumn& column : curve_columns()) {
    tell(progress, "curves of " + column_words(column.column));
    charts += curve_html(runs, column, folder);
  }
  if (charts.empty()) return html::element("p", "There are too few rows for curves yet.");
  return "<div class=\"charts\">" + charts + "</div>\n";
}

std::string fields_html(const ResultsReader& run, const ReportProgress& progress) {
  const std::vector<std::size_t> snapshots = snapshots_evenly(run.times(), max_snapshots);
  if (snapshots.empty()) return html::element("p", "The run has no snapshot yet.");
  static const std::vector<ShownField> fields{
      {"porosity", true, "Change of porosity since the start"},
      {"concentration", false, "Concentration of fines in the liquid"},
      {"safety", false,
       "Safety against heave; where water does not rise it has the colour of the largest"}};
  const ScratchFolder folder("suffuse-post");
  const auto tell_of = [&](const std::string& field) {
    tell(progress, "pictures of " + field + ", " + std::to_string(snapshots.size()) +
                       (snapshots.size() == 1 ? " time" : " times"));
  };
  tell_of("head");
  std::string films = head_html(run, snapshots, folder);
  for (const ShownField& field : fields) {
    tell_of((field.change ? "the change of " : "") + field_words(field.name));
    films += field_html(run, field, snapshots, folder);
  }
  return films;
}

}  // namespace suffuse
