#include "drawing/vtk_messages.hpp"

#include <vtkLogger.h>
#include <vtkObjectFactory.h>

#include <algorithm>

#include "common/errors.hpp"

namespace suffuse {
namespace {

class MessageList : public vtkOutputWindow {
 public:
  static MessageList* New();
  void DisplayText(const char* text) override {
    std::string message = text;
    message.erase(message.find_last_not_of(" \n") + 1);
    if (list != nullptr && !message.empty()) list->push_back(message);
  }
  std::vector<std::string>* list = nullptr;
};
vtkStandardNewMacro(MessageList);

}  // namespace

VtkMessages::VtkMessages()
    : before_(vtkOutputWindow::GetInstance()), verbosity_(vtkLogger::GetCurrentVerbosityCutoff()) {
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  const auto window = vtkSmartPointer<MessageList>::New();
  window->list = &messages_;
  vtkOutputWindow::SetInstance(window);
}

VtkMessages::~VtkMessages() {
  vtkOutputWindow::SetInstance(before_);
  vtkLogger::SetStderrVerbosity(vtkLogger::ConvertToVerbosity(verbosity_));
}

void VtkMessages::forget(const std::string& ending) {
  std::erase_if(messages_, [&](const std::string& text) { return text.ends_with(ending); });
}

void VtkMessages::throw_errors(const std::string& what) const {
  if (!messages_.empty()) throw FileError(what + ": " + messages_.front());
}

}  // namespace suffuse
