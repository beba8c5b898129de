#pragma once

/// Values as bytes, to pass them between processes of the same program.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace suffuse {

class ByteWriter {
 public:
  template <class T>
  void number(T value) {
    static_assert(std::is_trivially_copyable_v<T>);
    append(&value, sizeof(T));
  }
  template <class T>
  void numbers(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    number<std::uint64_t>(values.size());
    append(values.data(), values.size() * sizeof(T));
  }
  void text(std::string_view value) {
    number<std::uint64_t>(value.size());
    append(value.data(), value.size());
  }
  [[nodiscard]] std::string take() { return std::move(bytes_); }

 private:
  void append(const void* from, std::size_t size) {
    if (size > 0) bytes_.append(static_cast<const char*>(from), size);
  }
  std::string bytes_;
};

/// Reads the bytes of a `ByteWriter`; other bytes do no harm. Throws std::out_of_range before it
/// reads beyond the end or allocates memory for missing values.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : rest_(bytes) {}

  template <class T>
  [[nodiscard]] T number() {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_same_v<T, bool>);
    T value{};
    std::memcpy(&value, take(1, sizeof(T)), sizeof(T));
    return value;
  }
  template <class T>
  [[nodiscard]] std::vector<T> numbers() {
    const auto count = number<std::uint64_t>();
    const char* from = take(count, sizeof(T));
    std::vector<T> values(count);
    if (count > 0) std::memcpy(values.data(), from, count * sizeof(T));
    return values;
  }
  [[nodiscard]] std::string text() {
    const auto size = number<std::uint64_t>();
    const char* from = take(size, 1);
    return {from, size};
  }
  /// Number of the following values, each of at least one byte.
  [[nodiscard]] std::size_t count() {
    const auto value = number<std::uint64_t>();
    if (value > rest_.size()) throw std::out_of_range("bytes are missing");
    return value;
  }
  [[nodiscard]] bool is_at_end() const { return rest_.empty(); }

 private:
  const char* take(std::uint64_t count, std::size_t size) {
    if (count > rest_.size() / size) throw std::out_of_range("bytes are missing");
    const char* from = rest_.data();
    rest_.remove_prefix(count * size);
    return from;
  }
  std::string_view rest_;
};

}  // namespace suffuse
