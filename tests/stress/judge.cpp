#include "stress/judge.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "common/errors.hpp"
#include "physics/liquid.hpp"
#include "results/reader.hpp"
#include "stress/known_porosity.hpp"
#include "stress/stress_mesh.hpp"

namespace suffuse::stress {
namespace {

using Json = nlohmann::json;

constexpr double round_off = 1e-12;
/// Largest round-off of the concentration in an element without grains.
constexpr double no_grains = 1e-13;
/// Largest pressure of waves over the range of the driving pressures: each reflection doubles it.
/// With too long a step, pressures soon exceed this.
constexpr double max_waves = 10.0;
/// Largest relative overshoot of pressures that are promised to stay within bounds.
constexpr double max_overshoot = 1e-10;
/// Largest relative error of a known discharge, with the default tolerance of 1e-3.
constexpr double max_discharge_error = 3e-3;
/// Largest error of a known mean porosity.
constexpr double max_porosity_error = 1e-9;
/// Factors of safety are found within 1 %, so two of them differ by up to twice as much.
constexpr double max_factor_error = 0.021;

std::string shown(double value) {
  std::ostringstream text;
  text.precision(4);
  text << value;
  return text.str();
}

template <int Dim>
class Judge {
 public:
  Judge(const Scenario& scenario, const Case<Dim>& c, const std::string& folder,
        Judgement& judgement)
      : scenario_(scenario), case_(c), scene_(c.document.scene), results_(folder), j_(judgement) {}

  /// The violated conditions, one after the other; empty if all hold.
  std::vector<std::string> complaints(bool ended_well) {
    read_run_info(ended_well);
    j_.bounded = promises_bounds();
    check_history(ended_well);
    check_ledger();
    check_regions();
    for (std::size_t i = 0; i < results_.times().size(); ++i) check_snapshot(i);
    if (ended_well && scenario_.demands) {
      for (const std::string& complaint : scenario_.demands(results_)) complain(complaint);
    }
    return std::move(complaints_);
  }

 private:
  void complain(const std::string& what) {
    if (complaints_.size() < 4) complaints_.push_back(what);
  }
  void expect(bool holds, const std::string& what) {
    if (!holds) complain(what);
  }

  void read_run_info(bool ended_well) {
    std::ifstream in(results_.folder() + "/run.json");
    const Json info = Json::parse(in);
    j_.warnings = static_cast<int>(info.at("warnings").size());
    j_.steps = info.at("steps").get<double>();
    for (const Json& pass : info.at("passes")) {
      if (pass.at("name") == "flow, systems solved") j_.solutions = pass.at("calls").get<double>();
    }
    for (const Json& sentence : info.at("plan")) {
      keeps_inertia_ |= sentence.get<std::string>().starts_with("run: inertia");
    }
    const std::string status = info.at("status");
    const std::string wanted = ended_well ? "done" : "failed";
    expect(status == wanted, "run.json says " + status + "; expected " + wanted);
    expect(ended_well || !info.at("message").get<std::string>().empty(),
           "run.json does not say why the run failed");
  }

  /// Backward Euler promises bounds on a mesh without obtuse angles, with a scalar mobility and
  /// only pressures that drive. Water masses that are released later are a source: single-point
  /// models have it, except with incompressible water; double-point models do not.
  [[nodiscard]] bool promises_bounds() const {
    const bool monotone =
        scenario_.scheme == Scheme::sp_monotone || scenario_.scheme == Scheme::dp_monotone;
    const bool no_source =
        is_double_point(scenario_.scheme) || std::isinf(scene_.liquid.bulk_modulus);
    const bool scalar = std::ranges::all_of(scene_.soils, [](const Soil& s) {
      return s.drag == SoilDrag::darcy && s.anisotropy() == 1.0;
    });
    return monotone && no_source && scalar && !keeps_inertia_ && obtuse_elements(case_.mesh) == 0;
  }

  void check_finite(const Table& table, const std::string& file) {
    for (std::size_t k = 0; k < table.names.size(); ++k) {
      for (const double value : table.columns[k]) {
        if (std::isfinite(value)) continue;
        complain(table.names[k] + " in " + file + " is not a number");
        return;
      }
    }
  }

  void check_concentration(double low, double high, const std::string& where) {
    expect(low >= -no_grains, "c = " + shown(low) + " < 0 in " + where);
    expect(high < 1.0, "c = " + shown(high) + " >= 1 in " + where);
  }

  void check_history(bool ended_well) {
    const Table history = results_.history();
    check_finite(history, "history.csv");
    if (history.rows() == 0) return;
    const auto largest = [&](const char* name) {
      return *std::ranges::max_element(history.column(name));
    };
    const auto& lowest = history.column("concentration_min");
    j_.concentration_min = *std::ranges::min_element(lowest);
    j_.concentration_max = largest("concentration_max");
    check_concentration(j_.concentration_min, j_.concentration_max, "history.csv");
    j_.volume_defect = largest("volume_defect");
    j_.eos_error = largest("eos_error");
    expect(j_.eos_error <= max_eos_error,
           "water does not fit its pores in an element: eos_error = " + shown(j_.eos_error));
    j_.overshoot = largest("pressure_overshoot");
    expect(!j_.bounded || j_.overshoot <= max_overshoot,
           "pressure_overshoot = " + shown(j_.overshoot) + " where pressures have bounds");
    check_waves(*std::ranges::min_element(history.column("pressure_min")), largest("pressure_max"));
    const std::vector<double>& t = history.column("t");
    expect(!ended_well || std::abs(t.back() - scene_.time.end) <= round_off * scene_.time.end,
           "history.csv ends at t = " + shown(t.back()));
    check_mean_porosity(t, history.column("porosity_mean"));
    if (scenario_.discharge && ended_well && !is_explicit(scenario_.scheme)) {
      const double out = history.column("flux_out").back();
      j_.discharge_error = std::abs(out / *scenario_.discharge - 1.0);
      expect(j_.discharge_error <= max_discharge_error,
             "the discharge is " + shown(out) + " m3/s; expected " + shown(*scenario_.discharge));
    }
  }

  /// Explicit runs have waves; those caused by boundary pressures are about as high as these.
  void check_waves(double lowest, double highest) {
    const bool heavy = scene_.gravity != std::array<double, 3>{};
    if (!is_explicit(scenario_.scheme) || heavy) return;
    double low = 0.0;
    double high = 0.0;
    for (const BoundaryCondition& b : scene_.boundaries) {
      if (!b.pressure) return;
      low = std::min(low, b.pressure->smallest());
      high = std::max(high, b.pressure->largest());
    }
    // At rest, the round-off of the equation of state counts.
    const double range = high - low + round_off * scene_.liquid.bulk_modulus;
    expect(lowest >= low - max_waves * range && highest <= high + max_waves * range,
           "pressures from " + shown(lowest) + " to " + shown(highest) +
               " Pa where boundaries have " + shown(low) + " to " + shown(high));
  }

  void check_mean_porosity(const std::vector<double>& t, const std::vector<double>& mean) {
    const KnownPorosity exact(scene_);
    if (scene_.moves() || !exact.known()) return;
    for (std::size_t i = 0; i < t.size(); ++i) {
      j_.porosity_error = std::max(j_.porosity_error, std::abs(mean[i] - exact.at(t[i])));
    }
    expect(j_.porosity_error <= max_porosity_error,
           "mean porosity is off by " + shown(j_.porosity_error));
  }

  void check_ledger() {
    const Table ledger = results_.ledger();
    check_finite(ledger, "ledger.csv");
    const auto at = [&](const char* name, std::size_t i) { return ledger.column(name)[i]; };
    for (std::size_t i = 0; i < ledger.rows(); ++i) {
      const double residual =
          std::max(std::abs(at("residual_water", i)), std::abs(at("residual_grains", i)));
      j_.residual = std::max(j_.residual, residual);
      const double grains =
          at("solid", 0) + at("fines", 0) + at("fines_in", i) + at("fines_out", i);
      // The liquid gained what the solid lost, including fines that left the model and pending
      // fines.
      const double lost = at("solid", 0) - at("solid", i);
      const double gained = at("fines", i) - at("fines", 0) + at("fines_out", i) -
                            at("fines_in", i) + at("pending", i);
      expect(std::abs(lost - gained) <= round_off * grains,
             "the solid lost " + shown(lost) + " kg and the liquid gained " + shown(gained));
      const double eroded = at("eroded", i);
      const double deposited = at("deposited", i);
      // Fines that are eroded and deposited many times are counted every time.
      expect(std::abs(lost - (eroded - deposited)) <= round_off * (grains + eroded),
             "the solid lost " + shown(lost) + " kg; eroded are " + shown(eroded) + ", deposited " +
                 shown(deposited));
      expect(i == 0 || (eroded >= at("eroded", i - 1) - round_off * (grains + eroded) &&
                        deposited >= at("deposited", i - 1) - round_off * (grains + eroded)),
             "fines eroded or deposited become fewer");
      for (const char* name :
           {"erodible", "pending", "fines", "fines_out", "fines_in", "eroded", "deposited"}) {
        expect(at(name, i) >= -round_off * grains,
               std::string(name) + " = " + shown(at(name, i)) + " kg");
      }
      expect(at("water", i) >= 0.0, "water = " + shown(at("water", i)) + " kg");
    }
    expect(j_.residual <= round_off, "residual of the ledger " + shown(j_.residual));
  }

  /// The regions add up to the model.
  void check_regions() {
    const Table ledger = results_.ledger();
    const Table regions = results_.region_ledgers();
    check_finite(regions, "regions.csv");
    for (const char* name : {"solid", "water", "fines"}) {
      std::vector<double> sums(ledger.rows(), 0.0);
      const std::size_t of_each = case_.mesh.region_names.size();
      for (std::size_t row = 0; row < regions.rows() && row / of_each < sums.size(); ++row) {
        sums[row / of_each] += regions.column(name)[row];
      }
      for (std::size_t i = 0; i < sums.size(); ++i) {
        const double whole = ledger.column(name)[i];
        const double size = std::abs(whole) + ledger.column("solid")[i];
        if (std::abs(sums[i] - whole) <= round_off * size) continue;
        complain(std::string("regions hold ") + shown(sums[i]) + " kg of " + name + ", the model " +
                 shown(whole));
        return;
      }
    }
  }

  void check_snapshot(std::size_t index) {
    const std::string where = "snapshot " + std::to_string(index);
    std::vector<std::string> kinds{"cell", "node", "element_vertex", "solid"};
    if (is_double_point(scenario_.scheme)) kinds.emplace_back("liquid");
    for (const std::string& kind : kinds) {
      for (const std::string& name : results_.field_names(index, kind)) {
        const Field field = results_.field(index, kind, name);
        for (const double value : field.values) {
          if (std::isfinite(value)) continue;
          complain(kind + " " + name + " of " + where + " is not a number");
          break;
        }
      }
    }
    check_porosity(index, where);
    check_stored_water(index, where);
    const std::vector<double> fitted = results_.field(index, "cell", "concentration").values;
    if (is_double_point(scenario_.scheme)) {
      j_.fitted_min = std::min(j_.fitted_min, *std::ranges::min_element(fitted));
      check_points(index, where);
    } else {
      check_concentration(*std::ranges::min_element(fitted), *std::ranges::max_element(fitted),
                          where);
    }
  }

  void check_porosity(std::size_t index, const std::string& where) {
    const std::vector<double> porosity = results_.field(index, "solid", "porosity").values;
    expect(porosity.size() == static_cast<std::size_t>(case_.solid_points.size()),
           "solid points were lost in " + where);
    if (scene_.moves()) {
      // Points change their volumes, their elements and their order.
      expect(std::ranges::all_of(porosity, [](double n) { return n > 0.0 && n < 1.0; }),
             "porosity of a solid point outside 0 to 1 in " + where);
      const std::vector<double> cells = results_.field(index, "cell", "porosity").values;
      expect(std::ranges::all_of(cells, [](double n) { return n > 0.0 && n <= 1.0 + round_off; }),
             "porosity of an element outside 0 to 1 in " + where);
      return;
    }
    const int count = std::min(static_cast<int>(porosity.size()), case_.solid_points.size());
    for (int p = 0; p < count; ++p) {
      const int e = case_.solid_points.element[p];
      const Soil& soil = *scene_.find_soil(case_.mesh.region_names[case_.mesh.element_region[e]]);
      const double first = soil.initial_porosity(case_.solid_points.position(case_.mesh, p));
      const DepositionModel& deposition = soil.deposition;
      const bool catches = deposition.deposits();
      const double least = !catches                      ? first
                           : deposition.has_room_limit() ? deposition.porosity_min
                                                         : 0.0;
      const double most = soil.porosity_max() - least_residual(soil);
      const bool holds = porosity[p] > 0.0 && porosity[p] >= least - round_off &&
                         porosity[p] <= std::max(first, most) + round_off &&
                         (index == 0 || catches || porosity[p] >= last_porosity_[p] - round_off);
      if (holds) continue;
      complain("porosity " + shown(porosity[p]) + " of a solid point in " + where + ", outside " +
               shown(least) + " to " + shown(most) + " (by " + shown(porosity[p] - least) + ", " +
               shown(porosity[p] - most) + ")");
      break;
    }
    last_porosity_ = porosity;
    // Mean porosities of elements lie between 0 and 1.
    for (const double n : results_.field(index, "cell", "porosity").values) {
      if (n > 0.0 && n <= 1.0 + round_off) continue;
      complain("porosity " + shown(n) + " of an element in " + where);
      return;
    }
  }

  /// The water of the ledger fills the saturated part of the pores that fines leave free.
  void check_stored_water(std::size_t index, const std::string& where) {
    const Table ledger = results_.ledger();
    const std::vector<double>& t = ledger.column("t");
    const double time = results_.times()[index];
    const auto row = std::ranges::find_if(
        t, [&](double at) { return std::abs(at - time) <= round_off * scene_.time.end; });
    if (row == t.end()) return;  // a run that failed between two rows
    const auto i = static_cast<std::size_t>(row - t.begin());
    const auto cells = [&](const char* name) { return results_.field(index, "cell", name).values; };
    const std::vector<double> porosity = cells("porosity");
    const std::vector<double> pressure = cells("pressure");
    const std::vector<std::string> names = results_.field_names(index, "cell");
    const bool has_air = std::ranges::count(names, "saturation") > 0;
    const std::vector<double> saturation =
        has_air ? cells("saturation") : std::vector<double>(porosity.size(), 1.0);
    double pores = 0.0;
    double liquid = 0.0;
    double room = 0.0;
    for (int e = 0; e < case_.mesh.element_count(); ++e) {
      const double of_element = porosity[e] * element_volume(case_.mesh, e);
      pores += of_element;
      liquid += of_element * saturation[e];
      room += of_element * saturation[e] * density_ratio(pressure[e], scene_.liquid.bulk_modulus);
    }
    // Grains are incompressible.
    const double fines = ledger.column("fines")[i] / scene_.soils.front().grain_density;
    const double fits = room * (1.0 - fines / liquid);
    const double stored = ledger.column("water")[i] / scene_.liquid.density;
    const double misfit = std::abs(stored - fits) / pores;
    j_.misfit = std::max(j_.misfit, misfit);
    // Points carry masses; their volumes have the error that the run reports.
    const double allowed = std::max(
        max_eos_error, is_double_point(scenario_.scheme) ? j_.volume_defect + round_off : 0.0);
    expect(misfit <= allowed, "the water stored in " + where + " takes " + shown(stored) +
                                  " m3 without pressure, the pores have room for " + shown(fits));
  }

  /// The smallest n_e that remains at any flux.
  static double least_residual(const Soil& soil) {
    double least = 1.0;
    for (const auto& [flux, stays] : soil.erosion.residual.pairs) least = std::min(least, stays);
    return soil.erosion.residual.pairs.empty() ? 0.0 : least;
  }

  void check_points(std::size_t index, const std::string& where) {
    const std::vector<double> c = results_.field(index, "liquid", "concentration").values;
    if (!c.empty()) {
      check_concentration(*std::ranges::min_element(c), *std::ranges::max_element(c), where);
    }
    for (const char* name : {"volume", "water_mass"}) {
      for (const double value : results_.field(index, "liquid", name).values) {
        if (value > 0.0) continue;
        complain(std::string(name) + " of a liquid point is " + shown(value) + " in " + where);
        return;
      }
    }
    const std::vector<double> ids = results_.field(index, "liquid", "id").values;
    expect(std::set<double>(ids.begin(), ids.end()).size() == ids.size(),
           "liquid points share a number in " + where);
    check_places(index, where);
  }

  /// Liquid points lie in the elements that they name.
  void check_places(std::size_t index, const std::string& where) {
    const std::vector<Vector<Dim>> places = results_.point_positions<Dim>(index, "liquid");
    const std::vector<double> element = results_.field(index, "liquid", "element").values;
    for (std::size_t p = 0; p < places.size(); ++p) {
      const auto local = barycentric(case_.mesh, static_cast<int>(element[p]), places[p]);
      const double least = *std::ranges::min_element(local);
      if (least >= -1e-9) continue;
      complain("a liquid point lies outside its element in " + where);
      return;
    }
  }

  const Scenario& scenario_;
  const Case<Dim>& case_;
  const Scene& scene_;
  ResultsReader results_;
  Judgement& j_;
  bool keeps_inertia_ = false;
  std::vector<double> last_porosity_;
  std::vector<std::string> complaints_;
};

std::string joined(const std::vector<std::string>& parts) {
  std::string result;
  for (const std::string& part : parts) result += (result.empty() ? "" : "; ") + part;
  return result;
}

/// The lines of the program's output that are no warnings.
std::string error_line(const std::string& output) {
  std::istringstream lines(output);
  std::string found;
  for (std::string line; std::getline(lines, line);) {
    if (line.find("warning: ") != std::string::npos || line.empty()) continue;
    found += (found.empty() ? "" : " / ") + line;
  }
  return found;
}

/// Whether the message names a time in s, or the start, and a place.
bool says_where(const std::string& message) {
  static const std::regex time("t = [-+0-9.e]+ s");
  static const std::regex place(R"(at \( *[-+0-9.e]+,? +[-+0-9.e]+)");
  const bool has_time =
      std::regex_search(message, time) || message.find("at the start") != std::string::npos;
  return has_time && std::regex_search(message, place);
}

/// A controlled refusal has a message, and does not call itself a bug.
Judgement refusal(const Scenario& scenario, int exit_code, const std::string& message) {
  Judgement result;
  result.exit_code = exit_code;
  result.message = message;
  const bool controlled = !message.empty() &&
                          message.find("a bug in Suffuse") == std::string::npos &&
                          (!scenario.refusal_says_where || says_where(message));
  result.verdict = controlled && scenario.expected != Expected::done ? "refused" : "failed";
  if (controlled && scenario.expected == Expected::done) {
    result.message = "refused though the method covers it: " + message;
  }
  return result;
}

/// The text as a cell of a table without quotes.
std::string cell(std::string text) {
  std::ranges::replace(text, ',', ';');
  std::ranges::replace(text, '\n', ' ');
  return text;
}

Judgement with_end(Judgement judgement, const ChildEnd& end) {
  judgement.exit_code = end.exit_code;
  judgement.seconds = end.seconds;
  return judgement;
}

}  // namespace

Judgement judge_refusal(const Scenario& scenario, const std::string& message) {
  return refusal(scenario, static_cast<int>(ExitCode::wrong_input), message);
}

template <int Dim>
Judgement judge_run(const Scenario& scenario, const Case<Dim>& c, const ChildEnd& end,
                    const std::string& folder) {
  Judgement result;
  const bool wrong_input = end.exit_code == static_cast<int>(ExitCode::wrong_input);
  const bool gave_up = end.exit_code == static_cast<int>(ExitCode::numerical_failure);
  if (wrong_input) {
    result = judge_refusal(scenario, error_line(end.output));
  } else if (end.exit_code == static_cast<int>(ExitCode::file_failure) && scenario.disturb) {
    // The mesher would not have written the disturbed case file.
    result = refusal(scenario, end.exit_code, error_line(end.output));
  } else if (end.exit_code == 0 || gave_up) {
    if (gave_up) result = refusal(scenario, end.exit_code, error_line(end.output));
    // Without a start the run writes no results.
    if (gave_up && !std::filesystem::exists(folder)) return with_end(std::move(result), end);
    if (!gave_up) result.verdict = scenario.expected == Expected::refused ? "failed" : "pass";
    if (result.verdict == "failed" && !gave_up) result.message = "ran; expected a refusal";
    std::vector<std::string> wrong;
    try {
      wrong = Judge(scenario, c, folder, result).complaints(!gave_up);
    } catch (const std::exception& error) {
      wrong.push_back(std::string("results cannot be read: ") + error.what());
    }
    if (!wrong.empty()) {
      result.verdict = "failed";
      result.message = joined(wrong);
    }
  } else {
    result.verdict = "failed";
    result.message =
        end.timed_out ? "time limit"
        : end.signal  ? "ended by signal " + std::to_string(end.signal)
                     : "exit code " + std::to_string(end.exit_code) + ": " + error_line(end.output);
  }
  return with_end(std::move(result), end);
}

Judgement judge_strength(const Scenario& scenario, const std::vector<ChildEnd>& ends,
                         const std::vector<std::string>& tables) {
  Judgement result;
  std::vector<double> factors;
  double seconds = 0.0;
  for (std::size_t k = 0; k < ends.size(); ++k) {
    const ChildEnd& end = ends[k];
    seconds += end.seconds;
    result.exit_code = end.exit_code;
    result.verdict = "failed";
    if (end.exit_code == static_cast<int>(ExitCode::numerical_failure)) {
      result = refusal(scenario, end.exit_code, error_line(end.output));
      if (result.verdict == "failed") break;
      continue;
    }
    if (end.exit_code != 0) {
      result.message = end.timed_out ? "time limit" : error_line(end.output);
      break;
    }
    const Table table = read_table(tables[k]);
    const auto at = [&](const char* name) { return table.column(name).front(); };
    const double factor = at("factor");
    const bool holds = table.rows() == 1 && std::isfinite(factor) && factor > 0.0 &&
                       at("holds") <= factor && factor <= at("fails") &&
                       at("fails") <= 1.011 * at("holds") && at("displacement_max") >= 0.0;
    if (!holds) {
      result.message = "the factor is " + shown(factor) + ", between " + shown(at("holds")) +
                       " and " + shown(at("fails"));
      break;
    }
    factors.push_back(factor);
    result.verdict = "pass";
  }
  if (factors.size() == 2) {
    const double error = factors[1] / (factors[0] * scenario.strength->ratio) - 1.0;
    if (std::abs(error) > max_factor_error) {
      result.verdict = "failed";
      result.message = "the factor is " + shown(factors[0]) + ", and " + shown(factors[1]) +
                       " with " + shown(scenario.strength->ratio) + " times the strength";
    }
  }
  result.seconds = seconds;
  return result;
}

template Judgement judge_run(const Scenario&, const Case<2>&, const ChildEnd&, const std::string&);
template Judgement judge_run(const Scenario&, const Case<3>&, const ChildEnd&, const std::string&);

std::string table_head() {
  return "sweep,scheme,parameters,seed,verdict,exit_code,seconds,steps,warnings,residual,bounded,"
         "overshoot,concentration_min,concentration_max,fitted_min,volume_defect,eos_error,misfit,"
         "porosity_error,discharge_error,solutions,message";
}

std::string table_line(const std::string& sweep, const Scenario& scenario, const Judgement& j) {
  std::ostringstream line;
  line.precision(4);
  line << sweep << ',' << name_of(scenario.scheme) << ',' << cell(scenario.parameters) << ','
       << scenario.seed << ',' << j.verdict << ',' << j.exit_code << ',' << j.seconds << ','
       << j.steps << ',' << j.warnings << ',' << j.residual << ',' << j.bounded << ','
       << j.overshoot << ',' << j.concentration_min << ',' << j.concentration_max << ','
       << j.fitted_min << ',' << j.volume_defect << ',' << j.eos_error << ',' << j.misfit << ','
       << j.porosity_error << ',' << j.discharge_error << ',' << j.solutions << ','
       << cell(j.message);
  return line.str();
}

}  // namespace suffuse::stress
