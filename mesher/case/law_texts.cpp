#include "case/law_texts.hpp"

namespace suffuse {
namespace {

/// Every parameter that some law asks for, each key once.
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

/// Words of the laws that ask for a key.
template <class Law>
std::vector<std::string> words_with(std::span<const Law* const> laws, std::string_view key) {
  std::vector<std::string> words;
  for (const Law* law : laws) {
    const auto asks = [&](const auto& p) { return p.key == key; };
    if (std::ranges::any_of(law->parameters, asks)) words.emplace_back(law->word);
  }
  return words;
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
  std::string common;
  std::vector<std::string> others;
  for (const ErosionLaw* law : erosion_laws()) {
    if (!law->erodes()) continue;
    if (common.empty()) common = law->rate_unit;
    if (law->rate_unit == common) continue;
    others.push_back(std::string(law->rate_symbol) + ": " + std::string(law->rate_unit));
  }
  return others.empty() ? common : common + " (" + chained(others, ", ", ", ") + ")";
}

std::vector<ErosionParameter> erosion_parameters() {
  return parameters_of<ErosionParameter>(erosion_laws());
}

std::vector<std::string> laws_with_parameter(std::string_view key) {
  return words_with(erosion_laws(), key);
}

std::vector<RetentionParameter> retention_parameters() {
  return parameters_of<RetentionParameter>(retention_laws());
}

std::vector<std::string> laws_with_retention_parameter(std::string_view key) {
  return words_with(retention_laws(), key);
}

}  // namespace suffuse
