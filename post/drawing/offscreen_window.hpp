#pragma once

/// A VTK render window that draws into memory and needs no X server.

#include <vtkGenericOpenGLRenderWindow.h>

namespace suffuse {

/// The window of the process, `width` by `height` pixels with smooth edges, in an OpenGL context of
/// EGL's surfaceless platform (Mesa). It is made once: a second one would compile all shaders
/// again, which takes half of the time of a picture. Throws FileError when the machine has no such
/// platform or OpenGL does not start.
vtkGenericOpenGLRenderWindow& offscreen_window(int width, int height);

}  // namespace suffuse
