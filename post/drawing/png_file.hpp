#pragma once

/// PNG files of equal size, and films made of them.

#include <array>
#include <string>
#include <vector>

namespace suffuse {

/// Width and height, pixels. Throws FileError where the file is no PNG.
std::array<int, 2> png_size(const std::string& path);

/// Makes the pictures as wide as the widest and as high as the highest, by white room to the right
/// and beneath. Throws FileError.
void make_equal_size(const std::vector<std::string>& paths);

/// Joins pictures of one size into an animated PNG that starts over and over again. A program that
/// does not know such files shows the first picture. `rate`: pictures per second, 1 to 65535.
/// Throws FileError. Source: https://www.w3.org/TR/png-3/ (chunks acTL, fcTL, fdAT).
void write_animated_png(const std::vector<std::string>& pictures, int rate,
                        const std::string& path);

}  // namespace suffuse
