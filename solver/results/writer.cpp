#include "results/writer.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <stdexcept>
#include <utility>

#include "common/errors.hpp"
#include "common/hdf5_io.hpp"
#include "common/regular_file.hpp"
#include "files/layout.hpp"
#include "results/versions.hpp"
#include "results/vtkhdf.hpp"

namespace suffuse {
namespace {

namespace fs = std::filesystem;
using OrderedJson = nlohmann::ordered_json;

[[noreturn]] void fail_writing(const std::string& path, int reason) {
  throw FileError(path + ": cannot be written" +
                  (reason != 0 ? std::string(": ") + std::strerror(reason) : ""));
}

void write_file(const std::string& path, const std::string& text) {
  errno = 0;
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  out << text << std::flush;
  if (!out) fail_writing(path, errno);
}

void rename_over(const std::string& from, const std::string& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (error) throw FileError(to + ": cannot be written: " + error.message());
}

/// Replaces a file; on failure it stays as it was.
void replace_file(const std::string& path, const std::string& text) {
  const std::string temporary = path + ".tmp";
  try {
    write_file(temporary, text);
    rename_over(temporary, path);
  } catch (...) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    throw;
  }
}

std::string dump(const OrderedJson& json) {
  return json.dump(2, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
}

/// The element field that is constant in time.
constexpr const char* region_field = "region";

/// Whether a run writes a file of this name, other than run.json and the lock.
bool is_own_file(const std::string& name) {
  static const std::regex own(
      R"((case\.h5|checkpoint\.hdf|(history|ledger|regions|boundaries|probes|sections)\.csv|(mesh|solid|liquid)\.hdf\.series)(\.tmp)?|\.case\.\d+\.part\.h5)");
  return std::regex_match(name, own);
}

bool is_own_snapshot(const std::string& name) {
  static const std::regex own(R"((mesh|solid|liquid|state)_\d{6,12}\.hdf(\.tmp)?)");
  return std::regex_match(name, own);
}

bool is_own_grid(const std::string& name) {
  static const std::regex own(R"((mesh|solid)_grid\.hdf(\.tmp)?)");
  return std::regex_match(name, own);
}

/// The number of the snapshot of a file.
long snapshot_number(const std::string& name) {
  return std::stol(name.substr(name.find('_') + 1));
}

/// Removes the files with `doomed(name)`. Throws FileError.
template <class Doomed>
void remove_files(const fs::path& folder, const Doomed& doomed) {
  try {
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (entry.is_regular_file() && doomed(entry.path().filename().string())) {
        found.push_back(entry.path());
      }
    }
    for (const auto& path : found) fs::remove(path);
  } catch (const fs::filesystem_error& error) {
    throw FileError(folder.string() + ": " + error.code().message());
  }
}

/// Removes an earlier run except run.json, which identifies the folder until it is replaced.
void remove_earlier_run(const std::string& folder) {
  try {
    remove_files(folder, is_own_file);
    const fs::path snapshots = fs::path(folder) / layout::snapshots;
    if (fs::is_directory(snapshots)) {
      remove_files(snapshots, [](const std::string& name) {
        return is_own_snapshot(name) || is_own_grid(name);
      });
    }
    fs::create_directories(snapshots);
  } catch (const fs::filesystem_error& error) {
    throw FileError(folder + ": " + error.code().message());
  }
}

/// Whether a file is the incomplete one of a solver that was killed.
bool is_unfinished(const std::string& name) {
  return is_own_file(name) && (name.ends_with(".tmp") || name.ends_with(".part.h5"));
}

/// Removes the files that a run writes again if it continues after its first `count` snapshots.
void remove_later_snapshots(const std::string& folder, long count) {
  const auto is_later = [count](const std::string& name) {
    if (is_own_grid(name)) return name.ends_with(".tmp");
    return is_own_snapshot(name) && (name.ends_with(".tmp") || snapshot_number(name) >= count);
  };
  remove_files(folder, is_unfinished);
  remove_files(fs::path(folder) / layout::snapshots, is_later);
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

/// Writes fields outside of VTK's groups; element_vertex has one row of `vertices` per element.
void write_own_fields(Hdf5File& file, const Snapshot& snapshot, std::size_t elements, int vertices,
                      FieldPrecision precision) {
  file.create_group(layout::element_vertex_group);
  for (const auto& field : snapshot.element_vertex) {
    if (field.components != vertices) {
      throw std::logic_error("field " + field.name + " has " + std::to_string(field.components) +
                             " components per element; expected one for every vertex");
    }
    write_field(file, layout::element_vertex_group, field, {elements}, precision);
  }
}

void write_discharge(Hdf5File& file, const DischargeRecord& discharge) {
  const std::string group = layout::discharge_group;
  file.create_group(group);
  file.attribute(group, "unit", std::string("m3/s"));
  file.attribute(group, "low", discharge.low);
  file.attribute(group, "high", discharge.high);
  file.attribute(group, "largest_flux", discharge.largest_flux);
  file.attribute(group, "why_estimate", discharge.why_estimate);
}

/// Whether the case file has this scene: a run may continue with a later end.
bool holds_scene(const std::string& case_path, const SceneDocument& document) {
  try {
    const Hdf5File file(case_path, Hdf5File::Mode::read);
    return file.read_text("/scene/text") == document.text &&
           file.read_texts("/scene/overrides") == document.overrides;
  } catch (const FileError&) {
    return false;
  }
}

/// Calls `fill` on a temporary file, which gets the name `path` when it is complete.
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

GrowingTable::GrowingTable(std::string path, const std::string& names) : path_(std::move(path)) {
  write_file(path_, names + "\n");
  size_ = names.size() + 1;
  out_.open(path_, std::ios::binary | std::ios::app);
}

GrowingTable::GrowingTable(std::string path, long rows) : path_(std::move(path)) {
  std::ifstream in = open_regular_file(path_);
  if (!in) throw FileError(path_ + ": cannot be read");
  std::string line;
  for (long count = 0; count <= rows && std::getline(in, line); ++count) size_ += line.size() + 1;
  std::error_code error;
  fs::resize_file(path_, size_, error);
  if (error) fail_writing(path_, error.value());
  out_.open(path_, std::ios::binary | std::ios::app);
}

void GrowingTable::append(const std::string& lines) {
  errno = 0;
  out_ << lines << std::flush;
  const int reason = errno;
  std::error_code error;
  if (!out_) {
    out_.close();
    fs::resize_file(path_, size_, error);
    fail_writing(path_, reason);
  }
  size_ += lines.size();
  // The open file may have been removed or replaced.
  if (fs::file_size(path_, error) == size_ && !error) return;
  throw FileError(path_ + ": was removed or changed by another program while the run wrote to it");
}

template <int Dim>
ResultsWriter<Dim>::ResultsWriter(const std::string& folder, const Case<Dim>& c)
    : ResultsWriter(folder, c, lock_for_results(folder, c, Replace::same_case)) {}

template <int Dim>
ResultsWriter<Dim>::ResultsWriter(const std::string& folder, const Case<Dim>& c, FolderLock lock)
    : folder_(folder),
      case_(c),
      model_digest_(digest_of_model(c)),
      lock_(std::move(lock)),
      files_(table_files(c.document.scene, c.mesh.region_names.size())) {
  write_run_info(RunInfo{});
  remove_earlier_run(folder);
  write_case(layout::in_folder(folder, layout::case_copy), c);
  write_grids();
  for (const TableFile& file : files_) {
    tables_.emplace_back(layout::in_folder(folder, file.name), file.header);
  }
}

template <int Dim>
ResultsWriter<Dim>::ResultsWriter(const std::string& folder, const Case<Dim>& c, FolderLock lock,
                                  const RestartPoint& point)
    : folder_(folder),
      case_(c),
      model_digest_(digest_of_model(c)),
      lock_(std::move(lock)),
      files_(table_files(c.document.scene, c.mesh.region_names.size())) {
  const std::string case_copy = layout::in_folder(folder, layout::case_copy);
  if (!holds_scene(case_copy, c.document)) write_case(case_copy, c);
  continue_series(mesh_series_, point.snapshots);
  continue_series(solid_series_, point.snapshots);
  if (c.document.scene.formulation == Formulation::double_point) {
    continue_series(liquid_series_, point.snapshots);
  }
  remove_later_snapshots(folder, point.snapshots);
  remove_old_states();
  write_grids();
  for (const TableFile& file : files_) {
    tables_.emplace_back(layout::in_folder(folder, file.name), file.lines_per_time * point.rows);
  }
}

template <int Dim>
template <class Row>
void ResultsWriter<Dim>::append(const char* name, std::span<const Row> rows) {
  std::string lines;
  for (const Row& row : rows) lines += table_line(row);
  for (std::size_t k = 0; k < files_.size(); ++k) {
    if (files_[k].name == name) tables_[k].append(lines);
  }
}

template <int Dim>
void ResultsWriter<Dim>::append_history(const HistoryRow& row) {
  append(layout::history, std::span(&row, 1));
}

template <int Dim>
void ResultsWriter<Dim>::append_ledger(const LedgerRow& row) {
  append(layout::ledger, std::span(&row, 1));
}

template <int Dim>
void ResultsWriter<Dim>::append_regions(std::span<const RegionRow> rows) {
  append(layout::regions, rows);
}

template <int Dim>
void ResultsWriter<Dim>::append_boundaries(std::span<const BoundaryRow> rows) {
  append(layout::boundaries, rows);
}

template <int Dim>
void ResultsWriter<Dim>::append_probes(std::span<const ProbeRow> rows) {
  append(layout::probes, rows);
}

template <int Dim>
void ResultsWriter<Dim>::append_sections(std::span<const SectionRow> rows) {
  append(layout::sections, rows);
}

template <int Dim>
void ResultsWriter<Dim>::extend(Series& series, const std::string& file, double time) {
  // Appends to the text, because the time to write all entries again grows with their number.
  if (series.count++ > 0) series.entries += ",";
  series.entries += "\n    {\n      \"name\": " + OrderedJson(file).dump() +
                    ",\n      \"time\": " + OrderedJson(time).dump() + "\n    }";
}

template <int Dim>
void ResultsWriter<Dim>::write_series(const Series& series) const {
  replace_file(
      layout::in_folder(folder_, layout::series(series.kind)),
      "{\n  \"file-series-version\": \"1.0\",\n  \"files\": [" + series.entries + "\n  ]\n}\n");
}

template <int Dim>
void ResultsWriter<Dim>::continue_series(Series& series, long snapshots) {
  for (long index = 0; index < snapshots; ++index) {
    const std::string name = layout::snapshot(series.kind, index);
    const Hdf5File file(layout::in_folder(folder_, name), Hdf5File::Mode::read);
    extend(series, name, file.double_attribute(layout::own_group, "time"));
  }
  if (snapshots > 0) write_series(series);
}

template <int Dim>
void ResultsWriter<Dim>::write_grids() const {
  write_hdf5_whole(layout::in_folder(folder_, layout::grid("mesh")), [&](Hdf5File& file) {
    const std::vector<int>& regions = case_.mesh.element_region;
    write_vtkhdf(file, vtk_grid(case_.mesh),
                 {.cell = {{region_field, "1", 1, {regions.begin(), regions.end()}, true}}});
    write_region_names(file, case_.mesh.region_names);
    file.write_texts(layout::region_names, case_.mesh.region_names);
  });
  write_hdf5_whole(layout::in_folder(folder_, layout::grid("solid")), [&](Hdf5File& file) {
    write_vtkhdf(file, vtk_grid(case_.mesh, case_.solid_points), {});
  });
}

template <int Dim>
void ResultsWriter<Dim>::remove_old_states() const {
  const long oldest = static_cast<long>(mesh_series_.count) - case_.document.scene.output.restarts;
  remove_files(fs::path(folder_) / layout::snapshots, [oldest](const std::string& name) {
    return is_own_snapshot(name) && name.starts_with("state_") && snapshot_number(name) < oldest;
  });
}

template <int Dim>
void ResultsWriter<Dim>::write_snapshot(Snapshot snapshot) {
  // The state of the run is written last: if it exists, the other files do.
  const std::size_t index = mesh_series_.count;
  const double time = snapshot.time;
  const FieldPrecision precision = case_.document.scene.output.precision;
  const auto write = [&](const std::string& name, const auto& fill) {
    write_hdf5_whole(layout::in_folder(folder_, name), [&](Hdf5File& file) {
      write_provenance(file, case_, snapshot);
      fill(file);
    });
  };
  const std::string solid_name = layout::snapshot("solid", index);
  write(solid_name, [&](Hdf5File& file) {
    const VtkFields fields{.point = std::move(snapshot.solid), .precision = precision};
    if (snapshot.solid_positions.empty()) {
      write_vtkhdf_on(file, layout::grid_name("solid"), {}, fields);
    } else {
      write_vtkhdf(file, vtk_grid(std::move(snapshot.solid_positions)), fields);
    }
  });
  const bool has_liquid = case_.document.scene.formulation == Formulation::double_point;
  const std::string liquid_name = layout::snapshot("liquid", index);
  if (has_liquid) {
    write(liquid_name, [&](Hdf5File& file) {
      write_vtkhdf(file, vtk_grid(std::move(snapshot.liquid_positions)),
                   {.point = std::move(snapshot.liquid), .precision = precision});
    });
  }
  const std::string mesh_name = layout::snapshot("mesh", index);
  write(mesh_name, [&](Hdf5File& file) {
    write_vtkhdf_on(file, layout::grid_name("mesh"), {region_field},
                    {std::move(snapshot.cell), std::move(snapshot.node), precision});
    link_region_names(file, layout::grid_name("mesh"), case_.mesh.region_names);
    write_own_fields(file, snapshot, case_.mesh.elements.size(), Dim + 1, precision);
    if (snapshot.discharge) write_discharge(file, *snapshot.discharge);
  });
  if (snapshot.restart) {
    write_hdf5_whole(layout::in_folder(folder_, layout::state(index)),
                     [&](Hdf5File& file) { write_restart_point(file, *snapshot.restart); });
  }
  if (has_liquid) {
    extend(liquid_series_, liquid_name, time);
    write_series(liquid_series_);
  }
  extend(solid_series_, solid_name, time);
  write_series(solid_series_);
  // The mesh is last: its snapshots are in every series, even if the process is killed.
  extend(mesh_series_, mesh_name, time);
  write_series(mesh_series_);
  const long old = static_cast<long>(index) - case_.document.scene.output.restarts;
  if (old < 0) return;
  std::error_code ignored;
  fs::remove(layout::in_folder(folder_, layout::state(old)), ignored);
}

template <int Dim>
void ResultsWriter<Dim>::write_checkpoint(const RestartPoint& point) {
  write_hdf5_whole(layout::in_folder(folder_, layout::checkpoint),
                   [&](Hdf5File& file) { write_restart_point(file, point); });
}

template <int Dim>
void ResultsWriter<Dim>::remove_checkpoint() {
  std::error_code ignored;
  fs::remove(layout::in_folder(folder_, layout::checkpoint), ignored);
}

template <int Dim>
void ResultsWriter<Dim>::write_run_info(const RunInfo& info) {
  OrderedJson passes = OrderedJson::array();
  for (const auto& pass : info.passes) {
    passes.push_back({{"name", pass.name}, {"calls", pass.calls}, {"seconds", pass.seconds}});
  }
  const auto& document = case_.document;
  const OrderedJson json = {
      {"format", layout::format},
      {"format_version", layout::format_version},
      {"status", info.status},
      {"message", info.message},
      {"steps", info.steps},
      {"solid_points", info.solid_points},
      {"liquid_points", info.liquid_points},
      {"elements", info.elements},
      {"threads", info.threads},
      {"ranks", info.ranks},
      {"wall_seconds", info.wall_seconds},
      {"resumed_at", info.resumed_at ? OrderedJson(*info.resumed_at) : OrderedJson()},
      {"memory_bytes", static_cast<std::int64_t>(info.memory_bytes)},
      {"passes", passes},
      {"plan", info.plan},
      {"warnings", info.warnings},
      {"dimension", Dim},
      {"regions", case_.mesh.region_names},
      {"model", model_digest_},
      {"scene",
       {{"name", document.scene.name},
        {"path", document.path},
        {"overrides", document.overrides},
        {"files", document.files},
        {"text", document.text}}},
      {"versions", versions()},
  };
  replace_file(layout::in_folder(folder_, layout::run_info), dump(json));
}

template class ResultsWriter<2>;
template class ResultsWriter<3>;

}  // namespace suffuse
