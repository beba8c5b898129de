#pragma once

/// Texts about the laws, for the scene reference and for messages, from what each law declares.

#include <algorithm>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "physics/erosion/erosion_law.hpp"
#include "physics/retention/retention_law.hpp"

namespace suffuse {

/// One member of every law, in their order.
template <class Law>
std::vector<std::string> texts_of(std::span<const Law* const> laws, std::string_view Law::*member) {
  std::vector<std::string> texts;
  for (const Law* law : laws) texts.emplace_back(law->*member);
  return texts;
}

/// `a, b, c`, with other separators where given.
std::string chained(const std::vector<std::string>& texts, const std::string& separator,
                    const std::string& last_separator);

/// Symbols of the rates: `alpha`, `beta`, ...
std::vector<std::string> rate_symbols();
/// Unit of the rates, that of the first law with the laws that differ: `1/s (lambda: 1/m)`.
std::string rate_unit();

/// Every parameter that some erosion law asks for, each key once.
std::vector<ErosionParameter> erosion_parameters();
/// Words of the erosion laws that ask for this key.
std::vector<std::string> laws_with_parameter(std::string_view key);

/// The same of the retention laws.
std::vector<RetentionParameter> retention_parameters();
std::vector<std::string> laws_with_retention_parameter(std::string_view key);

}  // namespace suffuse
