#pragma once

/// Element sizes at the points of a user's geometry.

namespace suffuse {

/// Gives `size` to every point of the current Gmsh model to which its file gave none. Without it
/// Gmsh would take a tenth of the model's diagonal there. For confined processes
/// (`system_call_filter.hpp`) alone: Gmsh has to write a file for it. Gmsh's own errors come as its
/// exceptions.
void set_default_point_size(double size);

}  // namespace suffuse
