/// Linked into sanitized programs and tests: memory that libraries lose or keep, which the search
/// for leaks is not to count against them. Gmsh and Open CASCADE keep it until the program ends;
/// HDF5 loses it over damaged files, libpng and VTK's writers when the disk is full and an error
/// takes them out of their work.
extern "C" const char* __lsan_default_suppressions();  // NOLINT: the name is the sanitizer's
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libgmsh\nleak:libTK\nleak:libhdf5\nleak:libpng\nleak:libvtkIOImage\n"
         "leak:libvtkIOXML\n";
}
