#include "tools/element_test.hpp"

#include "common/closest_name.hpp"
#include "common/errors.hpp"
#include "files/number_text.hpp"
#include "files/text_output.hpp"
#include "physics/skeleton/soil_element.hpp"
#include "scene/scene_schema.hpp"

namespace suffuse {
namespace {

std::string header(const std::string& moment) {
  std::string text = moment;
  for (const std::string kind : {"stress_", "strain_"}) {
    for (const char* component : component_names) text.append(",").append(kind).append(component);
  }
  return text + ",mean_stress,deviator_stress,volumetric_strain,plastic_strain,fines_left\n";
}

std::string row_of(double moment, const SoilElementState& state) {
  std::string text = number_text(moment);
  const auto add = [&](double value) { text += ',' + number_text(value + 0.0); };  // no -0
  for (const double value : state.stress) add(value);
  for (const double value : state.strain) add(value);
  for (const double value : {state.mean_stress(), state.deviator_stress(),
                             state.volumetric_strain(), state.plastic_strain, state.fines_left}) {
    add(value);
  }
  return text + '\n';
}

/// `xx -1e5, yy -3.53e5, zz -1e5, xy 0 Pa`
std::string shown_stress(const PlaneComponents& stress) {
  std::string text;
  for (std::size_t c = 0; c < component_names.size(); ++c) {
    text += (c == 0 ? "" : ", ") + std::string(component_names[c]) + ' ' +
            short_text(stress[static_cast<int>(c)] + 0.0);  // no -0
  }
  return text + " Pa";
}

PlaneComponents stress_of(const ElementTableRow& row) {
  PlaneComponents stress;
  for (int c = 0; c < 4; ++c) stress[c] = row.stress[c].value_or(0.0);
  return stress;
}

SoilElementTarget target_of(const ElementTableRow& row) {
  SoilElementTarget target{.fines_left = row.fines_left};
  for (int c = 0; c < 4; ++c) {
    target.is_stress[c] = row.stress[c].has_value();
    target.value[c] = row.stress[c].value_or(row.strain[c].value_or(0.0));
  }
  return target;
}

[[noreturn]] void refuse_row(const ElementTable& table, const ElementTableRow& row,
                             const std::string& found, const std::string& expected) {
  throw InputError(InputProblem{.where = table.path + ':' + std::to_string(row.line),
                                .key = {},
                                .found = found,
                                .expected = expected,
                                .suggestion = {}});
}

/// The target at the share `share` of the way to a row.
SoilElementTarget part_of(const SoilElementTarget& whole, const SoilElementState& start,
                          double share) {
  SoilElementTarget part = whole;
  for (int c = 0; c < 4; ++c) {
    const double from = whole.is_stress[c] ? start.stress[c] : start.strain[c];
    part.value[c] = std::lerp(from, whole.value[c], share);
  }
  part.fines_left = std::lerp(start.fines_left, whole.fines_left, share);
  return part;
}

/// Number of increments for a row of the answer: the error of a path that yields falls with it.
int increments_of(const ElementTable& table, int steps) {
  constexpr std::size_t of_row = 1000;
  constexpr std::size_t of_table = 100000;
  const std::size_t wanted = std::min(of_row, of_table / table.rows.size());
  return static_cast<int>(wanted) / steps + 1;
}

/// The soil that is tested. Throws InputError.
const Soil& find_soil(const SceneDocument& document, const std::string& name) {
  std::vector<std::string> moving;
  for (const Soil& soil : document.scene.soils) {
    if (soil.skeleton.moves()) moving.push_back(soil.region);
  }
  if (name.empty() && moving.size() == 1) return *document.scene.find_soil(moving.front());
  const Soil* soil = document.scene.find_soil(name);
  if (soil && soil->skeleton.moves()) return *soil;
  if (moving.empty())
    throw InputError(document.path +
                     ": got no soil with a law of the skeleton; expected one under "
                     "[soil.NAME.skeleton]");
  if (name.empty()) {
    throw InputError(document.path + ": got " + std::to_string(moving.size()) +
                     " soils with a law of the skeleton; expected --soil with " +
                     quoted_list(moving));
  }
  const std::string suggestion = soil ? "" : closest_name(name, moving);
  throw InputError(std::vector{
      InputProblem{.where = document.path,
                   .key = "--soil",
                   .found = shown_value(name) + (soil ? ", whose skeleton is rigid" : ""),
                   .expected = quoted_list(moving),
                   .suggestion = suggestion.empty() ? "" : shown_value(suggestion)}});
}

}  // namespace

std::string element_test(const Soil& soil, const ElementTable& table, int steps) {
  const ElementTableRow& first = table.rows.front();
  SoilElement element(soil.skeleton, stress_of(first), first.fines_left);
  if (!element.is_admissible()) {
    refuse_row(table, first,
               "a stress at the start beyond the strength: " + shown_stress(element.state().stress),
               "one that the soil can carry");
  }
  std::string text = header(table.moment) + row_of(first.moment, element.state());
  for (std::size_t k = 1; k < table.rows.size(); ++k) {
    const ElementTableRow& row = table.rows[k];
    const SoilElementState start = element.state();
    const SoilElementTarget target = target_of(row);
    const int each = increments_of(table, steps);  // per row of the answer
    for (int i = 1; i <= steps * each; ++i) {
      const double share = static_cast<double>(i) / (steps * each);
      if (element.advance(part_of(target, start, share)) < 1.0) {
        refuse_row(table, row,
                   "stresses that the soil cannot carry: it yields on the way to this row at " +
                       shown_stress(element.state().stress) + " with " +
                       short_text(element.state().fines_left) + " of its fines left",
                   "stresses within the strength, or a strain in the place of one of them");
      }
      if (i % each != 0) continue;
      text += row_of(std::lerp(table.rows[k - 1].moment, row.moment, share), element.state());
    }
  }
  return text;
}

void run_element_test(const ElementTestOptions& options) {
  if (options.scene.ends_with(".h5")) {
    throw InputError(options.scene + ": got a case; expected a scene, as --element-test is given");
  }
  const SceneDocument document = read_scene(options.scene, options.overrides);
  const Soil& soil = find_soil(document, options.soil);
  const std::string text = element_test(soil, read_element_table(options.table), options.steps);
  TextOutput(options.output).write(text);
}

}  // namespace suffuse
