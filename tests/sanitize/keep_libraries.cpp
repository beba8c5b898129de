/// Linked into the sanitized programs that draw. Mesa unloads its OpenGL driver with the display
/// and leaves the driver's own tables allocated: 240 bytes that the driver points to while it is
/// loaded, and that no suppression can name once it is gone. Libraries therefore stay until the
/// program ends.

extern "C" int dlclose(void* /*handle*/) {
  return 0;
}
