#include "scene/scene_tree.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <cctype>
#include <sstream>
#include <string_view>
#include <utility>

#include "common/errors.hpp"
#include "scene/toml_fault.hpp"

namespace suffuse {
namespace {

using Form = SceneNode::Form;

/// Places in the file, or the place of an override.
struct Locator {
  std::string file;
  std::optional<Place> fixed;

  [[nodiscard]] Place operator()(const toml::source_region& region) const {
    if (fixed) return *fixed;
    const std::size_t line = region.begin.line;
    return {.source = 0, .line = line, .text = file + ':' + std::to_string(line)};
  }
};

bool is_bare(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-';
}

std::optional<std::vector<double>> read_numbers(const toml::array& array) {
  std::vector<double> numbers;
  for (const toml::node& item : array) {
    if (!item.is_number()) return std::nullopt;
    numbers.push_back(*item.value<double>());
  }
  return numbers;
}

std::optional<Value> read_value(const toml::node& node) {
  if (const auto* boolean = node.as_boolean()) return boolean->get();
  if (const auto* integer = node.as_integer()) return integer->get();
  if (const auto* real = node.as_floating_point()) return real->get();
  if (const auto* text = node.as_string()) return text->get();
  const auto* array = node.as_array();
  if (!array) return std::nullopt;
  if (!array->empty() && array->front().is_array()) {
    Rows rows;
    for (const toml::node& item : *array) {
      auto row = item.is_array() ? read_numbers(*item.as_array()) : std::nullopt;
      if (!row) return std::nullopt;
      rows.push_back(*std::move(row));
    }
    return rows;
  }
  return read_numbers(*array);
}

std::string show(const toml::node& node) {
  if (node.is_table()) return "a table";
  if (const auto* array = node.as_array()) {
    std::string items;
    for (const toml::node& item : *array) items += (items.empty() ? "" : ", ") + show(item);
    return '[' + items + ']';
  }
  if (const auto value = read_value(node)) return shown_value(*value);
  std::ostringstream text;  // dates and times
  node.visit([&text](const auto& concrete) {
    if constexpr (toml::is_chronological<decltype(concrete)>) text << concrete;
  });
  return text.str();
}

SceneNode read_node(const toml::node& node, std::string name, const Place& place,
                    const Locator& locate);

std::vector<SceneNode> read_children(const toml::table& table, const Locator& locate) {
  std::vector<SceneNode> children;
  for (const auto& [key, node] : table) {
    children.push_back(read_node(node, std::string(key.str()), locate(key.source()), locate));
  }
  // toml++ sorts by name; messages and soils follow the file.
  std::ranges::stable_sort(children, std::less{}, &SceneNode::place);
  return children;
}

SceneNode read_node(const toml::node& node, std::string name, const Place& place,
                    const Locator& locate) {
  SceneNode result;
  result.name = std::move(name);
  result.place = place;
  if (const auto* table = node.as_table()) {
    result.form = Form::table;
    result.shown = "a table";
    result.children = read_children(*table, locate);
  } else if (const auto* array = node.as_array();
             array && (array->empty() || array->is_homogeneous<toml::table>())) {
    result.form = Form::list;
    result.shown = array->empty() ? "[]" : "a list of tables";
    for (const toml::node& item : *array) {
      result.children.push_back(read_node(item, "", locate(item.source()), locate));
    }
  } else {
    result.form = Form::value;
    result.value = read_value(node);
    result.shown = show(node);
  }
  return result;
}

[[noreturn]] void refuse(const std::string& where, const std::string& sentence) {
  throw InputError(
      InputProblem{.where = where, .key = sentence, .found = {}, .expected = {}, .suggestion = {}});
}

/// Largest depth of nested tables by dotted keys, headings and braces, because recursive functions
/// call themselves once for each level.
constexpr int deepest_table = 64;

/// Finds the number of the first line whose tables are nested too deeply, or 0. Counts dots,
/// brackets and braces outside of texts and comments; the parser refuses TOML that is wrong in
/// other ways.
class DepthScan {
 public:
  explicit DepthScan(std::string_view text) : text_(text) {}

  std::size_t run() {
    while (at_ < text_.size()) {
      take(text_[at_]);
      ++at_;
      if (heading_ + within_ + dots_ + static_cast<int>(outer_dots_.size()) > deepest_table) {
        return line_;
      }
    }
    return 0;
  }

 private:
  void take(char c) {
    switch (c) {
      case '\n':
        end_line();
        break;
      case '#':
        at_ = std::min(text_.find('\n', at_), text_.size()) - 1;
        break;
      case '"':
      case '\'':
        skip_text(c);
        break;
      case '.':
        ++dots_;
        break;
      case '{':
        outer_dots_.push_back(dots_);
        within_ += std::exchange(dots_, 0);
        break;
      case '}':
        if (!outer_dots_.empty()) {
          dots_ = outer_dots_.back();
          within_ -= dots_;
          outer_dots_.pop_back();
        }
        break;
      case ',':
        dots_ = 0;
        break;
      default:
        if (begins_line_ && c == '[') {
          is_heading_ = true;
          heading_ = 0;
        }
    }
    begins_line_ = c == '\n' || (begins_line_ && (c == ' ' || c == '\t'));
  }

  void end_line() {
    ++line_;
    if (is_heading_) heading_ = dots_;
    is_heading_ = false;
    dots_ = 0;
  }

  /// Moves to the quote that ends the text beginning here.
  void skip_text(char quote) {
    const std::string three(3, quote);
    const bool is_long = text_.substr(at_, 3) == three;
    const std::string_view end =
        is_long ? std::string_view(three) : std::string_view(three).substr(2);
    at_ += end.size();
    for (; at_ < text_.size() && text_.substr(at_, end.size()) != end; ++at_) {
      if (text_[at_] == '\n' && !is_long) {
        --at_;
        return;
      }
      if (text_[at_] == '\n') ++line_;
      if (text_[at_] == '\\' && quote == '"') ++at_;
    }
    at_ += end.size() - 1;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t line_ = 1;
  bool begins_line_ = true;
  bool is_heading_ = false;
  int heading_ = 0;              // dots in the heading above
  int dots_ = 0;                 // dots in the current key
  int within_ = 0;               // dots in the keys of all tables in braces around it
  std::vector<int> outer_dots_;  // dots in each of those keys
};

/// \param place_of  a line
template <class PlaceOf>
void refuse_deep_tables(std::string_view text, const PlaceOf& place_of) {
  const std::size_t line = DepthScan(text).run();
  if (line == 0) return;
  throw InputError(InputProblem{
      .where = place_of(line),
      .key = {},
      .found = "tables that lie more than " + std::to_string(deepest_table) + " deep in each other",
      .expected = "a scene, whose tables lie three deep",
      .suggestion = {}});
}

/// Takes `"quoted"`, `'quoted'` or a bare name off the front of `rest`; empty when there is none.
std::string take_name(std::string_view& rest) {
  std::string name;
  if (rest.starts_with('"') || rest.starts_with('\'')) {
    const std::size_t end = rest.find(rest.front(), 1);
    if (end == std::string_view::npos) return {};
    name = rest.substr(1, end - 1);
    rest.remove_prefix(end + 1);
    return name;
  }
  const auto end = std::ranges::find_if_not(rest, is_bare);
  name = std::string(rest.begin(), end);
  rest.remove_prefix(name.size());
  return name;
}

/// Takes `[12]` off the front of `rest`, if it is there.
std::optional<std::size_t> take_index(std::string_view& rest) {
  const std::size_t end = rest.find(']');
  if (!rest.starts_with('[') || end == std::string_view::npos) return std::nullopt;
  const std::string digits(rest.substr(1, end - 1));
  // More than nine digits are no valid number of an entry.
  const bool number = !digits.empty() && digits.size() < 10 &&
                      digits.find_first_not_of("0123456789") == std::string::npos;
  if (!number) return std::nullopt;
  rest.remove_prefix(end + 1);
  return std::stoul(digits);
}

/// Empty when `text` is not a dotted key.
std::vector<KeyStep> read_key(std::string_view text) {
  std::vector<KeyStep> steps;
  do {
    if (!steps.empty()) text.remove_prefix(1);
    const std::string name = take_name(text);
    if (name.empty()) return {};
    steps.push_back({.name = name, .index = {}});
    if (const auto index = take_index(text)) steps.push_back({.name = {}, .index = index});
  } while (text.starts_with('.'));
  return text.empty() ? steps : std::vector<KeyStep>{};
}

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin == std::string::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

/// The first `=` outside quotes.
std::size_t find_equals(const std::string& text) {
  char quote = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (quote != 0) {
      if (text[i] == quote) quote = 0;
    } else if (text[i] == '"' || text[i] == '\'') {
      quote = text[i];
    } else if (text[i] == '=') {
      return i;
    }
  }
  return std::string::npos;
}

SceneNode read_override_value(const std::string& text, const Place& place) {
  const Locator locate{.file = {}, .fixed = place};
  refuse_deep_tables(text, [&](std::size_t) { return place.text; });
  try {
    const toml::table table = toml::parse(std::string_view("value = " + text));
    if (table.size() == 1) return read_node(*table.get("value"), "", place, locate);
  } catch (const toml::parse_error& error) {
    const bool begins_like_toml = std::string_view("\"'[{").find(text[0]) != std::string_view::npos;
    if (begins_like_toml) {
      refuse(place.text, "not a TOML value: " + std::string(error.description()));
    }
  }
  if (text.find('\n') != std::string::npos) refuse(place.text, "not a TOML value: several lines");
  return read_node(toml::value<std::string>(text), "", place, locate);
}

}  // namespace

const Place* find_place(const Places& places, std::string key) {
  while (!key.empty()) {
    if (const auto found = places.find(key); found != places.end()) return &found->second;
    const std::size_t end = key.find_last_of(".[");
    key.resize(end == std::string::npos ? 0 : end);
  }
  return nullptr;
}

SceneNode* SceneNode::find(const std::string& child) {
  const auto found = std::ranges::find(children, child, &SceneNode::name);
  return found == children.end() ? nullptr : &*found;
}

const SceneNode* SceneNode::find(const std::string& child) const {
  const auto found = std::ranges::find(children, child, &SceneNode::name);
  return found == children.end() ? nullptr : &*found;
}

// NOLINTNEXTLINE(misc-no-recursion): as deep as the scene's tables
SceneNode inherited(SceneNode node) {
  node.place.inherited = true;
  for (SceneNode& child : node.children) child = inherited(std::move(child));
  return node;
}

std::string KeyStep::shown() const {
  if (index) return '[' + std::to_string(*index) + ']';
  return shown_name(name);
}

SceneNode read_toml(const std::string& text, const std::string& path) {
  const Locator locate{.file = path, .fixed = {}};
  refuse_deep_tables(text, [&](std::size_t line) { return path + ':' + std::to_string(line); });
  try {
    const toml::table table = toml::parse(std::string_view(text));
    SceneNode root = read_node(table, "", {.source = 0, .line = 0, .text = path}, locate);
    return root;
  } catch (const toml::parse_error& error) {
    throw InputError(
        std::vector{toml_fault(text, error.source().begin.line, locate(error.source()).text,
                               std::string(error.description()))});
  }
}

Override read_override(const std::string& argument, std::size_t source) {
  const Place place{.source = source, .line = 0, .text = "--set " + argument};
  const std::size_t equals = find_equals(argument);
  const std::string key = trimmed(argument.substr(0, equals));
  const std::string value = equals == std::string::npos ? "" : trimmed(argument.substr(equals + 1));
  Override result{.key = read_key(key), .node = {}};
  if (result.key.empty() || value.empty()) {
    refuse(place.text, "expected KEY=VALUE, as in time.end=10 or boundary[0].pressure=3e3");
  }
  result.node = read_override_value(value, place);
  return result;
}

}  // namespace suffuse
