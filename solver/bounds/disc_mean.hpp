#pragma once

/// The mean of a field over a disc, as a sum over elements.

#include <vector>

#include "grid/grid.hpp"
#include "grid/point_place.hpp"

namespace suffuse {

template <int Dim>
struct DiscMean {
  struct Share {
    int element;
    double share;        ///< of the mean
    Vector<Dim> offset;  ///< of the centroid of its part in the disc from its own, m
  };

  double radius = 0.0;  ///< m
  std::vector<Share> shares;
};

/// Mean over a disc (in three dimensions a ball) around a place: over its part that is connected to
/// the place within the mesh, not through walls. The disc is larger than `radius`, m, where its
/// element is.
template <int Dim>
DiscMean<Dim> disc_mean(const Grid<Dim>& grid, const PointPlace<Dim>& place, double radius);

}  // namespace suffuse
