#pragma once

/// Liquid points that cross borders of regions.

namespace suffuse {

/// A point that changed its region; -1 is outside.
struct PointCrossing {
  int from;
  int to;
  int entered_by;     ///< outer face, -1: none
  int left_by;        ///< likewise
  double water_mass;  ///< kg
  double fines_mass;  ///< kg
};

}  // namespace suffuse
