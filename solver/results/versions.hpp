#pragma once

/// What this program was built from.

#include <map>
#include <string>

namespace suffuse {

/// Keys suffuse, git, compiler, eigen, hdf5. `git` is "unknown" when built outside a checkout.
std::map<std::string, std::string> versions();

}  // namespace suffuse
