#pragma once

/// Sizes of text in charts and maps, pixels.

namespace suffuse {

inline constexpr int font_size = 18;
/// Width of a letter in the widest font that viewers use in place of Helvetica.
inline constexpr float letter_width = 0.56F * font_size;
/// Height of one row of a map's legend.
inline constexpr float legend_row = 30.0F;

}  // namespace suffuse
