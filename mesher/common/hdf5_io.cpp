#include "common/hdf5_io.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <numeric>
#include <string_view>
#include <utility>

#include "common/chunk_writer.hpp"
#include "common/errors.hpp"

namespace suffuse {

namespace {

/// Closes one HDF5 identifier.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle(hid_t id, Close close) : id_(id), close_(close) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  [[nodiscard]] hid_t id() const { return id_; }
  [[nodiscard]] bool valid() const { return id_ >= 0; }

 private:
  hid_t id_;
  Close close_;
};

/// Stops HDF5 from printing its error stack, because every failure becomes a FileError, and from
/// cleaning up at the end of the program, where it crashes if a full disk prevented closing a file.
void tame_hdf5() {
  H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

/// The innermost sentence of HDF5's error stack, or empty; clears the stack.
std::string hdf5_reason() {
  std::string reason;
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned depth, const H5E_error2_t* error, void* out) -> herr_t {
        if (depth == 0 && error->desc != nullptr) *static_cast<std::string*>(out) = error->desc;
        return 0;
      },
      &reason);
  H5Eclear2(H5E_DEFAULT);
  return reason.empty() ? "" : " (HDF5: " + reason + ")";
}

[[noreturn]] void fail(const std::string& path, const std::string& object,
                       const std::string& what) {
  throw FileError(path + ": " + (object.empty() ? "" : object + ": ") + what);
}

[[noreturn]] void fail_writing(const std::string& path, const std::string& object) {
  fail(path, object, "could not be written" + hdf5_reason() + "; is the disk full?");
}

[[noreturn]] void fail_reading(const std::string& path, const std::string& object) {
  fail(path, object, "could not be read" + hdf5_reason() + "; the file is damaged, write it anew");
}

std::string extents_text(const std::vector<std::size_t>& shape) {
  std::string text;
  for (std::size_t extent : shape) text += (text.empty() ? "" : ", ") + std::to_string(extent);
  return "[" + text + "]";
}

std::size_t product(const std::vector<std::size_t>& shape) {
  return std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>());
}

Handle scalar_space() {
  return {H5Screate(H5S_SCALAR), H5Sclose};
}

Handle array_space(const std::vector<std::size_t>& shape) {
  const std::vector<hsize_t> extents(shape.begin(), shape.end());
  return {H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr), H5Sclose};
}

/// Type of texts of one fixed length, at least one byte. ASCII if possible, because VTK's reader
/// needs it for its attributes.
Handle text_type(std::span<const std::string> values) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  std::size_t longest = 1;
  bool ascii = true;
  for (const std::string& value : values) {
    longest = std::max(longest, value.size());
    ascii = ascii && std::ranges::all_of(value, [](char c) { return (c & 0x80) == 0; });
  }
  H5Tset_size(type.id(), longest);
  H5Tset_strpad(type.id(), H5T_STR_NULLPAD);
  H5Tset_cset(type.id(), ascii ? H5T_CSET_ASCII : H5T_CSET_UTF8);
  return type;
}

/// The concatenated texts, each padded to the size of `type`.
std::string padded(std::span<const std::string> values, const Handle& type) {
  std::string buffer;
  for (std::string value : values) {
    value.resize(H5Tget_size(type.id()), '\0');
    buffer += value;
  }
  return buffer;
}

/// Settings to create objects of one class: without times, so that equal contents give equal bytes.
Handle creation_settings(hid_t property_class) {
  Handle creation(H5Pcreate(property_class), H5Pclose);
  H5Pset_obj_track_times(creation.id(), false);
  return creation;
}

/// Settings to create groups: links and attributes are stored in the header of the group. Otherwise
/// HDF5 would make a heap and a tree for nine or more of them, which may be larger than a field.
Handle group_settings() {
  constexpr unsigned most = 64;
  Handle creation = creation_settings(H5P_GROUP_CREATE);
  H5Pset_link_phase_change(creation.id(), most, most - 1);
  H5Pset_attr_phase_change(creation.id(), most, most - 1);
  return creation;
}

/// Creates those of the groups `/a`, `/a/b`, ... above `object` that do not exist.
void create_groups_above(hid_t file, const std::string& path, const std::string& object) {
  const Handle creation = group_settings();
  for (std::size_t end = object.find('/', 1); end != std::string::npos;
       end = object.find('/', end + 1)) {
    const std::string group = object.substr(0, end);
    if (H5Lexists(file, group.c_str(), H5P_DEFAULT) > 0) continue;
    const Handle handle(H5Gcreate2(file, group.c_str(), H5P_DEFAULT, creation.id(), H5P_DEFAULT),
                        H5Gclose);
    if (!handle.valid()) fail_writing(path, group);
  }
}

void write_dataset(hid_t file, const std::string& path, const std::string& dataset, hid_t file_type,
                   hid_t memory_type, const Handle& space, const void* values) {
  create_groups_above(file, path, dataset);
  const Handle creation = creation_settings(H5P_DATASET_CREATE);
  const Handle set(H5Dcreate2(file, dataset.c_str(), file_type, space.id(), H5P_DEFAULT,
                              creation.id(), H5P_DEFAULT),
                   H5Dclose);
  if (!set.valid()) fail_writing(path, dataset);
  if (H5Sget_simple_extent_npoints(space.id()) == 0) return;
  if (H5Dwrite(set.id(), memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0) {
    fail_writing(path, dataset);
  }
}

template <class Value>
void write_array(hid_t file, const std::string& path, const std::string& dataset, hid_t file_type,
                 hid_t memory_type, std::span<const Value> values,
                 const std::vector<std::size_t>& shape) {
  if (shape.empty() || product(shape) != values.size()) {
    fail(path, dataset,
         std::to_string(values.size()) + " values do not fill the shape " + extents_text(shape));
  }
  write_dataset(file, path, dataset, file_type, memory_type, array_space(shape), values.data());
}

/// Compresses a table column by column; a plain array is one column.
template <class Value>
void write_compressed_array(hid_t file, const std::string& path, const std::string& dataset,
                            hid_t type, std::span<const Value> values,
                            const std::vector<std::size_t>& shape) {
  if (values.empty() || shape.size() > 2 || product(shape) != values.size()) {
    write_array(file, path, dataset, type, type, values, shape);
    return;
  }
  create_groups_above(file, path, dataset);
  const ChunkShape chunks = chunk_shape(shape[0], shape.size() == 2 ? shape[1] : 1, sizeof(Value));
  const Handle creation = creation_settings(H5P_DATASET_CREATE);
  const std::array<hsize_t, 2> extents{chunks.chunk_rows, 1};
  H5Pset_chunk(creation.id(), static_cast<int>(shape.size()), extents.data());
  H5Pset_fill_time(creation.id(), H5D_FILL_TIME_NEVER);
  H5Pset_shuffle(creation.id());
  H5Pset_deflate(creation.id(), 1);
  const Handle space = array_space(shape);
  const Handle set(
      H5Dcreate2(file, dataset.c_str(), type, space.id(), H5P_DEFAULT, creation.id(), H5P_DEFAULT),
      H5Dclose);
  if (!set.valid() ||
      !write_chunks(set.id(), chunks, reinterpret_cast<const std::uint8_t*>(values.data()))) {
    fail_writing(path, dataset);
  }
}

void refuse_nul(const std::string& path, const std::string& object,
                std::span<const std::string> values) {
  for (const std::string& value : values) {
    if (value.find('\0') == std::string::npos) continue;
    fail(path, object, "a text with a NUL character cannot be stored; remove the character");
  }
}

void write_attribute(hid_t file, const std::string& path, const std::string& object,
                     const std::string& name, hid_t file_type, hid_t memory_type,
                     const Handle& space, const void* values) {
  const Handle attribute(H5Acreate_by_name(file, object.c_str(), name.c_str(), file_type,
                                           space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose);
  if (!attribute.valid() || H5Awrite(attribute.id(), memory_type, values) < 0) {
    fail_writing(path, object + "@" + name);
  }
}

/// Refuses a link: it can lead to any file that the user may read, or to a pipe that blocks the
/// program. Suffuse's own objects are no links.
void refuse_link(hid_t file, const std::string& path, const std::string& object) {
  H5L_info_t link{};
  if (H5Lget_info(file, object.c_str(), &link, H5P_DEFAULT) < 0) fail_reading(path, object);
  if (link.type == H5L_TYPE_HARD) return;
  fail(path, object, "is a link; expected the object itself, as Suffuse writes it");
}

Handle open_dataset(const Hdf5File& file, hid_t id, const std::string& dataset) {
  if (!file.exists(dataset)) {
    fail(file.path(), dataset, "is missing; was this file written by another program or version?");
  }
  Handle set(H5Dopen2(id, dataset.c_str(), H5P_DEFAULT), H5Dclose);
  if (!set.valid()) fail(file.path(), dataset, "is not a dataset" + hdf5_reason());
  // This check comes before any query of the extents, which HDF5 reads from other files for a
  // virtual dataset.
  const Handle creation(H5Dget_create_plist(set.id()), H5Pclose);
  if (H5Pget_layout(creation.id()) == H5D_VIRTUAL || H5Pget_external_count(creation.id()) > 0) {
    fail(file.path(), dataset, "has its values in another file; expected them in this one");
  }
  return set;
}

std::vector<std::size_t> shape_of(const std::string& path, const std::string& object,
                                  const Handle& space) {
  const int rank = H5Sget_simple_extent_ndims(space.id());
  if (!space.valid() || rank < 0) fail_reading(path, object);
  std::vector<hsize_t> extents(static_cast<std::size_t>(rank));
  H5Sget_simple_extent_dims(space.id(), extents.data(), nullptr);
  return {extents.begin(), extents.end()};
}

/// The number of values, after a check that the file can hold them: a damaged extent must not cause
/// an allocation of terabytes.
std::size_t checked_count(const std::string& path, const std::string& dataset, const Handle& set,
                          const Handle& type) {
  const Handle space(H5Dget_space(set.id()), H5Sclose);
  if (H5Sget_simple_extent_type(space.id()) == H5S_NULL) return 0;
  const std::vector<std::size_t> shape = shape_of(path, dataset, space);
  const Handle creation(H5Dget_create_plist(set.id()), H5Pclose);
  constexpr long double highest_compression = 1100.0L;  // largest ratio of deflate
  const long double gain = H5Pget_nfilters(creation.id()) > 0 ? highest_compression : 1.0L;
  auto bytes = static_cast<long double>(H5Tget_size(type.id()));
  for (std::size_t extent : shape) bytes *= static_cast<long double>(extent);
  const auto stored = static_cast<long double>(H5Dget_storage_size(set.id()));
  std::error_code ignored;
  const auto file_size = static_cast<long double>(std::filesystem::file_size(path, ignored));
  if (bytes > gain * stored || stored > file_size) {
    fail(path, dataset,
         "its shape " + extents_text(shape) + " is larger than what the file holds; it is damaged");
  }
  return product(shape);
}

void expect_class(const std::string& path, const std::string& object, const Handle& type,
                  H5T_class_t wanted, const std::string& wanted_name) {
  const H5T_class_t found = H5Tget_class(type.id());
  if (found == wanted) return;
  const std::string found_name = found == H5T_INTEGER  ? "integers"
                                 : found == H5T_FLOAT  ? "floating-point numbers"
                                 : found == H5T_STRING ? "text"
                                                       : "values of another type";
  fail(path, object, "holds " + found_name + "; expected " + wanted_name);
}

/// Refuses types that HDF5 would convert with a loss of values.
void expect_convertible(const std::string& path, const std::string& object, const Handle& type) {
  const std::size_t size = H5Tget_size(type.id());
  const bool is_unsigned =
      H5Tget_class(type.id()) == H5T_INTEGER && H5Tget_sign(type.id()) == H5T_SGN_NONE;
  if (size > 8 || (is_unsigned && size == 8)) {
    fail(path, object, "its number type is too wide; expected at most 64 bits, signed");
  }
}

template <class Value>
std::vector<Value> read_array(const Hdf5File& file, hid_t id, const std::string& dataset,
                              H5T_class_t wanted, const std::string& wanted_name,
                              hid_t memory_type) {
  const Handle set = open_dataset(file, id, dataset);
  const Handle type(H5Dget_type(set.id()), H5Tclose);
  expect_class(file.path(), dataset, type, wanted, wanted_name);
  expect_convertible(file.path(), dataset, type);
  std::vector<Value> values(checked_count(file.path(), dataset, set, type));
  if (values.empty()) return values;
  if (H5Dread(set.id(), memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) {
    fail_reading(file.path(), dataset);
  }
  return values;
}

std::vector<std::string> fixed_texts(const std::string& buffer, std::size_t count) {
  std::vector<std::string> texts(count);
  const std::size_t length = count == 0 ? 0 : buffer.size() / count;
  for (std::size_t i = 0; i < count; ++i) {
    const char* start = buffer.data() + i * length;
    texts[i].assign(start, strnlen(start, length));
  }
  return texts;
}

void expect_text(const std::string& path, const std::string& object, const Handle& type) {
  expect_class(path, object, type, H5T_STRING, "text");
  if (H5Tis_variable_str(type.id()) != 0) {
    fail(path, object,
         "holds text of variable length; expected the fixed length that Suffuse writes");
  }
}

std::vector<std::string> read_text_list(const Hdf5File& file, hid_t id,
                                        const std::string& dataset) {
  const Handle set = open_dataset(file, id, dataset);
  const Handle type(H5Dget_type(set.id()), H5Tclose);
  expect_text(file.path(), dataset, type);
  const std::size_t count = checked_count(file.path(), dataset, set, type);
  if (count == 0) return {};
  std::string buffer(count * H5Tget_size(type.id()), '\0');
  if (H5Dread(set.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, buffer.data()) < 0) {
    fail_reading(file.path(), dataset);
  }
  return fixed_texts(buffer, count);
}

Handle open_attribute(const Hdf5File& file, hid_t id, const std::string& object,
                      const std::string& name) {
  if (!file.has_attribute(object, name)) {
    fail(file.path(), object + "@" + name,
         "is missing; was this file written by another program or version?");
  }
  Handle attribute(H5Aopen_by_name(id, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
                   H5Aclose);
  if (!attribute.valid()) fail_reading(file.path(), object + "@" + name);
  return attribute;
}

template <class Value>
Value number_attribute(const Hdf5File& file, hid_t id, const std::string& object,
                       const std::string& name, H5T_class_t wanted, const std::string& wanted_name,
                       hid_t memory_type) {
  const std::string place = object + "@" + name;
  const Handle attribute = open_attribute(file, id, object, name);
  const Handle type(H5Aget_type(attribute.id()), H5Tclose);
  expect_class(file.path(), place, type, wanted, wanted_name);
  expect_convertible(file.path(), place, type);
  const Handle space(H5Aget_space(attribute.id()), H5Sclose);
  if (H5Sget_simple_extent_npoints(space.id()) != 1) {
    fail(file.path(), place, "expected one value");
  }
  Value value{};
  if (H5Aread(attribute.id(), memory_type, &value) < 0) fail_reading(file.path(), place);
  return value;
}

/// From version 2 of the superblock on (H5F_LIBVER_V18), HDF5 stores checksums of all its metadata
/// and verifies them before it uses the metadata. Without checksums, a damaged file makes HDF5 1.10
/// itself read and write memory that it must not.
void refuse_old_layout(const std::string& path) {
  constexpr std::size_t place_of_version = 8;  // after the signature
  std::array<char, place_of_version + 1> start{};
  std::ifstream(path, std::ios::binary).read(start.data(), start.size());
  constexpr std::string_view signature = "\x89HDF\r\n\x1a\n";
  const bool at_start = std::string_view(start.data(), place_of_version) == signature;
  if (at_start && start[place_of_version] >= 2) return;
  fail(
      path, "",
      "is in the first of HDF5's file layouts, which has no checksums; write it anew with Suffuse, "
      "or convert it: h5repack --low=1 OLD NEW");
}

hid_t open_existing(const std::string& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) fail(path, "", "there is no such file");
  if (!std::filesystem::is_regular_file(status)) fail(path, "", "is not a file");
  if (std::FILE* probe = std::fopen(path.c_str(), "rb"); probe != nullptr) {
    static_cast<void>(std::fclose(probe));
  } else {
    fail(path, "", std::string("cannot be opened: ") + std::strerror(errno));
  }
  if (H5Fis_hdf5(path.c_str()) <= 0) {
    H5Eclear2(H5E_DEFAULT);
    fail(path, "", "is not an HDF5 file; expected one that Suffuse wrote");
  }
  refuse_old_layout(path);
  const hid_t id = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (id < 0) {
    fail(path, "",
         "cannot be opened" + hdf5_reason() +
             "; it is cut short, damaged or open for writing elsewhere: write it anew");
  }
  return id;
}

hid_t create_new(const std::string& path) {
  const Handle creation = creation_settings(H5P_FILE_CREATE);
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  // This format has checksums (see refuse_old_layout), also for the index of the chunks; HDF5 1.10
  // and later can read it.
  H5Pset_libver_bounds(access.id(), H5F_LIBVER_V110, H5F_LIBVER_V110);
  const hid_t id = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation.id(), access.id());
  if (id < 0) {
    const std::string reason =
        errno == 0 ? hdf5_reason() : std::string(": ") + std::strerror(errno);
    H5Eclear2(H5E_DEFAULT);
    fail(path, "",
         "cannot be created" + reason + "; check that its folder exists and can be written to");
  }
  return id;
}

}  // namespace

Hdf5File::Hdf5File(const std::string& path, Mode mode) : path_(path) {
  tame_hdf5();
  errno = 0;
  file_ = mode == Mode::read ? open_existing(path) : create_new(path);
}

Hdf5File::Hdf5File(Hdf5File&& other) noexcept
    : path_(std::move(other.path_)), file_(std::exchange(other.file_, -1)) {}

Hdf5File& Hdf5File::operator=(Hdf5File&& other) noexcept {
  if (this != &other) {
    if (file_ >= 0) H5Fclose(file_);
    path_ = std::move(other.path_);
    file_ = std::exchange(other.file_, -1);
  }
  return *this;
}

Hdf5File::~Hdf5File() {
  if (file_ >= 0) H5Fclose(file_);
}

void Hdf5File::close() {
  if (file_ < 0) return;
  const bool flushed = H5Fflush(file_, H5F_SCOPE_LOCAL) >= 0;
  const std::string reason = flushed ? "" : hdf5_reason();
  const bool closed = H5Fclose(std::exchange(file_, -1)) >= 0;
  if (!flushed || !closed) {
    fail(path_, "",
         "could not be written whole" + (flushed ? hdf5_reason() : reason) + "; is the disk full?");
  }
}

bool Hdf5File::exists(const std::string& object) const {
  if (object == "/") return true;
  // H5Lexists requires that every parent exists.
  for (std::size_t end = object.find('/', 1);; end = object.find('/', end + 1)) {
    const std::string parent = object.substr(0, end);
    if (H5Lexists(file_, parent.c_str(), H5P_DEFAULT) <= 0) {
      H5Eclear2(H5E_DEFAULT);
      return false;
    }
    refuse_link(file_, path_, parent);
    if (end == std::string::npos) break;
  }
  const bool resolves = H5Oexists_by_name(file_, object.c_str(), H5P_DEFAULT) > 0;
  H5Eclear2(H5E_DEFAULT);
  return resolves;
}

std::vector<std::string> Hdf5File::children(const std::string& group) const {
  const Handle handle(exists(group) ? H5Gopen2(file_, group.c_str(), H5P_DEFAULT) : -1, H5Gclose);
  if (!handle.valid()) {
    H5Eclear2(H5E_DEFAULT);
    fail(path_, group, "is missing or not a group");
  }
  std::vector<std::string> names;
  const herr_t status = H5Literate(
      handle.id(), H5_INDEX_NAME, H5_ITER_INC, nullptr,
      [](hid_t, const char* name, const H5L_info_t*, void* out) -> herr_t {
        static_cast<std::vector<std::string>*>(out)->emplace_back(name);
        return 0;
      },
      &names);
  if (status < 0) fail_reading(path_, group);
  return names;
}

void Hdf5File::create_group(const std::string& group) {
  create_groups_above(file_, path_, group);
  const Handle creation = group_settings();
  const Handle handle(H5Gcreate2(file_, group.c_str(), H5P_DEFAULT, creation.id(), H5P_DEFAULT),
                      H5Gclose);
  if (!handle.valid()) fail_writing(path_, group);
}

void Hdf5File::write(const std::string& dataset, std::span<const double> values,
                     const std::vector<std::size_t>& shape) {
  write_array(file_, path_, dataset, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, values, shape);
}

void Hdf5File::write(const std::string& dataset, std::span<const std::int64_t> values,
                     const std::vector<std::size_t>& shape) {
  write_array(file_, path_, dataset, H5T_STD_I64LE, H5T_NATIVE_INT64, values, shape);
}

void Hdf5File::write(const std::string& dataset, std::span<const std::int32_t> values,
                     const std::vector<std::size_t>& shape) {
  write_array(file_, path_, dataset, H5T_STD_I32LE, H5T_NATIVE_INT32, values, shape);
}

void Hdf5File::write(const std::string& dataset, std::span<const std::uint8_t> values,
                     const std::vector<std::size_t>& shape) {
  write_array(file_, path_, dataset, H5T_STD_U8LE, H5T_NATIVE_UINT8, values, shape);
}

void Hdf5File::write_compressed(const std::string& dataset, std::span<const double> values,
                                const std::vector<std::size_t>& shape) {
  write_compressed_array(file_, path_, dataset, H5T_IEEE_F64LE, values, shape);
}

void Hdf5File::write_compressed(const std::string& dataset, std::span<const float> values,
                                const std::vector<std::size_t>& shape) {
  write_compressed_array(file_, path_, dataset, H5T_IEEE_F32LE, values, shape);
}

void Hdf5File::write_compressed(const std::string& dataset, std::span<const std::int64_t> values,
                                const std::vector<std::size_t>& shape) {
  write_compressed_array(file_, path_, dataset, H5T_STD_I64LE, values, shape);
}

void Hdf5File::write_compressed(const std::string& dataset, std::span<const std::uint8_t> values,
                                const std::vector<std::size_t>& shape) {
  write_compressed_array(file_, path_, dataset, H5T_STD_U8LE, values, shape);
}

void Hdf5File::link_to(const std::string& object, const std::string& file) {
  create_groups_above(file_, path_, object);
  if (H5Lcreate_external(file.c_str(), object.c_str(), file_, object.c_str(), H5P_DEFAULT,
                         H5P_DEFAULT) < 0) {
    fail_writing(path_, object);
  }
}

bool Hdf5File::is_in(const std::string& object, const std::string& file) const {
  const std::string parent = object.substr(0, object.rfind('/'));
  if (!parent.empty() && !exists(parent)) return false;
  H5L_info_t link{};
  const bool found = H5Lget_info(file_, object.c_str(), &link, H5P_DEFAULT) >= 0;
  H5Eclear2(H5E_DEFAULT);
  if (!found || link.type != H5L_TYPE_EXTERNAL) return false;
  std::vector<char> target(link.u.val_size);
  const char* target_file = nullptr;
  const char* target_object = nullptr;
  if (H5Lget_val(file_, object.c_str(), target.data(), target.size(), H5P_DEFAULT) < 0 ||
      H5Lunpack_elink_val(target.data(), target.size(), nullptr, &target_file, &target_object) <
          0) {
    H5Eclear2(H5E_DEFAULT);
    return false;
  }
  return target_file == file && target_object == object;
}

void Hdf5File::write_text(const std::string& dataset, const std::string& value) {
  const std::span<const std::string> values(&value, 1);
  refuse_nul(path_, dataset, values);
  const Handle type = text_type(values);
  write_dataset(file_, path_, dataset, type.id(), type.id(), scalar_space(),
                padded(values, type).data());
}

void Hdf5File::write_texts(const std::string& dataset, const std::vector<std::string>& values) {
  refuse_nul(path_, dataset, values);
  const Handle type = text_type(values);
  write_dataset(file_, path_, dataset, type.id(), type.id(), array_space({values.size()}),
                padded(values, type).data());
}

void Hdf5File::attribute(const std::string& object, const std::string& name,
                         const std::string& value) {
  const std::span<const std::string> values(&value, 1);
  refuse_nul(path_, object + "@" + name, values);
  const Handle type = text_type(values);
  write_attribute(file_, path_, object, name, type.id(), type.id(), scalar_space(),
                  padded(values, type).data());
}

void Hdf5File::attribute(const std::string& object, const std::string& name, double value) {
  write_attribute(file_, path_, object, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, scalar_space(),
                  &value);
}

void Hdf5File::attribute(const std::string& object, const std::string& name,
                         std::span<const std::int64_t> values) {
  write_attribute(file_, path_, object, name, H5T_STD_I64LE, H5T_NATIVE_INT64,
                  array_space({values.size()}), values.data());
}

std::vector<std::size_t> Hdf5File::shape(const std::string& dataset) const {
  const Handle set = open_dataset(*this, file_, dataset);
  return shape_of(path_, dataset, {H5Dget_space(set.id()), H5Sclose});
}

std::vector<double> Hdf5File::read_doubles(const std::string& dataset) const {
  return read_array<double>(*this, file_, dataset, H5T_FLOAT, "floating-point numbers",
                            H5T_NATIVE_DOUBLE);
}

std::vector<std::int64_t> Hdf5File::read_integers(const std::string& dataset) const {
  return read_array<std::int64_t>(*this, file_, dataset, H5T_INTEGER, "integers", H5T_NATIVE_INT64);
}

std::vector<std::uint8_t> Hdf5File::read_bytes(const std::string& dataset) const {
  const Handle set = open_dataset(*this, file_, dataset);
  const Handle type(H5Dget_type(set.id()), H5Tclose);
  if (H5Tequal(type.id(), H5T_STD_U8LE) <= 0) fail(path_, dataset, "expected bytes");
  std::vector<std::uint8_t> values(checked_count(path_, dataset, set, type));
  if (!values.empty() &&
      H5Dread(set.id(), H5T_NATIVE_UINT8, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) {
    fail_reading(path_, dataset);
  }
  return values;
}

std::string Hdf5File::read_text(const std::string& dataset) const {
  std::vector<std::string> texts = read_text_list(*this, file_, dataset);
  if (texts.size() != 1) {
    fail(path_, dataset, "holds " + std::to_string(texts.size()) + " texts; expected one");
  }
  return std::move(texts.front());
}

std::vector<std::string> Hdf5File::read_texts(const std::string& dataset) const {
  return read_text_list(*this, file_, dataset);
}

bool Hdf5File::has_attribute(const std::string& object, const std::string& name) const {
  if (!exists(object)) fail(path_, object, "is missing");
  const bool found = H5Aexists_by_name(file_, object.c_str(), name.c_str(), H5P_DEFAULT) > 0;
  H5Eclear2(H5E_DEFAULT);
  return found;
}

std::string Hdf5File::text_attribute(const std::string& object, const std::string& name) const {
  const std::string place = object + "@" + name;
  const Handle attribute = open_attribute(*this, file_, object, name);
  const Handle type(H5Aget_type(attribute.id()), H5Tclose);
  expect_text(path_, place, type);
  const Handle space(H5Aget_space(attribute.id()), H5Sclose);
  if (H5Sget_simple_extent_npoints(space.id()) != 1) fail(path_, place, "expected one text");
  std::string buffer(H5Tget_size(type.id()), '\0');
  if (H5Aread(attribute.id(), type.id(), buffer.data()) < 0) fail_reading(path_, place);
  return fixed_texts(buffer, 1).front();
}

double Hdf5File::double_attribute(const std::string& object, const std::string& name) const {
  return number_attribute<double>(*this, file_, object, name, H5T_FLOAT, "a floating-point number",
                                  H5T_NATIVE_DOUBLE);
}

std::int64_t Hdf5File::integer_attribute(const std::string& object, const std::string& name) const {
  return number_attribute<std::int64_t>(*this, file_, object, name, H5T_INTEGER, "an integer",
                                        H5T_NATIVE_INT64);
}

}  // namespace suffuse
