#pragma once

/// VTK prints what goes wrong and carries on; this turns it into errors.

#include <string>
#include <vector>

#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>

namespace suffuse {

/// Catches VTK's messages for as long as it lives.
class VtkMessages {
 public:
  VtkMessages();
  VtkMessages(const VtkMessages&) = delete;
  VtkMessages& operator=(const VtkMessages&) = delete;
  ~VtkMessages();

  /// Drops the messages that end in exactly this.
  void forget(const std::string& ending);
  /// Throws FileError with the first message, if there is any; `what` says what was being done.
  void throw_errors(const std::string& what) const;

 private:
  std::vector<std::string> messages_;
  vtkSmartPointer<vtkOutputWindow> before_;
  int verbosity_;
};

}  // namespace suffuse
