#include "values/sample.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "common/closest_name.hpp"
#include "common/errors.hpp"
#include "files/number_text.hpp"
#include "files/time_unit.hpp"
#include "values/derived_fields.hpp"
#include "values/fields.hpp"
#include "values/refusal.hpp"
#include "values/snapshot_choice.hpp"

namespace suffuse {
namespace {

/// A point this far outside an element counts as on its edge, in barycentric coordinates.
constexpr double edge_tolerance = 1e-9;

/// A larger number of points is refused: it is likely a typing error.
constexpr int max_points = 1'000'000;

/// Where a field is looked for, in the order of preference.
constexpr std::array<const char*, 3> kinds_of_place{"element_vertex", "node", "cell"};

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

/// The place that "x,y" or "x,y,z" gives; nothing for other texts.
std::optional<Position> place_of(const std::string& text) {
  const auto coordinates = split(text, ',');
  if (coordinates.size() < 2 || coordinates.size() > 3) return std::nullopt;
  Position place(static_cast<Eigen::Index>(coordinates.size()));
  for (std::size_t d = 0; d < coordinates.size(); ++d) {
    const auto x = parse_number(coordinates[d]);
    if (!x || !std::isfinite(*x)) return std::nullopt;
    place[static_cast<Eigen::Index>(d)] = *x;
  }
  return place;
}

std::string position_text(const Position& x) {
  std::string text = "(" + number_text(x[0]);
  for (Eigen::Index d = 1; d < x.size(); ++d) text += ", " + number_text(x[d]);
  return text + ")";
}

/// An element that contains the point, and the position of the point in it.
template <int Dim>
struct Place {
  int element;
  std::array<double, Dim + 1> barycentric;
};

/// All elements that contain x, on their edges included; only those of soil where there are any.
template <int Dim>
std::vector<Place<Dim>> locate(const ResultsReader& results, const Mesh<Dim>& mesh,
                               const Position& x, const SampleNames& input_names) {
  if (x.size() != Dim) {
    refuse(input_names.command, input_names.places, "the point " + position_text(x),
           Dim == 3 ? "x,y,z: the model has three dimensions" : "x,y: the model is plane");
  }
  std::vector<Place<Dim>> everywhere;
  std::vector<Place<Dim>> in_soil;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto b = barycentric<Dim>(mesh, e, x);
    if (*std::min_element(b.begin(), b.end()) < -edge_tolerance) continue;
    everywhere.push_back({e, b});
    const auto& region = mesh.region_names[mesh.element_region[e]];
    if (results.scene().scene.find_soil(region) != nullptr) in_soil.push_back({e, b});
  }
  if (everywhere.empty()) {
    refuse(input_names.command, input_names.places, "the point " + position_text(x),
           "points inside the model");
  }
  return in_soil.empty() ? everywhere : in_soil;
}

/// The snapshots before and after a time, and the weight of the later one.
struct SnapshotPair {
  std::size_t before;
  std::size_t after;
  double weight;
};

SnapshotPair find_snapshots(const ResultsReader& results, double time,
                            const SampleNames& input_names) {
  const auto& times = results.times();
  expect_snapshots(results);
  const double slack = 1e-12 * std::max(std::abs(times.front()), std::abs(times.back()));
  if (!(time >= times.front() - slack && time <= times.back() + slack)) {
    refuse(input_names.command, input_names.time, number_text(time),
           "a time from " + number_text(times.front()) + " to " + number_text(times.back()) +
               " s, the first and last snapshot");
  }
  const auto later = std::lower_bound(times.begin(), times.end(), time);
  if (later == times.begin()) return {0, 0, 0.0};
  if (later == times.end()) return {times.size() - 1, times.size() - 1, 0.0};
  const auto after = static_cast<std::size_t>(later - times.begin());
  return {after - 1, after, (time - times[after - 1]) / (times[after] - times[after - 1])};
}

/// A field at one time, and the kind of place that it has values on.
struct SampledField {
  Field values;
  std::string where;

  /// 1 for a scalar, the dimension for a vector.
  [[nodiscard]] int width() const { return where == "element_vertex" ? 1 : values.components; }
};

/// Throws InputError for a field of points: it has no values between them.
void refuse_point_field(const ResultsReader& results, std::size_t index, const std::string& name,
                        const SampleNames& input_names) {
  std::vector<std::string> kinds{"solid"};
  if (results.scene().scene.formulation == Formulation::double_point) kinds.emplace_back("liquid");
  for (const auto& kind : kinds) {
    const auto names = results.field_names(index, kind);
    if (std::ranges::find(names, name) == names.end()) continue;
    std::string found = '"' + name + "\", which lives on the ";
    found += kind + " points";
    std::string expected = "a field " + fields_and_places(results, index, {"cell", "node"});
    expected += " (suffuse-post render --on " + kind + " shows it)";
    refuse(input_names.command, input_names.fields, found, expected);
  }
}

/// The value between two others; the nearer one if either is infinite.
double between(double before, double after, double weight) {
  if (std::isfinite(before) && std::isfinite(after)) return before + weight * (after - before);
  return weight < 0.5 ? before : after;
}

/// The kind of place that a field has values on. Throws InputError.
FieldPlace find_place_of(const ResultsReader& results, std::size_t index, const std::string& name,
                         const SampleNames& input_names) {
  std::vector<std::string> known;
  for (const std::string where : kinds_of_place) {
    const auto names = all_field_names(results, index, where);
    if (std::ranges::find(names, name) != names.end()) return {name, where};
    known.insert(known.end(), names.begin(), names.end());
  }
  refuse_point_field(results, index, name, input_names);
  std::sort(known.begin(), known.end());
  known.erase(std::unique(known.begin(), known.end()), known.end());
  refuse(input_names.command, input_names.fields, "\"" + name + "\"", quoted_list(known),
         closest_name(name, known));
}

SampledField read_sampled(const ResultsReader& results, const SnapshotPair& pair,
                          const FieldPlace& place) {
  Field field = read_field(results, pair.before, place);
  if (pair.weight > 0.0) {
    const Field later = read_field(results, pair.after, place);
    for (std::size_t i = 0; i < field.values.size(); ++i) {
      field.values[i] = between(field.values[i], later.values[i], pair.weight);
    }
  }
  return {field, place.where};
}

template <int Dim>
double value_in(const Mesh<Dim>& mesh, const SampledField& field, const Place<Dim>& place,
                int component) {
  const auto at = [&](std::size_t entity) {
    return field.values.values[entity * field.width() + component];
  };
  if (field.where == "cell") return at(place.element);
  double value = 0.0;
  for (int a = 0; a <= Dim; ++a) {
    const int vertex =
        field.where == "node" ? mesh.elements[place.element][a] : (Dim + 1) * place.element + a;
    value += place.barycentric[a] * at(vertex);
  }
  return value;
}

template <int Dim>
double mean_value(const Mesh<Dim>& mesh, const SampledField& field,
                  const std::vector<Place<Dim>>& around, int component) {
  double total = 0.0;
  for (const auto& place : around) total += value_in(mesh, field, place, component);
  return total / static_cast<double>(around.size());
}

std::string column_name(const SampledField& field, int component) {
  constexpr std::array<const char*, 3> axes{"_x", "_y", "_z"};
  return field.width() == 1 ? field.values.name : field.values.name + axes.at(component);
}

template <int Dim>
Table sample_in(const ResultsReader& results, const Mesh<Dim>& mesh, const SampleRequest& request,
                const SampleNames& input_names) {
  constexpr std::array<const char*, 3> axes{"x", "y", "z"};
  Table table{{"t"}, std::vector<std::vector<double>>(Dim + 1), {"s"}};
  for (int d = 0; d < Dim; ++d) {
    table.names.emplace_back(axes.at(d));
    table.units.emplace_back("m");
  }
  std::vector<std::vector<Place<Dim>>> around;
  for (const auto& x : request.positions) {
    around.push_back(locate(results, mesh, x, input_names));
  }
  for (const double time : request.times) {
    const SnapshotPair pair = find_snapshots(results, time, input_names);
    std::size_t column = Dim + 1;
    for (const auto& name : request.fields) {
      FieldPlace place = find_place_of(results, pair.before, name, input_names);
      place.change = request.change;
      const SampledField field = read_sampled(results, pair, place);
      for (int k = 0; k < field.width(); ++k, ++column) {
        if (column == table.names.size()) {
          table.names.push_back(column_name(field, k));
          table.units.push_back(field.values.unit == "1" ? "-" : field.values.unit);
          table.columns.emplace_back();
        }
        for (const auto& places : around) {
          table.columns[column].push_back(mean_value(mesh, field, places, k));
        }
      }
    }
    for (const auto& x : request.positions) {
      table.columns[0].push_back(time);
      for (int d = 0; d < Dim; ++d) table.columns[d + 1].push_back(x[d]);
    }
  }
  return table;
}

}  // namespace

Position parse_place(const std::string& text) {
  const auto place = place_of(text);
  if (!place) refuse(SampleNames{}.command, "--at", "\"" + text + "\"", "x,y or x,y,z in metres");
  return *place;
}

SampleLine parse_line(const std::string& text, const std::string& command,
                      const std::string& option) {
  const auto ends = split(text, ':');
  const auto from = place_of(ends.front());
  const auto to = place_of(ends.back());
  if (ends.size() != 2 || !from || !to || from->size() != to->size()) {
    refuse(command, option, "\"" + text + "\"", "x0,y0:x1,y1 or x0,y0,z0:x1,y1,z1 in metres");
  }
  if (*from == *to) refuse(command, option, "\"" + text + "\"", "two ends that differ");
  return {*from, *to};
}

std::vector<std::string> parse_field_names(const std::string& text) {
  auto names = split(text, ',');
  if (std::find(names.begin(), names.end(), "") != names.end()) {
    refuse(SampleNames{}.command, "--fields", "\"" + text + "\"",
           "names of fields with commas between");
  }
  return names;
}

double parse_time(const std::string& text, const std::string& command) {
  if (const auto time = read_time(text)) return *time;
  refuse(command, "--time", '"' + text + '"', "a time " + time_forms());
}

std::vector<double> parse_times(const ResultsReader& results, const std::string& text) {
  if (text == "all") return results.times();
  std::vector<double> times;
  for (const std::string& part : split(text, ',')) {
    const auto time = read_time(part);
    if (!time)
      refuse(SampleNames{}.command, "--times", "\"" + text + "\"",
             "all, or times with commas between, each " + time_forms());
    times.push_back(*time);
  }
  return times;
}

std::vector<Position> places_on(const SampleLine& line, int count) {
  if (count < 2)
    refuse(SampleNames{}.command, "--count", std::to_string(count),
           "at least 2, the ends of the line");
  if (count > max_points) {
    refuse(SampleNames{}.command, "--count", std::to_string(count),
           "at most " + std::to_string(max_points));
  }
  std::vector<Position> positions;
  for (int i = 0; i < count; ++i) {
    const double along = static_cast<double>(i) / (count - 1);
    positions.emplace_back((1.0 - along) * line.from + along * line.to);
  }
  return positions;
}

Table sample(const ResultsReader& results, const SampleRequest& request,
             const SampleNames& input_names) {
  return with_mesh(
      results, [&](const auto& mesh) { return sample_in(results, mesh, request, input_names); });
}

}  // namespace suffuse
