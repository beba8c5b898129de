#include "scene/scene_difference.hpp"

#include <map>
#include <set>

#include "common/errors.hpp"
#include "scene/scene_tree.hpp"

namespace suffuse {
namespace {

/// Longest value in a message; longer ones, such as tables of times, would hide the rest.
constexpr std::size_t longest_value = 40;

/// Values by dotted key, as messages show them.
using Values = std::map<std::string, std::string>;

/// The value as text: 200 and 200.0 are equal and give 200.
std::string shown(const SceneNode& node) {
  if (!node.value) return node.shown;
  std::string text = shown_value(*node.value);
  const bool is_number = std::holds_alternative<double>(*node.value);
  if (is_number && text.ends_with(".0")) text.resize(text.size() - 2);
  return text;
}

void collect(const SceneNode& node, const std::string& key, Values& values) {
  if (node.form == SceneNode::Form::value) values[key] = shown(node);
  for (std::size_t i = 0; i < node.children.size(); ++i) {
    const bool in_list = node.form == SceneNode::Form::list;
    const std::string step =
        in_list ? '[' + std::to_string(i) + ']' : shown_name(node.children[i].name);
    collect(node.children[i], joined(key, step), values);
  }
}

/// Applies a `--set`: its value replaces the whole value, table or list of the key.
void apply(const std::string& argument, Values& values) {
  const Override change = read_override(argument, 0);
  std::string key;
  for (const KeyStep& step : change.key) key = joined(key, step.shown());
  std::erase_if(values, [&](const auto& entry) {
    const std::string& other = entry.first;
    return other == key || other.starts_with(key + '.') || other.starts_with(key + '[');
  });
  collect(change.node, key, values);
}

std::string difference(const std::string& key, const std::string& there, const std::string& here) {
  if (there.size() > longest_value || here.size() > longest_value) return key + ": other values";
  return key + ": " + there + " there, " + here + " here";
}

template <class Map>
std::string value_or(const Map& map, const std::string& key, const std::string& otherwise) {
  const auto found = map.find(key);
  return found == map.end() ? otherwise : found->second;
}

}  // namespace

std::map<std::string, std::string> written_values(const SceneDocument& document) {
  Values values;
  collect(read_toml(document.text, document.path), "", values);
  for (const std::string& argument : document.overrides) apply(argument, values);
  return values;
}

std::vector<std::string> scene_differences(const SceneDocument& there, const SceneDocument& here) {
  std::vector<std::string> result;
  try {
    const Values before = written_values(there);
    const Values now = written_values(here);
    std::set<std::string> keys;
    for (const Values* values : {&before, &now}) {
      for (const auto& [key, value] : *values) keys.insert(key);
    }
    for (const std::string& key : keys) {
      const std::string was = value_or(before, key, "nothing");
      const std::string is = value_or(now, key, "nothing");
      if (was != is) result.push_back(difference(key, was, is));
    }
  } catch (const InputError&) {
    if (there.text != here.text || there.overrides != here.overrides) {
      result.emplace_back("the text of the scene");
    }
  }
  std::set<std::string> names;
  for (const auto* files : {&there.files, &here.files}) {
    for (const auto& [name, text] : *files) names.insert(name);
  }
  for (const std::string& name : names) {
    if (value_or(there.files, name, "") != value_or(here.files, name, "")) {
      result.push_back(name + ": other values");
    }
  }
  return result;
}

}  // namespace suffuse
