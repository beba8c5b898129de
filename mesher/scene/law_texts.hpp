#pragma once

/// Texts about the laws from their declarations, for the scene reference and for messages.

#include <algorithm>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "physics/exchange.hpp"
#include "physics/retention/retention_law.hpp"
#include "physics/skeleton/skeleton_law.hpp"

namespace suffuse {

/// One member of every law, in the order of the laws.
template <class Law>
std::vector<std::string> texts_of(std::span<const Law* const> laws, std::string_view Law::*member) {
  std::vector<std::string> texts;
  for (const Law* law : laws) texts.emplace_back(law->*member);
  return texts;
}

/// `"constant": 1; "first-order": n_e`: the word of each law and a member of it.
template <class Law>
std::string described(std::span<const Law* const> laws, std::string_view Law::*member) {
  std::string text;
  for (const Law* law : laws) {
    text += (text.empty() ? "\"" : "; \"") + std::string(law->word) + "\": ";
    text += law->*member;
  }
  return text;
}

/// `a, b, c`, or with other separators.
std::string chained(const std::vector<std::string>& texts, const std::string& separator,
                    const std::string& last_separator);

/// Symbols of the rates: `alpha`, `beta`, ...
std::vector<std::string> rate_symbols();
/// Unit of the rate for the first drive, then the units that differ: `1/s ("flux": 1/m)`.
std::string rate_unit();
/// Units of the threshold: `"flux": m/s, ...`.
std::string threshold_unit();

/// All parameters of the conductivity laws, each key once.
std::vector<ConductivityParameter> conductivity_parameters();
/// Words of the conductivity laws with this parameter.
std::vector<std::string> laws_with_conductivity_parameter(std::string_view key);

/// All parameters of the retention laws, and the words of the laws with a parameter.
std::vector<RetentionParameter> retention_parameters();
std::vector<std::string> laws_with_retention_parameter(std::string_view key);

/// All parameters of the laws of the skeleton, and the words of the laws with a parameter.
std::vector<SkeletonParameter> skeleton_parameters();
std::vector<std::string> laws_with_skeleton_parameter(std::string_view key);

}  // namespace suffuse
