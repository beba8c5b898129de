#pragma once

/// Versions of this program and of the libraries it was built with.

#include <map>
#include <string>

namespace suffuse {

/// Keys suffuse, git, compiler, eigen, hdf5. `git` is "unknown" when built outside a checkout.
std::map<std::string, std::string> versions();

}  // namespace suffuse
