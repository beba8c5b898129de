#include "drawing/offscreen_window.hpp"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <vtkObjectFactory.h>

#include <array>
#include <string>

#include "common/errors.hpp"
#include "drawing/vtk_messages.hpp"

namespace suffuse {
namespace {

[[noreturn]] void refuse(const std::string& what) {
  throw FileError(
      "cannot draw: " + what +
      "; off-screen drawing needs EGL's surfaceless platform (package libegl1 with Mesa)");
}

/// A window in an existing context. Debian's GLEW loads every OpenGL function, then looks for a GLX
/// display and reports `Unknown error` because there is none. VTK would stop at that message.
class EglWindow : public vtkGenericOpenGLRenderWindow {
 public:
  static EglWindow* New();

  void OpenGLInitContext() override {
    if (Initialized) return;
    VtkMessages messages;
    vtkGenericOpenGLRenderWindow::OpenGLInitContext();
    messages.forget("GLEW could not be initialized: Unknown error");
    messages.throw_errors("drawing");
    Initialized = true;
    GlewInitValid = true;
  }
};
vtkStandardNewMacro(EglWindow);

}  // namespace

OffscreenContext::OffscreenContext() {
  display_ = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (display_ == EGL_NO_DISPLAY || eglInitialize(display_, nullptr, nullptr) == EGL_FALSE) {
    refuse("EGL has no surfaceless display");
  }
  constexpr std::array<EGLint, 5> wanted{EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE,
                                         EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  eglBindAPI(EGL_OPENGL_API);
  if (eglChooseConfig(display_, wanted.data(), &config, 1, &count) == EGL_FALSE || count == 0) {
    refuse("EGL has no configuration for OpenGL");
  }
  constexpr std::array<EGLint, 5> version{EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION,
                                          2, EGL_NONE};
  context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, version.data());
  if (context_ == EGL_NO_CONTEXT ||
      eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_FALSE) {
    refuse("EGL gives no OpenGL 3.2 context");
  }
}

OffscreenContext::~OffscreenContext() {
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display_, context_);
  eglTerminate(display_);
}

vtkSmartPointer<vtkGenericOpenGLRenderWindow> make_offscreen_window(int width, int height) {
  const auto window = vtkSmartPointer<EglWindow>::New();
  window->SetSize(width, height);
  window->SetMultiSamples(8);
  window->SetOffScreenRendering(true);
  window->SetReadyForRendering(true);
  window->SetIsCurrent(true);
  window->OpenGLInit();
  return window;
}

}  // namespace suffuse
