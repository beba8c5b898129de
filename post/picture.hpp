#pragma once

/// Pictures as PNG, SVG or PDF, painted with VTK's 2D context and no X server.

#include <vtkContext2D.h>
#include <vtkContextItem.h>
#include <vtkContextScene.h>

#include <functional>
#include <string>

namespace suffuse {

/// The suffix of `path`: ".png", ".svg" or ".pdf". Throws InputError, naming `command`, for others.
std::string picture_format(const std::string& path,
                           const std::string& command = "suffuse-post figure");

/// Throws InputError when `path` does not end in .png.
void require_png(const std::string& path, const std::string& command);

/// Paints by a function.
class PaintedItem : public vtkContextItem {
 public:
  static PaintedItem* New();
  std::function<void(vtkContext2D&)> paint;
  bool Paint(vtkContext2D* painter) override;
};

/// Adds an item that paints with `paint`, above what is there already.
void add_painted(vtkContextScene& scene, std::function<void(vtkContext2D&)> paint);

/// Where text stands about its position.
enum class Anchor { left, center, right };

/// Black text, centred vertically on y; `angle` in degrees.
void paint_text(vtkContext2D& painter, const std::string& text, int size, float x, float y,
                Anchor anchor = Anchor::center, double angle = 0.0);

/// Paints a white picture of `width` by `height` pixels with what `fill` adds. Pixels count from
/// the bottom left. Throws FileError.
void draw_picture(int width, int height, const std::string& title, const std::string& path,
                  const std::function<void(vtkContextScene&)>& fill);

}  // namespace suffuse
