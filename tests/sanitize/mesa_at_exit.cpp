/// Linked into the sanitized programs that draw: prevents actions of Mesa that break the leak
/// search or take long under sanitizers.

#include <cstdlib>

namespace {

/// The thread that keeps compiled shaders on disk may still be at work when the program ends, and
/// the search for leaks then crashes in it ("Tracer caught signal 11").
[[maybe_unused]] const int no_shader_cache = setenv("MESA_SHADER_CACHE_DISABLE", "true", 0);

/// Selects the driver that interprets shaders: compiling them under the sanitizers takes most of a
/// test's time.
[[maybe_unused]] const int no_compiler = setenv("GALLIUM_DRIVER", "softpipe", 0);

}  // namespace

/// Mesa unloads its OpenGL driver with the display and leaves the driver's own tables allocated:
/// 240 bytes that the driver points to while it is loaded, and that no suppression can name once it
/// is gone. Libraries therefore stay until the program ends.
extern "C" int dlclose(void* /*handle*/) {
  return 0;
}
