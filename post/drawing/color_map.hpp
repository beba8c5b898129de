#pragma once

/// The colour map of fields: a number between 0 and 1 becomes a colour.

#include <cstddef>

#include "drawing/chart.hpp"

namespace suffuse {

/// Viridis at `fraction`, which is limited to 0 to 1. Its luminance rises all the way, so that the
/// map can be read in grey print. Polynomial of sixth degree by M. Zucker (2019), fitted to the map
/// of S. van der Walt and N. Smith (2015).
Color viridis(double fraction);

/// The colour of one of `count` regions. No two are alike, in grey either.
Color region_color(std::size_t number, std::size_t count);

/// A colour's part, 0 to 1, as a byte.
unsigned char byte_of(double part);

/// Luminance of a colour, 0 to 1 (Rec. 709).
double luminance(const Color& color);

}  // namespace suffuse
