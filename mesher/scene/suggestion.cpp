#include "scene/suggestion.hpp"

#include <algorithm>
#include <limits>
#include <set>

#include "common/closest_name.hpp"
#include "scene/scene_schema.hpp"

namespace suffuse {
namespace {

std::size_t nearness_limit(const std::string& word) {
  return std::max<std::size_t>(1, word.size() / 3);
}

/// The table or key of a pattern; if the pattern has a part for soils or boundaries, in that of
/// `table`.
std::string concrete(std::string pattern, const std::string& table,
                     const std::string& table_pattern, const std::string& soil) {
  for (const std::string group :
       {"soil.*", "boundary[]", "wall[]", "well[]", "output.probe[]", "output.section[]"}) {
    if (!pattern.starts_with(group)) continue;
    if (table_pattern.starts_with(group)) {
      // The text after the group has no wildcard, so it has the same length in table and pattern.
      const std::size_t below = table_pattern.size() - group.size();
      return table.substr(0, table.size() - below) + pattern.substr(group.size());
    }
    const std::string first = group.substr(0, group.size() - 1) + "0]";
    return (group == "soil.*" ? joined("soil", soil) : first) + pattern.substr(group.size());
  }
  return pattern;
}

/// Every key and every table that holds keys.
std::set<std::string> all_patterns() {
  std::set<std::string> patterns;
  for (const SceneKey& key : scene_keys()) {
    patterns.insert(key.pattern);
    for (std::size_t dot = key.pattern.find('.'); dot != std::string::npos;
         dot = key.pattern.find('.', dot + 1)) {
      patterns.insert(key.pattern.substr(0, dot));
    }
  }
  return patterns;
}

}  // namespace

std::string nearest_key(const std::string& name, const std::string& table,
                        const std::string& pattern, const std::string& soil) {
  std::string nearest;
  std::size_t best = std::numeric_limits<std::size_t>::max();
  for (const std::string& candidate : all_patterns()) {
    const std::string leaf = candidate.substr(candidate.rfind('.') + 1);
    if (leaf == "*") continue;
    const bool here = candidate == joined(pattern, leaf);
    const SceneKey* key = find_scene_key(candidate);
    const std::size_t distance = edit_distance(name, leaf.substr(0, leaf.find('[')));
    std::size_t score = std::numeric_limits<std::size_t>::max();
    // A key of this name in another table is more likely than a wrong letter in this table.
    if (distance <= (here ? nearness_limit(name) : name.size() / 4)) {
      score = 2 * distance + (here ? 0 : 1);
    } else if (key && !name.empty() && key->symbol == name) {
      score = here ? 1 : 2;
    }
    if (score >= best) continue;
    best = score;
    nearest = concrete(candidate, table, pattern, soil);
  }
  return nearest;
}

}  // namespace suffuse
