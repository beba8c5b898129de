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

/// Runs `body` and returns what Gmsh complained about, or empty when it did not; `no_memory` where
/// there was not enough.
std::string gmsh_complaint(const std::function<void()>& body);

}  // namespace suffuse
