#include "values/fields.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <unordered_map>

#include "common/closest_name.hpp"
#include "common/errors.hpp"
#include "files/time_unit.hpp"
#include "values/derived_fields.hpp"
#include "values/name_words.hpp"
#include "values/refusal.hpp"
#include "values/snapshot_choice.hpp"

namespace suffuse {
namespace {

/// A place as `--on` names it, and the kinds of fields there, in the order of preference.
struct NamedPlace {
  std::string name;
  std::vector<std::string> kinds;
};

std::vector<NamedPlace> places_of(const ResultsReader& results) {
  std::vector<NamedPlace> places{
      {"cell", {"cell"}}, {"node", {"element_vertex", "node"}}, {"solid", {"solid"}}};
  if (results.scene().scene.formulation == Formulation::double_point) {
    places.push_back({"liquid", {"liquid"}});
  }
  return places;
}

std::vector<std::string> names_on(const ResultsReader& results, std::size_t index,
                                  const NamedPlace& place) {
  std::vector<std::string> names;
  for (const auto& kind : place.kinds) {
    for (const auto& name : all_field_names(results, index, kind)) names.push_back(name);
  }
  std::ranges::sort(names);
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

void check_place(const std::vector<NamedPlace>& places, const std::string& on,
                 const std::string& command) {
  std::vector<std::string> names;
  std::ranges::transform(places, std::back_inserter(names), &NamedPlace::name);
  if (on.empty() || std::ranges::find(names, on) != names.end()) return;
  throw InputError(std::vector{
      InputProblem{command, "--on", '"' + on + '"', quoted_list(names), closest_name(on, names)}});
}

/// Throws InputError for a field that only soil with a law of the skeleton has.
void refuse_field_of_moving_soil(const ResultsReader& results, const std::string& name,
                                 const std::string& command) {
  static const std::vector<std::string> fields{"displacement", "effective_stress",
                                               "plastic_strain"};
  if (results.scene().scene.moves() || std::ranges::find(fields, name) == fields.end()) return;
  refuse(command, "--field", '"' + name + "\" of soil that does not move",
         missing_key("soil.NAME.skeleton",
                     "skeleton = { law = \"elastic\", young = 2e7, poisson = 0.3 }"));
}

/// A blank and the symbol of a field from the table in docs/theory/README.md, or nothing.
std::string symbol_of(const std::string& name) {
  static const std::map<std::string, std::string> symbols{
      {"porosity", "n_L"},          {"solid_fraction", "n_S"},   {"skeleton_fraction", "n_C"},
      {"erodible_fraction", "n_e"}, {"fines_fraction", "n_f"},   {"water_fraction", "n_w"},
      {"concentration", "c"},       {"erosion_rate", "phi_e"},   {"pressure", "p"},
      {"liquid_velocity", "v_L"},   {"darcy_flux", "q"},         {"head", "h"},
      {"saturation", "S"},          {"hydraulic_gradient", "i"}, {"safety", "i_cr / i"}};
  const auto found = symbols.find(name);
  return found == symbols.end() ? "" : " " + found->second;
}

bool are_moving_points(const ResultsReader& results, const std::string& where) {
  return where == "liquid" || (where == "solid" && results.scene().scene.moves());
}

[[noreturn]] void refuse_change(const FieldPlace& place, const std::string& why) {
  refuse("suffuse-post", "--change", '"' + place.name + "\" on " + place.where,
         "a field of places that stay: " + why);
}

/// Gives the values of points at the start the order of the points of the snapshot `index`, which
/// have the same numbers. Throws InputError where a point has no number, or was not there.
void sort_by_id(const ResultsReader& results, std::size_t index, const FieldPlace& place,
                Field& first) {
  for (const std::size_t i : {std::size_t{0}, index}) {
    if (std::ranges::count(results.field_names(i, place.where), "id") > 0) continue;
    refuse_change(place, "points move, and these have no field \"id\"");
  }
  const std::vector<double> first_id = results.field(0, place.where, "id").values;
  std::unordered_map<double, std::size_t> place_of;
  for (std::size_t i = 0; i < first_id.size(); ++i) place_of[first_id[i]] = i;
  const std::vector<double> unsorted = std::move(first.values);
  first.values.clear();
  const auto width = static_cast<std::ptrdiff_t>(first.components);
  for (const double id : results.field(index, place.where, "id").values) {
    const auto found = place_of.find(id);
    if (found == place_of.end()) refuse_change(place, "a point was not there at the start");
    const auto begin = unsorted.begin() + width * static_cast<std::ptrdiff_t>(found->second);
    first.values.insert(first.values.end(), begin, begin + width);
  }
}

}  // namespace

std::string fields_and_places(const ResultsReader& results, std::size_t index,
                              const std::vector<std::string>& only) {
  std::string text;
  for (const auto& place : places_of(results)) {
    if (!only.empty() && std::ranges::find(only, place.name) == only.end()) continue;
    const auto names = names_on(results, index, place);
    if (names.empty()) continue;
    if (!text.empty()) text += "; ";
    text += "on " + place.name + ": " + quoted_list(names);
  }
  return text;
}

FieldPlace find_field(const ResultsReader& results, std::size_t index, const std::string& name,
                      const std::string& on, const std::string& command) {
  const auto places = places_of(results);
  check_place(places, on, command);
  std::vector<std::string> known;
  for (const auto& place : places) {
    if (!on.empty() && place.name != on) continue;
    for (const auto& kind : place.kinds) {
      const auto names = all_field_names(results, index, kind);
      if (std::ranges::find(names, name) != names.end()) return {name, kind};
      known.insert(known.end(), names.begin(), names.end());
    }
  }
  refuse_field_of_moving_soil(results, name, command);
  throw InputError(InputProblem{
      command, "--field", '"' + name + '"' + (on.empty() ? "" : " on " + on),
      "one of the fields " + fields_and_places(results, index), closest_name(name, known)});
}

Field read_field(const ResultsReader& results, std::size_t index, const FieldPlace& place) {
  Field field = any_field(results, index, place.where, place.name);
  if (!place.change) return field;
  Field first = any_field(results, 0, place.where, place.name);
  if (are_moving_points(results, place.where)) sort_by_id(results, index, place, first);
  for (std::size_t i = 0; i < field.values.size(); ++i) field.values[i] -= first.values[i];
  return field;
}

ScalarField read_scalar(const ResultsReader& results, std::size_t index, const FieldPlace& place) {
  Field field = read_field(results, index, place);
  ScalarField scalar{{}, field.unit, false};
  if (place.where == "element_vertex" || field.components == 1) {
    scalar.values = std::move(field.values);
    return scalar;
  }
  scalar.is_vector = true;
  const auto width = static_cast<std::size_t>(field.components);
  for (std::size_t i = 0; i + width <= field.values.size(); i += width) {
    double square = 0.0;
    for (std::size_t k = 0; k < width; ++k) square += field.values[i + k] * field.values[i + k];
    scalar.values.push_back(std::sqrt(square));
  }
  return scalar;
}

std::vector<double> own_node_values(const ResultsReader& results, std::size_t index,
                                    FieldPlace place) {
  const auto names = results.field_names(index, "node");
  if (place.where == "node" || std::ranges::count(names, place.name) == 0) return {};
  place.where = "node";
  return read_scalar(results, index, place).values;
}

std::string field_title(const FieldPlace& place) {
  const std::string words = field_words(place.name);
  return place.change ? "Change of " + words + " since the start" : capitalized(words);
}

std::string field_label(const FieldPlace& place, const ScalarField& field) {
  return std::string(place.change ? "change of " : "") + (field.is_vector ? "magnitude of " : "") +
         field_words(place.name) + symbol_of(place.name) + " (" +
         (field.unit == "1" || field.unit.empty() ? "-" : field.unit) + ")";
}

std::size_t snapshot_at(const ResultsReader& results, const std::optional<double>& time) {
  const auto& times = results.times();
  expect_snapshots(results);
  if (!time) return times.size() - 1;
  const auto distance = [&](double t) { return std::abs(t - *time); };
  return static_cast<std::size_t>(std::ranges::min_element(times, {}, distance) - times.begin());
}

std::string snapshot_time_words(const ResultsReader& results, std::size_t index) {
  const auto& times = results.times();
  const auto at = times.begin() + static_cast<std::ptrdiff_t>(index);
  const auto first = index > 0 ? at - 1 : at;
  const auto last = std::min(at + 2, times.end());
  return time_words(times[index], times.back(), least_spacing({first, last}));
}

std::string snapshot_title(const ResultsReader& results, std::size_t index,
                           const std::optional<double>& asked, const std::string& what) {
  const double t = results.times()[index];
  std::string title = what + ", " + snapshot_time_words(results, index);
  if (asked && std::abs(*asked - t) > 1e-9 * std::max(1.0, std::abs(t))) {
    title += " (snapshot nearest to " +
             time_words(*asked, results.times().back(), std::abs(*asked - t)) + ")";
  }
  return title;
}

}  // namespace suffuse
