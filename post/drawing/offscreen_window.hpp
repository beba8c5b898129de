#pragma once

/// A VTK render window that draws into memory and needs no X server.

#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkSmartPointer.h>

#include <memory>

namespace suffuse {

/// An OpenGL context of EGL's surfaceless platform (Mesa). It is the current context of the thread
/// as long as the object lives.
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

/// A window of `width` by `height` pixels in the current OpenGL context, with smooth edges. Throws
/// FileError when OpenGL does not start.
vtkSmartPointer<vtkGenericOpenGLRenderWindow> make_offscreen_window(int width, int height);

}  // namespace suffuse
