#include "files/number_text.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace suffuse {
namespace {

/// The number with two or three digits.
std::string rounded_text(double value) {
  const double size = value > 0.0 ? std::pow(10.0, std::floor(std::log10(value)) - 1.0) : 1.0;
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(),
                                 std::round(value / size) * size, std::chars_format::general, 10)
                       .ptr;
  return {buffer.data(), end};
}

}  // namespace

std::string number_text(double value) {
  std::array<char, 32> buffer{};  // the shortest form of a double takes at most 24
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

std::string short_text(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                 std::chars_format::general, 4)
                       .ptr;
  return {buffer.data(), end};
}

std::string bytes_text(double bytes) {
  if (bytes >= 1e9) return rounded_text(bytes / 1e9) + " GB";
  if (bytes >= 1e6) return rounded_text(bytes / 1e6) + " MB";
  return rounded_text(bytes / 1e3) + " kB";
}

std::string duration_text(double seconds) {
  if (seconds < 120.0) return rounded_text(seconds) + " s";
  if (seconds < 7200.0) return rounded_text(seconds / 60.0) + " min";
  return rounded_text(seconds / 3600.0) + " h";
}

std::optional<double> parse_number(std::string_view text) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stop != end) return std::nullopt;
  return value;
}

}  // namespace suffuse
