#include "gmsh_groups.hpp"

#include <gmsh.h>

namespace suffuse {

void name_group(int dimension, const std::vector<int>& entities, const std::string& name) {
  const int group = gmsh::model::addPhysicalGroup(dimension, entities);
  gmsh::model::setPhysicalName(dimension, group, name);
}

}  // namespace suffuse
