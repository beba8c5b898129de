#pragma once

/// Runs Gmsh for as long as this object lives: silent, deterministic, on one thread, without the
/// user's own Gmsh settings. Gmsh is one global object, so there is at most one session at a time.

#include <functional>
#include <string>

namespace suffuse {

inline constexpr const char* no_memory = "not enough memory";

class GmshSession {
 public:
  GmshSession();
  GmshSession(const GmshSession&) = delete;
  GmshSession& operator=(const GmshSession&) = delete;
  ~GmshSession();
};

/// Runs `body` and returns the error of Gmsh, or an empty text; `no_memory` if memory was not
/// sufficient.
std::string gmsh_complaint(const std::function<void()>& body);

}  // namespace suffuse
