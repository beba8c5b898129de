#pragma once

/// Removes the rights of a process that are not needed to read files and compute.

#include <string>

namespace suffuse {

/// Actions that a confined process must not do.
enum class Refused : char {
  process = 'p',  ///< start a program, a process or a thread
  writing = 'w',  ///< write, make, rename or remove a file
  network = 'n',  ///< open a connection
  waiting = 's',  ///< sleep
  special = 'd',  ///< read a file that is not regular: a pipe, a device
};

/// From now on this process may compute, allocate memory, read regular files, write to the
/// descriptors that it has, and end: an allow list refuses every other system call. An attempt at
/// what `Refused` lists ends the process; any other call fails with EPERM. The process cannot take
/// this back.
///
/// An attempt is reported as the byte `report_mark`, the byte of `Refused` and the name of the file
/// if there is one. A process that blocks signals, as before the start of another process, is ended
/// by SIGSYS without a report.
/// \param report_to  descriptor
/// Throws FileError if the system has no such filter.
void confine_process(int report_to);

inline constexpr char report_mark = 'C';

/// While it lives, a file that a confined process opens to write is a file in memory instead, which
/// is removed with this object. There is at most one at a time.
class WritesToMemory {
 public:
  WritesToMemory();
  WritesToMemory(const WritesToMemory&) = delete;
  WritesToMemory& operator=(const WritesToMemory&) = delete;
  ~WritesToMemory();
  /// Path by which the file in memory is read.
  [[nodiscard]] std::string path() const;

 private:
  int file_ = -1;
};

}  // namespace suffuse
