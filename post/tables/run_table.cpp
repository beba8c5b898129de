#include "tables/run_table.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "common/errors.hpp"
#include "files/layout.hpp"
#include "files/number_text.hpp"
#include "files/text_output.hpp"
#include "values/column_fines.hpp"
#include "values/run_names.hpp"
#include "values/scene_words.hpp"
#include "values/specimen.hpp"

namespace suffuse {
namespace {

/// Erosion counts as complete when this share of the initial erodible mass is left.
constexpr double complete_share = 1e-9;

using Row = std::map<std::string, std::string>;

/// A cell of CSV; text with commas, quotes or line ends is quoted.
std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

void add_run_info(Row& row, const ResultsReader& run) {
  const std::string path = (std::filesystem::path(run.folder()) / layout::run_info).string();
  std::ifstream in(path);
  const auto info = nlohmann::json::parse(in, nullptr, false);
  if (!info.is_object()) throw FileError(path + ": cannot be read");
  for (const auto* key : {"steps", "elements", "solid_points", "liquid_points", "wall_seconds"}) {
    row[key] = number_text(info.value(key, 0.0));
  }
}

void add_settings(Row& row, const ResultsReader& run, const Specimen& soil) {
  const Scene& scene = run.scene().scene;
  const bool double_point = is_double_point(run);
  const auto& erosion = soil.portions.front().soil.erosion;
  row["formulation"] = scene_word(scene.formulation);
  row["law"] = erosion.law->word;
  row["rate"] = number_text(erosion.rate);
  row["mass_scaling"] = number_text(scene.time.mass_scaling);
  row["solid_per_element"] = std::to_string(scene.points.solid_per_element);
  if (!double_point) return;
  row["liquid_per_element"] = std::to_string(scene.points.liquid_per_element);
  row["seeding"] = scene_word(scene.points.seeding);
  row["integration"] = scene_word(scene.flow.integration);
  row["mass_transfer"] = scene_word(erosion.mass_transfer);
  row["empty_elements"] = scene_word(erosion.empty_elements);
}

/// When the erodible mass of the run is used up, s; infinity if it never is.
double computed_exhaustion(const std::vector<Masses>& masses) {
  const double first = masses.front().erodible;
  const auto none = std::ranges::find_if(
      masses, [&](const Masses& m) { return m.erodible <= complete_share * first; });
  return none == masses.end() ? std::numeric_limits<double>::infinity() : none->t;
}

/// When the erodible mass is used up by the exact solution, s; infinity where a residual stays.
double exact_completion(const Specimen& soil) {
  const bool keeps = std::ranges::any_of(soil.portions, [](const Portion& p) {
    const ErosionModel model = p.soil.erosion_model();
    return model.residual.at(unset) > 0.0 && p.initial_porosity < model.porosity_max;
  });
  return keeps ? std::numeric_limits<double>::infinity() : exact_exhaustion(soil);
}

/// Adds the largest distance of the mean porosity of the history from the exact one, in % of the
/// volume that can erode.
void add_porosity_error(Row& row, const ResultsReader& run, const Specimen& soil) {
  const double erodible =
      integrate(soil, 0.0, [](const Soil& s, double n, double) { return s.porosity_max() - n; });
  const Table history = run.history();
  double porosity = 0.0;
  for (std::size_t i = 0; i < history.rows(); ++i) {
    porosity = std::max(porosity, std::abs(history.column("porosity_mean")[i] -
                                           exact_mean_porosity(soil, history.column("t")[i])));
  }
  row["error_porosity_percent"] = number_text(100.0 * porosity * soil.volume / erodible);
}

/// Adds the largest distances from the exact curves, in % of the mass that can erode.
void add_errors(Row& row, const ResultsReader& run, const Specimen& soil,
                const std::vector<Masses>& masses) {
  const double density = run.scene().scene.liquid.density;
  const double erodible = exact_masses(soil, density, 0.0).erodible;
  if (!(erodible > 0.0)) return;
  double solid = 0.0;
  double eroded = 0.0;
  for (const auto& m : masses) {
    const Masses exact = exact_masses(soil, density, m.t);
    solid = std::max(solid, std::abs(m.solid - exact.solid));
    eroded = std::max(eroded, std::abs(m.eroded - exact.eroded));
  }
  row["error_solid_percent"] = number_text(100.0 * solid / erodible);
  row["error_eroded_percent"] = number_text(100.0 * eroded / erodible);
  if (soil.has_mean_of_history) add_porosity_error(row, run, soil);
}

void add_fines_error(Row& row, const ResultsReader& run, const std::vector<Masses>& masses) {
  const auto flow = column_flow(run);
  if (!flow) return;
  row["darcy_flux"] = number_text(flow->flux);
  const ColumnFines exact(*flow, masses.back().t);
  double error = 0.0;
  double largest = 0.0;
  for (const auto& m : masses) {
    const double fines = exact.fines(m.t);
    error = std::max(error, std::abs(m.fines - fines));
    largest = std::max(largest, fines);
  }
  if (largest > 0.0) row["error_fines_relative"] = number_text(error / largest);
}

/// NaN if any value is NaN.
double largest_magnitude(const Table& table, const std::string& name) {
  double largest = 0.0;
  for (const double value : table.column(name)) {
    if (!(std::abs(value) <= largest)) largest = std::abs(value);
  }
  return largest;
}

/// Adds the values at the end of a run.
void add_ends(Row& row, const Table& ledger, const Table& history) {
  const double lost = ledger.column("fines_out").back() - ledger.column("fines_in").back();
  // A stage may start with fines in the liquid.
  const double fines = ledger.column("erodible").front() + ledger.column("fines").front();
  row["eroded"] = number_text(ledger.column("eroded").back());
  row["fines_lost"] = number_text(lost);
  if (fines > 0.0) row["fines_lost_percent"] = number_text(100.0 * lost / fines);
  row["water_out"] = number_text(ledger.column("water_out").back());
  row["flux_out"] = number_text(history.column("flux_out").back());
  row["porosity_mean"] = number_text(history.column("porosity_mean").back());
  // Results of earlier versions do not have it.
  if (history.has("turbidity_out")) {
    row["turbidity_max"] = number_text(largest_magnitude(history, "turbidity_out"));
  }
}

Row row_of(const ResultsReader& run, const std::string& label) {
  const Specimen soil = specimen(run);
  const auto masses = computed_masses(run, soil);
  Row row{{"run", label}, {"status", run.status()}};
  add_run_info(row, run);
  add_settings(row, run, soil);
  if (has_exact_porosity(soil)) row["complete_exact"] = number_text(exact_completion(soil));
  row["complete_computed"] = number_text(computed_exhaustion(masses));
  if (has_exact_porosity(soil)) add_errors(row, run, soil, masses);
  add_fines_error(row, run, masses);
  const Table ledger = run.ledger();
  row["residual_water"] = number_text(largest_magnitude(ledger, "residual_water"));
  row["residual_grains"] = number_text(largest_magnitude(ledger, "residual_grains"));
  const Table history = run.history();
  row["empty_elements_total"] = number_text(history.column("empty_elements_total").back());
  row["volume_defect_max"] = number_text(largest_magnitude(history, "volume_defect"));
  add_ends(row, ledger, history);
  return row;
}

}  // namespace

const std::vector<std::string>& run_table_columns() {
  static const std::vector<std::string> columns{"run",
                                                "status",
                                                "formulation",
                                                "law",
                                                "rate",
                                                "darcy_flux",
                                                "elements",
                                                "solid_per_element",
                                                "solid_points",
                                                "liquid_per_element",
                                                "liquid_points",
                                                "seeding",
                                                "integration",
                                                "mass_transfer",
                                                "empty_elements",
                                                "mass_scaling",
                                                "steps",
                                                "wall_seconds",
                                                "complete_exact",
                                                "complete_computed",
                                                "error_porosity_percent",
                                                "error_solid_percent",
                                                "error_eroded_percent",
                                                "error_fines_relative",
                                                "residual_water",
                                                "residual_grains",
                                                "empty_elements_total",
                                                "volume_defect_max",
                                                "eroded",
                                                "fines_lost",
                                                "fines_lost_percent",
                                                "water_out",
                                                "flux_out",
                                                "porosity_mean",
                                                "turbidity_max"};
  return columns;
}

std::string run_table(const std::vector<ResultsReader>& runs) {
  const auto& columns = run_table_columns();
  std::string text;
  const auto add_line = [&](const auto& content) {
    for (std::size_t k = 0; k < columns.size(); ++k) {
      text += (k == 0 ? "" : ",") + cell(content(columns[k]));
    }
    text += "\n";
  };
  add_line([](const std::string& column) { return column; });
  const std::vector<std::string> names = folder_names(runs);
  for (std::size_t r = 0; r < runs.size(); ++r) {
    Row row = row_of(runs[r], names[r]);
    add_line([&](const std::string& column) { return row[column]; });
  }
  return text;
}

void write_run_table(const std::string& path, const std::vector<ResultsReader>& runs) {
  TextOutput(path).write(run_table(runs));
}

}  // namespace suffuse
