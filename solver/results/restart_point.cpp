#include "results/restart_point.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "common/errors.hpp"
#include "common/regular_file.hpp"
#include "files/layout.hpp"
#include "scene/scene_difference.hpp"

namespace suffuse {
namespace {

namespace fs = std::filesystem;

/// Version of the bytes of a state. Increase it whenever the list of an `archive` changes.
constexpr std::int64_t state_layout = 24;

/// FNV-1a (Fowler, Noll, Vo) on eight bytes at a time, with the high bits mixed into the low ones.
class Digest {
 public:
  void add(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    add_word(size);
    for (; size >= 8; size -= 8, bytes += 8) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes, 8);
      add_word(word);
    }
    std::uint64_t rest = 0;
    if (size > 0) std::memcpy(&rest, bytes, size);
    add_word(rest);
  }
  void add(const std::string& text) { add(text.data(), text.size()); }
  template <class Number>
  requires std::is_arithmetic_v<Number>
  void add(Number number) { add(&number, sizeof number); }
  template <class Value>
  void add(const std::vector<Value>& values) {
    add(values.data(), values.size() * sizeof(Value));
  }
  [[nodiscard]] std::string text() const {
    std::ostringstream out;
    out.fill('0');
    out.width(16);
    out << std::hex << hash_;
    return out.str();
  }

 private:
  void add_word(std::uint64_t word) {
    hash_ = (hash_ ^ word) * 1099511628211ULL;
    hash_ ^= hash_ >> 29;
  }
  std::uint64_t hash_ = 14695981039346656037ULL;
};

template <int Dim>
void add(Digest& digest, const MaterialPoints<Dim>& points) {
  digest.add(points.element);
  digest.add(points.barycentric);
  digest.add(points.volume);
}

template <int Dim>
void add_model(Digest& digest, const Case<Dim>& c) {
  for (const Vector<Dim>& node : c.mesh.nodes) digest.add(node.data(), sizeof(double) * Dim);
  digest.add(c.mesh.elements);
  digest.add(c.mesh.element_region);
  for (const std::string& name : c.mesh.region_names) digest.add(name);
  for (const BoundarySet<Dim>& boundary : c.mesh.boundaries) {
    digest.add(boundary.name);
    digest.add(boundary.faces);
  }
  add(digest, c.solid_points);
  add(digest, c.liquid_points);
}

/// Keys that must not change during a run; the whole text if it is no valid scene.
std::map<std::string, std::string> lasting_values(const SceneDocument& document) {
  try {
    std::map<std::string, std::string> values = written_values(document);
    for (const char* key : keys_that_may_change) values.erase(key);
    return values;
  } catch (const InputError&) {
    return {{"text", document.text}};
  }
}

/// Number of complete lines after the line of names.
long rows_in(const std::string& path) {
  std::ifstream in = open_regular_file(path);
  long lines = 0;
  std::array<char, 65536> block;
  while (in.read(block.data(), block.size()), in.gcount() > 0) {
    lines += std::count(block.data(), block.data() + in.gcount(), '\n');
  }
  return lines - 1;
}

/// Number of output times for which every table has all its rows.
long output_times_in(const std::string& folder, const std::vector<TableFile>& tables) {
  long times = std::numeric_limits<long>::max();
  for (const TableFile& table : tables) {
    const long rows = rows_in(layout::in_folder(folder, table.name));
    // A table may have no rows, but it must have its line of names.
    times = std::min(times, table.lines_per_time > 0 ? rows / table.lines_per_time
                            : rows < 0               ? rows
                                                     : times);
  }
  return times;
}

/// Number of leading snapshots with complete files. Reports the first damaged file.
long whole_snapshots(const std::string& folder, bool has_liquid_files,
                     std::vector<std::string>& damage) {
  for (long index = 0;; ++index) {
    for (const std::string kind : {"mesh", "solid", "liquid"}) {
      if (kind == "liquid" && !has_liquid_files) continue;
      const std::string path = layout::in_folder(folder, layout::snapshot(kind, index));
      if (!fs::exists(path)) return index;
      try {
        const Hdf5File file(path, Hdf5File::Mode::read);
        if (!file.exists(layout::own_group)) {
          throw FileError(path + ": was not written by suffuse-solver");
        }
      } catch (const FileError& error) {
        damage.emplace_back(error.what());
        return index;
      }
    }
  }
}

}  // namespace

std::string digest_of(const RestartPoint& point) {
  Digest digest;
  digest.add(point.time);
  digest.add(point.rows);
  digest.add(point.snapshots);
  digest.add(point.no_skip);
  digest.add(point.case_digest);
  digest.add(point.state);
  return digest.text();
}

template <int Dim>
std::string digest_of(const Case<Dim>& c) {
  Digest digest;
  for (const auto& [key, value] : lasting_values(c.document)) {
    digest.add(key);
    digest.add(value);
  }
  for (const auto& [name, text] : c.document.files) {
    digest.add(name);
    digest.add(text);
  }
  add_model(digest, c);
  return digest.text();
}

template <int Dim>
std::string digest_of_model(const Case<Dim>& c) {
  Digest digest;
  add_model(digest, c);
  return digest.text();
}

void write_restart_point(Hdf5File& file, const RestartPoint& point) {
  const std::string group = layout::restart_group;
  file.create_group(group);
  const auto integer = [&](const std::string& name, std::int64_t value) {
    file.attribute(group, name, std::span(&value, 1));
  };
  integer("layout", state_layout);
  file.attribute(group, "time", point.time);
  integer("rows", point.rows);
  integer("snapshots", point.snapshots);
  integer("no_skip", point.no_skip ? 1 : 0);
  file.attribute(group, "case", point.case_digest);
  file.attribute(group, "digest", digest_of(point));
  file.write(layout::restart_state, std::span(point.state), {point.state.size()});
}

std::optional<RestartPoint> read_restart_point(const std::string& path) {
  const Hdf5File file(path, Hdf5File::Mode::read);
  const std::string group = layout::restart_group;
  if (!file.exists(group) || !file.exists(layout::restart_state)) return std::nullopt;
  if (const auto found = file.integer_attribute(group, "layout"); found != state_layout) {
    throw FileError(path + ": keeps a state of layout " + std::to_string(found) +
                    "; this version of suffuse-solver goes on from layout " +
                    std::to_string(state_layout));
  }
  RestartPoint point;
  point.time = file.double_attribute(group, "time");
  point.rows = static_cast<long>(file.integer_attribute(group, "rows"));
  point.snapshots = static_cast<long>(file.integer_attribute(group, "snapshots"));
  point.no_skip = file.integer_attribute(group, "no_skip") != 0;
  point.case_digest = file.text_attribute(group, "case");
  point.state = file.read_bytes(layout::restart_state);
  if (digest_of(point) != file.text_attribute(group, "digest")) {
    throw FileError(path + ": " + group + ": is not what was written there; the file is damaged");
  }
  return point;
}

FoundRestart newest_restart_point(const std::string& folder, bool has_liquid_files,
                                  const std::vector<TableFile>& tables) {
  FoundRestart found;
  const long whole = whole_snapshots(folder, has_liquid_files, found.damage);
  const long rows = output_times_in(folder, tables);
  // A single snapshot without a state: the run was killed while it wrote its first files.
  found.holds_results = whole > 1 || rows > 1 || !found.damage.empty();
  const auto usable_point = [&](const std::string& path) -> std::optional<RestartPoint> {
    if (!fs::exists(path)) return std::nullopt;
    try {
      std::optional<RestartPoint> point = read_restart_point(path);
      if (!point || (point->snapshots <= whole && point->rows <= rows)) return point;
      found.damage.push_back(path + ": what was written before it is not all there");
    } catch (const FileError& error) {
      found.damage.emplace_back(error.what());
    }
    return std::nullopt;
  };
  found.path = layout::in_folder(folder, layout::checkpoint);
  found.point = usable_point(found.path);
  for (long index = whole; index-- > 0;) {
    const std::string path = layout::in_folder(folder, layout::state(index));
    std::optional<RestartPoint> point = usable_point(path);
    if (!point) continue;
    if (!found.point || point->time > found.point->time) {
      found.point = std::move(point);
      found.path = path;
    }
    break;  // the others are older
  }
  return found;
}

bool is_finished(const std::string& folder) {
  std::ifstream in = open_regular_file(layout::in_folder(folder, layout::run_info));
  const nlohmann::json info = nlohmann::json::parse(in, nullptr, false);
  return info.is_object() && info.value("status", nlohmann::json()) == "done";
}

template std::string digest_of(const Case<2>&);
template std::string digest_of(const Case<3>&);
template std::string digest_of_model(const Case<2>&);
template std::string digest_of_model(const Case<3>&);

}  // namespace suffuse
