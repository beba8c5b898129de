#pragma once

/// Runs Gmsh for as long as this object lives: silent, deterministic, on one thread, without the
/// user's own Gmsh settings. Gmsh is one global object, so there is at most one session at a time.

#include <functional>
#include <string>

namespace suffuse {

class GmshSession {
 public:
  GmshSession();
  GmshSession(const GmshSession&) = delete;
  GmshSession& operator=(const GmshSession&) = delete;
  ~GmshSession();
};

/// Runs `body` and returns what Gmsh complained about, or empty when it did not.
std::string gmsh_complaint(const std::function<void()>& body);

/// Runs `body` in a process of its own and returns how that ended, or empty when it ended well: a
/// damaged file can crash Gmsh, keep it busy for ever or have it fill the memory. Complaints are no
/// bad end.
/// \param max_seconds  of processor time; beyond, the process is ended
/// \param max_bytes  of memory, beside what is in use already
std::string gmsh_crash(const std::function<void()>& body, double max_seconds, double max_bytes);

}  // namespace suffuse
