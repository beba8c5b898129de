#pragma once

/// A VTK render window that draws into memory with no X server.

#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkSmartPointer.h>

#include <memory>

namespace suffuse {

/// An OpenGL context of EGL's surfaceless platform (Mesa), current for as long as this lives.
class OffscreenContext {
 public:
  /// Throws FileError when the machine has no such platform.
  OffscreenContext();
  OffscreenContext(const OffscreenContext&) = delete;
  OffscreenContext& operator=(const OffscreenContext&) = delete;
  ~OffscreenContext();

 private:
  void* display_ = nullptr;
  void* context_ = nullptr;
};

/// A window of `width` by `height` pixels on the context now current, with smooth edges.
vtkSmartPointer<vtkGenericOpenGLRenderWindow> make_offscreen_window(int width, int height);

}  // namespace suffuse
