#include "scene/scene_schema.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <type_traits>
#include <utility>

#include "common/short_number.hpp"
#include "scene/law_texts.hpp"

namespace suffuse {
namespace {

bool within(const SceneKey& key, double x) {
  if (std::isinf(x)) return key.infinite_allowed && x > 0.0;
  if (key.lower && (key.lower->open ? x <= key.lower->value : x < key.lower->value)) return false;
  if (key.upper && (key.upper->open ? x >= key.upper->value : x > key.upper->value)) return false;
  return std::isfinite(x);
}

/// The name of a value of this key in messages and in the reference.
std::string quantity_of(const SceneKey& key) {
  // A list of symbols cannot be one quantity between bounds.
  const bool one_symbol = !key.symbol.empty() && key.symbol.find(',') == std::string::npos;
  return one_symbol ? key.symbol : key.leaf();
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '\n') {
      result += "\\n";
    } else if (c == '"' || c == '\\') {
      result += {'\\', c};
    } else {
      result += c;
    }
  }
  return result + '"';
}

}  // namespace

// NOLINTNEXTLINE(readability-function-size): one list, which is read from top to bottom
const std::vector<SceneSection>& scene_sections() {
  static const std::vector<SceneSection> sections = {
      {"", "Top level", "Keys before the first table."},
      {"geometry", "[geometry]", "Either a built-in `shape` or your own `file`."},
      {"geometry.layers", "[geometry.layers]",
       "Rows of elements that a column or a box has beside its specimen, each as high as a row of "
       "the "
       "specimen. In this order from top to bottom, the specimen between `above` and `below`. "
       "Double-point only."},
      {"mesh", "[mesh]", "Linear triangles or tetrahedra."},
      {"points", "[points]", "Material points."},
      {"liquid", "[liquid]", "Weakly compressible or incompressible water."},
      {"soil.*", "[soil.NAME]",
       "One table per region, NAME being the region's. In double-point scenes, and where a "
       "skeleton "
       "moves, the regions `inflow`, `outflow`, `free_above` and `free_below`, of a column or of "
       "your own file, need none: without a soil they are free water, n_L = 1, or air where a soil "
       "has a retention."},
      {"soil.*.erosion", "[soil.NAME.erosion]",
       "How fines of this soil turn into fluidised grains: phi_e = state . rate . <D - D_cr> . "
       "<1 - c/c_cr>, <x> = max(x, 0). The state comes from the law, D is the drive. n_e = "
       "n_L,max - n_L is what can erode, n_L,max = 1 - n_C; deposits join it."},
      {"soil.*.deposition", "[soil.NAME.deposition]",
       "How this soil catches fluidised grains: phi_d = lambda_d |q| c, times the room that is "
       "left."},
      {"soil.*.field", "[soil.NAME.field]",
       "A conductivity that varies at random from place to place. Single-point, rigid soil with "
       "Darcy's drag only."},
      {"soil.*.retention", "[soil.NAME.retention]",
       "How much liquid the pores of this soil hold under suction, psi = p/(rho_w g) < 0, and how "
       "well it then conducts: S = S_r + (1 - S_r) S_e, conductivity k_r k. Without this table the "
       "soil is saturated at any pressure."},
      {"soil.*.skeleton", "[soil.NAME.skeleton]",
       "How the skeleton of this soil deforms and fails, in effective stress. Without this table "
       "it is rigid. Some values may change as fines leave: pairs `[[share, value], ...]` of the "
       "share of the erodible fines that is left (1: all, 0: none), linear between them, constant "
       "beyond the first and the last."},
      {"boundary[]", "[[boundary]]",
       "One entry per named boundary, with at most one of `pressure`, `velocity`, `darcy_flux`, "
       "`head` (or `file`), `seepage_face` and `rain`; without one it is impervious, as are "
       "boundaries without an entry. `fix` and `traction` hold or load the soil. Each value "
       "is a number, or changes in time: "
       "pairs `[[t, value], ...]`, linear between them, constant before the first and after the "
       "last; two pairs at nearly the same time, such as 5 and 5.001 s, make a jump."},
      {"wall[]", "[[wall]]",
       "Walls without thickness, such as sheet piles, on named curves inside the mesh: neither "
       "water nor grains get through, but for what the conductance says. They stand still: soil "
       "that moves slides along them."},
      {"well[]", "[[well]]",
       "Wells and drains on named curves or points inside the mesh, each with one of `head`, "
       "`rate` and `seepage_face`. Values may change in time as those of boundaries. They stand "
       "still: soil that moves slides along them, and those on a point are refused beside it."},
      {"initial", "[initial]", "State at the start."},
      {"flow", "[flow]", "Variants of the flow."},
      {"time", "[time]", "Time stepping."},
      {"output", "[output]", "What is written, and when."},
      {"output.probe[]", "[[output.probe]]", "Points whose state is recorded in probes.csv."},
      {"output.section[]", "[[output.section]]",
       "Lines whose discharge is recorded in sections.csv."},
      {"check", "[check]",
       "What `suffuse-post check` makes of the run: checks of standards. They change no result, "
       "and "
       "`suffuse-post check --set KEY=VALUE` changes them after the run."},
      {"check.heave", "[check.heave]", "Hydraulic heave at exits, EN 1997-1."},
      {"check.uplift", "[check.uplift]", "Uplift of a cover, EN 1997-1."},
      {"check.backward_erosion", "[check.backward_erosion]",
       "Backward erosion below a roof, by Sellmeijer and others (2011)."},
      {"check.blanket", "[check.blanket]",
       "Head below the cover at the landside toe of a levee, by blanket theory (EM 1110-2-1913)."},
  };
  return sections;
}

const SceneKey* find_scene_key(const std::string& pattern) {
  const auto found = std::ranges::find(scene_keys(), pattern, &SceneKey::pattern);
  return found == scene_keys().end() ? nullptr : &*found;
}

std::vector<std::string> scene_children(const std::string& pattern) {
  std::vector<std::string> children;
  for (const SceneKey& key : scene_keys()) {
    if (!key.pattern.starts_with(pattern)) continue;
    std::string rest = key.pattern.substr(pattern.size());
    if (!pattern.empty()) {
      if (rest.starts_with('.')) {
        rest.erase(0, 1);
      } else if (!rest.starts_with("[]")) {
        continue;
      }
    }
    const std::string child =
        rest.starts_with("[]") ? "[]" : rest.substr(0, rest.find_first_of(".["));
    if (!std::ranges::count(children, child)) children.push_back(child);
  }
  return children;
}

std::string joined(const std::string& parent, const std::string& child) {
  return parent.empty() || child.starts_with('[') ? parent + child : parent + '.' + child;
}

std::string SceneKey::leaf() const {
  return pattern.substr(pattern.rfind('.') + 1);
}

std::string SceneKey::bounds() const {
  const std::string quantity = quantity_of(*this);
  const auto relation = [](const Bound& bound, const char* strict, const char* weak) {
    return std::string(bound.open ? strict : weak);
  };
  if (lower && upper) {
    return shown_number(lower->value) + relation(*lower, " < ", " <= ") + quantity +
           relation(*upper, " < ", " <= ") + shown_number(upper->value);
  }
  if (lower) return quantity + relation(*lower, " > ", " >= ") + shown_number(lower->value);
  if (upper) return quantity + relation(*upper, " < ", " <= ") + shown_number(upper->value);
  return {};
}

std::string SceneKey::expected() const {
  const std::string limits = bounds().empty() ? "" : " with " + bounds();
  const std::string measure = unit.empty() ? "" : ", in " + unit;
  std::vector<std::string> all;
  switch (kind) {
    case ValueKind::text:
      return "a text that is not empty";
    case ValueKind::word:
      for (const std::string& word : words) all.push_back(quoted(word));
      return listed(all);
    case ValueKind::number:
      return "a number" + limits + measure + (infinite_allowed ? ", or inf" : "");
    case ValueKind::number_or_pair:
      return "a number" + limits + measure +
             ", or a pair of such numbers, along and across bedding";
    case ValueKind::number_or_word:
      for (const std::string& word : words) all.push_back(quoted(word));
      return listed(all) + ", or a number" + limits + measure;
    case ValueKind::vector_function:
      return "an array of 2 or 3 numbers" + measure +
             ", or such arrays behind times, [[t, x, y], ...] (s, ascending)";
    case ValueKind::function:
      return "a number" + limits + measure + ", or pairs [[" + argument + ", " +
             quantity_of(*this) + "], ...] of " + arguments + " and such numbers";
    case ValueKind::gradation:
      return "at least 3 pairs [[d, F], ...] of sizes (1e-6 to 1e6 mm, ascending) and per cent "
             "finer by mass "
             "(0 to 100, never falling, 100 at the last)";
    case ValueKind::integer:
      for (const std::int64_t integer : integers) all.push_back(std::to_string(integer));
      return all.empty() ? "an integer" + limits : listed(all);
    case ValueKind::boolean:
      return "true or false";
    case ValueKind::vector:
      return "an array of 2 or 3 numbers" + measure;
  }
  return {};
}

std::optional<Value> SceneKey::accept_number(const Value& value) const {
  const auto* real = std::get_if<double>(&value);
  const auto* integer = std::get_if<std::int64_t>(&value);
  if (!real && !integer) return std::nullopt;
  const double x = real ? *real : static_cast<double>(*integer);
  return within(*this, x) ? std::optional<Value>(x) : std::nullopt;
}

std::optional<Value> SceneKey::accept(const Value& value) const {
  const auto* text = std::get_if<std::string>(&value);
  const auto* integer = std::get_if<std::int64_t>(&value);
  const auto* numbers = std::get_if<std::vector<double>>(&value);
  bool accepted = false;
  switch (kind) {
    case ValueKind::text:
      accepted = text && !text->empty();
      break;
    case ValueKind::word:
      accepted = text && std::ranges::count(words, *text);
      break;
    case ValueKind::integer:
      accepted = integer && std::in_range<int>(*integer) &&
                 within(*this, static_cast<double>(*integer)) &&
                 (integers.empty() || std::ranges::count(integers, *integer));
      break;
    case ValueKind::boolean:
      accepted = std::holds_alternative<bool>(value);
      break;
    case ValueKind::number_or_pair:
      if (numbers) {
        accepted = numbers->size() == 2 &&
                   std::ranges::all_of(*numbers, [this](double x) { return within(*this, x); });
        break;
      }
      return accept_number(value);
    case ValueKind::number_or_word:
      if (!text) return accept_number(value);
      accepted = std::ranges::count(words, *text) > 0;
      break;
    case ValueKind::vector_function:
      if (const auto* rows = std::get_if<Rows>(&value)) {
        accepted = !rows->empty() && fault(value).empty();
        break;
      }
      [[fallthrough]];
    case ValueKind::vector:
      accepted = numbers && (numbers->size() == 2 || numbers->size() == 3) &&
                 std::ranges::all_of(*numbers, [](double x) { return std::isfinite(x); });
      break;
    case ValueKind::function:
      if (const auto* rows = std::get_if<Rows>(&value)) {
        accepted = !rows->empty() && fault(value).empty();
        break;
      }
      return accept_number(value);
    case ValueKind::gradation:
      accepted = std::holds_alternative<Rows>(value) && fault(value).empty();
      break;
    case ValueKind::number:
      return accept_number(value);
  }
  return accepted ? std::optional<Value>(value) : std::nullopt;
}

std::string SceneKey::fault(const Value& value) const {
  const auto* rows = std::get_if<Rows>(&value);
  if (kind == ValueKind::gradation && rows) return gradation_fault(*rows);
  if (!rows || rows->empty()) return {};
  return kind == ValueKind::function || kind == ValueKind::vector_function ? fault_of_pairs(*rows)
                                                                           : "";
}

std::string SceneKey::fault_of_pairs(const Rows& rows) const {
  const bool of_vectors = kind == ValueKind::vector_function;
  const bool descends = argument_is_share && rows.size() > 1 && !rows.front().empty() &&
                        !rows[1].empty() && rows[1].front() < rows.front().front();
  const std::size_t width = of_vectors && rows.front().size() == 4 ? 4 : of_vectors ? 3 : 2;
  const std::vector<double>* earlier = nullptr;
  for (const std::vector<double>& row : rows) {
    if (row.size() != width) {
      return "entry " + std::to_string(&row - rows.data() + 1) + ", " + shown_value(row);
    }
    std::string place = argument + " = " + shown_number(row[0]);
    if (!std::isfinite(row[0])) return place;
    if (argument_is_share && (row[0] < 0.0 || row[0] > 1.0)) return place;
    if (earlier && argument_is_share && row[0] == earlier->front()) return place + " twice";
    if (earlier && (descends ? row[0] >= earlier->front() : row[0] <= earlier->front())) {
      return out_of_order(argument, row[0], earlier->front());
    }
    for (std::size_t k = 1; k < width; ++k) {
      if (!within(*this, row[k])) {
        return quantity_of(*this) + " = " + shown_number(row[k]) + " at " + place;
      }
    }
    earlier = &row;
  }
  return {};
}

std::string shown_name(const std::string& name) {
  const auto is_bare = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; };
  return !name.empty() && std::ranges::all_of(name, is_bare) ? name : quoted(name);
}

std::string shown_number(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  std::string text(buffer.data(), end);
  // Shortens 2e+07 to 2e7.
  const std::size_t exponent = text.find('e');
  if (exponent == std::string::npos) return text;
  const bool negative = text[exponent + 1] == '-';
  const std::size_t digits = text.find_first_not_of("+-0", exponent + 1);
  return text.substr(0, exponent + 1) + (negative ? "-" : "") + text.substr(digits);
}

std::string shown_value(const Value& value) {
  if (const auto* boolean = std::get_if<bool>(&value)) return *boolean ? "true" : "false";
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return std::to_string(*integer);
  if (const auto* text = std::get_if<std::string>(&value)) return quoted(*text);
  if (const auto* real = std::get_if<double>(&value)) {
    const std::string text = shown_number(*real);
    const bool looks_integer = text.find_first_not_of("-0123456789") == std::string::npos;
    return looks_integer ? text + ".0" : text;
  }
  std::string text;
  const auto add = [&text](const Value& item) {
    text += (text.empty() ? "" : ", ") + shown_value(item);
  };
  if (const auto* rows = std::get_if<Rows>(&value)) {
    for (const auto& row : *rows) add(row);
  } else {
    for (const double x : std::get<std::vector<double>>(value)) add(x);
  }
  return '[' + text + ']';
}

std::string out_of_order(const std::string& argument, double value, double earlier) {
  const std::string found = argument + " = " + shown_number(value);
  if (value != earlier) return found + " after " + argument + " = " + shown_number(earlier);
  // A slightly larger argument with few digits.
  const double later =
      std::stod(short_number(value + 1e-4 * (value == 0.0 ? 1.0 : std::abs(value))));
  return found + " twice (for a jump give " + shown_number(value) + " and " + shown_number(later) +
         ")";
}

std::string listed(const std::vector<std::string>& items, const std::string& last_joint) {
  std::string text;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (i > 0) text += i + 1 == items.size() ? ' ' + last_joint + ' ' : ", ";
    text += items[i];
  }
  return text;
}

}  // namespace suffuse
