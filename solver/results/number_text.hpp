#pragma once

/// Numbers as text that reads back to the very same double.

#include <optional>
#include <string>
#include <string_view>

namespace suffuse {

/// Shortest decimal text that reads back exactly.
std::string number_text(double value);

/// Four digits, for sentences.
std::string short_text(double value);

/// The number that is the whole of `text`, or nothing.
std::optional<double> parse_number(std::string_view text);

}  // namespace suffuse
