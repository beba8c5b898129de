#pragma once

/// Runs code that reads a file of unknown origin in a separate process, which may do nothing else.

#include <functional>
#include <string>

namespace suffuse {

struct ChildLimits {
  double processor_seconds;
  double wall_seconds;
  double bytes;  ///< memory in addition to what this process has, and largest reply
};

/// How a child ended.
struct ChildEnd {
  enum class How {
    replied,
    refused,         ///< it tried what a confined process may not do
    crashed,         ///< by a signal
    left,            ///< without a reply
    processor_time,  ///< took more than it was given
    wall_time,
    memory,
  };
  How how;
  std::string text;  ///< the reply; where it was refused, what it tried, as `has Gmsh ... ` goes on
};

/// Runs `prepare` in a child process, which is then confined (`system_call_filter.hpp`), runs
/// `body` and returns its reply. Both are held to `limits`. The child has no other descriptor than
/// that of its reply; what it prints is dropped. It ends with this process, whichever way this one
/// ends. What comes back was made by whoever wrote the file that the child read: nothing about it
/// is sure but its length.
///
/// There must be one thread only. Throws FileError where no child can be started, or none that is
/// confined.
ChildEnd run_confined(const std::function<void()>& prepare,
                      const std::function<std::string()>& body, const ChildLimits& limits);

}  // namespace suffuse
