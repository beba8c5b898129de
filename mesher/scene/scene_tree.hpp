#pragma once

/// A scene as written: the tree of tables, lists of tables and values of a TOML file, with their
/// places. Only the syntax of TOML is checked here.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene_schema.hpp"

namespace suffuse {

/// The place of a key or a value.
struct Place {
  std::size_t source = 0;  ///< 0 for the file, then one for each `--set`
  std::size_t line = 0;
  std::string text;  ///< `FILE:LINE` or `--set KEY=VALUE`
  /// Whether the value is that of another soil (`like`); the place is there.
  bool inherited = false;

  [[nodiscard]] bool operator<(const Place& other) const {
    return source != other.source ? source < other.source : line < other.line;
  }
};

/// Places by dotted key.
using Places = std::map<std::string, Place>;

/// The nearest enclosing key of `key` that `places` knows, `key` included; nullptr when none is.
const Place* find_place(const Places& places, std::string key);

struct SceneNode {
  enum class Form { value, table, list };

  std::string name;  ///< empty for entries of lists
  Form form = Form::table;
  Place place;
  std::string shown;              ///< as messages quote it
  std::optional<Value> value;     ///< nothing if TOML allows the value but no key can
  std::optional<Value> accepted;  ///< set by the checks
  std::vector<SceneNode> children;

  [[nodiscard]] SceneNode* find(const std::string& child);
  [[nodiscard]] const SceneNode* find(const std::string& child) const;
};

/// One step of a dotted key: a name, or a position in a list.
struct KeyStep {
  std::string name;
  std::optional<std::size_t> index;

  [[nodiscard]] std::string shown() const;  ///< `porosity`, `"two words"` or `[0]`
};

/// A `--set` argument.
struct Override {
  std::vector<KeyStep> key;
  SceneNode node;
};

/// A node that a soil has from another one, with all below it.
SceneNode inherited(SceneNode node);

/// Throws InputError when the text is not TOML.
SceneNode read_toml(const std::string& text, const std::string& path);

/// Reads `key=value`; a value that does not begin like a TOML value is a text.
/// \param source  of the override's place
/// Throws InputError.
Override read_override(const std::string& argument, std::size_t source);

}  // namespace suffuse
