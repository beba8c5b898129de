#pragma once

/// Element sizes of a user's geometry. For confined processes (`system_call_filter.hpp`) alone:
/// Gmsh has to write a file to tell them. Gmsh's own errors come as its exceptions.

namespace suffuse {

/// What the file of the current Gmsh model says of sizes.
struct OwnSizes {
  bool any = false;    ///< at points, along curves, by a field, or a largest size
  bool field = false;  ///< a field of sizes
};

OwnSizes own_sizes();

/// Gives `size` to every point of the current Gmsh model to which its file gave none. Without it
/// Gmsh would take a tenth of the model's diagonal there.
void set_default_point_size(double size);

}  // namespace suffuse
