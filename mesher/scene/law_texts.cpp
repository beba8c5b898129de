#include "scene/law_texts.hpp"

namespace suffuse {
namespace {

/// All parameters of the laws, each key once.
template <class Parameter, class Law>
std::vector<Parameter> parameters_of(std::span<const Law* const> laws) {
  std::vector<Parameter> all;
  for (const Law* law : laws) {
    for (const Parameter& own : law->parameters) {
      const bool known = std::ranges::any_of(all, [&](const auto& p) { return p.key == own.key; });
      if (!known) all.push_back(own);
    }
  }
  return all;
}

/// Words of the laws with a parameter.
template <class Law>
std::vector<std::string> words_with(std::span<const Law* const> laws, std::string_view key) {
  std::vector<std::string> words;
  for (const Law* law : laws) {
    const auto asks = [&](const auto& p) { return p.key == key; };
    if (std::ranges::any_of(law->parameters, asks)) words.emplace_back(law->word);
  }
  return words;
}

std::string with_drive(const DriveLaw& drive, std::string_view unit) {
  return '"' + std::string(drive.word) + "\": " + std::string(unit);
}

}  // namespace

std::string chained(const std::vector<std::string>& texts, const std::string& separator,
                    const std::string& last_separator) {
  std::string result;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    if (i > 0) result += i + 1 == texts.size() ? last_separator : separator;
    result += texts[i];
  }
  return result;
}

std::vector<std::string> rate_symbols() {
  std::vector<std::string> symbols;
  for (const ErosionLaw* law : erosion_laws()) {
    if (law->erodes()) symbols.emplace_back(law->rate_symbol);
  }
  return symbols;
}

std::string rate_unit() {
  std::vector<std::string> others;
  const std::string_view common = drive_laws().front()->rate_unit;
  for (const DriveLaw* drive : drive_laws()) {
    if (drive->rate_unit != common) others.push_back(with_drive(*drive, drive->rate_unit));
  }
  return std::string(common) + " (" + chained(others, ", ", ", ") + ")";
}

std::string threshold_unit() {
  std::vector<std::string> units;
  for (const DriveLaw* drive : drive_laws()) {
    if (drive->depends_on_flow()) units.push_back(with_drive(*drive, drive->unit));
  }
  return chained(units, ", ", ", ");
}

std::vector<ConductivityParameter> conductivity_parameters() {
  return parameters_of<ConductivityParameter>(conductivity_laws());
}

std::vector<std::string> laws_with_conductivity_parameter(std::string_view key) {
  return words_with(conductivity_laws(), key);
}

std::vector<RetentionParameter> retention_parameters() {
  return parameters_of<RetentionParameter>(retention_laws());
}

std::vector<std::string> laws_with_retention_parameter(std::string_view key) {
  return words_with(retention_laws(), key);
}

std::vector<SkeletonParameter> skeleton_parameters() {
  return parameters_of<SkeletonParameter>(skeleton_laws());
}

std::vector<std::string> laws_with_skeleton_parameter(std::string_view key) {
  return words_with(skeleton_laws(), key);
}

}  // namespace suffuse
