#pragma once

#include "case/case_file.hpp"

namespace suffuse {

/// Height along gravity of the soil that can yield, m; 0 without gravity.
template <int Dim>
double height_that_yields(const Case<Dim>& c);

}  // namespace suffuse
