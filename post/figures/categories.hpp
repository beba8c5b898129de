#pragma once

/// Fields whose values stand for kinds, each kind with a name and a colour.

#include <string>
#include <vector>

#include "drawing/chart.hpp"
#include "values/fields.hpp"

namespace suffuse {

/// One value of a field whose values stand for kinds, with its name and colour.
struct Category {
  double value;
  std::string name;
  Color color;
};

/// The kinds of `saturation_state` and `region`; empty for all other fields.
std::vector<Category> categories(const ResultsReader& results, const FieldPlace& place);

}  // namespace suffuse
