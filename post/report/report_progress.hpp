#pragma once

/// What a report is working on, for those who wait.

#include <functional>
#include <string>

namespace suffuse {

/// Called as the work at a part of a report begins, such as "pictures of head, 12 times". Empty: no
/// one wants to know.
using ReportProgress = std::function<void(const std::string& part)>;

inline void tell(const ReportProgress& progress, const std::string& part) {
  if (progress) progress(part);
}

}  // namespace suffuse
