#pragma once

/// Writes the state of a run to bytes and reads it, so that a later process can continue. Each
/// class with a state lists its members once, for both directions:
///
///     void archive(StateArchive& archive) { archive(pressure_, velocity_, last_dt_); }
///
/// Small structures of numbers without padding may declare `has_no_gaps` instead.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/errors.hpp"
#include "results/pass_timer.hpp"

namespace suffuse {

class StateArchive {
 public:
  /// Creates an archive that collects the members it is given.
  StateArchive() = default;
  /// Creates an archive that restores what another one collected, in the same order.
  explicit StateArchive(std::vector<std::uint8_t> bytes)
      : bytes_(std::move(bytes)), restores_(true) {}

  /// Reserves memory for the bytes to be collected.
  void reserve(std::size_t bytes) { bytes_.reserve(bytes); }

  /// Whether it restores members; otherwise it collects them.
  [[nodiscard]] bool restores() const { return restores_; }

  /// Collects or restores members. Throws FileError if the bytes do not fit the members.
  template <class... Members>
  void operator()(Members&... members) {
    (pass(members), ...);
  }

  /// Call this at the end. Returns the collected bytes. Throws FileError if bytes are left after a
  /// restoration.
  std::vector<std::uint8_t> finish() {
    if (restores_ && read_ != bytes_.size()) misfit();
    return std::move(bytes_);
  }

  /// Throws the FileError for bytes that do not fit the members.
  [[noreturn]] static void misfit() {
    throw FileError("the state of the run does not fit this program and case");
  }

 private:
  template <class Value>
  static constexpr bool is_plain = std::is_arithmetic_v<Value> || std::is_enum_v<Value>;

  void raw(void* data, std::size_t size) {
    if (size == 0) return;
    if (restores_) {
      if (size > bytes_.size() - read_) misfit();
      std::memcpy(data, bytes_.data() + read_, size);
      read_ += size;
    } else {
      const auto* begin = static_cast<const std::uint8_t*>(data);
      bytes_.insert(bytes_.end(), begin, begin + size);
    }
  }

  /// Collects or restores a number of entries, each of at least one byte.
  std::size_t pass_size(std::size_t size) {
    std::uint64_t count = size;
    raw(&count, sizeof count);
    if (restores_ && count > bytes_.size() - read_) misfit();
    return count;
  }

  template <class Value>
  void pass(Value& value) {
    if constexpr (requires { value.archive(*this); }) {
      value.archive(*this);
    } else {
      static_assert(is_contiguous<Value>(), "has to say what its state is");
      raw(&value, sizeof value);
    }
  }

  template <class Value, std::size_t size>
  void pass(std::array<Value, size>& values) {
    pass_all(values.data(), size);
  }

  template <class Scalar, int rows, int columns>
  void pass(Eigen::Matrix<Scalar, rows, columns>& matrix) {
    if constexpr (rows == Eigen::Dynamic) matrix.resize(pass_size(matrix.size()));
    raw(matrix.data(), static_cast<std::size_t>(matrix.size()) * sizeof(Scalar));
  }

  template <class Value>
  void pass(std::vector<Value>& values) {
    values.resize(pass_size(values.size()));
    pass_all(values.data(), values.size());
  }

  void pass(std::vector<bool>& values) {
    values.resize(pass_size(values.size()));
    for (auto&& bit : values) {
      bool value = bit;
      pass(value);
      bit = value;
    }
  }

  void pass(std::string& text) {
    text.resize(pass_size(text.size()));
    raw(text.data(), text.size());
  }

  template <class Value>
  void pass(std::optional<Value>& value) {
    bool has_value = value.has_value();
    pass(has_value);
    if (!has_value) {
      value.reset();
      return;
    }
    if (!value) value.emplace();
    pass(*value);
  }

  /// The seconds are left out, because they differ from run to run.
  void pass(PassTiming& timing) { pass(timing.calls); }

  template <class Value>
  void pass_all(Value* values, std::size_t count) {
    if constexpr (is_contiguous<Value>()) {
      if (restores_ && count > (bytes_.size() - read_) / sizeof(Value)) misfit();
      raw(values, count * sizeof(Value));
    } else {
      for (std::size_t i = 0; i < count; ++i) pass(values[i]);
    }
  }

  /// Whether an array of these values has no padding between or inside them.
  template <class Value>
  static constexpr bool is_contiguous() {
    if constexpr (is_plain<Value>) {
      return true;
    } else if constexpr (requires { Value::has_no_gaps; }) {
      static_assert(std::is_trivially_copyable_v<Value>);
      return Value::has_no_gaps;
    } else if constexpr (requires {
                           typename Value::value_type;
                           std::tuple_size<Value>::value;
                         }) {
      return is_contiguous<typename Value::value_type>() &&
             sizeof(Value) == std::tuple_size_v<Value> * sizeof(typename Value::value_type);
    } else if constexpr (requires {
                           Value::SizeAtCompileTime;
                           typename Value::Scalar;
                         }) {
      return Value::SizeAtCompileTime > 0 &&
             sizeof(Value) == Value::SizeAtCompileTime * sizeof(typename Value::Scalar);
    } else {
      return false;
    }
  }

  std::vector<std::uint8_t> bytes_;
  std::size_t read_ = 0;
  bool restores_ = false;
};

}  // namespace suffuse
