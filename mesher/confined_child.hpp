#pragma once

/// Runs code that reads a file of unknown origin in a separate process without other rights.

#include <functional>
#include <string>

namespace suffuse {

struct ChildLimits {
  double processor_seconds;
  double wall_seconds;
  double bytes;  ///< memory beyond that of this process, and largest reply
};

/// How a child ended.
struct ChildEnd {
  enum class How {
    replied,
    refused,         ///< it tried a forbidden action
    crashed,         ///< by a signal
    left,            ///< without a reply
    processor_time,  ///< exceeded its limit
    wall_time,
    memory,
  };
  How how;
  std::string text;  ///< the reply; if refused, the action, to follow `has Gmsh ... `
};

/// Runs `prepare` in a child process, which is then confined (`system_call_filter.hpp`), runs
/// `body` and returns its reply. `limits` apply to both. The child has no other descriptor than
/// that of its reply; what it prints is dropped. It ends with this process in any case. Do not
/// trust the content of the reply, because a hostile file can have written it: only its length is
/// checked.
///
/// There must be one thread only. Throws FileError if no confined child can be started.
ChildEnd run_confined(const std::function<void()>& prepare,
                      const std::function<std::string()>& body, const ChildLimits& limits);

}  // namespace suffuse
