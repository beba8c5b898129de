#include "drawing/offscreen_window.hpp"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <vtkObjectFactory.h>
#include <vtkSmartPointer.h>

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

/// Makes a context the current one of the thread, for the rest of the process.
void make_context() {
  EGLDisplay display =
      eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) == EGL_FALSE) {
    refuse("EGL has no surfaceless display");
  }
  constexpr std::array<EGLint, 5> wanted{EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE,
                                         EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  eglBindAPI(EGL_OPENGL_API);
  if (eglChooseConfig(display, wanted.data(), &config, 1, &count) == EGL_FALSE || count == 0) {
    refuse("EGL has no configuration for OpenGL");
  }
  constexpr std::array<EGLint, 5> version{EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION,
                                          2, EGL_NONE};
  EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, version.data());
  if (context == EGL_NO_CONTEXT ||
      eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_FALSE) {
    refuse("EGL gives no OpenGL 3.2 context");
  }
}

vtkSmartPointer<EglWindow> make_window(int width, int height) {
  make_context();
  auto window = vtkSmartPointer<EglWindow>::New();
  window->SetSize(width, height);
  window->SetMultiSamples(8);
  window->SetOffScreenRendering(true);
  window->SetReadyForRendering(true);
  window->SetIsCurrent(true);
  window->OpenGLInit();
  return window;
}

}  // namespace

vtkGenericOpenGLRenderWindow& offscreen_window(int width, int height) {
  // Never destroyed: VTK and Mesa may be gone before.
  static auto* const window = new vtkSmartPointer<EglWindow>(make_window(width, height));
  (*window)->SetSize(width, height);
  return **window;
}

}  // namespace suffuse
