#pragma once

/// What axes say of columns of tables and of keys of scenes.

#include <string>

namespace suffuse {

/// A key of a scene with its unit, a column of a table in words with its unit, or the name itself:
/// `time.end (s)`, `fines lost (%)`. The unit of a key whose unit depends on another key is left
/// out.
std::string axis_text(const std::string& name);

}  // namespace suffuse
