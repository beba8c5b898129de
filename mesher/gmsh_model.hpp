#pragma once

/// The mesh of a Gmsh model with the names of its file, as plain data that can be passed from the
/// process of Gmsh to another.

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace suffuse {

/// Elements of one type.
struct GmshElements {
  int type = 0;  ///< Gmsh's number of the type
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
  int dimension = 2;  ///< 3 if there are volumes
  std::vector<std::size_t> node_tags;
  std::vector<double> coordinates;   ///< three for each node
  std::vector<GmshEntity> entities;  ///< of `dimension`, then of one less, each by ascending tags
  std::vector<GmshGroup> groups;     ///< groups of these dimensions and of points
};

/// Reads the current model of Gmsh. Throws the exceptions of Gmsh for its own errors.
GmshModel read_gmsh_model();

/// 3 if the current Gmsh model has volumes, otherwise 2.
int gmsh_model_dimension();

/// The fault of a model that cannot come from Gmsh, or an empty text: numbers of values that do not
/// match, elements with nodes that do not exist.
std::string gmsh_model_defect(const GmshModel& model);

}  // namespace suffuse
