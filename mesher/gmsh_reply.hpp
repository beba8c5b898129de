#pragma once

/// The reply of the process that runs Gmsh over a user's file, and its form as bytes.

#include <string>
#include <string_view>
#include <vector>

#include "common/errors.hpp"
#include "gmsh_model.hpp"

namespace suffuse {

struct GmshReply {
  std::vector<InputProblem> problems;  ///< what is wrong with the file; then there is no model
  GmshModel model;
  bool meshes_itself = false;  ///< the file, so that `mesh.size` does not apply
  bool wants_threads = false;  ///< the file, more than the one that there is
};

std::string bytes_of(const GmshReply& reply);

/// The bytes may be anything. Throws InputError where they are not a whole reply, or one whose
/// numbers do not fit together. Texts come without what moves a terminal's cursor.
GmshReply reply_from(std::string_view bytes);

}  // namespace suffuse
