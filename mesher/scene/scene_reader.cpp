#include "scene/scene_reader.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "common/closest_name.hpp"
#include "common/errors.hpp"
#include "scene/scene_checks.hpp"
#include "scene/scene_defaults.hpp"
#include "scene/scene_schema.hpp"
#include "scene/scene_tree.hpp"
#include "scene/suggestion.hpp"
#include "scene/table_file.hpp"

namespace suffuse {
namespace {

using Form = SceneNode::Form;

constexpr const char* like = "like";
/// Largest number of soils in a chain in which each is `like` the next.
constexpr std::size_t longest_chain = 100;

/// The pattern of the key or table `name` in a table; nothing when there is none.
std::optional<std::string> pattern_below(const std::string& table, const std::string& name) {
  for (const std::string& child : scene_children(table)) {
    if (child == "*" || (child == name && child != "[]")) return joined(table, child);
  }
  return std::nullopt;
}

bool is_list(const std::string& pattern) {
  return scene_children(pattern) == std::vector<std::string>{"[]"};
}

std::string indexed(const std::string& key, std::size_t index) {
  return key + '[' + std::to_string(index) + ']';
}

class SceneReader {
 public:
  SceneReader(const std::string& text, std::string path, const std::vector<std::string>& overrides,
              const FileLoader& load)
      : path_(std::move(path)), load_(load), root_(read_toml(text, path_)) {
    for (std::size_t i = 0; i < overrides.size(); ++i) apply_override(overrides[i], i + 1);
  }

  /// What the scene says, without the text that it was read from.
  SceneDocument read() {
    check_table(root_, "", "");
    inherit();
    collect_places(root_, "");
    // This precedes the binding of keys: a misspelt structure must not get the default of a shape.
    if (places_.contains("geometry.file")) scene_.mesh.structure = MeshStructure::crossed;
    bind();
    read_tables();
    complete_scene(scene_, path_, [this](const auto& key) { return places_.contains(key); });
    check_scene(scene_,
                {.given = [this](const std::string& key) { return places_.contains(key); },
                 .inherited = [this](const std::string& key) { return places_.at(key).inherited; },
                 .refused = [this](const std::string& key) { return refused_.contains(key); },
                 .report = [this](const Contradiction& found) { report(found); }});
    throw_problems();
    std::map<std::string, std::string> where;
    for (const auto& [key, place] : places_) where.emplace(key, place.text);
    return {path_, {}, {}, {}, scene_, std::move(where), files_, plane_vectors_};
  }

 private:
  struct Problem {
    Place place;
    InputProblem problem;
  };

  /// The table with the keys of a pattern: the scene itself, one soil or one entry of a list.
  struct Instance {
    const SceneNode* table;
    std::string key;  ///< key of the table
    std::size_t index;
  };

  void report(const Place& place, const std::string& key, const std::string& found,
              const std::string& expected, const std::string& suggestion = {}) {
    problems_.push_back({place,
                         {.where = place.text,
                          .key = key,
                          .found = found,
                          .expected = expected,
                          .suggestion = suggestion}});
  }

  /// Reports a missing key at the place of its table.
  void report_missing(const std::string& key, const std::string& expected) {
    report(place_of(key), key, "nothing", expected);
  }

  /// Reports a contradiction at its key, or at the last `--set` of one of the keys involved. If the
  /// key and its table are missing, the place is that of the first of the other keys.
  void report(const Contradiction& contradiction) {
    Place place = place_of(contradiction.key);
    for (const std::string& key : contradiction.others) {
      const Place other = place_of(key);
      const bool nowhere = place.source == 0 && place.line == 0;
      if (other.source > place.source || nowhere) place = other;
    }
    report(place, contradiction.key, contradiction.found, contradiction.expected);
  }

  [[nodiscard]] Place place_of(const std::string& key) const {
    const Place* place = find_place(places_, key);
    return place ? *place : root_.place;
  }

  void throw_problems() {
    if (problems_.empty()) return;
    std::ranges::stable_sort(problems_, std::less{}, &Problem::place);
    std::vector<InputProblem> sorted;
    for (Problem& p : problems_) sorted.push_back(std::move(p.problem));
    throw InputError(std::move(sorted));
  }

  // Overrides.

  void apply_override(const std::string& argument, std::size_t source) {
    try {
      insert(read_override(argument, source));
    } catch (const InputError& error) {
      const InputProblem& problem = error.problems().front();
      problems_.push_back({{.source = source, .line = 0, .text = problem.where}, problem});
    }
  }

  void insert(const Override& change) {
    SceneNode* node = &root_;
    std::string key;
    std::string pattern;
    for (const KeyStep& step : change.key) {
      const std::optional<std::string> next = step.index && is_list(pattern)
                                                  ? std::optional(pattern + "[]")
                                                  : pattern_below(pattern, step.name);
      if (!next || step.index.has_value() != is_list(pattern)) {
        return report_unknown(key, pattern, step.shown(), step.name, change.node);
      }
      // A value in place of a table is reported by the check of tables.
      if (node->form != (is_list(pattern) ? Form::list : Form::table)) return;
      node = step.index ? entry_at(*node, key, *step.index, change.node)
                        : child_at(*node, step.name, *next, change.node);
      if (!node) return;
      key = joined(key, step.shown());
      pattern = *next;
    }
    std::string name = std::move(node->name);
    *node = change.node;
    node->name = std::move(name);
  }

  /// The child of this name; creates it if there is none.
  static SceneNode* child_at(SceneNode& table, const std::string& name, const std::string& pattern,
                             const SceneNode& change) {
    if (SceneNode* child = table.find(name)) return child;
    SceneNode made;
    made.name = name;
    made.form = is_list(pattern) ? Form::list : Form::table;
    made.place = change.place;
    return &table.children.emplace_back(std::move(made));
  }

  /// The entry of this index; creates the next one. Reports later ones and returns nullptr.
  SceneNode* entry_at(SceneNode& list, const std::string& key, std::size_t index,
                      const SceneNode& change) {
    const std::size_t count = list.children.size();
    if (index < count) return &list.children[index];
    if (index > count) {
      report(change.place, indexed(key, index), "an index past the end",
             "0 to " + std::to_string(count) + ", the last of which adds an entry");
      return nullptr;
    }
    SceneNode made;
    made.place = change.place;
    return &list.children.emplace_back(std::move(made));
  }

  // Checks of each key by itself.

  void check_table(SceneNode& table, const std::string& key, const std::string& pattern) {
    for (SceneNode& child : table.children) {
      const std::string name = shown_name(child.name);
      if (const auto below = pattern_below(pattern, child.name)) {
        check_node(child, joined(key, name), *below);
      } else {
        report_unknown(key, pattern, name, child.name, child);
      }
    }
  }

  void check_node(SceneNode& node, const std::string& key, const std::string& pattern) {
    if (const SceneKey* declared = find_scene_key(pattern))
      return check_value(node, key, *declared);
    if (is_list(pattern)) {
      if (node.form != Form::list) {
        return report(node.place, key, node.shown, "a list of tables, each under [[" + key + "]]");
      }
      for (std::size_t i = 0; i < node.children.size(); ++i) {
        check_table(node.children[i], indexed(key, i), pattern + "[]");
      }
      return;
    }
    if (node.form != Form::table) {
      return report(node.place, key, node.shown, "a table with " + members(pattern));
    }
    check_table(node, key, pattern);
  }

  void check_value(SceneNode& node, const std::string& key, const SceneKey& declared) {
    if (node.value) node.accepted = declared.accept(*node.value);
    if (node.accepted) return;
    refused_.insert(key);
    std::string expected = declared.expected();
    const auto* real = node.value ? std::get_if<double>(&*node.value) : nullptr;
    if (real && !std::isfinite(*real) && !declared.infinite_allowed &&
        expected.starts_with("a number")) {
      expected.replace(0, 1, "a finite");
    }
    // The expected value is the only word; a suggestion would repeat it.
    const auto* text = node.value ? std::get_if<std::string>(&*node.value) : nullptr;
    std::string suggestion;
    if (text && declared.words.size() > 1) suggestion = closest_name(*text, declared.words);
    if (!suggestion.empty()) suggestion = shown_value(suggestion);
    const std::string fault = node.value ? declared.fault(*node.value) : "";
    report(node.place, key, fault.empty() ? node.shown : fault, expected, suggestion);
  }

  void report_unknown(const std::string& table, const std::string& pattern,
                      const std::string& shown, const std::string& name, const SceneNode& node) {
    const std::string found = node.form == Form::value ? "an unknown key" : "an unknown table";
    report(node.place, joined(table, shown), found, members(pattern),
           nearest_key(name, table, pattern, example_soil()));
  }

  /// Allowed content of a table, in words.
  [[nodiscard]] static std::string members(const std::string& pattern) {
    if (is_list(pattern)) return "an entry such as " + indexed(pattern, 0);
    if (scene_children(pattern) == std::vector<std::string>{"*"}) return "names of regions";
    if (const auto all = scene_children(pattern); !all.empty()) return listed(all);
    return "a value, not a table";
  }

  /// The only soil, or a placeholder.
  [[nodiscard]] std::string example_soil() const {
    const SceneNode* soils = root_.find("soil");
    return soils && soils->children.size() == 1 ? shown_name(soils->children[0].name) : "NAME";
  }

  // `like`.

  void inherit() {
    SceneNode* soils = root_.find("soil");
    if (!soils) return;
    std::set<std::string> visiting;
    for (SceneNode& soil : soils->children) inherit(soil, *soils, visiting);
  }

  /// Fills in what `soil` inherits from another; false when that is unknown.
  // NOLINTNEXTLINE(misc-no-recursion): ends at a soil without `like`, or one that is being visited
  bool inherit(SceneNode& soil, SceneNode& soils, std::set<std::string>& visiting) {
    if (without_inheritance_.contains(soil.name)) return false;
    const SceneNode* reference = soil.find(like);
    if (!reference) return soil.form == Form::table;
    const bool found = reference->accepted && inherit_from(*reference, soil, soils, visiting);
    if (!found) without_inheritance_.insert(soil.name);
    return found;
  }

  // NOLINTNEXTLINE(misc-no-recursion)
  bool inherit_from(const SceneNode& reference, SceneNode& soil, SceneNode& soils,
                    std::set<std::string>& visiting) {
    const auto& name = std::get<std::string>(*reference.accepted);
    const std::string key = "soil." + shown_name(soil.name) + ".like";
    SceneNode* other = soils.find(name);
    if (!other) {
      std::vector<std::string> others;
      for (const SceneNode& each : soils.children) {
        if (each.name != soil.name) others.push_back(each.name);
      }
      const std::string suggestion = closest_name(name, others);
      report(reference.place, key, reference.shown,
             others.empty() ? "no such key: there is no other soil"
                            : "the name of another soil: " + listed(others),
             suggestion.empty() ? "" : shown_value(suggestion));
      return false;
    }
    visiting.insert(soil.name);
    const bool cycle = visiting.contains(name);
    const bool too_long = visiting.size() > longest_chain;
    if (cycle) {
      report(reference.place, key, reference.shown,
             "a soil that does not lead back to " + shown_name(soil.name));
    } else if (too_long) {
      report(reference.place, key, reference.shown,
             "at most " + std::to_string(longest_chain) + " soils of which each is like the next");
    }
    const bool complete = !cycle && !too_long && inherit(*other, soils, visiting);
    visiting.erase(soil.name);
    if (complete) add_missing(*other, soil);
    return complete;
  }

  // NOLINTNEXTLINE(misc-no-recursion): as deep as the scene's tables
  static void add_missing(const SceneNode& from, SceneNode& to) {
    for (const SceneNode& child : from.children) {
      if (child.name == like) continue;
      SceneNode* own = to.find(child.name);
      if (!own) {
        to.children.push_back(inherited(child));
      } else if (own->form == Form::table && child.form == Form::table) {
        add_missing(child, *own);
      }
    }
  }

  // From the tree to the scene.

  // NOLINTNEXTLINE(misc-no-recursion): as deep as the scene's tables
  void collect_places(const SceneNode& node, const std::string& key) {
    if (!key.empty()) places_.emplace(key, node.place);
    for (std::size_t i = 0; i < node.children.size(); ++i) {
      const SceneNode& child = node.children[i];
      collect_places(
          child, node.form == Form::list ? indexed(key, i) : joined(key, shown_name(child.name)));
    }
  }

  /// Whether a soil's table makes its region free.
  static bool is_free(const SceneNode& table) {
    const SceneNode* free = table.find("free");
    return free && free->accepted && std::get<bool>(*free->accepted);
  }

  /// The tables of a group, such as `soil` or `output.probe`.
  /// \param first  index of the first of them
  [[nodiscard]] std::vector<Instance> members_of(const std::string& group,
                                                 std::size_t first = 0) const {
    std::vector<Instance> instances;
    const SceneNode* node = &root_;
    for (std::size_t begin = 0; node && begin <= group.size();) {
      const std::size_t end = std::min(group.find('.', begin), group.size());
      node = node->find(group.substr(begin, end - begin));
      begin = end + 1;
    }
    if (!node || node->form == Form::value) return instances;
    for (std::size_t i = 0; i < node->children.size(); ++i) {
      const SceneNode& child = node->children[i];
      if (child.form != Form::table || is_free(child)) continue;
      const std::string key =
          node->form == Form::list ? indexed(group, i) : joined(group, shown_name(child.name));
      instances.push_back({&child, key, first + instances.size()});
    }
    return instances;
  }

  void bind() {
    const std::size_t boundaries = members_of("boundary").size();
    const std::vector<std::pair<std::string, std::vector<Instance>>> groups = {
        {"soil.*.", members_of("soil")},
        {"boundary[].", members_of("boundary")},
        {"well[].", members_of("well", boundaries)},
        {"wall[].", members_of("wall")},
        {"output.probe[].", members_of("output.probe")},
        {"output.section[].", members_of("output.section")},
        {"", {{&root_, "", 0}}}};
    for (const Instance& soil : groups[0].second) {
      scene_.soils.emplace_back().region = soil.table->name;
    }
    for (const std::size_t group : {1, 2}) {
      for (const Instance& entry : groups[group].second) {
        scene_.boundaries.emplace_back().key = entry.key;
      }
    }
    scene_.walls.resize(groups[3].second.size());
    scene_.output.probes.resize(groups[4].second.size());
    scene_.output.sections.resize(groups[5].second.size());
    for (const SceneKey& declared : scene_keys()) {
      const auto group = std::ranges::find_if(
          groups, [&](const auto& g) { return declared.pattern.starts_with(g.first); });
      for (const Instance& instance : group->second) {
        bind(declared, instance, declared.pattern.substr(group->first.size()));
      }
    }
    report_incomplete_soils(groups[0].second);
    const SceneNode* soils = root_.find("soil");
    if (!soils) report_missing("soil", "at least one table [soil.NAME], NAME being its region's");
    for (const SceneNode& soil : soils ? soils->children : std::vector<SceneNode>()) {
      if (is_free(soil)) scene_.free_regions.insert(soil.name);
    }
  }

  /// \param path  of the key within the instance's table
  void bind(const SceneKey& declared, const Instance& instance, const std::string& path) {
    const SceneNode* node = instance.table;
    for (std::size_t begin = 0; node && begin <= path.size();) {
      if (node->form != Form::table) return;  // reported already
      const std::size_t end = std::min(path.find('.', begin), path.size());
      node = node->find(path.substr(begin, end - begin));
      begin = end + 1;
    }
    if (node && node->accepted) {
      declared.store(scene_, instance.index, *node->accepted);
      const auto* vector = std::get_if<std::vector<double>>(&*node->accepted);
      const bool plane = declared.kind == ValueKind::vector && vector && vector->size() == 2;
      if (plane) plane_vectors_.insert(joined(instance.key, path));
    }
    if (node) return;
    if (declared.default_value) declared.store(scene_, instance.index, *declared.default_value);
    const bool unknown = without_inheritance_.contains(instance.table->name);
    if (declared.required && !unknown && !instance.table->find(declared.unless)) {
      if (declared.pattern.starts_with("soil.*.")) {
        missing_[instance.key].emplace_back(path, declared.expected());
      } else {
        report_missing(joined(instance.key, path), declared.expected());
      }
    }
  }

  /// Reports soils that lack keys. In a scene with a complete soil, one that lacks many keys most
  /// likely has a misspelt name: this is one problem, not one for each key.
  void report_incomplete_soils(const std::vector<Instance>& soils) {
    std::vector<std::string> complete;
    for (const Instance& soil : soils) {
      if (!missing_.contains(soil.key)) complete.push_back(soil.table->name);
    }
    for (const Instance& soil : soils) {
      const auto missing = missing_.find(soil.key);
      if (missing == missing_.end()) continue;
      if (missing->second.size() > 1 && !complete.empty()) {
        std::vector<std::string> keys;
        for (const auto& [key, expected] : missing->second) keys.push_back(key);
        const std::string meant = closest_name(soil.table->name, complete);
        report(place_of(soil.key), soil.key, "a soil without " + listed(keys, "and"),
               "these keys, or like = NAME, or the name of a soil that has them: " +
                   quoted_list(complete),
               meant.empty() ? "" : joined("soil", shown_name(meant)));
        continue;
      }
      for (const auto& [key, expected] : missing->second) {
        report_missing(joined(soil.key, key), expected);
      }
    }
  }

  /// Reads the heads that are given in files.
  void read_tables() {
    for (const Instance& boundary : members_of("boundary")) {
      const SceneNode* file = boundary.table->find("file");
      if (!file || !file->accepted) continue;
      const auto& name = std::get<std::string>(*file->accepted);
      const std::optional<std::string> text = load_(name);
      if (!text) {
        report(file->place, joined(boundary.key, "file"), file->shown,
               "a CSV file that can be read, relative to the scene's folder");
        continue;
      }
      files_.emplace(name, *text);
      const std::string shown = file_beside_scene(path_, name);
      TableReading table = read_head_table(*text, shown);
      if (table.problem) {
        problems_.push_back({file->place, *table.problem});
      } else if (!boundary.table->find("head")) {
        scene_.boundaries[boundary.index].head = TimeFunction(std::move(table.rows));
      }
    }
  }

  std::string path_;
  const FileLoader& load_;
  std::map<std::string, std::string> files_;  ///< texts of the files read, by name
  std::set<std::string> plane_vectors_;
  std::vector<Problem> problems_;
  SceneNode root_;
  std::set<std::string> without_inheritance_;  ///< soils whose `like` cannot be followed
  /// Missing required keys and the expected value of each, by soil.
  std::map<std::string, std::vector<std::pair<std::string, std::string>>> missing_;
  std::set<std::string> refused_;  ///< keys whose value is not allowed
  Places places_;
  Scene scene_;
};

}  // namespace

SceneDocument read_document(const std::string& text, const std::string& path,
                            const std::vector<std::string>& overrides, const FileLoader& load) {
  SceneDocument document = SceneReader(text, path, overrides, load).read();
  document.text = text;
  document.overrides = overrides;
  return document;
}

}  // namespace suffuse
