#pragma once

/// Channels that erosion has opened: are they as narrow as the mesh lets them be?

#include <optional>

#include "solid/skeleton.hpp"

namespace suffuse {

/// Mean width of the soil that has lost half of its fines, over the mean size of its elements:
/// twice its volume over the area of its border to soil that has not. Soil counts if its erosion
/// depends on the flow, has a threshold and no length. Nothing if too few elements have eroded to
/// say. All ranks have to call it.
template <int Dim>
std::optional<double> relative_channel_width(const Grid<Dim>& grid, const Skeleton<Dim>& solid);

}  // namespace suffuse
