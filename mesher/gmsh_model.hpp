#pragma once

/// The mesh of a Gmsh model with what its file names, as plain data: it can be handed from the
/// process that ran Gmsh to another.

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace suffuse {

/// Elements of one type.
struct GmshElements {
  int type = 0;  ///< Gmsh's number of it
  std::string type_name;
  int nodes_each = 0;
  std::vector<std::size_t> tags;
  std::vector<std::size_t> nodes;  ///< `nodes_each` tags for each element
};

/// A point, curve, surface or volume.
struct GmshEntity {
  int dimension = 0;
  int tag = 0;
  std::array<double, 6>
      box{};  ///< x, y, z of the least corner, then of the greatest; zeros without elements
  std::vector<GmshElements> elements;
};

/// A physical group.
struct GmshGroup {
  int dimension = 0;
  int tag = 0;
  std::string name;
  std::vector<int> entities;
  std::vector<std::size_t> nodes;  ///< tags; of a group of points
};

struct GmshModel {
  int dimension = 2;  ///< 3 where there are volumes
  std::vector<std::size_t> node_tags;
  std::vector<double> coordinates;  ///< three for each node
  std::vector<GmshEntity>
      entities;                   ///< those of this dimension, then of one less, by ascending tags
  std::vector<GmshGroup> groups;  ///< of these dimensions and of points
};

/// The current model of Gmsh, whose errors come as its exceptions.
GmshModel read_gmsh_model();

/// 3 where the current Gmsh model has volumes, else 2.
int gmsh_model_dimension();

/// What is wrong with a model that did not come from Gmsh itself, or nothing: numbers of values
/// that do not match, elements at nodes that are not there.
std::string gmsh_model_defect(const GmshModel& model);

}  // namespace suffuse
