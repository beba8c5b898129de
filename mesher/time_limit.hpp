#pragma once

/// Ends the program when a library takes too long and cannot be asked to stop.

#include <string>

namespace suffuse {

/// While it lives, the process may use so many seconds of processor time. Then it writes the
/// message to stderr and ends with the exit code of wrong input. Nothing is unwound, so no output
/// may be open. There is at most one at a time.
class TimeLimit {
 public:
  /// \param seconds  infinite: no limit
  TimeLimit(double seconds, const std::string& message);
  TimeLimit(const TimeLimit&) = delete;
  TimeLimit& operator=(const TimeLimit&) = delete;
  ~TimeLimit();
};

}  // namespace suffuse
