#include "drawing/color_map.hpp"

#include <algorithm>
#include <cmath>

namespace suffuse {

Color viridis(double fraction) {
  // Coefficients, the highest power first.
  constexpr std::array<Color, 7> coefficients{
      {{-5.435455855934631, 4.645852612178535, 26.3124352495832},
       {4.776384997670288, -13.74514537774601, -65.35303263337234},
       {6.228269936347081, 14.17993336680509, 56.69055260068105},
       {-4.634230498983486, -5.799100973351585, -19.33244095627987},
       {-0.3308618287255563, 0.214847559468213, 0.09509516302823659},
       {0.1050930431085774, 1.404613529898575, 1.384590162594685},
       {0.2777273272234177, 0.005407344544966578, 0.3340998053353061}}};
  const double x = std::clamp(fraction, 0.0, 1.0);
  Color color{};
  for (int k = 0; k < 3; ++k) {
    double value = 0.0;
    for (const auto& coefficient : coefficients) value = value * x + coefficient.at(k);
    color.at(k) = std::clamp(value, 0.0, 1.0);
  }
  return color;
}

Color region_color(std::size_t number, std::size_t count) {
  if (count < 2) return viridis(0.7);
  return viridis(0.15 + 0.85 * static_cast<double>(number) / static_cast<double>(count - 1));
}

unsigned char byte_of(double part) {
  return static_cast<unsigned char>(std::lround(255.0 * part));
}

double luminance(const Color& color) {
  return 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2];
}

}  // namespace suffuse
