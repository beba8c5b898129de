#pragma once

/// Physical groups of Gmsh's current model.

#include <string>
#include <vector>

namespace suffuse {

/// Makes a physical group of entities of a dimension and names it. Gmsh chooses its tag if `tag` is
/// -1.
void name_group(int dimension, const std::vector<int>& entities, const std::string& name,
                int tag = -1);

}  // namespace suffuse
