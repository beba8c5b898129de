#include "results/writer.hpp"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <stdexcept>
#include <utility>

#include "case/errors.hpp"
#include "case/hdf5_io.hpp"
#include "results/layout.hpp"
#include "results/number_text.hpp"
#include "results/versions.hpp"
#include "results/vtkhdf.hpp"

namespace suffuse {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string in_folder(const std::string& folder, const std::string& name) {
  return (fs::path(folder) / name).string();
}

void append(std::ofstream& out, const std::string& path, const std::string& text) {
  out << text << std::flush;
  if (!out) throw FileError(path + ": cannot be written");
}

/// A file begun anew with `text`, open for more.
std::ofstream begin_file(const std::string& path, const std::string& text) {
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  append(out, path, text);
  return out;
}

void rename_over(const std::string& from, const std::string& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (error) throw FileError(to + ": cannot be written: " + error.message());
}

/// The file is either as it was or whole and new, whatever happens in between.
void replace_file(const std::string& path, const std::string& text) {
  begin_file(path + ".tmp", text);
  rename_over(path + ".tmp", path);
}

std::string dump(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

bool is_results_folder(const std::string& folder) {
  std::ifstream in(in_folder(folder, layout::run_info));
  const Json json = Json::parse(in, nullptr, false);
  return json.is_object() && json.value("format", Json()) == layout::format;
}

/// Files that a run writes beside run.json.
bool is_own_file(const std::string& name) {
  static const std::regex own(
      R"((case\.h5|(history|ledger|regions)\.csv|(mesh|solid|liquid)\.hdf\.series)(\.tmp)?)");
  return std::regex_match(name, own);
}

bool is_own_snapshot(const std::string& name) {
  static const std::regex own(R"((mesh|solid|liquid)_\d{6,}\.hdf(\.tmp)?)");
  return std::regex_match(name, own);
}

void remove_files(const fs::path& folder, bool (*is_own)(const std::string&)) {
  std::vector<fs::path> doomed;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_regular_file() && is_own(entry.path().filename().string())) {
      doomed.push_back(entry.path());
    }
  }
  for (const auto& path : doomed) fs::remove(path);
}

/// run.json stays until it is replaced, so that the folder can be recognised at every moment.
void remove_earlier_run(const std::string& folder) {
  remove_files(folder, is_own_file);
  const fs::path snapshots = fs::path(folder) / layout::snapshots;
  if (fs::is_directory(snapshots)) remove_files(snapshots, is_own_snapshot);
}

void prepare_folder(const std::string& folder) {
  try {
    if (fs::exists(folder) && !fs::is_directory(folder)) {
      throw FileError(folder + ": is a file; expected a folder for the results");
    }
    if (fs::exists(folder) && !fs::is_empty(folder)) {
      if (!is_results_folder(folder)) {
        throw FileError(folder +
                        ": is not empty and holds no results of suffuse-solver; "
                        "not touched: choose another folder or empty it");
      }
      remove_earlier_run(folder);
    }
    fs::create_directories(fs::path(folder) / layout::snapshots);
  } catch (const fs::filesystem_error& error) {
    throw FileError(folder + ": " + error.code().message());
  }
}

template <class Columns>
std::string header_line(const Columns& columns) {
  std::string line;
  for (const auto& [name, member] : columns) {
    if (!line.empty()) line += ',';
    line += name;
  }
  return line;
}

template <class Row, class Columns>
std::string row_line(const Row& row, const Columns& columns) {
  std::string line;
  for (const auto& [name, member] : columns) {
    if (!line.empty()) line += ',';
    line += number_text(row.*member);
  }
  return line;
}

std::string regions_header() {
  return "t,region,porosity_mean" + header_line(ledger_columns).substr(1);
}

std::string region_line(const RegionRow& row) {
  const std::string ledger = row_line(row.ledger, ledger_columns);
  const auto comma = ledger.find(',');
  return ledger.substr(0, comma) + ',' + std::to_string(row.region) + ',' +
         number_text(row.porosity_mean) + ledger.substr(comma);
}

/// "snapshots/mesh_000012.hdf"
std::string snapshot_name(const std::string& kind, std::size_t index) {
  std::string digits = std::to_string(index);
  if (digits.size() < 6) digits.insert(0, 6 - digits.size(), '0');
  return std::string(layout::snapshots) + "/" + kind + "_" + digits + ".hdf";
}

template <int Dim>
void write_provenance(Hdf5File& file, const Case<Dim>& c, const Snapshot& snapshot) {
  const std::string group = layout::own_group;
  file.create_group(group);
  file.attribute(group, "time", snapshot.time);
  file.attribute(group, "time_unit", std::string("s"));
  const std::int64_t step = snapshot.step;
  const std::int64_t dimension = Dim;
  file.attribute(group, "step", std::span(&step, 1));
  file.attribute(group, "dimension", std::span(&dimension, 1));
  file.attribute(group, "scene", c.document.scene.name);
  for (const auto& [program, version] : versions()) {
    file.attribute(group, "version_" + program, version);
  }
}

/// Fields of the solver's own; those of element_vertex have one row of `vertices` per element.
void write_own_fields(Hdf5File& file, const Snapshot& snapshot, std::size_t elements,
                      int vertices) {
  file.create_group(layout::element_vertex_group);
  for (const auto& field : snapshot.element_vertex) {
    if (field.components != vertices) {
      throw std::logic_error("field " + field.name + " has " + std::to_string(field.components) +
                             " components per element; expected one for every vertex");
    }
    write_field(file, layout::element_vertex_group, field, {elements});
  }
  file.create_group(layout::restart_group);
  for (const auto& field : snapshot.restart) {
    write_field(file, layout::restart_group, field, {field.values.size() / field.components});
  }
}

/// Calls `fill` on a new file that takes the name `path` only once it is whole.
template <class Fill>
void write_hdf5_whole(const std::string& path, const Fill& fill) {
  const std::string temporary = path + ".tmp";
  try {
    Hdf5File file(temporary, Hdf5File::Mode::create);
    fill(file);
    file.close();
    rename_over(temporary, path);
  } catch (...) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    throw;
  }
}

}  // namespace

template <int Dim>
ResultsWriter<Dim>::ResultsWriter(const std::string& folder, const Case<Dim>& c)
    : folder_(folder), case_(c) {
  prepare_folder(folder);
  write_run_info(RunInfo{});
  write_case(in_folder(folder, layout::case_copy), c);
  history_ = begin_file(in_folder(folder, layout::history), header_line(history_columns) + "\n");
  ledger_ = begin_file(in_folder(folder, layout::ledger), header_line(ledger_columns) + "\n");
  regions_ = begin_file(in_folder(folder, layout::regions), regions_header() + "\n");
}

template <int Dim>
void ResultsWriter<Dim>::append_history(const HistoryRow& row) {
  append(history_, in_folder(folder_, layout::history), row_line(row, history_columns) + "\n");
}

template <int Dim>
void ResultsWriter<Dim>::append_ledger(const LedgerRow& row) {
  append(ledger_, in_folder(folder_, layout::ledger), row_line(row, ledger_columns) + "\n");
}

template <int Dim>
void ResultsWriter<Dim>::append_regions(std::span<const RegionRow> rows) {
  std::string lines;
  for (const auto& row : rows) lines += region_line(row) + "\n";
  append(regions_, in_folder(folder_, layout::regions), lines);
}

template <int Dim>
void ResultsWriter<Dim>::append_to(Series& series, const std::string& file, double time) const {
  // Written piece by piece: to make it of all entries again takes longer with each of them.
  if (series.count++ > 0) series.entries += ",";
  series.entries += "\n    {\n      \"name\": " + Json(file).dump() +
                    ",\n      \"time\": " + Json(time).dump() + "\n    }";
  replace_file(
      in_folder(folder_, layout::series(series.kind)),
      "{\n  \"file-series-version\": \"1.0\",\n  \"files\": [" + series.entries + "\n  ]\n}\n");
}

template <int Dim>
void ResultsWriter<Dim>::write_snapshot(Snapshot snapshot) {
  const std::string mesh_name = snapshot_name("mesh", mesh_series_.count);
  write_hdf5_whole(in_folder(folder_, mesh_name), [&](Hdf5File& file) {
    write_vtkhdf(file, vtk_grid(case_.mesh), snapshot.cell, snapshot.node);
    write_provenance(file, case_, snapshot);
    write_own_fields(file, snapshot, case_.mesh.elements.size(), Dim + 1);
  });
  const std::string solid_name = snapshot_name("solid", solid_series_.count);
  write_hdf5_whole(in_folder(folder_, solid_name), [&](Hdf5File& file) {
    write_vtkhdf(file, vtk_grid(case_.mesh, case_.solid_points), {}, snapshot.solid);
    write_provenance(file, case_, snapshot);
  });
  if (case_.document.scene.formulation == Formulation::double_point) {
    const std::string liquid_name = snapshot_name("liquid", liquid_series_.count);
    write_hdf5_whole(in_folder(folder_, liquid_name), [&](Hdf5File& file) {
      write_vtkhdf(file, vtk_grid(std::move(snapshot.liquid_positions)), {}, snapshot.liquid);
      write_provenance(file, case_, snapshot);
    });
    append_to(liquid_series_, liquid_name, snapshot.time);
  }
  append_to(mesh_series_, mesh_name, snapshot.time);
  append_to(solid_series_, solid_name, snapshot.time);
}

template <int Dim>
void ResultsWriter<Dim>::write_run_info(const RunInfo& info) {
  Json passes = Json::array();
  for (const auto& pass : info.passes) {
    passes.push_back({{"name", pass.name}, {"calls", pass.calls}, {"seconds", pass.seconds}});
  }
  const auto& document = case_.document;
  const Json json = {
      {"format", layout::format},
      {"format_version", layout::format_version},
      {"status", info.status},
      {"message", info.message},
      {"steps", info.steps},
      {"solid_points", info.solid_points},
      {"liquid_points", info.liquid_points},
      {"elements", info.elements},
      {"threads", info.threads},
      {"wall_seconds", info.wall_seconds},
      {"memory_bytes", static_cast<std::int64_t>(info.memory_bytes)},
      {"passes", passes},
      {"plan", info.plan},
      {"warnings", info.warnings},
      {"dimension", Dim},
      {"regions", case_.mesh.region_names},
      {"scene",
       {{"name", document.scene.name},
        {"path", document.path},
        {"overrides", document.overrides},
        {"text", document.text}}},
      {"versions", versions()},
  };
  replace_file(in_folder(folder_, layout::run_info), dump(json));
}

template class ResultsWriter<2>;
template class ResultsWriter<3>;

}  // namespace suffuse
