#pragma once

/// Sizes of elements that a file asks for, in the place of `mesh.size`.

#include <array>
#include <string>
#include <variant>
#include <vector>

#include "case/mesh_sizes.hpp"
#include "scene/scene.hpp"

namespace suffuse {

struct WantedSizes {
  std::string path;
  std::variant<MeshSizes<2>, MeshSizes<3>> sizes;

  [[nodiscard]] int dimension() const {
    return std::holds_alternative<MeshSizes<2>>(sizes) ? 2 : 3;
  }
};

/// Throws FileError.
WantedSizes read_wanted_sizes(const std::string& path);

/// The scene as it is meshed with sizes of a file: of the structure "free" where it names none, and
/// without its own `mesh.size`. Throws InputError for a scene whose mesh cannot have any sizes, and
/// for sizes that make more elements than anybody wants.
SceneDocument scene_with_sizes(SceneDocument document, const WantedSizes& wanted);

/// The box around a model, and whether some of its boundaries are curved: the boxes of its meshes
/// differ then.
struct ModelBox {
  int dimension;
  std::array<double, 3> low;   ///< m
  std::array<double, 3> high;  ///< m
  bool curved = false;
};

/// Throws InputError where the sizes are those of a mesh of another model: of other dimensions, or
/// with another box around it.
void refuse_sizes_of_another_model(const WantedSizes& wanted, const ModelBox& box);

/// Throws InputError where the mesh of the sizes has other regions than these.
void refuse_sizes_of_other_regions(const WantedSizes& wanted, std::vector<std::string> regions);

/// While it lives, Gmsh makes elements of these sizes in the place of those that points and
/// curvature ask for. Limits and fields of sizes hold too: the smaller size counts.
class SizesInGmsh {
 public:
  /// \param scale  metres per unit of length of the models
  SizesInGmsh(const WantedSizes& wanted, double scale);
  SizesInGmsh(const SizesInGmsh&) = delete;
  SizesInGmsh& operator=(const SizesInGmsh&) = delete;
  ~SizesInGmsh();
};

}  // namespace suffuse
