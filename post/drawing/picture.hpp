#pragma once

/// Pictures as PNG, SVG or PDF, painted with VTK's 2D context. No X server is needed.

#include <vtkContext2D.h>
#include <vtkContextItem.h>
#include <vtkContextScene.h>

#include <functional>
#include <string>

namespace suffuse {

/// The suffix of `path`: ".png", ".svg" or ".pdf". Throws InputError, naming `command`, for other
/// suffixes.
std::string picture_format(const std::string& path,
                           const std::string& command = "suffuse-post figure");

/// An item of a VTK scene that calls a function to paint itself.
class PaintedItem : public vtkContextItem {
 public:
  static PaintedItem* New();
  std::function<void(vtkContext2D&)> paint;
  bool Paint(vtkContext2D* painter) override;
};

/// Adds an item that paints with `paint`, over the items added before.
void add_painted(vtkContextScene& scene, std::function<void(vtkContext2D&)> paint);

/// The end of a text that is at the given position.
enum class Anchor { left, center, right };

/// Paints black text, centred vertically on y; `size` in pixels, `angle` in degrees.
void paint_text(vtkContext2D& painter, const std::string& text, int size, float x, float y,
                Anchor anchor = Anchor::center, double angle = 0.0);

class SpaceDrawing;

/// Writes a white picture of `width` by `height` pixels with the items that `fill` adds. Pixels
/// count from the bottom left; `title` goes into the metadata. Models in space, for PNG only, are
/// drawn below the items. Throws InputError for an unknown suffix, FileError.
void draw_picture(int width, int height, const std::string& title, const std::string& path,
                  const std::function<void(vtkContextScene&)>& fill,
                  const SpaceDrawing* space = nullptr);

}  // namespace suffuse
