#pragma once

/// Element sizes at the points of a user's geometry.

namespace suffuse {

/// Gives `size` to every point of the current Gmsh model whose file gives none. Gmsh would
/// otherwise use a tenth of the model's diagonal. Only for confined processes
/// (`system_call_filter.hpp`), because Gmsh has to write a file. Throws the exceptions of Gmsh for
/// its own errors.
void set_default_point_size(double size);

}  // namespace suffuse
