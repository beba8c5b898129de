/// Linked into sanitized programs and tests: leaks of libraries that the leak search ignores. Gmsh
/// and Open CASCADE keep memory until the program ends; HDF5 loses memory over damaged files,
/// libpng and VTK's writers lose it when the disk is full and an error interrupts them.
extern "C" const char* __lsan_default_suppressions();  // NOLINT: the name is the sanitizer's
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libgmsh\nleak:libTK\nleak:libhdf5\nleak:libpng\nleak:libvtkIOImage\n"
         "leak:libvtkIOXML\n";
}
