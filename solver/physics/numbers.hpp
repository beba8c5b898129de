#pragma once

/// Constants of double precision.

#include <limits>

namespace suffuse {

/// The distance from 1 to the next larger double.
inline constexpr double epsilon = std::numeric_limits<double>::epsilon();

inline constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace suffuse
