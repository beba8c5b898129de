#pragma once

/// Writes the state of a run to bytes and reads it, so that a later process can continue. Each
/// class with a state lists its members once, for both directions:
///
///     void archive(StateArchive& archive) { archive(pressure_, velocity_, last_dt_); }
///
/// Small structures of numbers without padding may declare `has_no_gaps` instead.
///
/// A vector that has an entry for each element, face, node or solid point of the model is tagged,
///
///     archive(on_elements(pressure_), on_nodes(velocity_), last_dt_);
///
/// as a rank has a part of it only. The bytes are the same on any number of ranks. What has no tag
/// has to be the same on all ranks, which is checked.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/errors.hpp"
#include "results/pass_timer.hpp"

namespace suffuse {

/// What the entries of a vector belong to.
enum class RowKind : std::uint8_t { elements, faces, nodes, points };

/// A vector with an entry for each row of the model, of which this rank holds a part.
template <class Values>
struct TaggedRows {
  RowKind kind;
  Values& values;  ///< may be empty on all ranks
};

template <class Values>
TaggedRows<Values> on_elements(Values& values) {
  return {RowKind::elements, values};
}
template <class Values>
TaggedRows<Values> on_faces(Values& values) {
  return {RowKind::faces, values};
}
template <class Values>
TaggedRows<Values> on_nodes(Values& values) {
  return {RowKind::nodes, values};
}
template <class Values>
TaggedRows<Values> on_points(Values& values) {
  return {RowKind::points, values};
}

/// A vector of which each rank holds a part, of any length: the whole is that of rank 0, then that
/// of rank 1, and so on. All ranks get the whole when it is restored.
template <class Values>
struct TaggedParts {
  Values& values;
};
template <class Values>
TaggedParts<Values> in_parts(Values& values) {
  return {values};
}

/// How ranks share the state of a run. All ranks have to make the same calls.
class SharedState {
 public:
  /// The rows that a rank holds.
  struct Rows {
    /// A row that a rank holds: its number in the whole model, and its place here.
    struct Held {
      long number;
      int place;
    };
    std::vector<Held> held;  ///< ascending in number
    long whole = 0;          ///< rows of the whole model
    // Range of the places of those that it owns.
    std::size_t first = 0;
    std::size_t last = 0;
  };

  SharedState() = default;
  virtual ~SharedState() = default;
  SharedState(const SharedState&) = delete;
  SharedState& operator=(const SharedState&) = delete;

  [[nodiscard]] virtual const Rows& rows(RowKind kind) const = 0;
  /// The bytes of all ranks, in their order, on rank 0; none on the others.
  [[nodiscard]] virtual std::vector<std::uint8_t> gather(std::vector<std::uint8_t> own) const = 0;
  /// Whether this is rank 0, which keeps the state.
  [[nodiscard]] virtual bool keeps() const = 0;
  /// Whether all ranks give this number.
  [[nodiscard]] virtual bool all_equal(std::uint64_t number) const = 0;
};

class StateArchive {
 public:
  /// Creates an archive that collects the members it is given. `shared` outlives it; null: this
  /// program is alone.
  explicit StateArchive(const SharedState* shared = nullptr) : shared_(shared) {}
  /// Creates an archive that restores what another one collected, in the same order. All ranks give
  /// it all bytes.
  explicit StateArchive(std::vector<std::uint8_t> bytes, const SharedState* shared = nullptr)
      : shared_(shared), bytes_(std::move(bytes)), restores_(true) {}

  /// Reserves memory for the bytes to be collected.
  void reserve(std::size_t bytes) { bytes_.reserve(bytes); }

  /// Whether it restores members; otherwise it collects them.
  [[nodiscard]] bool restores() const { return restores_; }

  /// Collects or restores members. Throws FileError if the bytes do not fit the members.
  template <class... Members>
  void operator()(Members&&... members) {
    (pass(members), ...);
  }

  /// Call this at the end. Returns the collected bytes, on several ranks those of all on rank 0 and
  /// none on the others. Throws FileError if bytes are left after a restoration.
  std::vector<std::uint8_t> finish() {
    if (restores_ && read_ != bytes_.size()) misfit();
    if (restores_ || shared_ == nullptr) return std::move(bytes_);
    if (!shared_->all_equal(untagged_)) {
      throw std::logic_error("ranks differ in a part of the state that all have to share");
    }
    return shared_->keeps() ? std::move(bytes_) : std::vector<std::uint8_t>();
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
      if (shared_ == nullptr || in_rows_) return;
      // FNV-1a (Fowler, Noll, Vo).
      for (std::size_t i = 0; i < size; ++i) {
        untagged_ = (untagged_ ^ begin[i]) * 1099511628211ULL;
      }
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

  template <class Values>
  void pass(TaggedRows<Values>& rows) {
    if (shared_ == nullptr) {
      pass(rows.values);
    } else if (restores_) {
      take_rows(rows.values, shared_->rows(rows.kind));
    } else {
      collect_rows(rows.values, shared_->rows(rows.kind));
    }
  }

  template <class Value>
  void pass(TaggedParts<std::vector<Value>>& parts) {
    if (shared_ == nullptr || restores_) {
      pass(parts.values);
      return;
    }
    static_assert(is_contiguous<Value>());
    const auto* begin = reinterpret_cast<const std::uint8_t*>(parts.values.data());
    const std::vector<std::uint8_t> all =
        shared_->gather({begin, begin + parts.values.size() * sizeof(Value)});
    in_rows_ = true;
    pass_size(all.size() / sizeof(Value));
    in_rows_ = false;
    bytes_.insert(bytes_.end(), all.begin(), all.end());
  }

  /// Collects the rows of all ranks on rank 0.
  template <class Value>
  void collect_rows(std::vector<Value>& values, const SharedState::Rows& rows) {
    const std::size_t begin = bytes_.size();
    in_rows_ = true;
    if (!values.empty()) pass_all(values.data() + rows.first, rows.last - rows.first);
    const auto at = bytes_.begin() + static_cast<std::ptrdiff_t>(begin);
    const std::vector<std::uint8_t> all = shared_->gather({at, bytes_.end()});
    bytes_.resize(begin);
    pass_size(all.empty() ? 0 : static_cast<std::size_t>(rows.whole));
    bytes_.insert(bytes_.end(), all.begin(), all.end());
    in_rows_ = false;
  }

  /// Restores the rows that this rank holds, of those of the whole model.
  template <class Value>
  void take_rows(std::vector<Value>& values, const SharedState::Rows& rows) {
    const std::size_t count = pass_size(0);
    if (count != 0 && count != static_cast<std::size_t>(rows.whole)) misfit();
    // A value may have members that are not stored: those that are here stay.
    values.resize(count == 0 ? 0 : rows.held.size());
    Value of_others{};
    auto next = rows.held.begin();
    for (long row = 0; row < static_cast<long>(count); ++row) {
      const bool is_here = next != rows.held.end() && next->number == row;
      pass(is_here ? values[static_cast<std::size_t>((next++)->place)] : of_others);
    }
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

  const SharedState* shared_;
  std::uint64_t untagged_ = 14695981039346656037ULL;  ///< digest of what has no tag
  bool in_rows_ = false;                              ///< while tagged rows are collected
  std::vector<std::uint8_t> bytes_;
  std::size_t read_ = 0;
  bool restores_ = false;
};

}  // namespace suffuse
