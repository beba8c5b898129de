#include "scene/table_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <string_view>

#include "scene/scene_schema.hpp"

namespace suffuse {
namespace {

constexpr std::string_view header = "t,head";

std::string_view without_outer_blanks(std::string_view text) {
  constexpr std::string_view blanks = " \t\r";
  const std::size_t begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

std::optional<double> read_number(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc{} && end == text.data() + text.size();
  return whole && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

/// A line such as `t,head` without blanks, for comparison.
std::string without_blanks(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c != ' ' && c != '\t') result += c;
  }
  return result;
}

/// A line as a message quotes it.
std::string shown_line(std::string_view line) {
  constexpr std::size_t longest = 60;
  if (line.empty()) return "an empty line";
  return shown_value(std::string(line.substr(0, longest))) + (line.size() > longest ? "..." : "");
}

}  // namespace

std::string separator_advice(const std::string& line) {
  const bool semicolon = line.find(';') != std::string::npos;
  if (!semicolon && line.find('\t') == std::string::npos) return "";
  return std::string(", with commas between columns in the place of ") +
         (semicolon ? "semicolons" : "tabs") + ", and decimal points in numbers";
}

TableReading read_head_table(const std::string& text, const std::string& path) {
  TableReading result;
  std::istringstream lines(text.starts_with("\xEF\xBB\xBF") ? text.substr(3) : text);
  std::size_t number = 0;
  const auto fail = [&](const std::string& found, const std::string& expected) {
    result.problem = InputProblem{
        .where = path + ':' + std::to_string(number), .found = found, .expected = expected};
    return result;
  };
  for (std::string raw; std::getline(lines, raw);) {
    ++number;
    const std::string_view line = without_outer_blanks(raw);
    if (number == 1) {
      if (without_blanks(line) != header) {
        return fail(shown_line(line), "the header line t,head" + separator_advice(raw));
      }
      continue;
    }
    if (line.empty()) continue;
    const std::size_t comma = line.find(',');
    const auto t = read_number(without_outer_blanks(line.substr(0, comma)));
    const auto value = comma == std::string_view::npos
                           ? std::nullopt
                           : read_number(without_outer_blanks(line.substr(comma + 1)));
    if (!t || !value) {
      const bool more_commas = std::ranges::count(line, ',') > 1;
      return fail(shown_line(line),
                  "two numbers t,head: a time in s and a head in m" +
                      (more_commas ? ", with decimal points" : separator_advice(raw)));
    }
    if (!result.rows.empty() && *t <= result.rows.back().first) {
      return fail(out_of_order("t", *t, result.rows.back().first), "times that ascend");
    }
    result.rows.emplace_back(*t, *value);
  }
  number = std::max<std::size_t>(number, 1);
  if (result.rows.empty()) return fail("no row", "the header line t,head and at least one row");
  return result;
}

}  // namespace suffuse
