#include "file_edits.hpp"

#include <hdf5.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "bytes.hpp"

namespace suffuse::fuzz {
namespace {

namespace fs = std::filesystem;

/// Largest number of values of a dataset that an edit makes.
constexpr hsize_t max_values = 4096;
constexpr int max_edits = 64;

/// An HDF5 identifier that closes itself.
class Id {
 public:
  using Close = herr_t (*)(hid_t);
  Id(hid_t id, Close close) : id_(id), close_(close) {}
  Id(const Id&) = delete;
  Id& operator=(const Id&) = delete;
  Id(Id&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Id& operator=(Id&&) = delete;
  ~Id() {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }  // NOLINT(google-explicit-constructor): goes to HDF5 alone
  [[nodiscard]] bool valid() const { return id_ >= 0; }

 private:
  hid_t id_;
  Close close_;
};

/// The words of a line, and what is left of it.
class Words {
 public:
  explicit Words(std::string line) : rest_(std::move(line)) {}
  std::string word() {
    const std::size_t end = std::min(rest_.find(' '), rest_.size());
    std::string taken = rest_.substr(0, end);
    rest_.erase(0, std::min(end + 1, rest_.size()));
    return taken;
  }
  std::string rest() { return std::exchange(rest_, {}); }
  std::uint64_t number() { return std::strtoull(word().c_str(), nullptr, 0); }
  /// Reads one to four extents.
  std::vector<hsize_t> extents() {
    std::vector<hsize_t> all;
    while (!rest_.empty() && all.size() < 4) all.push_back(number());
    if (all.empty()) all.push_back(1);
    return all;
  }

 private:
  std::string rest_;
};

hsize_t product(const std::vector<hsize_t>& extents) {
  hsize_t all = 1;
  for (const hsize_t extent : extents) {
    if (extent != 0 && all > max_values / extent) return max_values + 1;
    all *= extent;
  }
  return all;
}

Id simple_space(const std::vector<hsize_t>& extents) {
  return {H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr), H5Sclose};
}

Id text_type(std::size_t length) {
  Id type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, std::max<std::size_t>(length, 1));
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  return type;
}

Id named_type(const std::string& name) {
  static const std::map<std::string, hid_t> simple{
      {"i8", H5T_STD_I8LE},    {"u8", H5T_STD_U8LE},          {"i32", H5T_STD_I32LE},
      {"u32", H5T_STD_U32LE},  {"i64", H5T_STD_I64LE},        {"u64", H5T_STD_U64LE},
      {"f32", H5T_IEEE_F32LE}, {"f64", H5T_IEEE_F64LE},       {"big", H5T_IEEE_F64BE},
      {"bits", H5T_STD_B32LE}, {"reference", H5T_STD_REF_OBJ}};
  if (const auto found = simple.find(name); found != simple.end()) {
    return {H5Tcopy(found->second), H5Tclose};
  }
  if (name == "text") return text_type(5);
  if (name == "vtext") {
    Id type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type, H5T_VARIABLE);
    return type;
  }
  if (name == "compound") {
    Id type(H5Tcreate(H5T_COMPOUND, 16), H5Tclose);
    H5Tinsert(type, "a", 0, H5T_STD_I64LE);
    H5Tinsert(type, "b", 8, H5T_IEEE_F64LE);
    return type;
  }
  if (name == "array") {
    const std::array<hsize_t, 1> three{3};
    return {H5Tarray_create2(H5T_IEEE_F64LE, 1, three.data()), H5Tclose};
  }
  if (name == "opaque") return {H5Tcreate(H5T_OPAQUE, 8), H5Tclose};
  if (name == "enum") {
    Id type(H5Tenum_create(H5T_STD_I32LE), H5Tclose);
    const int one = 1;
    H5Tenum_insert(type, "one", &one);
    return type;
  }
  // For any other name, an integer whose width depends on the length of the name.
  Id type(H5Tcopy(H5T_STD_I64LE), H5Tclose);
  H5Tset_size(type, 1 + name.size() % 16);
  return type;
}

bool exists(hid_t file, const std::string& name) {
  return !name.empty() && H5Oexists_by_name(file, name.c_str(), H5P_DEFAULT) > 0;
}

/// All values of a dataset as they are stored.
std::vector<char> stored_bytes(hid_t set, hid_t type) {
  const Id space(H5Dget_space(set), H5Sclose);
  const hssize_t count = H5Sget_simple_extent_npoints(space);
  if (count <= 0 || count > static_cast<hssize_t>(max_values)) return {};
  if (H5Tdetect_class(type, H5T_VLEN) > 0 || H5Tis_variable_str(type) > 0) return {};
  const std::size_t size = H5Tget_size(type);
  if (size > max_values * 16) return {};
  std::vector<char> bytes(static_cast<std::size_t>(count) * size);
  if (H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) < 0) bytes.clear();
  return bytes;
}

void set_value(hid_t file, Words& words) {
  const std::string name = words.word();
  const std::uint64_t index = words.number();
  const std::string text = words.rest();
  if (!exists(file, name)) return;
  const Id set(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!set.valid()) return;
  const Id type(H5Dget_type(set), H5Tclose);
  std::vector<char> bytes = stored_bytes(set, type);
  const std::size_t size = H5Tget_size(type);
  if (bytes.empty()) return;
  char* const place = bytes.data() + (index % (bytes.size() / size)) * size;
  const H5T_class_t kind = H5Tget_class(type);
  if (kind == H5T_STRING) {
    std::string padded = text;
    padded.resize(size, '\0');
    std::memcpy(place, padded.data(), size);
  } else if (kind == H5T_FLOAT && size == 8) {
    const double value = std::strtod(text.c_str(), nullptr);
    std::memcpy(place, &value, 8);
  } else {
    const long long value = std::strtoll(text.c_str(), nullptr, 0);
    std::memcpy(place, &value, std::min<std::size_t>(size, 8));
  }
  H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data());
}

Id dataset_settings() {
  Id creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation, false);
  return creation;
}

/// Copies all attributes of one object to another.
void copy_attributes(hid_t from, hid_t to) {
  H5Aiterate2(
      from, H5_INDEX_NAME, H5_ITER_INC, nullptr,
      [](hid_t object, const char* name, const H5A_info_t*, void* out) -> herr_t {
        const Id old(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
        const Id type(H5Aget_type(old), H5Tclose);
        const Id space(H5Aget_space(old), H5Sclose);
        const Id made(
            H5Acreate2(*static_cast<hid_t*>(out), name, type, space, H5P_DEFAULT, H5P_DEFAULT),
            H5Aclose);
        const hssize_t count = H5Sget_simple_extent_npoints(space);
        if (!made.valid() || count <= 0 || H5Tis_variable_str(type) > 0) return 0;
        std::vector<char> bytes(static_cast<std::size_t>(count) * H5Tget_size(type));
        if (H5Aread(old, type, bytes.data()) >= 0) H5Awrite(made, type, bytes.data());
        return 0;
      },
      &to);
}

/// Removes the name of a dataset and returns the dataset; it may not exist.
Id unlinked(hid_t file, const std::string& name) {
  if (!exists(file, name)) return {-1, H5Dclose};
  Id old(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
  H5Ldelete(file, name.c_str(), H5P_DEFAULT);
  return old;
}

/// Replaces the object `name`, if any, by a new dataset that repeats `bytes`.
void make_dataset(hid_t file, const std::string& name, hid_t type, const Id& space,
                  const std::string& bytes) {
  const Id old = unlinked(file, name);
  const Id links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(links, 1);
  const Id set(H5Dcreate2(file, name.c_str(), type, space, links, dataset_settings(), H5P_DEFAULT),
               H5Dclose);
  if (set.valid() && old.valid()) copy_attributes(old, set);
  const hssize_t count = H5Sget_simple_extent_npoints(space);
  if (!set.valid() || count <= 0 || H5Tis_variable_str(type) > 0) return;
  std::vector<char> values(static_cast<std::size_t>(count) * H5Tget_size(type));
  for (std::size_t i = 0; i < values.size() && !bytes.empty(); ++i) {
    values[i] = bytes[i % bytes.size()];
  }
  H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
}

/// Replaces the dataset of this name by one of another type, or of other extents.
void remake(hid_t file, const std::string& name, const std::string& type_name,
            const std::vector<hsize_t>& extents) {
  if (!exists(file, name)) return;
  std::string bytes;
  hid_t new_type = -1;
  hid_t new_space = -1;
  {
    const Id set(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
    if (!set.valid()) return;
    const Id type(H5Dget_type(set), H5Tclose);
    const std::vector<char> stored = stored_bytes(set, type);
    bytes.assign(stored.begin(), stored.end());
    if (type_name.empty()) new_type = H5Tcopy(type);
    if (extents.empty()) new_space = H5Dget_space(set);
  }
  const Id type = type_name.empty() ? Id(new_type, H5Tclose) : named_type(type_name);
  const Id space = extents.empty() ? Id(new_space, H5Sclose) : simple_space(extents);
  if (!type.valid() || !space.valid()) return;
  if (H5Sget_simple_extent_npoints(space) > static_cast<hssize_t>(max_values)) return;
  make_dataset(file, name, type, space, bytes);
}

void claim(hid_t file, Words& words) {
  const std::string name = words.word();
  const std::string layout = words.word();
  const std::vector<hsize_t> extents = words.extents();
  if (name.empty()) return;
  const Id old = unlinked(file, name);
  const Id type(old.valid() ? H5Dget_type(old) : H5Tcopy(H5T_IEEE_F64LE), H5Tclose);
  const Id space = simple_space(extents);
  const Id creation = dataset_settings();
  const std::vector<hsize_t> chunk(extents.size(), 8);
  if (layout == "chunked" || layout == "deflate") {
    H5Pset_chunk(creation, static_cast<int>(chunk.size()), chunk.data());
    if (layout == "deflate") H5Pset_deflate(creation, 9);
  } else if (layout == "external") {
    H5Pset_external(creation, "/proc/version", 0, H5F_UNLIMITED);
  } else if (layout == "virtual") {
    H5Pset_virtual(creation, space, "/nowhere.h5", "/set", space);
  }
  const Id set(H5Dcreate2(file, name.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT),
               H5Dclose);
  if (set.valid() && old.valid()) copy_attributes(old, set);
}

void make_attribute(hid_t file, Words& words) {
  const std::string object = words.word();
  const std::string name = words.word();
  const std::string type_name = words.word();
  const std::string text = words.rest();
  if (!exists(file, object) || name.empty()) return;
  if (H5Aexists_by_name(file, object.c_str(), name.c_str(), H5P_DEFAULT) > 0) {
    H5Adelete_by_name(file, object.c_str(), name.c_str(), H5P_DEFAULT);
  }
  const bool is_text = type_name == "text";
  const Id type = is_text ? text_type(text.size()) : named_type(type_name);
  // A comma in the text makes a list of three values; no further word of the edit is needed.
  const bool is_list = text.find(',') != std::string::npos && !is_text;
  const Id space = is_list ? simple_space({3}) : Id(H5Screate(H5S_SCALAR), H5Sclose);
  const Id attribute(H5Acreate_by_name(file, object.c_str(), name.c_str(), type, space, H5P_DEFAULT,
                                       H5P_DEFAULT, H5P_DEFAULT),
                     H5Aclose);
  if (!attribute.valid() || H5Tis_variable_str(type) > 0) return;
  std::string bytes(H5Tget_size(type) * (is_list ? 3 : 1), '\0');
  if (is_text) {
    bytes.replace(0, std::min(text.size(), bytes.size()), text, 0, bytes.size());
  } else if (H5Tget_class(type) == H5T_FLOAT && H5Tget_size(type) == 8) {
    const double value = std::strtod(text.c_str(), nullptr);
    std::memcpy(bytes.data(), &value, 8);
  } else {
    const long long value = std::strtoll(text.c_str(), nullptr, 0);
    std::memcpy(bytes.data(), &value, std::min<std::size_t>(bytes.size(), 8));
  }
  H5Awrite(attribute, type, bytes.data());
}

/// Appends a text to the list of `--set` arguments.
void add_override(hid_t file, const std::string& text) {
  const std::string name = "/scene/overrides";
  std::vector<std::string> all;
  if (exists(file, name)) {
    const Id set(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
    if (!set.valid()) return;
    const Id type(H5Dget_type(set), H5Tclose);
    if (H5Tget_class(type) != H5T_STRING) return;
    const std::vector<char> bytes = stored_bytes(set, type);
    const std::size_t size = H5Tget_size(type);
    for (std::size_t at = 0; at < bytes.size(); at += size) {
      all.emplace_back(bytes.data() + at, strnlen(bytes.data() + at, size));
    }
  }
  if (all.size() >= max_edits) return;
  all.push_back(text);
  std::size_t longest = 1;
  for (const std::string& each : all) longest = std::max(longest, each.size());
  std::string padded;
  for (std::string each : all) {
    each.resize(longest, '\0');
    padded += each;
  }
  make_dataset(file, name, text_type(longest), simple_space({all.size()}), padded);
}

void edit_links(hid_t file, const std::string& edit, Words& words) {
  const std::string first = words.word();
  const std::string second = words.word();
  if (first.empty() || first == "/") return;
  const auto make_place = [&](const std::string& name) {
    if (exists(file, name)) H5Ldelete(file, name.c_str(), H5P_DEFAULT);
  };
  if (edit == "remove") {
    make_place(first);
  } else if (edit == "group") {
    make_place(first);
    const Id made(H5Gcreate2(file, first.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  } else if (edit == "type-object") {
    make_place(first);
    const Id type = named_type("i32");
    H5Tcommit2(file, first.c_str(), type, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  } else if (edit == "soft") {
    make_place(first);
    H5Lcreate_soft(second.c_str(), file, first.c_str(), H5P_DEFAULT, H5P_DEFAULT);
  } else if (edit == "outside") {
    make_place(first);
    H5Lcreate_external(second.c_str(), "/mesh", file, first.c_str(), H5P_DEFAULT, H5P_DEFAULT);
  } else if (!exists(file, first) || first == second || second.empty() || second == "/") {
    return;
  } else if (edit == "rename") {
    make_place(second);
    H5Lmove(file, first.c_str(), file, second.c_str(), H5P_DEFAULT, H5P_DEFAULT);
  } else if (edit == "copy") {
    if (second.starts_with(first + "/")) return;  // HDF5 would go on for ever
    make_place(second);
    H5Ocopy(file, first.c_str(), file, second.c_str(), H5P_DEFAULT, H5P_DEFAULT);
  } else if (edit == "hard") {
    make_place(second);
    H5Lcreate_hard(file, first.c_str(), file, second.c_str(), H5P_DEFAULT, H5P_DEFAULT);
  }
}

/// Makes `edit` if it is an edit to an HDF5 file; returns whether it is.
bool edit_hdf5(hid_t file, const std::string& edit, Words& words) {
  static const std::vector<std::string> links{"remove", "group", "type-object", "rename",
                                              "copy",   "hard",  "soft",        "outside"};
  if (edit == "value") {
    set_value(file, words);
  } else if (edit == "type") {
    const std::string name = words.word();
    remake(file, name, words.word(), {});
  } else if (edit == "shape") {
    const std::string name = words.word();
    const std::vector<hsize_t> extents = words.extents();
    if (product(extents) <= max_values) remake(file, name, "", extents);
  } else if (edit == "claim") {
    claim(file, words);
  } else if (edit == "text") {
    const std::string name = words.word();
    const std::string text = words.rest();
    if (name.size() > 1) {
      make_dataset(file, name, text_type(text.size()), Id(H5Screate(H5S_SCALAR), H5Sclose), text);
    }
  } else if (edit == "attribute") {
    make_attribute(file, words);
  } else if (edit == "no-attribute") {
    const std::string object = words.word();
    const std::string name = words.word();
    if (exists(file, object)) {
      H5Adelete_by_name(file, object.c_str(), name.c_str(), H5P_DEFAULT);
    }
  } else if (edit == "set") {
    add_override(file, words.rest());
  } else if (std::ranges::find(links, edit) != links.end()) {
    edit_links(file, edit, words);
  } else {
    return false;
  }
  return true;
}

void edit_json(const std::string& path, Words& words) {
  using Json = nlohmann::ordered_json;
  Json json = Json::parse(file_bytes(path), nullptr, false);
  const std::string pointer = words.word();
  const Json value = Json::parse(words.rest(), nullptr, false);
  if (json.is_discarded()) return;
  try {
    const Json::json_pointer place(pointer);
    if (value.is_discarded()) {
      if (!place.empty()) json.at(place.parent_pointer()).erase(place.back());
    } else {
      json[place] = value;
    }
    write_bytes(path, json.dump(1, ' ', false, Json::error_handler_t::replace));
  } catch (const Json::exception&) {
    // there is no such place
  }
}

void edit_line(const std::string& path, Words& words) {
  std::vector<std::string> lines;
  std::istringstream in(file_bytes(path));
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  const std::uint64_t index = words.number();
  if (lines.empty()) lines.emplace_back();
  lines[index % lines.size()] = words.rest();
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  write_bytes(path, text);
}

/// An edit to the bytes of a file, made after all others.
struct RawEdit {
  std::string path;
  std::string edit;
  std::uint64_t at = 0;
  std::uint64_t value = 0;
};

void apply(const RawEdit& raw) {
  constexpr std::uint64_t longest = 1U << 20U;
  if (raw.edit == "delete" || raw.edit == "folder") {
    fs::remove_all(raw.path);
    if (raw.edit == "folder") fs::create_directory(raw.path);
    return;
  }
  if (!fs::is_regular_file(raw.path)) return;
  std::string bytes = file_bytes(raw.path);
  if (bytes.empty()) return;
  if (raw.edit == "byte") bytes[raw.at % bytes.size()] = static_cast<char>(raw.value);
  if (raw.edit == "cut") bytes.resize(raw.at % bytes.size());
  if (raw.edit == "grow") bytes.resize(bytes.size() + raw.at % longest, '\0');
  write_bytes(raw.path, bytes);
}

/// The files of one folder, and the HDF5 file among them that is open.
class Editor {
 public:
  Editor(std::string folder, const std::string& file) : folder_(std::move(folder)) {
    path_ = folder_ + "/" + file;
  }
  Editor(const Editor&) = delete;
  Editor& operator=(const Editor&) = delete;
  ~Editor() { close(); }

  void edit(const std::string& line) {
    Words words(line);
    const std::string edit = words.word();
    if (edit == "in") {
      close();
      const std::string name = words.word();
      // Only files within the folder are edited.
      if (name.find("..") == std::string::npos) path_ = folder_ + "/" + name;
    } else if (edit == "byte" || edit == "cut" || edit == "grow" || edit == "delete" ||
               edit == "folder") {
      const std::uint64_t at = words.number();
      raw_.push_back({path_, edit, at, words.number()});
    } else if (edit == "json" || edit == "line") {
      if (!fs::is_regular_file(path_) || is_hdf5()) return;
      edit == "json" ? edit_json(path_, words) : edit_line(path_, words);
    } else if (open() && !is_copy_of_elsewhere(edit, line)) {
      edit_hdf5(file_, edit, words);
    }
  }

  void finish() {
    close();
    for (const RawEdit& raw : raw_) {
      if (fs::exists(raw.path) && raw.path.size() > folder_.size() + 1) apply(raw);
    }
  }

 private:
  /// HDF5 1.10.8 crashes when it ends (H5F__close_cb), after it failed to copy values that are in
  /// another file. Only editors copy: the sources never do.
  bool is_copy_of_elsewhere(const std::string& edit, const std::string& line) {
    elsewhere_ = elsewhere_ || line.find(" external") != std::string::npos ||
                 line.find(" virtual") != std::string::npos;
    return elsewhere_ && edit == "copy";
  }

  [[nodiscard]] bool is_hdf5() const { return path_.ends_with(".h5") || path_.ends_with(".hdf"); }
  bool open() {
    if (file_ >= 0) return true;
    if (!is_hdf5() || !fs::is_regular_file(path_)) return false;
    const Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_LATEST);
    file_ = H5Fopen(path_.c_str(), H5F_ACC_RDWR, access);
    return file_ >= 0;
  }
  void close() {
    if (file_ >= 0) H5Fclose(std::exchange(file_, -1));
  }

  std::string folder_;
  std::string path_;
  hid_t file_ = -1;
  bool elsewhere_ = false;
  std::vector<RawEdit> raw_;
};

}  // namespace

std::string seed_of(const std::string& script, const std::vector<std::string>& known) {
  for (const std::string& name : known) {
    if (script == "seed " + name || script.starts_with("seed " + name + "\n")) return name;
  }
  return known.front();
}

void apply_edits(const std::string& script, const std::string& folder, const std::string& file) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  Editor editor(folder, file);
  std::istringstream lines(script);
  int count = 0;
  for (std::string line; std::getline(lines, line) && count < max_edits; ++count) {
    // Names end at a NUL for HDF5, but not for us.
    if (line.find('\0') == std::string::npos) editor.edit(line);
  }
  editor.finish();
}

}  // namespace suffuse::fuzz
