#include "scene/toml_fault.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <regex>
#include <sstream>

#include "scene/scene_schema.hpp"

namespace suffuse {
namespace {

/// Longest line that is searched for the fault; longer ones get the message of the parser.
constexpr std::size_t longest_line = 1000;

struct FaultyLine {
  std::string table;  ///< table of the line, such as `soil.sand`
  std::string text;
};

/// The name in the brackets of `[soil.sand]` or `[[boundary]]`; empty if the line is no such
/// heading.
std::string heading_of(const std::string& line) {
  const std::size_t begin = line.find_first_not_of(" \t");
  if (begin == std::string::npos || line[begin] != '[') return {};
  const std::size_t name = line.find_first_not_of("[ \t", begin);
  const std::size_t end = line.find_first_of("[], \t", std::min(name, line.size()));
  if (end == std::string::npos || line[end] == ',') return {};
  return line.substr(name, end - name);
}

FaultyLine line_of(const std::string& text, std::size_t number) {
  FaultyLine result;
  std::map<std::string, std::size_t> entries;  // present number, by the name of the list
  std::istringstream lines(text);
  for (std::size_t i = 1; i <= number && std::getline(lines, result.text); ++i) {
    const std::string heading = heading_of(result.text);
    if (heading.empty()) continue;
    result.table = heading;
    if (result.text.find("[[") == std::string::npos) continue;
    result.table += '[' + std::to_string(entries[heading]++) + ']';
  }
  return result;
}

/// `key = value` at the beginning of a line or in braces.
const std::string key_pattern = R"((?:^|[{,])\s*([A-Za-z0-9_.-]+)\s*=\s*)";

std::optional<InputProblem> decimal_comma(const std::string& line) {
  static const std::regex pattern(key_pattern +
                                  R"(([+-]?\d+),(\d+(?:[eE][+-]?\d+)?)\s*(?:[},#]|$))");
  std::smatch found;
  if (!std::regex_search(line, found, pattern)) return std::nullopt;
  return InputProblem{
      .where = {},
      .key = found[1],
      .found = found[2].str() + ',' + found[3].str(),
      .expected = "a point as decimal sign, " + found[2].str() + '.' + found[3].str(),
      .suggestion = {}};
}

std::optional<InputProblem> bare_word(const std::string& line) {
  static const std::regex pattern(key_pattern +
                                  R"((?!(?:true|false|inf|nan)\b)([A-Za-z_][^\s"'\[\]{},#=]*))");
  std::smatch found;
  if (!std::regex_search(line, found, pattern)) return std::nullopt;
  return InputProblem{.where = {},
                      .key = found[1],
                      .found = found[2],
                      .expected = "a word in quotes, " + shown_value(found[2].str()),
                      .suggestion = {}};
}

}  // namespace

InputProblem toml_fault(const std::string& text, std::size_t line, const std::string& where,
                        const std::string& parser_says) {
  const FaultyLine faulty = line_of(text, line);
  if (faulty.text.size() <= longest_line) {
    auto problem = decimal_comma(faulty.text);
    if (!problem) problem = bare_word(faulty.text);
    if (problem) {
      problem->where = where;
      problem->key = joined(faulty.table, problem->key);
      return *problem;
    }
  }
  return {.where = where,
          .key = "not TOML: " + parser_says,
          .found = {},
          .expected = {},
          .suggestion = {}};
}

}  // namespace suffuse
