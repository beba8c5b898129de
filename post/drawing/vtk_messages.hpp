#pragma once

/// Turns VTK's error messages into exceptions. VTK itself prints them and goes on.

#include <string>
#include <vector>

#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>

namespace suffuse {

/// Collects VTK's messages during its lifetime.
class VtkMessages {
 public:
  VtkMessages();
  VtkMessages(const VtkMessages&) = delete;
  VtkMessages& operator=(const VtkMessages&) = delete;
  ~VtkMessages();

  /// Drops the messages that end in `ending`.
  void forget(const std::string& ending);
  /// Throws FileError with the first message, if there is any; `what` is the start of its text.
  void throw_errors(const std::string& what) const;

 private:
  std::vector<std::string> messages_;
  vtkSmartPointer<vtkOutputWindow> before_;
  int verbosity_;
};

}  // namespace suffuse
