#include "results/reader.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "case/case_file.hpp"
#include "common/errors.hpp"
#include "common/hdf5_io.hpp"
#include "common/regular_file.hpp"
#include "files/folder_lock.hpp"
#include "files/layout.hpp"
#include "files/number_text.hpp"
#include "files/table_files.hpp"
#include "files/text_output.hpp"
#include "results/vtkhdf.hpp"
#include "scene/table_file.hpp"

namespace suffuse {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
constexpr auto replace = Json::error_handler_t::replace;  // replaces what is not UTF-8 in messages

std::ifstream open_file(const std::string& path) {
  std::ifstream in = open_regular_file(path);
  if (!in.is_open()) throw FileError(path + ": cannot be read");
  return in;
}

Json read_json(const std::string& path) {
  std::ifstream in = open_file(path);
  Json json = Json::parse(in, nullptr, false);
  if (json.is_discarded()) throw FileError(path + ": is not JSON");
  return json;
}

Json read_run_info(const std::string& folder) {
  if (!fs::is_directory(folder)) throw FileError(folder + ": no such results folder");
  const std::string path = layout::in_folder(folder, layout::run_info);
  if (!fs::exists(path)) {
    throw FileError(folder + ": is not a results folder: it has no " + layout::run_info);
  }
  Json json = read_json(path);
  if (!json.is_object() || json.value("format", Json()) != layout::format) {
    throw FileError(path + ": was not written by suffuse-solver");
  }
  const Json version = json.value("format_version", Json());
  if (!version.is_number_integer() || version < layout::oldest_readable_version ||
      version > layout::format_version) {
    throw FileError(path + ": got format_version " + version.dump(-1, ' ', true, replace) +
                    "; expected " + std::to_string(layout::oldest_readable_version) + " to " +
                    std::to_string(layout::format_version));
  }
  return json;
}

/// The status of a run. A run that was killed could not write its end.
std::string status_in(const Json& info, const std::string& folder) {
  std::string status = info.at("status").get<std::string>();
  return status == "running" && !may_be_held(folder) ? "stopped without notice" : status;
}

struct Series {
  std::vector<std::string> files;
  std::vector<double> times;
};

/// Whether a name is that of a file in the folder of snapshots.
bool is_snapshot_name(const std::string& name) {
  const fs::path path(name);
  return name.find('\0') == std::string::npos && path.parent_path() == layout::snapshots &&
         path.has_filename() && path.filename() != ".." && path.filename() != ".";
}

void check_snapshot(const std::string& place, const std::string& name, double time,
                    const std::vector<double>& times) {
  if (!is_snapshot_name(name)) {
    throw FileError(place + ": got the file " + Json(name).dump(-1, ' ', true, replace) +
                    "; expected one in " + layout::snapshots);
  }
  if (!times.empty() && !(time > times.back())) {
    throw FileError(place + ": got t = " + number_text(time) +
                    " s; expected a later time than the one before, " + number_text(times.back()) +
                    " s");
  }
}

/// Empty when there is no snapshot yet.
Series read_series(const std::string& folder, const std::string& kind) {
  const std::string path = layout::in_folder(folder, layout::series(kind));
  Series series;
  if (!fs::exists(path)) return series;
  const Json json = read_json(path);
  try {
    for (const auto& entry : json.at("files")) {
      const auto name = entry.at("name").get<std::string>();
      const auto time = entry.at("time").get<double>();
      const std::string place = path + ": snapshot " + std::to_string(series.files.size());
      check_snapshot(place, name, time, series.times);
      series.files.push_back(layout::in_folder(folder, name));
      series.times.push_back(time);
    }
  } catch (const Json::exception& error) {
    throw FileError(path + ": is not a file series: " + error.what());
  }
  return series;
}

void refuse_repeated(const std::vector<std::string>& names, const std::string& path) {
  for (const std::string& name : names) {
    if (std::ranges::count(names, name) == 1) continue;
    throw InputError(
        InputProblem{path + ":1", "", "several columns \"" + name + '"', "each column once"});
  }
}

void append_row(Table& table, const std::vector<std::string>& cells, const std::string& where) {
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const auto value = parse_number(cells[k]);
    if (!value) {
      throw FileError(where + table.names[k] + ": got '" + cells[k] + "'; expected a number");
    }
    table.columns[k].push_back(*value);
  }
}

std::vector<std::string> cells_of(const Table& table, std::size_t row) {
  std::vector<std::string> cells;
  for (const auto& column : table.columns) cells.push_back(number_text(column[row]));
  return cells;
}

/// Joins `cells` with commas; inserts `second` after the first cell unless it is empty.
std::string joined(const std::vector<std::string>& cells, const std::string& second) {
  std::string line;
  for (std::size_t k = 0; k < cells.size(); ++k) {
    line += (k > 0 ? "," : "") + cells[k];
    if (k == 0 && !second.empty()) line += "," + second;
  }
  return line;
}

/// Cuts "t [s]" to "t" and returns "s"; returns an empty text without a unit.
std::string cut_unit(std::string& name) {
  const auto start = name.find(" [");
  if (start == std::string::npos || !name.ends_with(']')) return "";
  std::string unit = name.substr(start + 2, name.size() - start - 3);
  name.resize(start);
  return unit;
}

constexpr const char* points_dataset = "/VTKHDF/Points";

/// Number of rows of a table with this number of columns.
std::size_t row_count(const Hdf5File& file, const std::string& dataset, std::size_t columns) {
  const std::vector<std::size_t> shape = file.shape(dataset);
  if (shape.size() != 2 || shape[1] != columns) {
    throw FileError(file.path() + ": " + dataset + ": expected a table of " +
                    std::to_string(columns) + " columns");
  }
  return shape[0];
}

/// The group of a snapshot file with the fields of `where`.
std::string field_group(const std::string& where) {
  if (where == "cell") return "/VTKHDF/CellData";
  if (where == "node" || where == "solid" || where == "liquid") return "/VTKHDF/PointData";
  if (where == "element_vertex") return layout::element_vertex_group;
  throw std::logic_error("no fields on " + where);
}

/// Refuses links that do not lead to `grid`, because VTK follows every link.
void refuse_links(const Hdf5File& file, const std::string& grid) {
  for (const std::string group :
       {"/VTKHDF", "/VTKHDF/CellData", "/VTKHDF/PointData", layout::field_data_group}) {
    if (!file.exists(group)) continue;
    for (const std::string& name : file.children(group)) {
      const std::string object = std::string(group).append("/").append(name);
      // `exists` throws if the object is a link.
      if (!file.is_in(object, grid)) static_cast<void>(file.exists(object));
    }
  }
}

}  // namespace

std::vector<std::string> Table::headings() const {
  std::vector<std::string> result = names;
  for (std::size_t k = 0; k < units.size(); ++k) {
    if (!units[k].empty()) result[k] += " [" + units[k] + "]";
  }
  return result;
}

bool Table::has(const std::string& name) const {
  return std::find(names.begin(), names.end(), name) != names.end();
}

const std::vector<double>& Table::column(const std::string& name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw FileError("the table has no column " + name);
  return columns[found - names.begin()];
}

Table read_table(const std::string& path) {
  return read_tables(path, "").front().table;
}

std::vector<NamedTable> read_tables(const std::string& path, const std::string& by) {
  std::ifstream in = open_file(path);
  std::string line;
  if (!std::getline(in, line)) throw FileError(path + ":1: got nothing; expected a line of names");
  if (const std::string advice = separator_advice(line); !advice.empty()) {
    throw FileError(path + ":1: got " + line + "; expected a line of names" + advice);
  }
  std::vector<std::string> names = csv_cells(line);
  std::vector<std::string> units(names.size());
  std::ranges::transform(names, units.begin(), cut_unit);
  refuse_repeated(names, path);
  const auto key = std::ranges::find(names, by) - names.begin();
  if (!by.empty() && key == std::ssize(names)) {
    throw FileError(path + ":1: got no column " + by);
  }
  Table empty;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (!by.empty() && names[k] == by) continue;
    empty.names.push_back(names[k]);
    empty.units.push_back(units[k]);
  }
  empty.columns.resize(empty.names.size());
  std::vector<NamedTable> tables;
  if (by.empty()) tables.push_back({"", empty});
  for (int number = 2; std::getline(in, line); ++number) {
    // A row without an end of line is still being written: leave it out.
    if (in.eof()) break;
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    auto cells = csv_cells(line);
    const std::string where = path + ":" + std::to_string(number) + ": ";
    if (cells.size() != names.size()) {
      throw FileError(where + "got " + std::to_string(cells.size()) + " columns; expected " +
                      std::to_string(names.size()) +
                      (cells.size() > names.size() ? ", with decimal points in numbers"
                                                   : separator_advice(line)));
    }
    std::string name;
    if (!by.empty()) {
      name = cells[key];
      cells.erase(cells.begin() + key);
    }
    auto found = std::ranges::find(tables, name, &NamedTable::name);
    if (found == tables.end()) found = tables.insert(found, {name, empty});
    append_row(found->table, cells, where);
  }
  return tables;
}

void write_table(const std::string& path, const Table& table) {
  std::string text = joined(table.headings(), "") + "\n";
  for (std::size_t row = 0; row < table.rows(); ++row)
    text += joined(cells_of(table, row), "") + "\n";
  TextOutput(path).write(text);
}

void write_tables(const std::string& path, const std::string& by,
                  const std::vector<NamedTable>& tables) {
  std::string text;
  std::size_t rows = 0;
  for (const auto& [name, table] : tables) {
    if (text.empty()) text = joined(table.headings(), by) + "\n";
    rows = std::max(rows, table.rows());
  }
  for (std::size_t row = 0; row < rows; ++row) {
    for (const auto& [name, table] : tables) {
      if (row < table.rows()) text += joined(cells_of(table, row), csv_cell(name)) + "\n";
    }
  }
  TextOutput(path).write(text);
}

ResultsReader::ResultsReader(const std::string& folder) : folder_(folder) {
  const Json info = read_run_info(folder);
  const std::string path = layout::in_folder(folder, layout::run_info);
  try {
    status_ = status_in(info, folder);
    dimension_ = info.at("dimension").get<int>();
    regions_ = info.at("regions").get<std::vector<std::string>>();
    const auto& scene = info.at("scene");
    scene_ = parse_scene(scene.at("text").get<std::string>(), scene.at("path").get<std::string>(),
                         scene.at("overrides").get<std::vector<std::string>>(),
                         scene.value("files", std::map<std::string, std::string>{}));
    complete_for_mesh(scene_, dimension_);
  } catch (const Json::exception& error) {
    throw FileError(path + ": is incomplete: " + error.what());
  } catch (const InputError& error) {
    throw FileError(path + ": the scene within is not valid:\n" + error.what());
  }
  if (dimension_ != 2 && dimension_ != 3) {
    throw FileError(path + ": dimension: got " + std::to_string(dimension_) + "; expected 2 or 3");
  }
  const Series mesh = read_series(folder, "mesh");
  times_ = mesh.times;
  mesh_files_ = mesh.files;
  take_series("solid", solid_files_);
  if (scene_.scene.formulation == Formulation::double_point) take_series("liquid", liquid_files_);
}

void ResultsReader::take_series(const std::string& kind, std::vector<std::string>& files) {
  const Series series = read_series(folder_, kind);
  // If a run is writing, the series may differ by the newest snapshot.
  const std::size_t count = std::min(mesh_files_.size(), series.files.size());
  for (std::size_t i = 0; i < count; ++i) {
    if (times_[i] != series.times[i]) {
      throw FileError(folder_ + ": snapshot " + std::to_string(i) +
                      " has different times in mesh.hdf.series and " + layout::series(kind));
    }
  }
  times_.resize(count);
  mesh_files_.resize(count);
  files.assign(series.files.begin(), series.files.begin() + count);
}

Table ResultsReader::history() const {
  Table table = read_table(layout::in_folder(folder_, layout::history));
  for (std::string& name : table.names) {
    if (const std::string now = renamed_column(name); !now.empty()) name = now;
  }
  return table;
}
Table ResultsReader::ledger() const {
  return read_table(layout::in_folder(folder_, layout::ledger));
}
Table ResultsReader::region_ledgers() const {
  return read_table(layout::in_folder(folder_, layout::regions));
}

std::vector<NamedTable> ResultsReader::boundaries() const {
  return read_tables(layout::in_folder(folder_, layout::boundaries), "boundary");
}
Table ResultsReader::probes() const {
  return read_table(layout::in_folder(folder_, layout::probes));
}
Table ResultsReader::sections() const {
  return read_table(layout::in_folder(folder_, layout::sections));
}

std::string ResultsReader::snapshot_path(const std::string& kind, std::size_t index) const {
  if (kind == "solid") return solid_files_.at(index);
  if (kind == "liquid") return liquid_files_.at(index);
  return mesh_files_.at(index);
}

void ResultsReader::require_dimension(int dimension) const {
  if (dimension_ == dimension) return;
  if (dimension == 3) throw InputError(folder_ + ": got a plane model; expected one of tetrahedra");
  throw InputError(folder_ +
                   ": got results of three dimensions; expected a plane model. Of these, render "
                   "draws surfaces and cuts, sample and the figure profile follow lines");
}

template <int Dim>
Mesh<Dim> ResultsReader::mesh() const {
  require_dimension(Dim);
  return read_case<Dim>(layout::in_folder(folder_, layout::case_copy)).mesh;
}

template <int Dim>
std::vector<Vector<Dim>> ResultsReader::point_positions(std::size_t index,
                                                        const std::string& kind) const {
  require_dimension(Dim);
  const Hdf5File file = file_of(index, kind, points_dataset);
  const std::vector<double> coordinates = file.read_doubles(points_dataset);
  std::vector<Vector<Dim>> positions;
  for (std::size_t i = 0; i < 3 * row_count(file, points_dataset, 3); i += 3) {
    positions.emplace_back(Vector<Dim>(coordinates.data() + i));
  }
  return positions;
}

Hdf5File ResultsReader::file_of(std::size_t index, const std::string& where,
                                const std::string& object) const {
  Hdf5File file(snapshot_path(where, index), Hdf5File::Mode::read);
  const std::string kind = where == "solid" ? "solid" : "mesh";
  if (where == "liquid" || !file.is_in(object, layout::grid_name(kind))) return file;
  return {layout::in_folder(folder_, layout::grid(kind)), Hdf5File::Mode::read};
}

std::size_t ResultsReader::entity_count(std::size_t index, const std::string& where) const {
  if (where == "solid" || where == "liquid") {
    return row_count(file_of(index, where, points_dataset), points_dataset, 3);
  }
  const Hdf5File file(layout::in_folder(folder_, layout::case_copy), Hdf5File::Mode::read);
  const auto dimension = static_cast<std::size_t>(dimension_);
  return where == "node" ? row_count(file, "/mesh/nodes", dimension)
                         : row_count(file, "/mesh/elements", dimension + 1);
}

Field ResultsReader::field(std::size_t index, const std::string& where,
                           const std::string& name) const {
  const Hdf5File file = file_of(index, where, field_group(where) + "/" + name);
  Field field = read_field(file, field_group(where), name);
  const std::size_t entities = entity_count(index, where);
  const std::size_t found = field.values.size() / static_cast<std::size_t>(field.components);
  if (found != entities) {
    throw FileError(file.path() + ": " + field_group(where) + "/" + name + ": got values for " +
                    std::to_string(found) + " of " + std::to_string(entities) +
                    "; the snapshot is not of this run's mesh and points, or damaged");
  }
  return field;
}

std::vector<std::string> ResultsReader::field_names(std::size_t index,
                                                    const std::string& where) const {
  const Hdf5File file(snapshot_path(where, index), Hdf5File::Mode::read);
  const std::string kind = where == "solid" || where == "liquid" ? where : "mesh";
  refuse_links(file, layout::grid_name(kind));
  const std::string grid = layout::in_folder(folder_, layout::grid(kind));
  if (file.is_in(points_dataset, layout::grid_name(kind))) {
    refuse_links(Hdf5File(grid, Hdf5File::Mode::read), "");
  }
  return file.children(field_group(where));
}

std::optional<DischargeRecord> ResultsReader::discharge(std::size_t index) const {
  const Hdf5File file(snapshot_path("mesh", index), Hdf5File::Mode::read);
  const std::string group = layout::discharge_group;
  if (!file.exists(group)) return std::nullopt;
  return DischargeRecord{file.double_attribute(group, "low"), file.double_attribute(group, "high"),
                         file.double_attribute(group, "largest_flux"),
                         file.text_attribute(group, "why_estimate")};
}

template Mesh<2> ResultsReader::mesh() const;
template Mesh<3> ResultsReader::mesh() const;
template std::vector<Vector<2>> ResultsReader::point_positions(std::size_t,
                                                               const std::string&) const;
template std::vector<Vector<3>> ResultsReader::point_positions(std::size_t,
                                                               const std::string&) const;

}  // namespace suffuse
