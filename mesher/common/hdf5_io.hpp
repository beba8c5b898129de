#pragma once

/// Reads and writes HDF5 files: the functions for case and results files. Every failure is a
/// FileError with the names of file and object.

#include <hdf5.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace suffuse {

/// One open HDF5 file. Movable, closes itself.
class Hdf5File {
 public:
  enum class Mode { read, create };
  Hdf5File(const std::string& path, Mode mode);
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;
  Hdf5File(Hdf5File&& other) noexcept;
  Hdf5File& operator=(Hdf5File&& other) noexcept;
  ~Hdf5File();

  /// Flushes and closes; throws when the file could not be written completely (the destructor
  /// cannot throw).
  void close();

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] bool exists(const std::string& object) const;
  [[nodiscard]] std::vector<std::string> children(const std::string& group) const;

  /// Creates a group and its parents.
  void create_group(const std::string& group);

  /// Writes an array of `shape` (row major; the product of `shape` is the size of `values`).
  void write(const std::string& dataset, std::span<const double> values,
             const std::vector<std::size_t>& shape);
  void write(const std::string& dataset, std::span<const std::int64_t> values,
             const std::vector<std::size_t>& shape);
  void write(const std::string& dataset, std::span<const std::int32_t> values,
             const std::vector<std::size_t>& shape);
  void write(const std::string& dataset, std::span<const std::uint8_t> values,
             const std::vector<std::size_t>& shape);
  /// Writes an array as `write` does, but compressed without loss, a table column by column. For
  /// fields, which are large.
  void write_compressed(const std::string& dataset, std::span<const double> values,
                        const std::vector<std::size_t>& shape);
  void write_compressed(const std::string& dataset, std::span<const float> values,
                        const std::vector<std::size_t>& shape);
  void write_compressed(const std::string& dataset, std::span<const std::int64_t> values,
                        const std::vector<std::size_t>& shape);
  void write_compressed(const std::string& dataset, std::span<const std::uint8_t> values,
                        const std::vector<std::size_t>& shape);
  /// Writes an external link: `object` stands for the object with its name in `file`, which lies in
  /// the folder of this file. Links are for other programs; no function here follows them (see
  /// `is_in`).
  void link_to(const std::string& object, const std::string& file);
  /// Whether `object` is such a link to `file`.
  [[nodiscard]] bool is_in(const std::string& object, const std::string& file) const;
  /// Writes text, and lists of texts: UTF-8 of fixed length, padded with NUL. Text of variable
  /// length is neither written nor read, because HDF5 crashes on it in a damaged file.
  void write_text(const std::string& dataset, const std::string& value);
  void write_texts(const std::string& dataset, const std::vector<std::string>& values);

  /// Attributes of a group or dataset.
  void attribute(const std::string& object, const std::string& name, const std::string& value);
  void attribute(const std::string& object, const std::string& name, double value);
  void attribute(const std::string& object, const std::string& name,
                 std::span<const std::int64_t> values);

  [[nodiscard]] std::vector<std::size_t> shape(const std::string& dataset) const;
  [[nodiscard]] std::vector<double> read_doubles(const std::string& dataset) const;
  [[nodiscard]] std::vector<std::int64_t> read_integers(const std::string& dataset) const;
  [[nodiscard]] std::vector<std::uint8_t> read_bytes(const std::string& dataset) const;
  [[nodiscard]] std::string read_text(const std::string& dataset) const;
  [[nodiscard]] std::vector<std::string> read_texts(const std::string& dataset) const;
  [[nodiscard]] bool has_attribute(const std::string& object, const std::string& name) const;
  [[nodiscard]] std::string text_attribute(const std::string& object,
                                           const std::string& name) const;
  [[nodiscard]] double double_attribute(const std::string& object, const std::string& name) const;
  [[nodiscard]] std::int64_t integer_attribute(const std::string& object,
                                               const std::string& name) const;

 private:
  std::string path_;
  hid_t file_ = -1;
};

}  // namespace suffuse
