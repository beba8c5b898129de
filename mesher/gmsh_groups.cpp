#include "gmsh_groups.hpp"

#include <gmsh.h>

namespace suffuse {

void name_group(int dimension, const std::vector<int>& entities, const std::string& name, int tag) {
  const int group = gmsh::model::addPhysicalGroup(dimension, entities, tag);
  gmsh::model::setPhysicalName(dimension, group, name);
}

}  // namespace suffuse
