#pragma once

/// Suction that soil does not have: full of water under it, or beside a boundary that takes more
/// water than the soil gives.

#include <string>
#include <vector>

#include "boundary/face_conditions.hpp"
#include "solid/soil_map.hpp"

namespace suffuse {

/// The pressures at one time.
struct PressuresAt {
  double time = 0.0;                    ///< s
  const std::vector<double>& pressure;  ///< per element, Pa
};

/// Warns of soil without retention under suction; empty: there is none. All ranks have to call it.
template <int Dim>
std::string suction_warning(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                            const PressuresAt& now);

/// Throws NumericalError where a prescribed flux leaves soil that has no conductivity left: it
/// would take water that does not flow there. All ranks have to call it.
template <int Dim>
void refuse_dry_outflow(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                        const std::vector<FaceCondition>& conditions, const PressuresAt& now);

}  // namespace suffuse
