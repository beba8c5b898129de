#include "tables/reference_error.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "common/closest_name.hpp"
#include "common/errors.hpp"
#include "files/number_text.hpp"
#include "files/text_output.hpp"
#include "tables/table_output.hpp"
#include "values/refusal.hpp"
#include "values/sample.hpp"

namespace suffuse {
namespace {

const std::string error_command = "suffuse-post error";
const std::string mean_prefix = "mean_";

bool is_place(const std::string& column) {
  return column == "x" || column == "y" || column == "z";
}

std::vector<std::string> quantity_names(const Table& table) {
  std::vector<std::string> names;
  for (const auto& name : table.names) {
    if (name != "t" && !is_place(name)) names.push_back(name);
  }
  return names;
}

/// Accumulates the errors of one quantity.
class ErrorSum {
 public:
  void add(double value, double expected) {
    const double difference = std::abs(value - expected);
    const double size = std::abs(expected);
    ++count_;
    sum_ += difference;
    size_sum_ += size;
    squares_ += difference * difference;
    size_squares_ += size * size;
    // If the difference is NaN, the largest one becomes NaN.
    if (!(difference <= largest_)) largest_ = difference;
    largest_size_ = std::max(largest_size_, size);
  }
  [[nodiscard]] ReferenceError result(const std::string& quantity) const {
    return {quantity, count_, sum_ / size_sum_, std::sqrt(squares_ / size_squares_),
            largest_ / largest_size_};
  }

 private:
  std::size_t count_ = 0;
  double sum_ = 0.0;
  double size_sum_ = 0.0;
  double squares_ = 0.0;
  double size_squares_ = 0.0;
  double largest_ = 0.0;
  double largest_size_ = 0.0;
};

/// The field that a column names; NAME_x, NAME_y and NAME_z name components of NAME.
std::string field_of(const std::string& quantity) {
  const bool component =
      quantity.ends_with("_x") || quantity.ends_with("_y") || quantity.ends_with("_z");
  return component ? quantity.substr(0, quantity.size() - 2) : quantity;
}

/// Rows of the reference by time.
std::map<double, std::vector<std::size_t>> rows_by_time(const Table& table) {
  std::map<double, std::vector<std::size_t>> rows;
  const auto& t = table.column("t");
  for (std::size_t row = 0; row < t.size(); ++row) rows[t[row]].push_back(row);
  return rows;
}

/// The columns of `sampled` named `names`. Throws InputError where a scalar is named with a
/// component, or a vector without one.
std::vector<const std::vector<double>*> sampled_columns(const Table& sampled,
                                                        const std::vector<std::string>& names,
                                                        const std::string& path) {
  std::vector<const std::vector<double>*> columns;
  for (const auto& name : names) {
    if (!sampled.has(name)) {
      std::vector<std::string> known;
      for (const auto& column : sampled.names) {
        if (column.starts_with(field_of(name)) && !is_place(column)) known.push_back(column);
      }
      refuse(error_command, path, '"' + name + '"', quoted_list(known), closest_name(name, known));
    }
    columns.push_back(&sampled.column(name));
  }
  return columns;
}

std::vector<ErrorSum> field_errors(const ResultsReader& run, const ReferenceTable& reference,
                                   const std::vector<std::string>& names) {
  const Table& table = reference.values;
  std::vector<std::string> fields;
  for (const auto& name : names) {
    const std::string field = field_of(name);
    if (std::ranges::find(fields, field) == fields.end()) fields.push_back(field);
  }
  const std::vector<std::string> axes =
      table.has("z") ? std::vector<std::string>{"x", "y", "z"} : std::vector<std::string>{"x", "y"};
  const SampleNames input_names{error_command, reference.path + ": t", reference.path + ": x, y",
                                reference.path};
  std::vector<ErrorSum> sums(names.size());
  for (const auto& [t, rows] : rows_by_time(table)) {
    std::vector<Position> places;
    for (const auto row : rows) {
      Position& place = places.emplace_back(static_cast<Eigen::Index>(axes.size()));
      for (std::size_t d = 0; d < axes.size(); ++d) {
        place[static_cast<Eigen::Index>(d)] = table.column(axes[d])[row];
      }
    }
    const Table sampled = sample(run, {{t}, places, fields}, input_names);
    const auto columns = sampled_columns(sampled, names, reference.path);
    for (std::size_t k = 0; k < names.size(); ++k) {
      for (std::size_t i = 0; i < rows.size(); ++i) {
        sums[k].add((*columns[k])[i], table.column(names[k])[rows[i]]);
      }
    }
  }
  return sums;
}

/// A quantity against time.
struct TimeSeries {
  std::vector<double> t;
  std::vector<double> values;
};

/// The value at `t`, linear between the times of `curve`. `path` names the reference table in
/// messages.
double interpolate(const TimeSeries& curve, double t, const std::string& path) {
  const double slack = 1e-12 * std::max(std::abs(curve.t.front()), std::abs(curve.t.back()));
  if (!(t >= curve.t.front() - slack && t <= curve.t.back() + slack)) {
    refuse(error_command, path + ": t", number_text(t),
           "a time from " + number_text(curve.t.front()) + " to " + number_text(curve.t.back()) +
               " s, which the run has");
  }
  const auto above = std::ranges::upper_bound(curve.t, t);
  if (above == curve.t.begin()) return curve.values.front();
  if (above == curve.t.end()) return curve.values.back();
  const auto i = static_cast<std::size_t>(above - curve.t.begin());
  const double weight = (t - curve.t[i - 1]) / (curve.t[i] - curve.t[i - 1]);
  return curve.values[i - 1] + weight * (curve.values[i] - curve.values[i - 1]);
}

/// Volumes of the elements, m3 (m2 in a plane model).
std::vector<double> volumes_of(const ResultsReader& run) {
  return with_mesh(run, [](const auto& mesh) {
    std::vector<double> volumes;
    volumes.reserve(mesh.elements.size());
    for (int e = 0; e < mesh.element_count(); ++e) volumes.push_back(element_volume(mesh, e));
    return volumes;
  });
}

/// Volume mean over the model of an element field, or of a component NAME_x, NAME_y or NAME_z, for
/// every snapshot. Returns nothing when there is no such field.
std::optional<TimeSeries> mean_series(const ResultsReader& run, const std::string& quantity) {
  const std::string field = field_of(quantity);
  const std::vector<double> volumes = volumes_of(run);
  TimeSeries curve;
  for (std::size_t index = 0; index < run.times().size(); ++index) {
    const auto names = run.field_names(index, "cell");
    if (std::ranges::find(names, field) == names.end()) return std::nullopt;
    const Field values = run.field(index, "cell", field);
    const bool component = field != quantity;
    if (component != (values.components > 1)) return std::nullopt;
    const int k = quantity.ends_with("_z") ? 2 : quantity.ends_with("_y") ? 1 : 0;
    if (k >= values.components) return std::nullopt;
    double sum = 0.0;
    double volume = 0.0;
    for (std::size_t e = 0; e < volumes.size(); ++e) {
      sum += volumes[e] * values.values[e * static_cast<std::size_t>(values.components) + k];
      volume += volumes[e];
    }
    curve.t.push_back(run.times()[index]);
    curve.values.push_back(sum / volume);
  }
  if (curve.t.empty()) return std::nullopt;
  return curve;
}

/// The quantity over the run. Throws InputError when the run does not have it.
TimeSeries reference_curve(const ResultsReader& run, const std::string& quantity,
                           const std::string& path) {
  const Table history = run.history();
  const Table ledger = run.ledger();
  for (const Table* table : {&history, &ledger}) {
    if (table->has(quantity) && table->rows() > 0) {
      return {table->column("t"), table->column(quantity)};
    }
  }
  if (quantity.starts_with(mean_prefix)) {
    if (const auto found = mean_series(run, quantity.substr(mean_prefix.size()))) return *found;
  }
  std::vector<std::string> known = quantity_names(history);
  const auto more = quantity_names(ledger);
  known.insert(known.end(), more.begin(), more.end());
  refuse(error_command, path, '"' + quantity + '"',
         "a column of history.csv or ledger.csv, \"mean_\" and a field of the elements (a "
         "vector with _x, _y or _z), or columns x and y with places",
         closest_column(quantity, known));
}

std::vector<ErrorSum> curve_errors(const ResultsReader& run, const ReferenceTable& reference,
                                   const std::vector<std::string>& names) {
  std::vector<ErrorSum> sums;
  for (const auto& name : names) {
    const TimeSeries curve = reference_curve(run, name, reference.path);
    ErrorSum sum;
    for (std::size_t row = 0; row < reference.values.rows(); ++row) {
      sum.add(interpolate(curve, reference.values.column("t")[row], reference.path),
              reference.values.column(name)[row]);
    }
    sums.push_back(sum);
  }
  return sums;
}

/// Throws InputError for a table that is not as read_reference_table says.
void check_reference(const ReferenceTable& reference) {
  const Table& table = reference.values;
  const auto names = quantity_names(table);
  if (!table.has("t")) refuse(error_command, reference.path, "no column \"t\"", "times in s");
  if (table.has("x") != table.has("y")) {
    refuse(error_command, reference.path, "one column of places",
           "both \"x\" and \"y\", or neither");
  }
  if (table.has("z") && !table.has("x")) {
    refuse(error_command, reference.path, "\"z\" alone", "\"x\" and \"y\" too");
  }
  if (names.empty()) refuse(error_command, reference.path, "no column of values", "at least one");
  if (table.rows() == 0) refuse(error_command, reference.path, "no row", "at least one");
  for (std::size_t k = 0; k < table.names.size(); ++k) {
    for (const double value : table.columns[k]) {
      if (!std::isfinite(value)) {
        refuse(error_command, reference.path + ": " + table.names[k], number_text(value),
               "finite numbers");
      }
    }
  }
  for (const auto& name : names) {
    if (std::ranges::all_of(table.column(name), [](double value) { return value == 0.0; })) {
      refuse(error_command, reference.path + ": " + name, "zeros alone",
             "a value that differences can be relative to");
    }
  }
}

}  // namespace

ReferenceTable read_reference_table(const std::string& path) {
  ReferenceTable reference{path, with_seconds(read_table(path), path)};
  check_reference(reference);
  return reference;
}

std::vector<ReferenceError> reference_errors(const ResultsReader& run,
                                             const ReferenceTable& reference) {
  const auto names = quantity_names(reference.values);
  const auto sums = reference.values.has("x") ? field_errors(run, reference, names)
                                              : curve_errors(run, reference, names);
  std::vector<ReferenceError> errors;
  for (std::size_t k = 0; k < names.size(); ++k) errors.push_back(sums[k].result(names[k]));
  return errors;
}

std::string error_text(const std::vector<ReferenceError>& errors) {
  std::string text;
  for (const auto& e : errors) {
    text += e.quantity + ": L1 " + number_text(e.l1) + ", L2 " + number_text(e.l2) + ", largest " +
            number_text(e.max) + " of " + std::to_string(e.values) + " values\n";
  }
  return text;
}

void write_errors(const std::string& path, const std::vector<ReferenceError>& errors) {
  std::string text = "quantity,values,l1,l2,max\n";
  for (const auto& e : errors) {
    text += e.quantity + ',' + std::to_string(e.values) + ',' + number_text(e.l1) + ',' +
            number_text(e.l2) + ',' + number_text(e.max) + '\n';
  }
  TextOutput(path).write(text);
}

}  // namespace suffuse
