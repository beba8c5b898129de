#include "drawing/picture.hpp"

#include <vtkBrush.h>
#include <vtkContextActor.h>
#include <vtkGL2PSExporter.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPNGWriter.h>
#include <vtkPen.h>
#include <vtkRenderer.h>
#include <vtkTextProperty.h>
#include <vtkWindowToImageFilter.h>

#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "common/errors.hpp"
#include "common/pending_file.hpp"
#include "drawing/offscreen_window.hpp"
#include "drawing/space.hpp"
#include "drawing/vtk_messages.hpp"

namespace suffuse {
namespace {

InputError wrong_format(const std::string& path, const std::string& command,
                        const std::string& expected) {
  return InputError(InputProblem{command, "-o", "\"" + path + "\"", expected});
}

void write_png(vtkRenderWindow& window, const std::string& path) {
  vtkNew<vtkWindowToImageFilter> image;
  image->SetInput(&window);
  image->SetInputBufferTypeToRGB();
  image->ReadFrontBufferOff();
  vtkNew<vtkPNGWriter> writer;
  writer->SetFileName(path.c_str());
  writer->SetInputConnection(image->GetOutputPort());
  writer->Write();
}

/// Writes SVG or PDF, with curves as curves and text as text.
void write_vector(vtkRenderWindow& window, const std::string& title, const std::string& path) {
  const std::filesystem::path file(path);
  vtkNew<vtkGL2PSExporter> exporter;
  exporter->SetRenderWindow(&window);
  // The exporter appends the suffix itself.
  exporter->SetFilePrefix((file.parent_path() / file.stem()).string().c_str());
  if (file.extension() == ".svg") {
    exporter->SetFileFormatToSVG();
  } else {
    exporter->SetFileFormatToPDF();
  }
  exporter->SetTitle(title.c_str());
  if (file.extension() == ".svg") exporter->CompressOff();
  exporter->SilentOn();      // it would warn that SVG has no background colour
  exporter->SetSortToOff();  // what is drawn later lies on top
  exporter->TextAsPathOff();
  exporter->Write();
}

/// Throws FileError when `file` does not end as it must: the exporter does not report a full disk.
void expect_end(const std::string& file, const std::string& end, const std::string& path) {
  std::ifstream in(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) {
    text.pop_back();
  }
  if (!text.ends_with(end)) {
    throw FileError(path + ": could not be written whole; is the disk full?");
  }
}

/// A renderer in the window for one picture.
class WindowRenderer {
 public:
  explicit WindowRenderer(vtkRenderWindow& window) : window_(window) {
    window_.AddRenderer(renderer_);
  }
  WindowRenderer(const WindowRenderer&) = delete;
  WindowRenderer& operator=(const WindowRenderer&) = delete;
  ~WindowRenderer() { window_.RemoveRenderer(renderer_); }
  [[nodiscard]] vtkRenderer& renderer() const { return *renderer_; }

 private:
  vtkRenderWindow& window_;
  vtkNew<vtkRenderer> renderer_;
};

/// Paints a white background, so that pictures can be read on dark pages.
void paint_paper(vtkContext2D& painter, int width, int height) {
  painter.GetPen()->SetLineType(vtkPen::NO_PEN);
  painter.GetBrush()->SetColorF(1.0, 1.0, 1.0);
  painter.DrawRect(0.0F, 0.0F, static_cast<float>(width), static_cast<float>(height));
  painter.GetPen()->SetLineType(vtkPen::SOLID_LINE);
}

}  // namespace

vtkStandardNewMacro(PaintedItem);

bool PaintedItem::Paint(vtkContext2D* painter) {
  paint(*painter);
  return true;
}

void add_painted(vtkContextScene& scene, std::function<void(vtkContext2D&)> paint) {
  vtkNew<PaintedItem> item;
  item->paint = std::move(paint);
  scene.AddItem(item);
}

std::string picture_format(const std::string& path, const std::string& command) {
  std::string suffix = std::filesystem::path(path).extension().string();
  if (suffix == ".png" || suffix == ".svg" || suffix == ".pdf") return suffix;
  throw wrong_format(path, command, "a name that ends in .png, .svg or .pdf");
}

void paint_text(vtkContext2D& painter, const std::string& text, int size, float x, float y,
                Anchor anchor, double angle) {
  vtkNew<vtkTextProperty> style;
  style->SetFontSize(size);
  style->SetOrientation(angle);
  style->SetColor(0.0, 0.0, 0.0);
  style->SetVerticalJustificationToCentered();
  if (anchor == Anchor::left) {
    style->SetJustificationToLeft();
  } else if (anchor == Anchor::right) {
    style->SetJustificationToRight();
  } else {
    style->SetJustificationToCentered();
  }
  painter.ApplyTextProp(style);
  painter.DrawString(x, y, text.c_str());
}

void draw_picture(int width, int height, const std::string& title, const std::string& path,
                  const std::function<void(vtkContextScene&)>& fill, const SpaceDrawing* space) {
  const std::string format = picture_format(path);
  PendingFile file(path);
  vtkGenericOpenGLRenderWindow& window = offscreen_window(width, height);
  const VtkMessages messages;

  const WindowRenderer in_window(window);
  vtkRenderer& renderer = in_window.renderer();
  renderer.SetBackground(1.0, 1.0, 1.0);
  vtkNew<vtkContextActor> actor;
  if (space != nullptr) {
    space->add_to(renderer, width, height);
  } else {
    add_painted(*actor->GetScene(),
                [&](vtkContext2D& painter) { paint_paper(painter, width, height); });
  }
  fill(*actor->GetScene());
  actor->GetScene()->SetRenderer(&renderer);
  renderer.AddActor(actor);
  window.Render();
  if (format == ".png") {
    write_png(window, file.temporary_path());
  } else {
    write_vector(window, title, file.temporary_path());
    expect_end(file.temporary_path(), format == ".svg" ? "</svg>" : "%%EOF", path);
  }
  messages.throw_errors(path);
  file.commit();
}

}  // namespace suffuse
