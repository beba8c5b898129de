#pragma once

#include <string>

#include "common/short_number.hpp"
#include "mesh/mesh.hpp"

namespace suffuse {

/// A place as text for messages: `(1, 2)`.
template <int Dim>
std::string place_text(const Vector<Dim>& x) {
  std::string text = "(" + short_number(x[0]);
  for (int d = 1; d < Dim; ++d) text += ", " + short_number(x[d]);
  return text + ")";
}

}  // namespace suffuse
