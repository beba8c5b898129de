#pragma once

/// The reply of the process that runs Gmsh for a user's file, and its form as bytes.

#include <string>
#include <string_view>
#include <vector>

#include "common/errors.hpp"
#include "gmsh_model.hpp"

namespace suffuse {

/// Limits of a geometry file that forbid some of the wanted sizes.
struct FileLimits {
  bool smallest = false;  ///< Mesh.MeshSizeMin is larger than the smallest wanted size
  bool largest = false;   ///< Mesh.MeshSizeMax is smaller than the largest wanted size
  bool field = false;     ///< the file has a field of sizes, which applies where it is smaller
};

struct GmshReply {
  std::vector<InputProblem> problems;  ///< problems of the file; then there is no model
  GmshModel model;
  bool meshes_itself = false;  ///< the file, so that `mesh.size` does not apply
  bool wants_threads = false;  ///< the file, more than the one that there is
  double default_size = 0.0;  ///< m, for a file without sizes in a scene without; 0: there are some
  FileLimits limits;          ///< of the file, which hold in addition to sizes of `--sizes`
};

std::string bytes_of(const GmshReply& reply);

/// The bytes may be arbitrary. Throws InputError if they are no complete and consistent reply.
/// Removes control characters, which can move a terminal's cursor, from texts.
GmshReply reply_from(std::string_view bytes);

}  // namespace suffuse
