#pragma once

/// Numbers as text: exact for files, with few digits for sentences.

#include <optional>
#include <string>
#include <string_view>

namespace suffuse {

/// Shortest decimal text from which the same number is read.
std::string number_text(double value);

/// Four digits, for sentences.
std::string short_text(double value);

/// 1.234e7 -> "12 MB": two or three digits, decimal units.
std::string bytes_text(double bytes);

/// 75.4 -> "75 s", 400 -> "6.7 min": two or three digits.
std::string duration_text(double seconds);

/// The number if `text` is one number, otherwise nothing.
std::optional<double> parse_number(std::string_view text);

}  // namespace suffuse
