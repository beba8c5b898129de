#pragma once

/// Pixels of a PNG file.

#include <gtest/gtest.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>
#include <Eigen/Core>

#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "drawing/chart.hpp"

namespace suffuse::testing {

class Pixels {
 public:
  explicit Pixels(const std::string& path) {
    vtkNew<vtkPNGReader> reader;
    reader->SetFileName(path.c_str());
    reader->Update();
    auto* image = reader->GetOutput();
    width_ = image->GetDimensions()[0];
    height_ = image->GetDimensions()[1];
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        std::array<int, 3> color{};
        for (int k = 0; k < 3; ++k) {
          color.at(k) = static_cast<int>(image->GetScalarComponentAsDouble(x, y, 0, k));
        }
        colors_.push_back(color);
      }
    }
  }

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  /// 0 to 255 each, from the bottom left.
  [[nodiscard]] std::array<int, 3> at(int x, int y) const { return colors_.at(y * width_ + x); }
  [[nodiscard]] std::array<int, 3> at(const Eigen::Vector2d& pixel) const {
    return at(static_cast<int>(std::floor(pixel[0])), static_cast<int>(std::floor(pixel[1])));
  }
  /// Number of pixels that are not white.
  [[nodiscard]] int inked() const {
    int count = 0;
    for (const auto& color : colors_) count += color == std::array<int, 3>{255, 255, 255} ? 0 : 1;
    return count;
  }
  [[nodiscard]] std::size_t color_count() const {
    return std::set<std::array<int, 3>>(colors_.begin(), colors_.end()).size();
  }

 private:
  int width_ = 0;
  int height_ = 0;
  std::vector<std::array<int, 3>> colors_;
};

/// Compares a colour of the picture with the intended one, up to rounding.
inline void expect_color(const std::array<int, 3>& found, const Color& meant,
                         const std::string& where) {
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(found.at(k), 255.0 * meant.at(k), 4.0) << where << ", part " << k;
  }
}

}  // namespace suffuse::testing
