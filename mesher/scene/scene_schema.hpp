#pragma once

/// Every key of a scene, declared once: its values, its meaning and where it is stored.
/// The declarations are in `scene_keys.cpp`. Checking, `--set`, suggestions and
/// docs/reference/scene-reference.md all follow these declarations.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scene/scene.hpp"

namespace suffuse {

/// Arrays of numbers; each has two in a table of values against time.
using Rows = std::vector<std::vector<double>>;

/// A value of TOML. Only arrays of numbers, and arrays of such arrays, are allowed as arrays.
using Value = std::variant<bool, std::int64_t, double, std::string, std::vector<double>, Rows>;

enum class ValueKind {
  text,
  word,
  number,
  number_or_pair,
  integer,
  boolean,
  vector,
  number_or_word,   ///< a number, or one of `words`
  function,         ///< a number, or pairs of numbers
  vector_function,  ///< a vector, or pairs of a time and a vector
  gradation
};

struct Bound {
  double value = 0.0;
  bool open = false;  ///< the bound itself is not allowed
};

struct SceneKey {
  /// Dotted; `*` stands for any name and `[]` for any entry of a list: `soil.*.porosity`.
  std::string pattern;
  ValueKind kind = ValueKind::number;
  std::string sentence;
  std::string symbol;
  std::string unit;
  std::optional<Bound> lower;
  std::optional<Bound> upper;
  bool infinite_allowed = false;  ///< for numbers: inf is within the bounds
  /// The argument of a function given by pairs: its symbol and its name.
  std::string argument = "t";
  std::string arguments = "times (s, ascending)";
  bool argument_is_share = false;      ///< between 0 and 1; pairs may descend too
  std::vector<std::string> words;      ///< all allowed words, for ValueKind::word
  std::vector<std::int64_t> integers;  ///< all allowed ones; empty: any within the bounds
  bool required = false;
  std::string unless;  ///< the other key of its table that stands in for a required one
  std::optional<Value> default_value;
  std::string default_note;  ///< the default in words, if it is no plain value
  /// Stores an accepted value in the soil or boundary of this index, or in the scene itself.
  std::function<void(Scene&, std::size_t, const Value&)> store;

  [[nodiscard]] std::string leaf() const;    ///< `porosity`
  [[nodiscard]] std::string bounds() const;  ///< `0 < n_0 < 1`, or empty
  [[nodiscard]] std::string expected() const;
  /// The value for `store`, or nothing if it is not allowed.
  [[nodiscard]] std::optional<Value> accept(const Value& value) const;
  /// The fault of the pairs of a function or a gradation, if one pair is wrong:
  /// `t = 3 after t = 5`. Empty if the message has to quote the whole value.
  [[nodiscard]] std::string fault(const Value& value) const;

 private:
  [[nodiscard]] std::string fault_of_pairs(const Rows& rows) const;
  [[nodiscard]] std::optional<Value> accept_number(const Value& value) const;
};

/// A table of the scene, for the reference.
struct SceneSection {
  std::string pattern;  ///< `soil.*`; empty for the top level
  std::string heading;  ///< `[soil.NAME]`
  std::string sentence;
};

const std::vector<SceneKey>& scene_keys();
const std::vector<SceneSection>& scene_sections();

/// The key of this pattern, or nullptr.
const SceneKey* find_scene_key(const std::string& pattern);

/// The parts that may follow a pattern, in the order of declaration: names, `*` or `[]`. Empty for
/// keys and unknown patterns. The empty pattern is the whole scene.
std::vector<std::string> scene_children(const std::string& pattern);

/// `parent.child`, `parent[]`, or `child` at the top level.
std::string joined(const std::string& parent, const std::string& child);

/// A name as in a dotted key, in quotes if TOML needs them.
std::string shown_name(const std::string& name);

/// The shortest text that reads back as exactly this number, `2e7`.
std::string shown_number(double value);

/// A value as written in a scene.
std::string shown_value(const Value& value);

/// The fault of a time, or of another argument, that is not larger than the one before it. If the
/// two are equal, the text explains how to give a jump.
std::string out_of_order(const std::string& argument, double value, double earlier);

/// `a, b or c`
std::string listed(const std::vector<std::string>& items, const std::string& last_joint = "or");

}  // namespace suffuse
