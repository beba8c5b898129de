#pragma once

/// The reply of the process that runs Gmsh for a user's file, and its form as bytes.

#include <string>
#include <string_view>
#include <vector>

#include "common/errors.hpp"
#include "gmsh_model.hpp"

namespace suffuse {

struct GmshReply {
  std::vector<InputProblem> problems;  ///< problems of the file; then there is no model
  GmshModel model;
  bool meshes_itself = false;  ///< the file does so, and `mesh.size` does not apply
  bool wants_threads = false;  ///< the file requests more than the one thread
};

std::string bytes_of(const GmshReply& reply);

/// The bytes may be arbitrary. Throws InputError if they are no complete and consistent reply.
/// Removes control characters, which can move a terminal's cursor, from texts.
GmshReply reply_from(std::string_view bytes);

}  // namespace suffuse
